// The numbers of accessors.
#pragma once

#include <photongrid/io/gltf/document.hpp>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <vector>

namespace photongrid::gltf {

/// The elements of an accessor, as numbers; integers that are normalised from 0 or -1 to 1.
/// \throws scene_error for one that reaches beyond its buffer view, or whose elements have another number of
///         components.
/// @{
std::vector<glm::vec2> pairs(document& all, std::size_t accessor);
std::vector<glm::vec3> triples(document& all, std::size_t accessor);
/// Of elements with three components, the fourth is 1.
std::vector<glm::vec4> quadruples(document& all, std::size_t accessor);
std::vector<glm::mat4> matrices(document& all, std::size_t accessor);
/// @}

/// Whole numbers.
/// \throws scene_error, also for an accessor of another type.
/// @{
std::vector<std::uint32_t> indices(document& all, std::size_t accessor);
std::vector<glm::uvec4> joints(document& all, std::size_t accessor);
/// @}

} // namespace photongrid::gltf
