// Light that meets several facets of rough metal or glass before it leaves. Of the light that a facet sends out, the
// share unhidden() leaves; the rest meets other facets. It leaves at last in the directions in which most light would
// be hidden (Kulla and Conty, Revisiting Physically Based Shading at Imageworks, 2017). With h and k, the shares that
// are hidden of light from cosine x outside and inside, and H and K, their means over light that comes evenly,
//
//     f(x, y) = stays h(x) h(y) / (pi H)         from outside to outside
//     f(x, y) = crosses h(x) k(y) / (pi K)       from outside to inside, of power
//
// and likewise from inside. So what is hidden of light from x leaves somewhere, and light may go either way along a
// path if n^2 K times what crosses from inside is H times what crosses from outside, n: the index of refraction. Of
// metal all stays. Included by kernels after trace/materials.glsl.
//
// trace/rebound_layout.hpp writes the table of a material. The first record: number of intervals of roughness;
// intervals per roughness. Of each interval then two records, one of each end: H / alpha^2, K / alpha^2, share that
// crosses from outside; and one for each step of the cosine: h, k at one end, h, k at the other.
SWITCH(23, REBOUNDS)

struct Rebounds {
    uint steps;    // the record of step 0
    float upper;   // weight of the interval's upper end
    float alpha;
    float outside; // H
    float inside;  // K
    float crosses; // share of what is hidden outside
};

bool has_rebounds(Material m)
{
    return REBOUNDS && m.rebounds > 0u && m.alpha > 0.0f;
}

float between_ends(float low, float high, float upper)
{
    precise float mean = low + (high - low) * upper;
    return mean;
}

Rebounds rebounds_of(Material m)
{
    vec4 head = scene(m.rebounds);
    precise float at = sqrt(m.alpha) * head.y;
    uint interval = min(uint(at), uint(head.x) - 1u);
    uint first = m.rebounds + 1u + interval * (REBOUND_STEPS + 3u);
    vec4 low = scene(first);
    vec4 high = scene(first + 1u);
    Rebounds r;
    r.steps = first + 2u;
    precise float upper = at - float(interval);
    r.upper = upper < 1.0f ? upper : 1.0f;
    r.alpha = m.alpha;
    precise float alpha2 = m.alpha * m.alpha;
    precise float outside = between_ends(low.x, high.x, r.upper) * alpha2;
    precise float inside = between_ends(low.y, high.y, r.upper) * alpha2;
    r.outside = outside;
    r.inside = inside;
    r.crosses = between_ends(low.z, high.z, r.upper);
    return r;
}

// The cosine of a step: even in cosine / (cosine + REBOUND_SPREAD alpha).
float cosine_of_step(Rebounds r, uint step)
{
    precise float spread = REBOUND_SPREAD * r.alpha;
    precise float cosine = spread * float(step) / (float(REBOUND_STEPS) * (1.0f + spread) - float(step));
    return cosine < 1.0f ? cosine : 1.0f;
}

float hidden_at_step(Rebounds r, bool inside, uint step)
{
    vec4 shares = scene(r.steps + step);
    return inside ? between_ends(shares.y, shares.w, r.upper) : between_ends(shares.x, shares.z, r.upper);
}

// The share of light that is hidden: linear in the cosine between two steps.
struct HiddenStep {
    float from;  // its cosines
    float to;
    float share; // at `from`
    float slope;
};

HiddenStep hidden_step(Rebounds r, bool inside, uint step)
{
    HiddenStep h;
    h.from = cosine_of_step(r, step);
    h.to = cosine_of_step(r, step + 1u);
    h.share = hidden_at_step(r, inside, step);
    precise float slope = (hidden_at_step(r, inside, step + 1u) - h.share) / (h.to - h.from);
    h.slope = slope;
    return h;
}

float hidden_share(Rebounds r, bool inside, float cosine)
{
    float bounded = cosine < 1.0f ? cosine : 1.0f;
    precise float spread = REBOUND_SPREAD * r.alpha;
    precise float at = bounded / (bounded + spread) * (1.0f + spread) * float(REBOUND_STEPS);
    HiddenStep h = hidden_step(r, inside, min(uint(at), REBOUND_STEPS - 1u));
    precise float share = h.share + (bounded - h.from) * h.slope;
    return share > 0.0f ? share : 0.0f;
}

// The mean of the share over light that comes evenly, up to a cosine within the step.
float mean_in_step(HiddenStep h, float cosine)
{
    precise float wide = (cosine - h.from) * (cosine + h.from);
    precise float cubes
        = (cosine - h.from) * (cosine * cosine + cosine * h.from + h.from * h.from) * 0.666666667f;
    precise float mean = (h.share - h.slope * h.from) * wide + h.slope * cubes;
    return mean;
}

// The cosine of a direction in which light leaves, for u from 0 to 1: its density is the share times the cosine.
float rebound_cosine(Rebounds r, bool inside, float u)
{
    float total = 0.0f;
    for (uint step = 0u; step < REBOUND_STEPS; ++step) {
        HiddenStep h = hidden_step(r, inside, step);
        precise float more = total + mean_in_step(h, h.to);
        total = more;
    }
    precise float goal = u * total;
    float below = 0.0f;
    HiddenStep found = hidden_step(r, inside, 0u);
    bool is_found = false;
    for (uint step = 0u; step < REBOUND_STEPS && !is_found; ++step) {
        found = hidden_step(r, inside, step);
        precise float past = below + mean_in_step(found, found.to);
        is_found = goal < past || step + 1u == REBOUND_STEPS; // of the last, if rounding leaves the goal above all
        below = is_found ? below : past;
    }
    precise float within = goal - below;
    float low = found.from;
    float high = found.to;
    for (uint turn = 0u; turn < 20u; ++turn) {
        precise float middle = 0.5f * (low + high);
        bool is_past = mean_in_step(found, middle) > within;
        low = is_past ? low : middle;
        high = is_past ? middle : high;
    }
    return high;
}

// Of the light that is hidden on one side, the share that leaves on the other one.
float crossing_share(Rebounds r, bool inside, float index)
{
    if (!inside)
        return r.crosses;
    precise float share = r.crosses * r.outside / (index * index * r.inside);
    return share < 1.0f ? share : 1.0f;
}

// The factor on the reflectance of metal: with each bounce the light takes on its colour once more, and what a facet
// sends on leaves with the mean share that is not hidden.
vec3 rebound_tint(Rebounds r, Material m)
{
    if (m.kind != MIRROR_SURFACE)
        return vec3(1.0f, 1.0f, 1.0f);
    precise vec3 leaving = m.reflectance * (1.0f - r.outside);
    precise vec3 hidden = m.reflectance * r.outside;
    precise vec3 tint
        = vec3(leaving.x / (1.0f - hidden.x), leaving.y / (1.0f - hidden.y), leaving.z / (1.0f - hidden.z));
    return tint;
}
