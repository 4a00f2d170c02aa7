// Directions in which the sky is seen from points of surfaces, as trace/sky_guide.hpp has learned them. Included by
// kernels after trace/lights.glsl, trace/sky_bins.glsl and the INPUT sky_guide, which has first the nodes of a tree of
// cells, level by level: x: the coordinate by which one splits, 0 to 2 of the position, 3 to 5 of the normal; y: where.
// Then of each cell x: 1: its samples follow the guide; and for four bins of directions each the shares of the samples
// in those up to them.

const float SKY_GUIDED = 0.75f; // share of a guided cell's samples that follow the guide

uint sky_table(uint cell)
{
    return SKY_CELLS - 1u + cell * (SKY_BINS / 4u + 1u);
}

uint sky_cell(LitPoint lit)
{
    uint node = 1u;
    for (uint depth = 0u; depth < SKY_DEPTH; ++depth) {
        vec4 split = sky_guide(node - 1u);
        uint axis = uint(split.x);
        vec3 of = axis < 3u ? lit.position : lit.normal;
        uint along = axis < 3u ? axis : axis - 3u;
        float x = along == 0u ? of.x : along == 1u ? of.y : of.z;
        node = 2u * node + (x < split.y ? 0u : 1u);
    }
    return node - SKY_CELLS;
}

// The share of the cell's samples in bins 0 to `bin`.
float sky_share_up_to(uint cell, uint bin)
{
    vec4 four = sky_guide(sky_table(cell) + 1u + bin / 4u);
    uint lane = bin & 3u;
    return lane == 0u ? four.x : lane == 1u ? four.y : lane == 2u ? four.z : four.w;
}

// The direction at a place in a bin.
vec3 sky_direction(uint bin, float u, float v)
{
    precise float row = (float(bin / SKY_SIDE) + u) / float(SKY_SIDE);
    precise float column = (float(bin % SKY_SIDE) + v) / float(SKY_SIDE);
    return uniform_direction(row, column);
}

uint sky_bin(vec3 d)
{
    precise float across = sqrt(d.x * d.x + d.y * d.y);
    float half_turn = across > 0.0f ? angle_of(abs(d.y), d.x) : 0.0f;
    precise float column = (d.y < 0.0f ? 6.28318531f - half_turn : half_turn) * 0.159154943f * float(SKY_SIDE);
    precise float row = (0.5f - 0.5f * d.z) * float(SKY_SIDE);
    return min(uint(row > 0.0f ? row : 0.0f), SKY_SIDE - 1u) * SKY_SIDE + min(uint(column), SKY_SIDE - 1u);
}

const float DENSITY_PER_SKY_SHARE = 7.95774715e-2f * float(SKY_BINS); // 1 / (4 pi) of each share, sr^-1

ArrivingLight sky_from(uint at, vec3 towards, float guided_density, float guided, float share, LitPoint lit)
{
    EnvironmentSeen seen = environment_seen(at, towards);
    precise float density = guided_density * guided + seen.density * (1.0f - guided);
    precise vec3 weighted = seen.radiance / density;
    ArrivingLight a;
    // Rounding may put a direction at the edge of a bin or of a texel into one that no sample is drawn from.
    a.found = density > 0.0f ? distant_sample(towards, share, lit) : no_light(lit);
    a.power = weighted;
    a.radiance_per_power = density;
    a.is_rectangle = false;
    return a;
}

// A sample of the environment in this bin alone.
ArrivingLight sky_in_bin(uint at, uint bin, SampleNumbers n, LitPoint lit)
{
    return sky_from(at, sky_direction(bin, n.r.x, n.r.y), DENSITY_PER_SKY_SHARE, 1.0f, n.share, lit);
}

// A sample of the environment by the guide.
ArrivingLight guided_sky(uint at, SampleNumbers n, LitPoint lit)
{
    uint cell = sky_cell(lit);
    if (!(sky_guide(sky_table(cell)).x > 0.0f))
        return arriving_light(at, n, lit);
    vec3 towards = lit.normal;
    if (n.place.x < SKY_GUIDED) {
        precise float goal = n.place.x / SKY_GUIDED;
        uint low = 0u;
        uint high = SKY_BINS - 1u;
        while (low < high) {
            uint middle = (low + high) / 2u;
            if (sky_share_up_to(cell, middle) > goal)
                high = middle;
            else
                low = middle + 1u;
        }
        towards = sky_direction(low, n.place.y, n.r.z);
    } else {
        precise float left = (n.place.x - SKY_GUIDED) / (1.0f - SKY_GUIDED);
        towards = environment_sample(at, vec2(min(left, 0.99999994f), n.place.y), vec2(n.r.z, n.r.w)).towards;
    }
    uint bin = sky_bin(towards);
    precise float in_bin = sky_share_up_to(cell, bin) - (bin > 0u ? sky_share_up_to(cell, bin - 1u) : 0.0f);
    precise float density = in_bin * DENSITY_PER_SKY_SHARE;
    return sky_from(at, towards, density, SKY_GUIDED, n.share, lit);
}
