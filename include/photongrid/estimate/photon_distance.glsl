// How far a photon is, as a search measures it. Included by kernels after their SWITCHes and inputs.
//
// A photon that a policy rejects is farther than any radius, so that it neither counts nor shrinks one. FLATTEN turns the
// ball of the search into an ellipsoid that is flat along the surface's normal (Jensen, Realistic Image Synthesis Using
// Photon Mapping, 2001, section 7.3): distances only grow, so what holds for cells out of reach still holds.
//
// args.leaks: x: NORMALS: smallest cosine between the photon's surface normal and the query's; y: FLATTEN: c^2 - 1, where
// distances along the normal count c times.
//
// q: the photon's position, w: its direction of travel, m: its surface normal; p, n: the query's position and normal.
float distance2_of(vec4 q, vec4 w, vec4 m, vec4 p, vec4 n)
{
    precise float dx = q.x - p.x;
    precise float dy = q.y - p.y;
    precise float dz = q.z - p.z;
    precise float d2 = dx * dx + dy * dy + dz * dz;
    if (FLATTEN) {
        precise float h = dx * n.x + dy * n.y + dz * n.z;
        precise float longer = d2 + args.leaks.y * (h * h);
        d2 = longer;
    }
    d2 = d2 < 1.17549435e-38f ? 0.0f : d2; // denormals are 0 on every backend
    if (SIDE) {
        // Light that arrives from behind the surface.
        precise float arrival = w.x * n.x + w.y * n.y + w.z * n.z;
        if (!(arrival < 0.0f))
            d2 = 3.4028234e38f;
    }
    if (NORMALS) {
        precise float cosine = m.x * n.x + m.y * n.y + m.z * n.z;
        if (!(cosine >= args.leaks.x))
            d2 = 3.4028234e38f;
    }
    return d2;
}

float photon_distance2(uint at, vec4 p, vec4 n)
{
    vec4 q = positions(at);
    vec4 w = q;
    if (SIDE)
        w = directions(at);
    vec4 m = q;
    if (NORMALS)
        m = photon_normals(at);
    return distance2_of(q, w, m, p, n);
}
