// How light goes on at mirrors and glass. Included by kernels after backend/vector.glsl.
struct Fresnel {
    float reflected; // share of the light that is reflected, 1 for total internal reflection
    vec3 refracted;  // direction of the rest
};

vec3 reflect_direction(vec3 d, vec3 normal)
{
    return ray_at(d, normal, -2.0f * dot3(d, normal));
}

// Light of direction d meets a dielectric with this outward normal and index of refraction.
Fresnel fresnel(vec3 d, vec3 normal, float index)
{
    Fresnel f;
    f.reflected = 1.0f;
    f.refracted = d;
    float incoming = -dot3(d, normal);
    bool entering = incoming > 0.0f;
    float eta = entering ? 1.0f / index : index; // ratio of indices, this side over the other
    float cos_i = entering ? incoming : -incoming;
    cos_i = cos_i < 1.0f ? cos_i : 1.0f;
    precise float sin2_t = eta * eta * (1.0f - cos_i * cos_i);
    if (sin2_t >= 1.0f)
        return f; // total internal reflection
    precise float cos_t = sqrt(1.0f - sin2_t);
    precise float parallel = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    precise float perpendicular = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    precise float reflected = 0.5f * (parallel * parallel + perpendicular * perpendicular);
    f.reflected = reflected;
    vec3 facing = entering ? normal : -normal;
    precise vec3 r = d * eta + facing * (eta * cos_i - cos_t);
    f.refracted = normalized3(r);
    return f;
}
