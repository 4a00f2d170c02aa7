// Convex polygons, and the surfaces of rectangle lights. Records: trace/polygon_record.glsl.
SWITCH(3, POLYGONS)
const uint POLYGON = 3u;

// Watertight test: projects the vertices along the ray and tests whether the ray is inside the projected polygon. Each
// vertex is rounded once, and the comparisons of products are exact, so that of two polygons with a common edge or
// vertex at least one is hit. Returns the distance along the ray, clamped to those of the nearest and the farthest
// vertex. After Woop, Benthin and Wald, Watertight Ray/Triangle Intersection, JCGT 2(1), 2013.
float hit_at_edge(uint vertices, uint edges, vec3 o, vec3 d, float plane_t, float far)
{
    vec3 u = from_basis(vec3(1.0f, 0.0f, 0.0f), d);
    vec3 v = from_basis(vec3(0.0f, 1.0f, 0.0f), d);
    bool left = false;
    bool right = false;
    float nearest = far;
    float farthest = 0.0f;
    float x0 = 0.0f;
    float y0 = 0.0f;
    for (uint e = 0u; e <= edges; ++e) {
        precise vec3 f = vec3(scene(vertices + (e == edges ? 0u : e))) - o;
        float x = dot3(f, u);
        float y = dot3(f, v);
        float z = dot3(f, d);
        precise float xy = x0 * y;
        precise float yx = y0 * x;
        left = left || (e > 0u && xy > yx);
        right = right || (e > 0u && xy < yx);
        nearest = z < nearest ? z : nearest;
        farthest = z > farthest ? z : farthest;
        x0 = x;
        y0 = y;
    }
    if (left == right) // outside, or seen edge-on
        return far;
    float t = plane_t < nearest ? nearest : plane_t;
    t = t > farthest ? farthest : t;
    return t > 0.0f && t < far ? t : far;
}

// Intersects the plane, then tests one half-space per edge. The half-spaces are larger than the polygon by a small
// margin, so that no ray slips between a polygon and an adjoining shape. If rounding, which is larger at grazing
// incidence, leaves it open on which side of an edge the ray passes, hit_at_edge decides.
float hit_polygon(uint at, uint edges, vec3 o, vec3 d, float far)
{
    vec4 plane = polygon_plane(at);
    float slope = dot3(vec3(plane), d);
    if (slope == 0.0f)
        return far;
    precise float t = (plane.w - dot3(vec3(plane), o)) / slope;
    bool in_reach = t > 0.0f && t < far;
    if (!in_reach && abs(slope) > 0.001f) // at grazing incidence t may have a large error
        return far;
    vec3 p = ray_at(o, d, t);
    bool open = false;
    for (uint e = 0u; e < edges; ++e) {
        vec4 edge = polygon_edge(at, e);
        float inward = dot3(vec3(edge), p);
        if (inward < edge.w) {
            precise float outside = (edge.w - inward) * abs(slope);
            if (outside > polygon_error(at))
                return far;
            open = true;
        }
    }
    if (open)
        return hit_at_edge(polygon_vertices(at, edges), edges, o, d, t, far);
    return in_reach ? t : far;
}

Closest closest_polygon(vec3 o, vec3 d, Closest c)
{
    Table polygons = table_of(scene(POLYGON));
    uint at = polygons.first;
    for (uint n = 0u; n < polygons.count; ++n) {
        uint edges = polygon_edges(at);
        float t = hit_polygon(at, edges, o, d, c.t);
        if (t < c.t) {
            c.t = t;
            c.kind = POLYGON;
            c.at = at;
        }
        at += polygon_stride(edges);
    }
    return c;
}

Hit polygon_surface(uint at, Hit hit)
{
    hit.position = onto_plane(polygon_plane(at), hit.position);
    hit.normal = vec3(polygon_plane(at));
    hit.material = polygon_material(at);
    if (AREA_LIGHTS && is_light_surface(at)) {
        hit.material = NO_MATERIAL;
        hit.light = polygon_light(at);
    }
    return hit;
}

// Tests the polygons of `candidates` (shaft in trace/intersect.glsl).
bool polygons_block(vec3 o, vec3 d, float far, uint candidates)
{
    Table polygons = table_of(scene(POLYGON));
    uint at = polygons.first;
    for (uint n = 0u; n < polygons.count; ++n) {
        uint edges = polygon_edges(at);
        if ((candidates & bit_of(n)) != 0u && hit_polygon(at, edges, o, d, far) < far)
            return true;
        at += polygon_stride(edges);
    }
    return false;
}

// All polygons except those whose plane has the point and the parallelogram clearly on one side.
uint polygons_in_shaft(vec3 from, vec3 corner, vec3 edge_u, vec3 edge_v)
{
    uint candidates = 0u;
    Table polygons = table_of(scene(POLYGON));
    uint at = polygons.first;
    for (uint n = 0u; n < polygons.count; ++n) {
        vec4 plane = polygon_plane(at);
        vec3 normal = vec3(plane);
        float error = polygon_error(at);
        precise float here = dot3(normal, from) - plane.w;
        precise float there = dot3(normal, corner) - plane.w;
        float by_u = dot3(normal, edge_u);
        float by_v = dot3(normal, edge_v);
        precise float highest = there + (by_u > 0.0f ? by_u : 0.0f) + (by_v > 0.0f ? by_v : 0.0f);
        precise float lowest = there + (by_u < 0.0f ? by_u : 0.0f) + (by_v < 0.0f ? by_v : 0.0f);
        if (!(here > error && lowest > error) && !(here < -error && highest < -error))
            candidates |= bit_of(n);
        at += polygon_stride(polygon_edges(at));
    }
    return candidates;
}
