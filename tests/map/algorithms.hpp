// The fixture of tests of maps and searches on any backend.
#pragma once

#include "../backends/serial_algorithms.hpp"
#include "../core/under_test.hpp"
#include "../estimate/known_answers.hpp"
#include "photon_generator.hpp"

#include <photongrid/core/random.kernel.hpp>
#include <photongrid/core/self_test.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/map/fitting_grid.hpp>
#include <photongrid/map/map_builders.hpp>
#include <photongrid/map/pair_value.kernel.hpp>
#include <photongrid/map/photon_cell.kernel.hpp>

#include <rapidcheck.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace photongrid::testing {

using glm::uvec2;
using glm::uvec3;
using glm::vec4;

template <class Tag>
class algorithms : public on_backend<Tag> {
protected:
    using B = typename Tag::type;

    std::vector<uvec2> sorted_on_device(std::vector<uvec2> pairs, sort_report* report = nullptr)
    {
        auto buffer = this->b().upload(std::span<const uvec2>(pairs));
        const auto r = bitonic_sort(this->b(), buffer);
        if (report != nullptr)
            *report = r;
        return this->b().download(buffer);
    }

    static std::vector<uvec2> sorted_by_std(std::vector<uvec2> pairs)
    {
        std::sort(pairs.begin(), pairs.end(), [](uvec2 a, uvec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
        return pairs;
    }
};
TYPED_TEST_SUITE_P(algorithms);

// --- buffers
// ----------------------------------------------------------------------------------------------------------

} // namespace photongrid::testing
