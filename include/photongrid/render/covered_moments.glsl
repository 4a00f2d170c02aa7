// Moments of the part of an estimate's disc that lies on polygons, in units of the radius, along the two axes of
// basis_about(normal): what correct_bias.glsl needs for a slope of the light. The number of polygons per pass is
// bounded.
//
// Let u be the offset from the disc's centre, w a radial weight, and Psi(rho) the integral of s w(s) from rho to the
// rim. Then w u is minus the gradient of Psi, and by the theorem of Gauss the integral of w u over the intersection of
// polygon and disc is a sum over the polygon's edges: inward normal times the integral of Psi along the edge. Psi
// vanishes on the rim and outside. In the same way the second moments are those of Psi u, plus the integral of Psi, a
// quarter of Epanechnikov's share.
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
STATE(0, vec4, shares)    // x: by the constant filter; y: by Epanechnikov's; zw: first moment by the estimate's filter
STATE(1, vec4, firsts)    // xy: first moment by the constant filter; zw: by Epanechnikov's
STATE(2, vec4, seconds)   // xyz: uu, uv, vv: second moments by the constant filter

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
    precise vec4 share = shares;
    precise vec4 first = firsts;
    precise vec4 second = seconds;
    uint next = args.first;
    for (uint polygon = 0u; polygon < args.polygons; ++polygon) {
        uint at = next;
        uint edges = polygon_edges(at);
        uint vertices = polygon_vertices(at, edges);
        next = at + polygon_stride(edges);
        PartOfDisc part = part_of_disc(at, p, n, radius, inverse);
        if (part.counted == 0.0f)
            continue;
        precise vec4 its_share = vec4(1.0f, 1.0f, 0.0f, 0.0f);
        precise vec4 its_first = vec4(0.0f, 0.0f, 0.0f, 0.0f);
        precise vec4 its_second = vec4(0.25f, 0.0f, 0.25f, 0.0f);
        if (!part.is_whole) {
            its_share = its_first;
            its_second = its_first;
            precise vec3 a = vec3(scene(vertices)) - p;
            for (uint e = 0u; e < edges; ++e) {
                precise vec3 b = vec3(scene(vertices + (e + 1u == edges ? 0u : e + 1u))) - p;
                EdgeOfDisc edge = edge_of_disc(at, e, a, b, inverse);
                vec3 inward = in_basis(edge.inward, n);
                vec3 way = in_basis(edge.way, n);
                float d = edge.d;
                float s = edge.from;
                float t = edge.to;
                // Along the edge: integrals of Psi by each filter, and of Psi times the offset along the edge.
                precise float even = constant_edge_moment(d, t) - constant_edge_moment(d, s);
                precise float inner = epanechnikov_edge_moment(d, t) - epanechnikov_edge_moment(d, s);
                precise float filtered = filter_edge_moment(d, t) - filter_edge_moment(d, s);
                precise float s2 = s * s;
                precise float t2 = t * t;
                precise float along = 0.5f * (1.0f - d * d) * (t2 - s2) - 0.25f * (t2 * t2 - s2 * s2);
                precise float constant_within = d * (t - s);
                precise float inner_within
                    = d * (epanechnikov_edge_integral(d, t) - epanechnikov_edge_integral(d, s));
                precise vec4 more_share = its_share
                    + vec4(constant_within + edge.rim, inner_within + edge.rim, inward.x * filtered,
                        inward.y * filtered);
                precise vec4 more_first = its_first
                    + vec4(inward.x * even, inward.y * even, inward.x * inner, inward.y * inner);
                precise float uu = inward.x * (way.x * along - d * inward.x * even);
                precise float uv
                    = 0.5f * (inward.x * way.y + inward.y * way.x) * along - d * inward.x * inward.y * even;
                precise float vv = inward.y * (way.y * along - d * inward.y * even);
                precise vec4 more_second = its_second + vec4(uu, uv, vv, 0.0f);
                its_share = more_share;
                its_first = more_first;
                its_second = more_second;
                a = b;
            }
            precise vec4 mean_share = its_share * 0.159154943f; // 1 / (2 pi)
            precise vec4 mean_first = its_first * 0.159154943f;
            precise vec4 mean_second = its_second * 0.159154943f
                + vec4(0.25f * mean_share.y, 0.0f, 0.25f * mean_share.y, 0.0f);
            its_share = mean_share;
            its_first = mean_first;
            its_second = mean_second;
        }
        precise vec4 all_share = share + its_share * part.counted;
        precise vec4 all_first = first + its_first * part.counted;
        precise vec4 all_second = second + its_second * part.counted;
        share = all_share;
        first = all_first;
        second = all_second;
    }
    shares = share;
    firsts = first;
    seconds = second;
}
