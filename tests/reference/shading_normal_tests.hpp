// Light by way of a flat mesh that claims to be tilted: photons, which carry power with Veach's factor for shading
// normals, against eye paths of the reference, which carry radiance and need none.
#pragma once

#include "eye_path_sums.hpp"

namespace photongrid::testing {
namespace {

    /// A floor, and above it a horizontal square whose normals are not those of its plane.
    scene under_a_tilted_square(const material& of, double height, const glm::vec3& normal)
    {
        scene s;
        s.name = of.name;
        s.materials = {{"floor", material_kind::lambertian, dvec3(0.1)}, of};
        s.polygons = {{{{-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}}, 0}};
        const mesh square{{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}}, {{0, 1, 2}, {0, 2, 3}},
            std::vector<glm::vec3>(4, normal)};
        s.meshes = {{"", std::make_shared<const mesh>(square), glm::dmat3(1), {0, height, 0}, 1}};
        return s;
    }

    TEST(validation, photons_off_a_mirror_that_claims_to_be_tilted_equal_eye_paths)
    {
        auto s = under_a_tilted_square({"mirror", material_kind::mirror, dvec3(0.9)}, 1.5, {0.5f, -1, 0});
        s.rectangle_lights = {{"lamp", {-1, 0.2, -1}, {0, 0, 2}, {2, 0, 0}, dvec3(20)}}; // upwards
        s.camera = {{2.2, 1.2, -0.1}, {2.2, 0, 0}, {0, 0, 1}, 60};
        expect_photons_equal_eye_paths(s);
    }

    TEST(validation, photons_through_glass_that_claims_to_be_tilted_equal_eye_paths)
    {
        auto s = under_a_tilted_square({"glass", material_kind::glass, dvec3(1), 1.5}, 0.8, {0.5f, 1, 0});
        s.rectangle_lights = {{"lamp", {-0.5, 1.6, -0.5}, {1, 0, 0}, {0, 0, 1}, dvec3(20)}}; // downwards
        s.camera = {{0.1, 0.7, 0}, {-0.2, 0, 0}, {0, 0, 1}, 60};
        expect_photons_equal_eye_paths(s);
    }

} // namespace
} // namespace photongrid::testing
