// What pbrt's directives of transformations say.
#pragma once

#include <photongrid/io/import/token_reader.hpp>

#include <glm/mat4x4.hpp>

#include <array>
#include <cstddef>

namespace photongrid::pbrt {

template <std::size_t N>
std::array<double, N> read_numbers(token_reader& t)
{
    std::array<double, N> all{};
    for (auto& v : all)
        v = t.number("a number");
    return all;
}

/// \name What a directive's numbers make
/// Of Transform and ConcatTransform, Translate, Scale, Rotate, and LookAt, which moves the world in front of a camera.
/// \throws scene_error for a missing number, and for an axis or a view without a direction.
/// @{
glm::dmat4 read_matrix(token_reader& t);
glm::dmat4 read_translation(token_reader& t);
glm::dmat4 read_scaling(token_reader& t);
glm::dmat4 read_rotation(token_reader& t, const source_place& place);
glm::dmat4 read_view(token_reader& t, const source_place& place);
/// @}

} // namespace photongrid::pbrt
