// A point that is lit, and a sample of a light as seen from it (2.4). Included by kernels after the scene buffer.

// A point of a surface that is lit.
struct LitPoint {
    vec3 position;
    vec3 normal;
    vec3 origin;       // of its shadow rays, off the surface
    float offset;      // of the origin from the surface, m
    float round_share; // see ray_offset
};

LitPoint lit_point(vec3 p, vec3 n)
{
    LitPoint lit;
    lit.position = p;
    lit.normal = n;
    lit.round_share = scene(SCENE_SIZES).x;
    lit.offset = ray_offset(p, lit.round_share);
    lit.origin = ray_at(p, n, lit.offset);
    return lit;
}

// The way from a lit point to a point of a light.
struct LightWay {
    vec3 direction;  // unit
    float distance2; // m^2; 0: the points are the same
    float cosine;    // with the lit point's normal
};

LightWay way_to(vec3 target, LitPoint lit)
{
    LightWay way;
    precise vec3 towards = target - lit.position;
    way.distance2 = dot3(towards, towards);
    precise float inverse = 1.0f / sqrt(way.distance2);
    precise vec3 d = towards * inverse;
    way.direction = d;
    way.cosine = dot3(d, lit.normal);
    return way;
}

struct LightSample {
    float per_power; // irradiance if it is visible, divided by the light's power, m^-2
    bool has_ray;    // else it counts as visible
    vec3 direction;  // of the shadow ray, unit
    float far;       // length of the shadow ray, m
};

LightSample no_light(LitPoint lit)
{
    LightSample none;
    none.per_power = 0.0f;
    none.has_ray = false;
    none.direction = lit.normal;
    none.far = 0.0f;
    return none;
}

// A sample whose shadow ray goes to `end`; no light from a point without distance.
LightSample lit_from(vec3 end, float per_power, LitPoint lit)
{
    LightSample found = no_light(lit);
    precise vec3 ray = end - lit.origin;
    float length2 = dot3(ray, ray);
    if (!(length2 > 0.0f))
        return found;
    precise float far = sqrt(length2);
    precise vec3 way = ray / far;
    found.per_power = per_power;
    found.has_ray = true;
    found.direction = way;
    found.far = far;
    return found;
}

// The random numbers of one sample of a light.
struct SampleNumbers {
    vec4 r;       // 0 to 1
    vec2 place;   // of the sample's stratum of the unit square, in which it is at r.xy
    float along;  // of the sample's part of 0 to 1, in which it is at r.x
    float share;  // of the sample among all samples of the light
};

// A sample of a light.
struct ArrivingLight {
    LightSample found;
    vec3 power;               // factor on found.per_power
    float radiance_per_power; // m^-2 sr^-1; 0 of lights without size
    bool is_rectangle;
};

// A photon at its start.
struct Emitted {
    vec3 origin;    // m
    vec3 direction; // unit
    vec3 power;     // W, divided by the probability of its light
};

// The estimate of the irradiance, without shadows, of lamps of this power inside a ball: 0 only where none of the ball
// can be seen from the lit side.
float ball_importance(vec3 middle, float radius, float watts, LitPoint lit)
{
    precise vec3 to = middle - lit.position;
    precise float least = radius + lit.offset;
    precise float distance2 = dot3(to, to) + least * least;
    float distance = sqrt(distance2);
    precise float cosine = (dot3(to, lit.normal) + least) / distance; // of the ball's highest point, at least
    precise float falling = (cosine < 1.0f ? cosine : 1.0f) * watts / distance2 * 7.95774715e-2f;
    return falling > 0.0f ? falling : 0.0f;
}
