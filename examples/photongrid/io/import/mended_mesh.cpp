#include <photongrid/io/import/mended_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace photongrid {

namespace {
    bool is_place(const glm::vec3& p)
    {
        return std::abs(p.x) <= 1e18f && std::abs(p.y) <= 1e18f && std::abs(p.z) <= 1e18f;
    }
    bool is_normal(const glm::vec3& n) { return std::isfinite(n.x) && std::isfinite(n.y) && std::isfinite(n.z); }
    bool is_coordinate(const glm::vec2& t) { return std::abs(t.x) <= 1e6f && std::abs(t.y) <= 1e6f; }
    bool is_colour(const glm::vec3& c) { return c.x >= 0 && c.y >= 0 && c.z >= 0 && c.x <= 1 && c.y <= 1 && c.z <= 1; }

    template <class T, class Is>
    bool all(const std::vector<T>& values, const Is& is)
    {
        return std::all_of(values.begin(), values.end(), is);
    }
    bool is_sound(const mesh& m)
    {
        return all(m.positions, is_place) && all(m.normals, is_normal) && all(m.texture_coordinates, is_coordinate)
            && all(m.colors, is_colour);
    }

    std::string counted(std::size_t n, const char* one, const char* more, const std::string& what)
    {
        return std::to_string(n) + (n == 1 ? one : more) + what;
    }
} // namespace

std::string mend(mesh& m)
{
    if (is_sound(m))
        return "";
    std::vector<bool> used(m.positions.size(), false);
    const auto before = m.triangles.size();
    std::erase_if(m.triangles, [&](const glm::uvec3& t) {
        const bool drawn = is_place(m.positions[t.x]) && is_place(m.positions[t.y]) && is_place(m.positions[t.z]);
        for (int c = 0; c < 3; ++c)
            used[t[c]] = used[t[c]] || drawn;
        return !drawn;
    });
    std::string said;
    if (const auto n = before - m.triangles.size(); n > 0)
        said = counted(n, " triangle has", " triangles have", " a vertex that is not finite or beyond 10^18: left out");
    std::size_t replaced = 0;
    const auto replace = [&](auto& values, const auto& is, const auto& by) {
        for (std::size_t v = 0; v < values.size(); ++v)
            if (!is(values[v])) {
                values[v] = by(values[v]);
                replaced += used[v] ? 1 : 0;
            }
    };
    const auto place = std::find_if(m.positions.begin(), m.positions.end(), is_place);
    const auto some = place == m.positions.end() ? glm::vec3(0) : *place;
    replace(m.positions, is_place, [&](const glm::vec3&) { return some; }); // none of them is used
    replace(m.normals, is_normal, [](const glm::vec3&) { return glm::vec3(0); });
    replace(m.texture_coordinates, is_coordinate, [](const glm::vec2&) { return glm::vec2(0); });
    replace(m.colors, is_colour, [](const glm::vec3& c) {
        return glm::vec3(std::clamp(c.x > 0 ? c.x : 0.0f, 0.0f, 1.0f), std::clamp(c.y > 0 ? c.y : 0.0f, 0.0f, 1.0f),
            std::clamp(c.z > 0 ? c.z : 0.0f, 0.0f, 1.0f));
    });
    if (replaced > 0)
        said += (said.empty() ? "" : "; ")
            + counted(replaced, " value", " values",
                " of vertices out of range: normals and texture coordinates are 0, colours from 0 to 1");
    return said;
}

std::shared_ptr<const mesh> mended(std::shared_ptr<const mesh> m, std::string& said)
{
    said.clear();
    if (is_sound(*m))
        return m;
    auto made = *m;
    said = mend(made);
    return std::make_shared<const mesh>(std::move(made));
}

} // namespace photongrid
