// Textures and colours of vertices, on any backend: against interpolation in double precision, and the serial backend's
// pictures. Included by each on_<backend>.cpp.
#pragma once

#include "mesh_scene_tests.hpp"
#include "texture_scenes.hpp"

namespace photongrid::testing {

template <class Tag>
class textures : public mesh_scenes<Tag> {
protected:
    /// All pixels of a rectangle in even light against `reflectance(u, v)`, for u and v from 0 to 1 on the rectangle.
    void expect_reflectance(const scene& s, const auto& reflectance)
    {
        const auto seen = this->picture(s);
        const double half = std::tan(glm::radians(8.0));
        std::size_t inside = 0;
        for (std::uint32_t y = 0; y < 32; ++y)
            for (std::uint32_t x = 0; x < 48; ++x) {
                const double u = (0.75 + 3 * half * 1.5 * ((x + 0.5) / 24 - 1)) / 1.5,
                             v = 0.5 + 3 * half * (1 - (y + 0.5) / 16);
                if (!(u > 0.001 && u < 0.999 && v > 0.001 && v < 0.999))
                    continue;
                ++inside;
                const dvec3 known = reflectance(u, v);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(static_cast<double>(seen.pixels[y * 48 + x][c]), known[c], 2e-4)
                        << x << ' ' << y << ' ' << c;
            }
        EXPECT_GT(inside, 1000u);
    }
};
TYPED_TEST_SUITE_P(textures);

TYPED_TEST_P(textures, are_interpolated_between_texels)
{
    for (const auto wrap : {texture_wrap::repeat, texture_wrap::clamp})
        for (const auto& [width, height] : {std::pair{5u, 3u}, {1u, 1u}, {2u, 40u}}) {
            const auto t = random_texture(width, height, width);
            const glm::dvec2 scale(1.75, -2.5), offset(-0.4, 1.3);
            const auto s = rectangle_in_even_light(textured_rectangle({0, 0, 0}, {1.5f, 0, 0}, {0, 1, 0}),
                {"", std::make_shared<const texture>(t), wrap, scale, offset});
            this->expect_reflectance(s, [&](double u, double v) {
                // The weight of each texel is the product of two hats.
                const double x = (scale.x * u + offset.x) * t.width, y = t.height - (scale.y * v + offset.y) * t.height;
                dvec3 sum(0);
                for (int row = -150; row < 150; ++row)
                    for (int column = -20; column < 20; ++column) {
                        const double weight = std::max(0.0, 1 - std::abs(x - (column + 0.5)))
                            * std::max(0.0, 1 - std::abs(y - (row + 0.5)));
                        if (weight == 0)
                            continue;
                        const auto place = [&](int at, std::uint32_t size) {
                            const int n = static_cast<int>(size);
                            return wrap == texture_wrap::repeat ? ((at % n) + n) % n : std::clamp(at, 0, n - 1);
                        };
                        sum += weight
                            * dvec3(t.texels[static_cast<std::size_t>(
                                place(row, t.height) * static_cast<int>(t.width) + place(column, t.width))])
                            / 65535.0;
                    }
                return sum * dvec3(1, 0.5, 0.25);
            });
        }
}

TYPED_TEST_P(textures, of_vertices_are_interpolated_over_triangles)
{
    auto rectangle = textured_rectangle({0, 0, 0}, {1.5f, 0, 0}, {0, 1, 0});
    rectangle.colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    this->expect_reflectance(rectangle_in_even_light(rectangle, {}), [&](double u, double v) {
        const dvec3 color = u > v ? dvec3(1 - u, u - v, v) : dvec3(1 - v + (v - u), v - u, v);
        return color * dvec3(1, 0.5, 0.25);
    });
}

TYPED_TEST_P(textures, of_white_change_nothing)
{
    auto s = with_meshes(small_cornell());
    const auto plain = this->picture(s);
    s.materials[0].texture.map = std::make_shared<const texture>();
    for (auto& m : s.meshes)
        if (m.material == 0) {
            auto surface = *m.surface;
            surface.texture_coordinates.assign(surface.positions.size(), {0.3f, 0.7f});
            m.surface = std::make_shared<const mesh>(surface);
        }
    // What the red and green walls reflect is rounded to 2^-12.
    EXPECT_LE(relative_mse(this->picture(s), plain), 1e-6);
}

TYPED_TEST_P(textures, equal_the_serial_backends)
{
    const auto s = textured_cornell();
    this->expect_serial(s, s.render);
}

REGISTER_TYPED_TEST_SUITE_P(textures, are_interpolated_between_texels, of_vertices_are_interpolated_over_triangles,
    of_white_change_nothing, equal_the_serial_backends);

} // namespace photongrid::testing
