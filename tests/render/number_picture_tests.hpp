// Hard cases of the numbers of a picture (docs/reference/hard_cases.md, H), on any backend. Included by each
// on_<backend>.cpp.
#pragma once

#include "../backends/serial_pictures.hpp"
#include "../core/under_test.hpp"
#include "../scene/test_scenes.hpp"

#include <algorithm>

namespace photongrid::testing {

template <class Tag>
class hard_cases_of_pictures : public on_backend<Tag> {
};
TYPED_TEST_SUITE_P(hard_cases_of_pictures);

TYPED_TEST_P(hard_cases_of_pictures, h4_pixels_that_are_not_finite_are_counted_and_black)
{
    auto& b = this->b();
    auto s = small_cornell();
    s.render.output.width = s.render.output.height = 32;
    s.render.view.spp = 2;
    auto built = build_map(b, s, s.render);
    const auto [clean, clean_stats] = draw(b, built, s.camera, s.render);
    EXPECT_EQ(clean_stats.invalid_pixels, 0u);
    // Two photons go bad after they were checked, as a faulty device may have it.
    auto powers = b.download(built.map().photons.powers);
    powers[powers.size() / 3].y = std::numeric_limits<float>::quiet_NaN();
    powers[powers.size() / 2].x = std::numeric_limits<float>::infinity();
    built.lights.front().map.photons.powers = b.upload(std::span<const glm::vec4>(powers));
    const auto [bad, stats] = draw(b, built, s.camera, s.render);
    std::size_t black = 0, changed = 0;
    for (std::size_t i = 0; i < bad.pixels.size(); ++i)
        if (bad.pixels[i] != clean.pixels[i])
            ++(bad.pixels[i] == glm::vec3(0) ? black : changed);
    this->report("H4", "pixels that are not finite and counted:", static_cast<double>(stats.invalid_pixels));
    EXPECT_GT(stats.invalid_pixels, 4u);
    EXPECT_LT(stats.invalid_pixels, bad.pixels.size());
    EXPECT_EQ(stats.invalid_pixels, black);
    EXPECT_EQ(changed, 0u); // all others keep every bit
}

REGISTER_TYPED_TEST_SUITE_P(hard_cases_of_pictures, h4_pixels_that_are_not_finite_are_counted_and_black);

} // namespace photongrid::testing
