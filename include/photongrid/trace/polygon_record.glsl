// A polygon's records, read by name: plane; edges, material, light + 1 (0: none), bound on rounding; for each edge its
// half-space; for each vertex its place. Included by kernels after their scene buffer.
vec4 polygon_plane(uint at)
{
    return scene(at);
}
uint polygon_edges(uint at)
{
    return uint(scene(at + 1u).x);
}
uint polygon_material(uint at)
{
    return uint(scene(at + 1u).y);
}
bool is_light_surface(uint at)
{
    return scene(at + 1u).z > 0.0f;
}
uint polygon_light(uint at)
{
    return uint(scene(at + 1u).z) - 1u;
}
// Bounds the error of distances from the plane and the edges, m.
float polygon_error(uint at)
{
    return scene(at + 1u).w;
}
// xyz: inward, unit, in the plane; w: offset
vec4 polygon_edge(uint at, uint e)
{
    return scene(at + 2u + e);
}
// Record of the first vertex; the others follow.
uint polygon_vertices(uint at, uint edges)
{
    return at + 2u + edges;
}
// Records of a polygon.
uint polygon_stride(uint edges)
{
    return 2u + 2u * edges;
}
