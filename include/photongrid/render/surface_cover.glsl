// The polygons of a scene that an estimate's disc lies on, for sums over them (covered_share.glsl): integrals over the
// intersection of polygon and disc are sums over the polygon's edges. Included by kernels after their scene buffer,
// materials.glsl and polygon_record.glsl. Lengths are divided by the disc's radius unless they are said to be in m.
//
// A polygon counts if the point lies in its plane, on either side, or if its plane is tilted by up to 2.5 degrees and
// passes near the point within the disc, so that slightly bent walls stay connected. The photons of other polygons must
// be rejected (leak_policy::min_cosine).
//
// A lamp or mirror close in front of the surface hides what lies behind it, as a lamp does that is mounted on a
// ceiling: its part is subtracted. It holds no photons, and keeps them from the surface. Light reaches as far behind
// its edge as it is missing beside it, so that only the square of its height over the radius is neglected.

// A polygon's part in a disc.
struct PartOfDisc {
    float counted;         // how much of it counts: 1 if it holds photons, less than 0 if it hides the surface; 0: it
                           // has no part
    bool is_whole;         // the whole disc is on it
    bool holds_its_center; // it holds photons, and the disc's centre lies on it
};

// The part of the surface behind a lamp or mirror that it hides, by its height above the surface over the radius: all
// of it at height 0, none from a quarter of the radius on, where the disc sees how light fades behind the edge.
float hidden_part(float height)
{
    precise float part = 1.0f - 16.0f * (height * height);
    return part > 0.0f ? part : 0.0f;
}

// How much of a polygon's part counts. `height`, of its plane above the surface at the point, and `rise`, of that plane
// over the disc, m; `inverse`: of the radius.
float counted_part(uint at, float height, float rise, float inverse)
{
    float error = polygon_error(at);
    if (!is_light_surface(at)) {
        Material material = material_of(polygon_material(at));
        if (material.kind != MIRROR_SURFACE) {
            precise float tolerance = error + rise;
            return stores_photons(material) && abs(height) <= tolerance ? 1.0f : 0.0f;
        }
    }
    precise float over_radius = (height + rise) * inverse;
    return height > error ? -hidden_part(over_radius) : 0.0f;
}

// The part of the polygon at record `at` in the disc about p, of normal n and this radius, m.
PartOfDisc part_of_disc(uint at, vec3 p, vec3 n, float radius, float inverse)
{
    PartOfDisc part;
    part.counted = 0.0f;
    part.is_whole = false;
    part.holds_its_center = false;
    vec4 plane = polygon_plane(at);
    vec3 up = vec3(plane);
    float error = polygon_error(at);
    uint edges = polygon_edges(at);
    uint vertices = polygon_vertices(at, edges);
    precise float above = dot3(up, p) - plane.w;
    vec3 turn = cross3(n, up);
    float sine2 = dot3(turn, turn);
    precise float rise = radius * sqrt(sine2); // of its plane over the disc
    if (!(sine2 <= 0.0019f) || !(abs(above) <= error + rise + 0.25f * radius))
        return part;
    float height = dot3(n, up) > 0.0f ? -above : above;
    float counted = counted_part(at, height, rise, inverse);
    if (counted == 0.0f)
        return part;

    float nearest = 3.0e38f; // edge's line, m; positive inside
    for (uint e = 0u; e < edges; ++e) {
        precise vec3 f = p - vec3(scene(vertices + e));
        float d = dot3(vec3(polygon_edge(at, e)), f);
        nearest = d < nearest ? d : nearest;
    }
    if (counted < 0.0f && nearest > 2.0f * error)
        return part; // the point is behind it
    part.holds_its_center = counted > 0.0f && sine2 <= 1e-10f && abs(above) <= error && nearest >= -2.0f * error;
    if (nearest <= -radius)
        return part;
    part.counted = counted;
    part.is_whole = nearest >= radius;
    return part;
}

// An edge of a polygon, seen from the disc's centre.
struct EdgeOfDisc {
    vec3 inward; // unit
    vec3 way;    // unit, along the edge
    float d;     // distance of its line, positive if the centre is inside
    float from;  // the part of it inside the disc, as distances along `way` from the foot of the centre on its line
    float to;
    float rim; // the angle that the rest of it subtends, at the rim; negative if d is
};

// The angle that an edge at distance d subtends between a and b, a <= b.
float subtended(float d, float a, float b)
{
    precise float sine = abs(d) * (b - a);
    precise float cosine = d * d + a * b;
    return sine > 0.0f ? angle_of(sine, cosine) : 0.0f;
}

// Edge e of a polygon, from a to b: of the vertices less the disc's centre, m.
EdgeOfDisc edge_of_disc(uint at, uint e, vec3 a, vec3 b, float inverse)
{
    EdgeOfDisc edge;
    vec3 inward = vec3(polygon_edge(at, e));
    vec3 way = cross3(inward, vec3(polygon_plane(at)));
    precise float d = -dot3(inward, a) * inverse;
    precise float s = dot3(way, a) * inverse;
    precise float t = dot3(way, b) * inverse;
    precise float chord2 = 1.0f - d * d;
    precise float chord = sqrt(chord2 > 0.0f ? chord2 : 0.0f); // half of it
    float from = s < -chord ? -chord : s > chord ? chord : s;
    float to = t < -chord ? -chord : t > chord ? chord : t;
    precise float rim = subtended(d, s, from) + subtended(d, to, t);
    if (from == to)
        rim = subtended(d, s, t);
    edge.inward = inward;
    edge.way = way;
    edge.d = d;
    edge.from = from;
    edge.to = to;
    edge.rim = d < 0.0f ? -rim : rim;
    return edge;
}
