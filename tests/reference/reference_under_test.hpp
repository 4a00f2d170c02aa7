// The path tracer in double under test.
#pragma once

#include <photongrid/reference/reference.hpp>

#include "../scene/test_scenes.hpp"
#include <photongrid/io/image_file.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <numeric>
#include <random>

#include <sys/wait.h>
#include <unistd.h>

namespace photongrid {
namespace {

    const std::uint32_t white = 0;

    /// A scene with the materials that the tests use: white (reflectance 1), grey, mirror, glass.
    scene empty_scene()
    {
        scene s;
        s.name = "test";
        s.materials = {{"white", material_kind::lambertian, dvec3(1)}, {"grey", material_kind::lambertian, dvec3(0.5)},
            {"mirror", material_kind::mirror, dvec3(0.8)}, {"glass", material_kind::glass, dvec3(1), 1.5}};
        return s;
    }
    polygon rectangle(dvec3 corner, dvec3 u, dvec3 v, std::uint32_t material)
    {
        return {{corner, corner + u, corner + u + v, corner + v}, material};
    }

    /// A camera that sees next to nothing but `point`.
    camera looking_at(dvec3 from, dvec3 point) { return {from, point, {0.3, 0.8, 0.5}, 0.001}; }

    reference_settings quick(std::uint32_t width, std::uint32_t height, std::uint32_t spp)
    {
        reference_settings r;
        r.width = width;
        r.height = height;
        r.spp = spp;
        r.threads = 2;
        return r;
    }

    struct mean_and_error {
        dvec3 mean{0}, error{0};
    };
    /// All pixels together, as estimates of one quantity.
    mean_and_error overall(const reference_picture& p)
    {
        mean_and_error m;
        const double n = static_cast<double>(p.mean.pixels.size());
        for (std::size_t i = 0; i < p.mean.pixels.size(); ++i) {
            m.mean += dvec3(p.mean.pixels[i]) / n;
            m.error += dvec3(p.standard_error.pixels[i]) * dvec3(p.standard_error.pixels[i]) / (n * n);
        }
        m.error = glm::sqrt(m.error);
        return m;
    }
    /// Four standard errors, and the rounding of float pictures.
    void expect_agrees(const reference_picture& p, double expected, double largest_error)
    {
        const auto m = overall(p);
        EXPECT_LT(m.error.x, largest_error * expected) << "too noisy to tell";
        EXPECT_NEAR(m.mean.x, expected, 4 * m.error.x + 2e-7 * expected);
        EXPECT_EQ(p.stats.invalid_samples, 0u);
    }

    void expect_dark(const reference_picture& p)
    {
        for (const auto& pixel : p.mean.pixels)
            EXPECT_EQ(pixel, glm::vec3(0));
    }

} // namespace
} // namespace photongrid
