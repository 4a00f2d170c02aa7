// The share of an estimate's disc that lies on polygons, weighted by the estimate's filter: 1 far from all edges, 1/2
// on a straight edge, 1/4 in a right corner. The number of polygons per pass is bounded.
//
// The integral of a radial weight over the intersection of polygon and disc is a sum over the polygon's edges, in polar
// coordinates about the disc's centre: for an edge at signed distance d, the integral of F(rho) dphi between its ends,
// where F is the integral of weight times radius up to rho, the distance of the edge or of the disc's rim, whichever is
// smaller. On the part of the edge inside the disc, dphi is d ds / rho^2 and the integral is a polynomial in s (with a
// logarithm for the cone); on the rim it is an angle.
//
// A polygon counts if the point lies in its plane, on either side, or if its plane is tilted by up to 2.5 degrees and
// passes near the point within the disc, so that slightly bent walls stay connected. The photons of other polygons must
// be rejected (leak_policy::min_cosine).
//
// A lamp or mirror close in front of the surface hides what lies behind it, as a lamp does that is mounted on a
// ceiling: its share is subtracted. It holds no photons, and keeps them from the surface. Light reaches as far behind
// its edge as it is missing beside it, so that only the square of its height over the radius is neglected.
#include <photongrid/backend/vector.glsl>
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

// The angle that an edge at distance d subtends between a and b, a <= b.
float subtended(float d, float a, float b)
{
    precise float sine = abs(d) * (b - a);
    precise float cosine = d * d + a * b;
    return sine > 0.0f ? angle_of(sine, cosine) : 0.0f;
}

// The contribution of an edge: signed distance d from the disc's centre, positive inside, and ends a <= b, all divided
// by the radius.
float edge_share(float d, float a, float b)
{
    precise float chord2 = 1.0f - d * d;
    precise float chord = sqrt(chord2 > 0.0f ? chord2 : 0.0f); // half of it
    float from = a < -chord ? -chord : a > chord ? chord : a;
    float to = b < -chord ? -chord : b > chord ? chord : b;
    float rim = 0.0f;
    float within = 0.0f;
    if (from == to) {
        rim = subtended(d, a, b);
    } else {
        precise float outside = subtended(d, a, from) + subtended(d, to, b);
        precise float inside = d * (filter_edge_integral(d, to) - filter_edge_integral(d, from));
        rim = outside;
        within = inside;
    }
    precise float share = (within + (d < 0.0f ? -rim : rim)) * 0.159154943f; // 1 / (2 pi)
    return share;
}

// The part of the surface behind a lamp or mirror that it hides, by its height above the surface over the radius: all
// of it at height 0, none from a quarter of the radius on, where the disc sees how light fades behind the edge.
float hidden_part(float height)
{
    precise float part = 1.0f - 16.0f * (height * height);
    return part > 0.0f ? part : 0.0f;
}

// How much of a polygon's share counts: 1 if it holds photons and lies in the surface's plane, less than 0 if it hides
// the surface. `height`, of its plane above the surface at the point, and `rise`, of that plane over the disc, m;
// `inverse`: of the radius.
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
        vec4 plane = polygon_plane(at);
        vec3 up = vec3(plane);
        float error = polygon_error(at);
        uint edges = polygon_edges(at);
        uint vertices = polygon_vertices(at, edges);
        next = at + polygon_stride(edges);
        precise float above = dot3(up, p) - plane.w;
        vec3 turn = cross3(n, up);
        float sine2 = dot3(turn, turn);
        precise float rise = radius * sqrt(sine2); // of its plane over the disc
        if (!(sine2 <= 0.0019f) || !(abs(above) <= error + rise + 0.25f * radius))
            continue;
        float height = dot3(n, up) > 0.0f ? -above : above;
        float counted = counted_part(at, height, rise, inverse);
        if (counted == 0.0f)
            continue;

        float nearest = 3.0e38f; // edge's line, m; positive inside
        for (uint e = 0u; e < edges; ++e) {
            precise vec3 f = p - vec3(scene(vertices + e));
            float d = dot3(vec3(polygon_edge(at, e)), f);
            nearest = d < nearest ? d : nearest;
        }
        if (counted < 0.0f && nearest > 2.0f * error)
            continue; // the point is behind it
        if (counted > 0.0f && sine2 <= 1e-10f && abs(above) <= error && nearest >= -2.0f * error)
            found = 1.0f;
        if (nearest <= -radius)
            continue;
        precise float share = 0.0f;
        if (nearest >= radius) {
            share = 1.0f;
        } else {
            precise vec3 a = vec3(scene(vertices)) - p;
            for (uint e = 0u; e < edges; ++e) {
                precise vec3 b = vec3(scene(vertices + (e + 1u == edges ? 0u : e + 1u))) - p;
                vec3 inward = vec3(polygon_edge(at, e));
                vec3 way = cross3(inward, up); // from a to b
                precise float d = -dot3(inward, a) * inverse;
                precise float s = dot3(way, a) * inverse;
                precise float t = dot3(way, b) * inverse;
                precise float more = share + edge_share(d, s, t);
                share = more;
                a = b;
            }
        }
        precise float all = sum + counted * share;
        sum = all;
    }
    cover = vec4(sum, found, 0.0f, 0.0f);
}
