#include "advice.hpp"

#include <photongrid/io/tone_map.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace photongrid {

namespace {
    template <class... Parts>
    std::string text(const Parts&... parts)
    {
        std::ostringstream out;
        out.precision(3);
        (out << ... << parts);
        return out.str();
    }
    std::string point(const dvec3& p) { return text('(', p.x, ", ", p.y, ", ", p.z, ')'); }

    std::string count(std::size_t n, const char* what) { return text(n, ' ', what, n == 1 ? "" : "s"); }

    /// Whether everything is behind the camera.
    bool looks_away(const camera& c, const bounds& b)
    {
        const dvec3 forward = c.look_at - c.position;
        for (const double x : {b.low.x, b.high.x})
            for (const double y : {b.low.y, b.high.y})
                for (const double z : {b.low.z, b.high.z})
                    if (glm::dot(dvec3(x, y, z) - c.position, forward) > 0)
                        return false;
        return true;
    }

    /// What of the meshes is kept although it has no meaning by itself.
    void add_oddities(std::vector<std::string>& odd, const scene& s)
    {
        std::size_t without_area = 0, without_normal = 0;
        for (const auto& m : s.meshes) {
            for (std::size_t t = 0; t < m.surface->triangles.size(); ++t) {
                const auto c = corners_of(m, t);
                without_area += glm::cross(c[1] - c[0], c[2] - c[0]) == dvec3(0) ? 1 : 0;
            }
            for (const auto& n : m.surface->normals)
                without_normal += n == glm::vec3(0) ? 1 : 0;
        }
        if (without_area > 0)
            odd.push_back(
                count(without_area, "triangle") + " of meshes without area; such close cracks, so they are kept");
        if (without_normal > 0)
            odd.push_back(
                count(without_normal, "normal") + " of meshes of length 0; the other corners' normals decide");
    }

    /// The largest mean of a count that is at most `n` once in twenty times (Wilson and Hilferty 1931).
    double most_expected(std::uint64_t n)
    {
        const double d = 9.0 * static_cast<double>(n + 1);
        return d / 9 * std::pow(1 - 1 / d + 1.645 / std::sqrt(d), 3);
    }

    /// What to say of tracing that ended with few of the photons asked for; "" for others.
    std::string few_photons(const scene& s, const photon_stats& p, const render_settings& settings)
    {
        constexpr std::uint32_t too_few = 100; // that tell nothing, as of a pilot that found no use for any
        if (p.emitted == 0 || 40 * p.stored > p.asked || settings.map.photons < too_few)
            return "";
        const auto share = text("at most ", 100 * most_expected(p.stored) / static_cast<double>(p.emitted), " %");
        const auto paths = text(p.emitted, " photon paths from ", detail::names_of_lights(s));
        const char* where = " hit a mirror, glass or a second diffuse surface; ";
        return p.stored == 0
            ? text("none of ", paths, where, "the picture has direct light alone; other light is ", share, " of it")
            : text("few of ", paths, where, "light other than direct, ", share, " of it, is from ", p.stored, " of ",
                p.asked, " photons asked for, and noisy");
    }

    /// Whether edge correction is asked for where nothing has edges that it corrects.
    bool corrects_nothing(const scene& s, const render_settings& settings)
    {
        return settings.estimate.edges == edge_correction::polygons
            && std::none_of(s.polygons.begin(), s.polygons.end(),
                [&](const polygon& p) { return is_diffuse(s.materials, s.materials[p.material]); });
    }

    std::string size_of(const bounds& b)
    {
        const dvec3 size = b.high - b.low;
        return text(size.x, " x ", size.y, " x ", size.z, " m");
    }
} // namespace

std::string summary_of(const scene& s)
{
    std::size_t triangles = 0;
    for (const auto& m : s.meshes)
        triangles += m.surface->triangles.size();
    const auto of_meshes = triangles > 0 ? text(" (meshes of ", count(triangles, "triangle"), ')') : "";
    return text('"', s.name, "\": ", count(count_shapes(s), "shape"), of_meshes, ", ",
        count(s.materials.size(), "material"), ", ", count(count_lights(s), "light"), " of ",
        detail::power_of_lights(s), " W (red + green + blue), ", size_of(bounds_of(s)));
}

std::vector<std::string> oddities(const scene& s)
{
    std::vector<std::string> odd;
    const auto b = bounds_of(s);
    const double size = glm::length(b.high - b.low);
    if (size > 1000 || size < 0.01)
        odd.push_back(text("the scene measures ", size_of(b), "; are its lengths in the unit that \"units\" names?"));
    std::set<std::uint32_t> used;
    const auto use = [&](const auto& list, auto) {
        for (const auto& x : list)
            used.insert(x.material);
    };
    for_each_shape(s, use);
    use(s.meshes, nullptr);
    add_oddities(odd, s);
    for (std::uint32_t m = 0; m < s.materials.size(); ++m)
        if (!used.contains(m))
            odd.push_back(text("no shape has the material \"", s.materials[m].name, '"'));
    if (looks_away(s.camera, b))
        odd.push_back(text("the camera at ", point(s.camera.position),
            " looks away from the whole scene, which extends from ", point(b.low), " to ", point(b.high)));
    return odd;
}

std::vector<std::string> warnings(
    const scene& s, const render_settings& settings, const render_stats& stats, const image& picture, bool is_png)
{
    std::vector<std::string> all;
    if (stats.invalid_pixels > 0)
        all.push_back(text(stats.invalid_pixels, " pixels were NaN or infinite and are black"));
    if (const auto few = few_photons(s, stats.photons, settings); !few.empty())
        all.push_back(few);
    if (corrects_nothing(s, settings))
        all.push_back("--edge-correction polygons changes nothing here: no polygon of the scene stores photons, and "
                      "meshes and other shapes are not corrected");
    const auto fitting = fitting_exposure(picture);
    const auto b = bounds_of(s);
    if (!fitting && settings.output.only == light_part::all)
        all.push_back(text("every pixel is black: the camera at ", point(s.camera.position),
            " sees nothing that is lit, in a scene that extends from ", point(b.low), " to ", point(b.high)));
    // Six stops: less than 1.5 % or more than 60 times what fits.
    else if (const auto set = settings.output.exposure; set && fitting && is_png && std::abs(*fitting - *set) > 6)
        all.push_back(text("the PNG is almost ", *fitting > *set ? "black" : "white", " at exposure ", *set,
            " EV; --exposure ", std::round(*fitting), " would fit its radiance. The scene measures ", size_of(b),
            " and its lights emit ", detail::power_of_lights(s), " W"));
    return all;
}

} // namespace photongrid
