// Accessors of a polygon's records: plane; edges, material, light + 1 (0: none), rounding error; a half-space per edge;
// a position per vertex. Included by kernels after the scene buffer.
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
// Error bound of distances from the plane and the edges, m.
float polygon_error(uint at)
{
    return scene(at + 1u).w;
}
// xyz: inward, unit, in the plane; w: offset
vec4 polygon_edge(uint at, uint e)
{
    return scene(at + 2u + e);
}
// The record of the first vertex. The others follow it.
uint polygon_vertices(uint at, uint edges)
{
    return at + 2u + edges;
}
// The number of records of a polygon.
uint polygon_stride(uint edges)
{
    return 2u + 2u * edges;
}
