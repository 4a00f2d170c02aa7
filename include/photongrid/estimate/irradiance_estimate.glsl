// Density estimate from the photons gathered: irradiance = weighted flux / (pi r^2) x the kernel's norm (Jensen 1996; the
// paper's section 2.3), and its standard error. The disc is that of the photon that set the radius, or of the given or
// maximum radius, for that is what was searched; it is never smaller than the stated floor, so coincident photons give a
// finite answer.
struct Params {
    float norm;        // 1 / mean of the kernel over its disc
    float min_radius2; // m^2
    uint left_out;     // 1: the photon that set the radius is not in the sum
};
PARAMS(Params)
INPUT(0, vec4, search_radii)
INPUT(1, vec4, sums)
INPUT(2, vec4, squares)
INPUT(3, uvec4, tallies)
OUTPUT(0, vec4, irradiance)     // rgb: W/m^2; w: squared radius searched, m^2
OUTPUT(1, uvec2, used)          // photons within it, photons visited
OUTPUT(2, vec4, standard_error) // rgb: of irradiance, W/m^2; w: of its sum over channels

void kernel(uint i)
{
    vec4 r = search_radii(i);
    vec4 s = sums(i);
    vec4 q = squares(i);
    uvec4 n = tallies(i);
    float disc2 = max(r.x, args.min_radius2);
    float per_area = args.norm / (3.14159265f * disc2);
    irradiance = vec4(s.x * per_area, s.y * per_area, s.z * per_area, r.x);
    used = uvec2(n.x, n.y);

    // The sum of squares is the variance of a sum over randomly many photons (a Poisson process, radius given). Where the
    // k-th photon set the radius, the disc varies too: a relative variance of 1 / (k - 2) where the squares show 1 / terms.
    float spread = 1.0f;
    if (r.y > 0.0f && n.x > 0u) {
        float terms = float(n.x) - float(args.left_out);
        spread = n.x > 2u ? terms / float(n.x - 2u) : 1.0f;
    }
    vec4 variance = vec4(q.x * spread, q.y * spread, q.z * spread, q.w * spread);
    standard_error = vec4(sqrt(variance.x) * per_area, sqrt(variance.y) * per_area, sqrt(variance.z) * per_area, sqrt(variance.w) * per_area);
}
