// Planes, for disks and polygons.

// Distance to a plane, or `far`.
float hit_plane(vec4 plane, vec3 o, vec3 d, float far)
{
    float slope = dot3(vec3(plane), d);
    if (slope == 0.0f)
        return far;
    precise float t = (plane.w - dot3(vec3(plane), o)) / slope;
    return t > 0.0f && t < far ? t : far;
}

// Projects p onto a plane: after a long ray, p lies off the plane by the rounding of t.
vec3 onto_plane(vec4 plane, vec3 p)
{
    precise float above = dot3(vec3(plane), p) - plane.w;
    return ray_at(p, vec3(plane), -above);
}
