// The squared distance of a photon from a query point, with leak policies. Included by kernels after their SWITCHes and
// inputs.
//
// A photon that a policy rejects gets a distance larger than any radius, so that it neither counts nor affects the
// radius. FLATTEN turns the search ball into an ellipsoid that is flat along the surface normal (Jensen, Realistic
// Image Synthesis Using Photon Mapping, 2001, section 7.3). Distances only grow by it, so cells outside the radius may
// still be skipped.
//
// args.leaks: x: NORMALS: least cosine of the angle between the photon's and the query's surface normals; y: FLATTEN:
// c^2 - 1, where distances along the normal are multiplied by c.
//
// q, w, m: the photon's position, direction and surface normal; p, n: the query's position and surface normal.
#include <photongrid/estimate/off_surface.glsl>

float distance2_of(vec4 q, vec4 w, vec4 m, vec4 p, vec4 n)
{
    precise float dx = q.x - p.x;
    precise float dy = q.y - p.y;
    precise float dz = q.z - p.z;
    precise float plain2 = dx * dx + dy * dy + dz * dz;
    float d2 = plain2;
    if (FLATTEN) {
        precise float h = dx * n.x + dy * n.y + dz * n.z;
        precise float longer = d2 + args.leaks.y * (h * h);
        d2 = longer;
    }
    d2 = d2 < 1.17549435e-38f ? 0.0f : d2; // denormals count as 0 on every backend
    if (SIDE) {
        // Reject photons that arrive from behind the surface.
        precise float arrival = w.x * n.x + w.y * n.y + w.z * n.z;
        if (!(arrival < 0.0f))
            d2 = 3.4028234e38f;
    }
    if (NORMALS) {
        precise float cosine = m.x * n.x + m.y * n.y + m.z * n.z;
        if (!(cosine >= args.leaks.x) || is_off_surface(dx, dy, dz, plain2, m, n, cosine, p))
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
