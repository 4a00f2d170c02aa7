// The statistics that devices of loose rounding are tested by see an error of 1 % in any material, and none where only
// rounding differs.
#pragma once

#include "material_statistics.hpp"

namespace photongrid::testing {

/// The scene with camera and lights moved by some units in the last place: other paths here and there, as on a device
/// that rounds loosely.
inline scene rounded_otherwise(scene s)
{
    s.camera.position += dvec3(4e-7, -3e-7, 2e-7);
    for (auto& l : s.rectangle_lights)
        l.corner += dvec3(2e-7, 0, -3e-7);
    for (auto& l : s.point_lights)
        l.position += dvec3(-2e-7, 3e-7, 2e-7);
    return s;
}

TEST(material_statistics, long_see_one_per_cent_in_one_material_and_no_rounding)
{
    serial_backend serial;
    const drawing draw = [&](const scene& s, const render_settings& k) { return render(serial, s, k).picture; };
    for (const auto& s : {small_cornell(), all_shapes()}) {
        for (const auto& d : differences_by_material(s, rounded_otherwise(s), draw, draw)) {
            EXPECT_FALSE(d.stands_out()) << s.name << ": " << d.what << ": " << d.mean << ", limit " << d.limit;
            EXPECT_LT(d.limit, 0.01) << s.name << ": " << d.what << ": an error of 1 % would not be seen";
        }
        for (std::size_t m = 0; m < s.materials.size(); ++m) {
            auto darker = rounded_otherwise(s);
            darker.materials[m].reflectance *= 0.99;
            const auto all = differences_by_material(s, darker, draw, draw);
            EXPECT_TRUE(std::any_of(all.begin(), all.end(), [](const auto& d) { return d.stands_out(); }))
                << s.name << ": " << s.materials[m].name << " is 1 % darker, and nothing stands out";
        }
    }
}

} // namespace photongrid::testing
