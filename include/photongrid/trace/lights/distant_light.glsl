// Light from outside of the scene, which enters through the faces of a box. Records: at + 2 and at + 3: corners of the
// box.

// The areas of the faces, as seen along d, that are perpendicular to each axis, m^2.
vec3 seen_faces(uint at, vec3 d)
{
    precise vec3 size = vec3(scene(at + 3u)) - vec3(scene(at + 2u));
    precise vec3 areas
        = vec3(abs(d.x) * (size.y * size.z), abs(d.y) * (size.z * size.x), abs(d.z) * (size.x * size.y));
    return areas;
}

// The area of the box's outline as seen along d, m^2.
float outline_area(uint at, vec3 d)
{
    vec3 areas = seen_faces(at, d);
    precise float sum = areas.x + areas.y + areas.z;
    return sum;
}

// Where light of direction d enters the box: even over its outline as seen along d, for numbers from 0 to 1.
vec3 entry_point(uint at, vec3 d, float face, float u, float v)
{
    vec3 low = vec3(scene(at + 2u));
    vec3 high = vec3(scene(at + 3u));
    vec3 areas = seen_faces(at, d);
    vec3 near = vec3(d.x > 0.0f ? low.x : high.x, d.y > 0.0f ? low.y : high.y, d.z > 0.0f ? low.z : high.z);
    precise float goal = face * (areas.x + areas.y + areas.z);
    precise float past_x_and_y = areas.x + areas.y;
    precise vec3 size = high - low;
    precise vec3 by_u = low + size * u;
    precise vec3 by_v = low + size * v;
    if (goal < areas.x)
        return vec3(near.x, by_u.y, by_v.z);
    if (goal < past_x_and_y)
        return vec3(by_v.x, near.y, by_u.z);
    return vec3(by_u.x, by_v.y, near.z);
}

// It arrives from everywhere along `towards`.
LightSample distant_sample(vec3 towards, float per_power, LitPoint lit)
{
    LightSample found = no_light(lit);
    float cosine = dot3(towards, lit.normal);
    if (!(cosine > 0.0f))
        return found;
    precise float received = per_power * cosine;
    found.per_power = received;
    found.has_ray = true;
    found.direction = towards;
    found.far = 3.0e38f;
    return found;
}
