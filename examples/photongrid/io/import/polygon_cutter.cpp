#include <photongrid/io/import/polygon_cutter.hpp>

#include <cmath>
#include <glm/geometric.hpp>

namespace photongrid {

namespace {
    constexpr std::uint64_t max_steps = std::uint64_t{1} << 30;

    /// Twice the area of a triangle, above 0 if it is counterclockwise.
    double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c)
    {
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    }
} // namespace

glm::dvec3 normal_of_polygon(std::span<const glm::dvec3> corners)
{
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < corners.size(); ++i)
        sum += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
    const double length = glm::length(sum);
    return length > 0 && std::isfinite(length) ? sum / length : glm::dvec3(0, 0, 1);
}

bool polygon_cutter::is_ear(std::uint32_t at) const
{
    const auto &a = plane_[before_[at]], &b = plane_[at], &c = plane_[after_[at]];
    if (turn(a, b, c) <= 0)
        return false;
    for (const auto r : reflex_) {
        const auto& p = plane_[r];
        if (p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0)
            return false;
    }
    return true;
}

std::span<const glm::uvec3> polygon_cutter::triangles_of(std::span<const glm::dvec3> corners, const glm::dvec3& normal)
{
    const auto n = static_cast<std::uint32_t>(corners.size());
    made_.clear();
    bool is_fan = true;
    for (std::uint32_t i = 2; i < n; ++i) {
        const auto &a = corners[0], &b = corners[i - 1], &c = corners[i];
        is_fan = is_fan && !(glm::dot(glm::cross(b - a, c - a), normal) < 0);
        made_.emplace_back(0, i - 1, i);
    }
    if (is_fan)
        return made_;
    if (steps_ > max_steps) {
        ++not_cut_;
        return made_;
    }

    // Without the axis along which the normal is longest.
    const auto size = glm::abs(normal);
    const int away = size.x >= size.y && size.x >= size.z ? 0
        : size.y >= size.z                                ? 1
                                                          : 2,
              u = (away + 1) % 3, v = (away + 2) % 3;
    plane_.clear();
    for (const auto& c : corners)
        plane_.emplace_back(normal[away] < 0 ? c[v] : c[u], normal[away] < 0 ? c[u] : c[v]);
    before_.resize(n);
    after_.resize(n);
    reflex_.clear();
    for (std::uint32_t i = 0; i < n; ++i) {
        before_[i] = (i + n - 1) % n;
        after_[i] = (i + 1) % n;
        if (turn(plane_[before_[i]], plane_[i], plane_[after_[i]]) <= 0)
            reflex_.push_back(i);
    }
    made_.clear();
    bool is_cut = true;
    std::uint32_t at = 0;
    for (std::uint32_t left = n; left > 3; --left) {
        std::uint32_t tried = 0;
        for (; tried < left && steps_ <= max_steps && !is_ear(at); ++tried) {
            steps_ += reflex_.size() + 1;
            at = after_[at];
        }
        if (tried == left || steps_ > max_steps) { // any corner: one without area if there is one
            for (std::uint32_t i = 0; i < left && turn(plane_[before_[at]], plane_[at], plane_[after_[at]]) != 0; ++i)
                at = after_[at];
            is_cut = is_cut && turn(plane_[before_[at]], plane_[at], plane_[after_[at]]) == 0;
        }
        made_.emplace_back(before_[at], at, after_[at]);
        steps_ += reflex_.size() + 1;
        std::erase(reflex_, at);
        after_[before_[at]] = after_[at];
        before_[after_[at]] = before_[at];
        at = after_[at];
    }
    made_.emplace_back(before_[at], at, after_[at]);
    not_cut_ += is_cut ? 0 : 1;
    return made_;
}

std::string text_of_flat_faces(std::size_t count)
{
    return std::to_string(count) + (count == 1 ? " face has" : " faces have") + " fewer than three corners: left out";
}

std::string text_of_crossed_faces(std::size_t count)
{
    return std::to_string(count) + (count == 1 ? " face crosses itself: its" : " faces cross themselves: their")
        + " triangles cover each other, or more than the face";
}

} // namespace photongrid
