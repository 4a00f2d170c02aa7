// A sample of a point or rectangle light as seen from a point of a surface (2.4). Included by kernels after
// trace/light_record.glsl, trace/lit_point.glsl, trace/lights/point_light.glsl and rectangle_light.glsl; args: strata,
// branch, nth, seed, first_pixel.

struct Lamp {
    vec3 position; // of a rectangle one corner, m
    vec3 edge_u;   // m
    vec3 edge_v;   // m
    vec3 normal;   // unit; light leaves on this side
    vec3 power;    // W
};

// A light as seen from a point: what all samples have in common.
struct SeenLight {
    Lamp light;
    float radiance_per_power; // m^-2 sr^-1
    bool area;        // it is a rectangle
    vec3 edge_u;      // of a stratum
    vec3 edge_v;
    float size2;      // of a stratum's diagonal, squared, m^2
    float share;      // of a sample among all samples
    bool some_close;  // some strata may be close (LightSample)
    vec3 off_light;   // from a point of the light to where shadow rays end
};

SeenLight seen_light(uint at, LitPoint lit)
{
    SeenLight seen;
    seen.light.position = vec3(scene(at + 1u));
    seen.light.edge_u = vec3(scene(at + 2u));
    seen.light.edge_v = vec3(scene(at + 3u));
    seen.light.normal = vec3(scene(at + 4u));
    seen.light.power = light_power(at);
    seen.radiance_per_power = radiance_per_power(at);
    seen.area = AREA_LIGHTS && (!POINT_LIGHTS || kind_of_light(at) == RECTANGLE_LIGHT);
    precise float share_u = 1.0f / float(args.strata.x);
    precise float share_v = 1.0f / float(args.strata.y);
    precise vec3 edge_u = seen.light.edge_u * share_u;
    precise vec3 edge_v = seen.light.edge_v * share_v;
    precise float size2 = dot3(edge_u, edge_u) + dot3(edge_v, edge_v);
    seen.edge_u = edge_u;
    seen.edge_v = edge_v;
    seen.size2 = size2;
    precise float share = 1.0f / float(args.strata.x * args.strata.y);
    seen.share = share;
    seen.some_close = false;
    seen.off_light = vec3(0.0f, 0.0f, 0.0f);
    if (seen.area) {
        vec3 corner = seen.light.position;
        precise vec3 middle = ray_at(ray_at(corner, seen.light.edge_u, 0.5f), seen.light.edge_v, 0.5f) - lit.position;
        seen.some_close = dot3(middle, middle)
            < 32.0f * size2 + dot3(seen.light.edge_u, seen.light.edge_u) + dot3(seen.light.edge_v, seen.light.edge_v);
        // Shadow rays end off the light and start off the surface, so that neither occludes itself.
        precise vec3 off_light = seen.light.normal
            * ray_offset(abs(corner) + abs(seen.light.edge_u) + abs(seen.light.edge_v), lit.round_share);
        seen.off_light = off_light;
    }
    return seen;
}

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

// Sample s of light `number`, for element i. The sample of an area light is a random point of its stratum. A stratum
// closer than four times its size is close: one of its points does not represent the rest, so its form factor is taken.
LightSample light_sample(SeenLight seen, uint number, uint s, uint i, LitPoint lit)
{
    vec3 corner = seen.light.position;
    vec3 target = corner;
    vec3 stratum = corner;
    bool close = false;
    if (seen.area) {
        vec2 r = sequence2(
            args.nth, uvec4(i + args.first_pixel, args.branch, 3000u + number, args.seed ^ (s * 0x9E3779B1u)));
        uint row = s / args.strata.x;
        precise float u = float(s - row * args.strata.x);
        precise float v = float(row);
        target = ray_at(ray_at(corner, seen.edge_u, u + r.x), seen.edge_v, v + r.y);
        if (seen.some_close) {
            stratum = ray_at(ray_at(corner, seen.edge_u, u), seen.edge_v, v);
            precise vec3 middle = ray_at(ray_at(stratum, seen.edge_u, 0.5f), seen.edge_v, 0.5f) - lit.position;
            close = dot3(middle, middle) < 16.0f * seen.size2;
        }
    }
    LightWay way = way_to(target, lit);
    float distance2 = way.distance2;
    if (!(distance2 > 0.0f))
        return no_light(lit);
    float cosine = way.cosine;
    float leaving = seen.area ? -dot3(way.direction, seen.light.normal) : 1.0f;
    if (!(leaving > 0.0f) || (!close && !(cosine > 0.0f)))
        return no_light(lit);
    // 1 / (4 pi): intensity of a point light. The distance is at least the ray offset.
    float least2 = lit.offset * lit.offset;
    precise float factor = cosine / (distance2 > least2 ? distance2 : least2) * 7.95774715e-2f;
    precise vec3 end = target;
    if (seen.area) {
        // Radiance times area is power / pi.
        precise float diffuse = cosine * leaving / distance2 * 3.18309886e-1f * seen.share;
        if (close) {
            precise vec3 f = stratum - lit.position;
            // The stratum's part of the irradiance.
            precise float filled = form_factor(f, seen.edge_u, seen.edge_v, lit.normal) * 3.14159265f
                * seen.radiance_per_power;
            diffuse = filled;
        }
        factor = diffuse;
        end = target + seen.off_light;
    }
    LightSample found = lit_from(end, factor, lit);
    // For a stratum partly below the horizon, samples below it count as visible.
    found.has_ray = found.has_ray && cosine > 0.0f;
    if (!seen.area) {
        precise float short_of = found.far * 0.9999f; // a point light may touch a surface
        found.far = short_of;
    }
    return found;
}
