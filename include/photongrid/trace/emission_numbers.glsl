// The numbers that path `id` begins with: even, or drawn by an emission guide. Included by kernels after their input
// `guide`; args: boxes (0: even), seed.
struct EmissionNumbers {
    vec4 first;
    vec4 second;
    float weight; // factor on the power of the path
};

vec4 in_emission_box(uint at, vec4 u)
{
    vec4 low = guide(at);
    vec4 size = guide(at + 2u);
    precise vec4 inside = low + size * u;
    // Rounding must not make a number 1.
    return vec4(inside.x < 0.99999994f ? inside.x : 0.99999994f, inside.y < 0.99999994f ? inside.y : 0.99999994f,
        inside.z < 0.99999994f ? inside.z : 0.99999994f, inside.w < 0.99999994f ? inside.w : 0.99999994f);
}

EmissionNumbers emission_numbers(uint id)
{
    EmissionNumbers e;
    e.first = random4(uvec4(id, 0u, 0u, args.seed));
    e.second = random4(uvec4(id, 0u, 1u, args.seed));
    e.weight = 1.0f;
    if (args.boxes == 0u)
        return e;
    // Boxes in turn by a Weyl sequence, so that each gets its share of any run of paths.
    float drawn = float((id * 0x9E3779B1u + scrambled(args.seed)) >> 8u);
    uint low = 0u;
    uint high = args.boxes - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (drawn < guide(middle * VECTORS_PER_EMISSION_BOX).x)
            high = middle;
        else
            low = middle + 1u;
    }
    uint at = low * VECTORS_PER_EMISSION_BOX;
    e.first = in_emission_box(at + 1u, e.first);
    e.second = in_emission_box(at + 2u, e.second);
    e.weight = guide(at).y;
    return e;
}
