// The paper's three scenes, from their files, on any backend: in two passes and by both maps they equal serial's. In
// short runs with a quarter of the photons.
#pragma once

#include "pictures.hpp"

#include <photongrid/io/scene_file.hpp>

namespace photongrid::testing {

template <class Tag>
class scene_files : public on_backend<Tag> {
protected:
    void compare(const std::string& name, glm::uvec2 size)
    {
        const auto s = read_scene(std::string(PHOTONGRID_SCENES) + "/" + name + ".json");
        render_settings numbers;
        numbers.map.photons = 60000;
        numbers.map.caustic_photons = 60000;
        numbers.estimate.k = 100;
        numbers.estimate.caustic_k = 40;
        numbers.view.spp = 1;
        numbers.view.light_samples = 2;
        numbers.output.passes = 2;
        auto settings = with_numbers(s.render, numbers);
        settings.map.grid = s.paper.value().map.grid;
        settings.estimate.max_radius = s.paper->estimate.max_radius;
        if (size.x > 0) {
            settings.output.width = size.x;
            settings.output.height = size.y;
            settings.map.photons /= 4;
            settings.map.caustic_photons /= 4;
        }
        expect_the_pictures_of_serial(name + ", the paper's estimate", s, as_paper(settings));
        expect_the_pictures_of_serial(name, s, settings);
    }

private:
    /// By both maps. What their difference may be, routed_picture_tests.hpp tests.
    void expect_the_pictures_of_serial(const std::string& name, const scene& s, render_settings settings)
    {
        image pictures[2];
        std::uint64_t overflowing = 0;
        for (const auto builder : {map_builder::sort, map_builder::route}) {
            settings.map.builder = builder;
            auto [drawn, stats] = render(this->b(), s, settings);
            auto& picture = pictures[builder == map_builder::route ? 1 : 0] = std::move(drawn);
            overflowing = stats.map.overflowing_cells;
            expect_an_exact_account(stats.photons, stats.photons.stored); // of other photons there may be fewer
            const auto& m = settings.map;
            const std::uint64_t passes = settings.output.passes;
            EXPECT_GE(stats.photons.stored, passes * std::max(m.caustic_photons, m.photons) * 9 / 10);
            EXPECT_LE(stats.photons.stored, passes * (m.caustic_photons + m.photons));
            EXPECT_EQ(stats.invalid_pixels, 0u);
            const auto caps = this->b().caps();
            if (caps.exact_division && caps.exact_sqrt && caps.backend != "serial") {
                serial_backend serial;
                EXPECT_LE(relative_mse(picture, render(serial, s, settings).picture), 1e-9) << name;
            }
        }
        std::printf("%s: %llu overflowing cells, relMSE of route against sort %.4f\n", name.c_str(),
            static_cast<unsigned long long>(overflowing), relative_mse(pictures[1], pictures[0]));
    }
};
TYPED_TEST_SUITE_P(scene_files);

TYPED_TEST_P(scene_files, glass_ball) { this->compare("glass_ball", {128, 96}); }
TYPED_TEST_P(scene_files, ring) { this->compare("ring", {128, 96}); }
TYPED_TEST_P(scene_files, cornell_box) { this->compare("cornell_box", {128, 96}); }
TYPED_TEST_P(scene_files, cornell_blocks) { this->compare("cornell_blocks", {128, 96}); }
TYPED_TEST_P(scene_files, long_glass_ball) { this->compare("glass_ball", {0, 0}); }
TYPED_TEST_P(scene_files, long_ring) { this->compare("ring", {0, 0}); }
TYPED_TEST_P(scene_files, long_cornell_box) { this->compare("cornell_box", {0, 0}); }

REGISTER_TYPED_TEST_SUITE_P(
    scene_files, glass_ball, ring, cornell_box, cornell_blocks, long_glass_ball, long_ring, long_cornell_box);

} // namespace photongrid::testing
