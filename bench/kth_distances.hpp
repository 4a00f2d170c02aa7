// What searches find, point by point, compared.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace photongrid::bench {

/// Each point's squared distance of the k-th nearest, m^2, as the first search has found it.
class kth_distances {
public:
    explicit kth_distances(std::size_t points) : known_(points, unknown) {}

    /// Whether any search has looked at this point.
    bool has(std::size_t point) const { return known_[point] != unknown; }

    /// Keeps a search's distance if it is the point's first. Otherwise: does it differ by more than the rounding of its
    /// terms, which a compiler may fuse? The next photon's distance differs by a thousand times as much. From any
    /// thread, but not for one point at a time.
    bool differs(std::size_t point, float distance2)
    {
        constexpr float rounding = 0x1p-22f; // four units in the last place
        if (!has(point)) {
            known_[point] = distance2;
            return false;
        }
        return !(std::abs(distance2 - known_[point]) <= rounding * known_[point]);
    }

private:
    static constexpr float unknown = -1;
    std::vector<float> known_;
};

} // namespace photongrid::bench
