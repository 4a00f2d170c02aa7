// The share of an estimate's disc that lies on polygons, weighted by the estimate's filter: 1 far from all edges, 1/2
// on a straight edge, 1/4 in a right corner. The number of polygons per pass is bounded.
//
// The integral of a radial weight over the intersection of polygon and disc is a sum over the polygon's edges, in polar
// coordinates about the disc's centre: for an edge at signed distance d, the integral of F(rho) dphi between its ends,
// where F is the integral of weight times radius up to rho, the distance of the edge or of the disc's rim, whichever is
// smaller. On the part of the edge inside the disc, dphi is d ds / rho^2 and the integral is a polynomial in s (with a
// logarithm for the cone); on the rim it is an angle.
#include <photongrid/core/vector.glsl>
#include <photongrid/estimate/search_radius.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    float min_radius2; // m^2; see least_disc2
    uint first;        // record of the first polygon of this pass
    uint polygons;     // how many
};
PARAMS(Params)
#include <photongrid/estimate/filter.glsl>
INPUT(0, vec4, scene)
INPUT(1, vec4, points)    // xyz, m; w > 0: the point has an estimate
INPUT(2, vec4, surfaces)  // xyz: unit normal
INPUT(3, vec4, estimates) // w: squared radius, m^2
STATE(0, vec4, cover)     // x: sum of shares; y: 1 where the point lies on one of the polygons

#include <photongrid/trace/materials.glsl>
#include <photongrid/trace/polygon_record.glsl>
#include <photongrid/render/surface_cover.glsl>

void kernel(uint i)
{
    vec4 point = points(i);
    if (!(point.w > 0.0f))
        return;
    vec3 p = vec3(point);
    vec3 n = vec3(surfaces(i));
    precise float radius = sqrt(max(estimates(i).w, least_disc2(point, args.min_radius2)));
    precise float inverse = 1.0f / radius;
    float sum = cover.x;
    float found = cover.y;
    uint next = args.first;
    for (uint polygon = 0u; polygon < args.polygons; ++polygon) {
        uint at = next;
        uint edges = polygon_edges(at);
        uint vertices = polygon_vertices(at, edges);
        next = at + polygon_stride(edges);
        PartOfDisc part = part_of_disc(at, p, n, radius, inverse);
        if (part.holds_its_center)
            found = 1.0f;
        if (part.counted == 0.0f)
            continue;
        precise float share = 0.0f;
        if (part.is_whole) {
            share = 1.0f;
        } else {
            precise vec3 a = vec3(scene(vertices)) - p;
            for (uint e = 0u; e < edges; ++e) {
                precise vec3 b = vec3(scene(vertices + (e + 1u == edges ? 0u : e + 1u))) - p;
                EdgeOfDisc edge = edge_of_disc(at, e, a, b, inverse);
                precise float within
                    = edge.d * (filter_edge_integral(edge.d, edge.to) - filter_edge_integral(edge.d, edge.from));
                precise float more = share + (within + edge.rim) * 0.159154943f; // 1 / (2 pi)
                share = more;
                a = b;
            }
        }
        precise float all = sum + part.counted * share;
        sum = all;
    }
    cover = vec4(sum, found, 0.0f, 0.0f);
}
