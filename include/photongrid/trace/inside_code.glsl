// The media that a ray is in (trace/media.glsl), in one number with the sign of z of a unit normal, whose x and y are
// stored beside it. Included by kernels after core/vector.glsl.
SWITCH(25, MEDIA)

float inside_code(uint inside, float z)
{
    float code = 1.0f + float(inside);
    return MEDIA ? (z < 0.0f ? -code : code) : z;
}

uint inside_of(float code)
{
    return MEDIA ? uint(abs(code)) - 1u : 0u;
}

// The w of the point where an eye ray ends on a diffuse surface: 1 in the air, more in media.
float point_code(uint inside)
{
    return MEDIA ? 1.0f + float(inside) : 1.0f;
}

uint inside_of_point(float code)
{
    return MEDIA ? uint(code) - 1u : 0u;
}

// The z of a unit vector, with the sign of a code.
float z_beside(float x, float y, float code)
{
    precise float z2 = 1.0f - x * x - y * y;
    precise float z = sqrt(z2 > 0.0f ? z2 : 0.0f);
    return code < 0.0f ? -z : z;
}

float z_of(float x, float y, float code)
{
    return MEDIA ? z_beside(x, y, code) : code;
}
