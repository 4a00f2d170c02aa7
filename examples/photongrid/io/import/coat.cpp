#include <photongrid/io/import/coat.hpp>
#include <photongrid/trace/coat_layout.hpp>

#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace photongrid {

namespace {
    /// The share of diffuse light from below that the coat of a plastic throws back. A rough coat's takes some ms, and
    /// files have many materials but few coats: each is computed once.
    double thrown_back_by(const material& plastic)
    {
        static std::mutex one_at_a_time;
        static std::map<std::pair<double, double>, double> known;
        const std::pair coat(plastic.index_of_refraction, alpha_of(plastic));
        const std::lock_guard lock(one_at_a_time);
        if (const auto found = known.find(coat); found != known.end())
            return found->second;
        if (known.size() == 4096) // a file with as many coats
            known.clear();
        return known[coat] = detail::shares_of_coat(coat.first, coat.second).thrown_back;
    }

    /// `change`: of a colour, with the share of light from below that the coat throws back.
    template <class Change>
    void change_reflectance(material& plastic, Change change)
    {
        const double thrown_back = thrown_back_by(plastic);
        if (!plastic.texture.map) {
            plastic.reflectance = change(plastic.reflectance, thrown_back);
            return;
        }
        auto map = *plastic.texture.map;
        for (auto& t : map.texels) {
            const auto colour = change(plastic.reflectance * dvec3(t) / 65535.0, thrown_back) * 65535.0 + 0.5;
            t = glm::u16vec4(colour.x, colour.y, colour.z, t.w);
        }
        plastic.texture.map = std::make_shared<const texture>(std::move(map));
        plastic.texture.file.clear(); // it is not what the file has any more
        plastic.reflectance = dvec3(1);
    }
} // namespace

// Of b, the reflectance below, b (1 - t) / (1 - b t) leaves (trace/coat.glsl).
void set_reflectance_below_coat(material& plastic)
{
    change_reflectance(plastic, [](const dvec3& leaves, double t) { return leaves / (1 - t + t * leaves); });
}

void set_reflectance_above_coat(material& plastic)
{
    change_reflectance(plastic, [](const dvec3& below, double t) { return below * (1 - t) / (1.0 - t * below); });
}

} // namespace photongrid
