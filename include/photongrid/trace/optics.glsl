// Reflection and refraction. Included by kernels after core/vector.glsl.
struct Fresnel {
    float reflected;      // reflectance; 1 for total internal reflection
    vec3 refracted;       // direction of the refracted light
    float radiance_scale; // of eye rays that are refracted: radiance divided by the index squared is constant
};

vec3 reflect_direction(vec3 d, vec3 normal)
{
    return ray_at(d, normal, -2.0f * dot3(d, normal));
}

Fresnel total_reflection(vec3 d)
{
    Fresnel f;
    f.reflected = 1.0f;
    f.refracted = d;
    f.radiance_scale = 1.0f;
    return f;
}

// The Fresnel reflectance and the refracted direction for direction d at a dielectric with this outward normal and
// index of refraction.
Fresnel fresnel(vec3 d, vec3 normal, float index)
{
    Fresnel f = total_reflection(d);
    float incoming = -dot3(d, normal);
    bool entering = incoming > 0.0f;
    float eta = entering ? 1.0f / index : index; // index on the side of the ray, divided by that of the other side
    precise float eta2 = eta * eta;
    f.radiance_scale = eta2;
    float cos_i = entering ? incoming : -incoming;
    cos_i = cos_i < 1.0f ? cos_i : 1.0f;
    precise float sin2_t = eta * eta * (1.0f - cos_i * cos_i);
    if (sin2_t >= 1.0f)
        return f; // total internal reflection
    precise float cos_t = sqrt(1.0f - sin2_t);
    precise float parallel = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    precise float perpendicular = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    precise float reflected = 0.5f * (parallel * parallel + perpendicular * perpendicular);
    f.reflected = reflected < 1.0f ? reflected : 1.0f; // a device may round quotients up
    vec3 facing = entering ? normal : -normal;
    precise vec3 r = d * eta + facing * (eta * cos_i - cos_t);
    f.refracted = normalized3(r);
    return f;
}
