// Colours for numbers.
#pragma once

#include <glm/vec3.hpp>

namespace photongrid::false_colors {

// All colours are linear, 0 to 1.

/// From 0, black, by violet, red and orange to 1, nearly white. Lightness (CIE L*) rises evenly, so that the order is
/// seen without colours as well. Numbers beyond the ends have the colour of the end. NaN: not_finite.
glm::vec3 heat(double t);

/// From -1, blue, by 0, white, to 1, red; else as heat().
glm::vec3 balance(double t);

/// A pixel that has no number: green, which is in neither scale.
inline constexpr glm::vec3 not_finite{0, 1, 0};

} // namespace photongrid::false_colors
