// Density estimate from the gathered photons: irradiance = weighted power / (pi r^2) x the filter's norm (Jensen 1996;
// the paper's section 2.3), and its standard error. r is the distance of the photon that set the radius, or the given
// or maximum radius if none did. It has a least value (least_disc2), so that coincident photons give a finite result.
#include <photongrid/estimate/search_radius.glsl>
#include <photongrid/estimate/search_tally.glsl>

struct Params {
    float norm;        // 1 / mean of the filter over its disc
    float min_radius2; // m^2; see least_disc2
    uint leave_out;    // 1: LEAVE_OUT of gather_photons.glsl was on
};
PARAMS(Params)
INPUT(0, vec4, search_radii) // see search_radius.glsl
INPUT(1, vec4, sums)
INPUT(2, vec4, squares)
INPUT(3, uvec4, tallies)
INPUT(4, vec4, points)
OUTPUT(0, vec4, irradiance)     // rgb: W/m^2; w: squared radius searched, m^2
OUTPUT(1, uvec2, used)          // photons within the radius, photons visited
OUTPUT(2, vec4, standard_error) // rgb: of irradiance, W/m^2; w: of its sum over channels

void kernel(uint i)
{
    vec4 search_radius = search_radii(i);
    float radius2 = radius2_of(search_radius);
    vec4 s = sums(i);
    vec4 q = squares(i);
    uint found = photons_found(tallies(i));
    float least2 = least_disc2(points(i), args.min_radius2);
    float disc2 = max(radius2, least2);
    float per_area = args.norm / (3.14159265f * disc2);
    irradiance = vec4(s.x * per_area, s.y * per_area, s.z * per_area, radius2);
    used = uvec2(found, photons_visited(tallies(i)));

    // For a given radius the number of photons is random (a Poisson process), and the sum of squares estimates the
    // variance of the sum. If the k-th photon set the radius, the disc's area varies instead: the relative variance is
    // 1 / (k - 2), where the squares give 1 / terms.
    float spread = 1.0f;
    if (is_by_photon(search_radius) && found > 2u) {
        bool excludes = args.leave_out != 0u && excludes_photon(search_radius, least2);
        float terms = float(found) - (excludes ? 1.0f : 0.0f);
        spread = terms / float(found - 2u);
    }
    vec4 variance = vec4(q.x * spread, q.y * spread, q.z * spread, q.w * spread);
    standard_error = vec4(sqrt(variance.x) * per_area, sqrt(variance.y) * per_area,
        sqrt(variance.z) * per_area, sqrt(variance.w) * per_area);
}
