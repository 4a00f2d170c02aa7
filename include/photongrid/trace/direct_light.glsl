// Direct light at the ends of eye rays (2.4): shadow rays to every light, with stratified samples of area lights. The
// number of samples per pass is bounded. Irradiance, W/m^2.
//
// The kernel is one function, because its loop over samples uses nearly all that its loop over lights has computed.
#include <photongrid/backend/vector.glsl>
#include <photongrid/backend/random.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uvec2 strata;     // strata along the two edges of an area light; their product is the number of samples
    uint first;       // this pass takes samples first ...
    uint past;        // ... to past - 1
    uint ray_id;      // sample x branches + branch
    uint seed;
    uint first_pixel; // pixel of element 0
};
PARAMS(Params)
SWITCH(6, POINT_LIGHTS)
SWITCH(7, AREA_LIGHTS)
INPUT(0, vec4, scene)
INPUT(1, vec4, points)   // w > 0: compute direct light
INPUT(2, vec4, surfaces) // xyz: normal
STATE(0, vec4, irradiance)

#include <photongrid/trace/intersect.glsl>
#include <photongrid/trace/lights.glsl>

// One edge's term of Lambert's formula: the projected angle that it subtends.
float edge_term(vec3 a, vec3 b, vec3 n)
{
    vec3 c = cross3(a, b);
    precise float s = sqrt(dot3(c, c));
    if (!(s > 0.0f))
        return 0.0f;
    precise float term = angle_of(s, dot3(a, b)) * dot3(c, n) / s;
    return term;
}

// The form factor of a parallelogram: the share of the hemisphere about n that it covers, weighted by the cosine,
// clipped at the horizon (Lambert, Photometria, 1760). `corner` is relative to the point.
float form_factor(vec3 corner, vec3 edge_u, vec3 edge_v, vec3 n)
{
    float sum = 0.0f;
    bool cut = false;
    vec3 exit_point = corner;  // where the outline goes below the horizon
    vec3 entry_point = corner; // and where it comes back
    vec3 a = corner;
    for (uint e = 1u; e <= 4u; ++e) {
        precise vec3 b = corner + edge_u * (e == 1u || e == 2u ? 1.0f : 0.0f)
            + edge_v * (e == 2u || e == 3u ? 1.0f : 0.0f);
        float ha = dot3(a, n);
        float hb = dot3(b, n);
        if (ha >= 0.0f || hb >= 0.0f) {
            vec3 from = a;
            vec3 to = b;
            if (ha < 0.0f || hb < 0.0f) {
                precise float share = ha / (ha - hb);
                precise vec3 horizon = a + (b - a) * share;
                cut = true;
                if (ha < 0.0f) {
                    from = horizon;
                    entry_point = horizon;
                } else {
                    to = horizon;
                    exit_point = horizon;
                }
            }
            precise float more = sum + edge_term(from, to, n);
            sum = more;
        }
        a = b;
    }
    if (cut) {
        precise float closed = sum + edge_term(exit_point, entry_point, n);
        sum = closed;
    }
    precise float factor = abs(sum) * 0.159154943f; // 1 / (2 pi)
    return factor;
}

void kernel(uint i)
{
    vec4 point = points(i);
    if (!(point.w > 0.0f))
        return;
    vec3 p = vec3(point);
    vec3 n = vec3(surfaces(i));
    float round_share = scene(SCENE_SIZES).x;
    float off = ray_offset(p, round_share);
    vec3 origin = ray_at(p, n, off);
    vec3 sum = vec3(irradiance);
    precise float share_u = 1.0f / float(args.strata.x);
    precise float share_v = 1.0f / float(args.strata.y);
    precise float share = 1.0f / float(args.strata.x * args.strata.y);
    Table lights = table_of(scene(LIGHT_TABLE));
    uint at = lights.first;
    for (uint number = 0u; number < lights.count; ++number) {
        Light light = light_at(at);
        vec3 corner = light.position;
        bool area = AREA_LIGHTS && (!POINT_LIGHTS || light.is_area);
        precise vec3 edge_u = light.edge_u * share_u; // of a stratum
        precise vec3 edge_v = light.edge_v * share_v;
        // Strata closer than four times their size need the form factor: one of their points does not represent the
        // rest.
        precise float size2 = dot3(edge_u, edge_u) + dot3(edge_v, edge_v);
        bool some_close = false;
        precise vec3 off_light = vec3(0.0f, 0.0f, 0.0f);
        Candidates between = everything();
        if (area) {
            precise vec3 middle = ray_at(ray_at(corner, light.edge_u, 0.5f), light.edge_v, 0.5f) - p;
            some_close = dot3(middle, middle)
                < 32.0f * size2 + dot3(light.edge_u, light.edge_u) + dot3(light.edge_v, light.edge_v);
            // Shadow rays end off the light and start off the surface, so that neither occludes itself.
            off_light = light.normal * ray_offset(abs(corner) + abs(light.edge_u) + abs(light.edge_v), round_share);
            between = shaft(origin, ray_at(corner, off_light, 1.0f), light.edge_u, light.edge_v);
        }
        uint past = area ? args.past : 1u; // all samples of a point light are the same
        for (uint s = args.first; s < past; ++s) {
            vec3 target = corner;
            vec3 stratum = corner;
            bool close = false;
            if (area) {
                vec4 r = random4(
                    uvec4(i + args.first_pixel, args.ray_id, 3000u + number, args.seed ^ (s * 0x9E3779B1u)));
                uint row = s / args.strata.x;
                precise float u = float(s - row * args.strata.x);
                precise float v = float(row);
                target = ray_at(ray_at(corner, edge_u, u + r.x), edge_v, v + r.y);
                if (some_close) {
                    stratum = ray_at(ray_at(corner, edge_u, u), edge_v, v);
                    precise vec3 middle = ray_at(ray_at(stratum, edge_u, 0.5f), edge_v, 0.5f) - p;
                    close = dot3(middle, middle) < 16.0f * size2;
                }
            }
            precise vec3 towards = target - p;
            float distance2 = dot3(towards, towards);
            if (!(distance2 > 0.0f))
                continue;
            precise float inverse = 1.0f / sqrt(distance2);
            precise vec3 d = towards * inverse;
            float cosine = dot3(d, n);
            float leaving = area ? -dot3(d, light.normal) : 1.0f;
            if (!(leaving > 0.0f) || (!close && !(cosine > 0.0f)))
                continue;
            // 1 / (4 pi): intensity of a point light. The distance is at least the ray offset.
            precise float factor = cosine / (distance2 > off * off ? distance2 : off * off) * 7.95774715e-2f;
            precise vec3 end = target;
            if (area) {
                // Radiance times area is power / pi.
                precise float diffuse = cosine * leaving / distance2 * 3.18309886e-1f * share;
                if (close) {
                    precise vec3 f = stratum - p;
                    // The stratum's part of the irradiance.
                    precise float filled = form_factor(f, edge_u, edge_v, n) * 3.14159265f * light.radiance_per_power;
                    diffuse = filled;
                }
                factor = diffuse;
                end = target + off_light;
            }
            precise vec3 ray = end - origin;
            float length2 = dot3(ray, ray);
            if (!(length2 > 0.0f))
                continue;
            precise float far = sqrt(length2);
            precise vec3 ray_d = ray / far;
            // For a stratum partly below the horizon, samples below it count as visible; a point light may touch a
            // surface.
            if (cosine > 0.0f && occluded(origin, ray_d, area ? far : far * 0.9999f, between))
                continue;
            precise vec3 more = sum + light.power * factor;
            sum = more;
        }
        at += lights.stride;
    }
    irradiance = vec4(sum.x, sum.y, sum.z, 0.0f);
}
