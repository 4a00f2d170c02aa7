// Hard cases of ray tracing (docs/reference/hard_cases.md), on any backend: the fixture.
#pragma once

#include "../render/pictures.hpp"
#include "direct_light_at.hpp"
#include "probe_rays.hpp"
#include <photongrid/io/scene_file.hpp>

namespace photongrid::testing {

template <class Tag>
class hard_cases : public on_backend<Tag> {
protected:
    using B = typename Tag::type;

    /// Rays against a scene, on the device; where arithmetic is exact, every bit must be serial's.
    ray_hits trace(const scene& s, const rays& r)
    {
        auto mine = trace_rays(this->b(), s, r);
        if (exact()) {
            serial_backend serial;
            const auto theirs = trace_rays(serial, s, r);
            EXPECT_EQ(count_different_bits(mine.places, theirs.places), 0u)
                << "of " << r.size() << ", " << first_difference(mine.places, theirs.places);
            EXPECT_EQ(count_different_bits(mine.facings, theirs.facings), 0u)
                << "of " << r.size() << ", " << first_difference(mine.facings, theirs.facings);
            // After a miss they are infinite or NaN, whose sign devices choose.
            const auto starts_of_hits = [](ray_hits h) {
                for (std::size_t i = 0; i < h.starts.size(); ++i)
                    if (!h.hit(i))
                        h.starts[i] = glm::vec4(0, 0, 0, h.starts[i].w);
                return h.starts;
            };
            const auto starts = starts_of_hits(mine), their_starts = starts_of_hits(theirs);
            EXPECT_EQ(count_different_bits(starts, their_starts), 0u)
                << "of " << r.size() << ", " << first_difference(starts, their_starts);
        }
        return mine;
    }

    bool exact() { return this->b().caps().exact_division && this->b().caps().exact_sqrt; }

    std::vector<glm::vec4> direct_light_at(
        const scene& s, const std::vector<dvec3>& points, const std::vector<dvec3>& normals, uint samples)
    {
        return testing::direct_light_at(this->b(), s, points, normals, samples);
    }
};
TYPED_TEST_SUITE_P(hard_cases);

} // namespace photongrid::testing
