// Values in the attributes of Mitsuba's elements: numbers, colours, spectra and transformations.
#pragma once

#include <photongrid/io/mitsuba/description.hpp>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace photongrid::mitsuba {

/// An element that is read: where it stands, and its attributes by their names, with what `$` stands for; "" for one
/// that it lacks.
struct element {
    std::string tag;
    source_place place;
    std::function<std::string(const char*)> attribute;
};

/// "toWorld", "intIOR" as "to_world", "int_ior".
std::string snake_case(std::string_view name);

/// The words of a text between blanks and commas.
std::vector<std::string_view> words_of(std::string_view text);

/// The numbers of a text.
/// \throws scene_error for a word that is no finite number.
std::vector<double> numbers_of(const source_place& place, std::string_view text);

/// The rgb of `<rgb>` and `<srgb>`: one or three numbers, or "#rrggbb"; linear.
std::vector<double> color_of(const element& e);

/// The samples of "400:0.5, 500:0.6", at ascending wavelengths.
sampled_spectrum samples_of(const source_place& place, std::string_view text);
/// Those of wavelengths and values.
sampled_spectrum samples_of(const source_place& place, std::vector<double> wavelengths, std::vector<double> values);

/// The vector of the attributes x, y and z, or of `value`, which is three numbers or one.
/// `if_absent`: of an attribute that is missing; without it that is an error.
dvec3 vector_of(const element& e, std::optional<double> if_absent);

/// What `<translate>`, `<scale>`, `<rotate>`, `<lookat>` or `<matrix>` does.
glm::dmat4 transformation_of(const element& e);

/// A unit vector at a right angle to a unit vector, as Mitsuba finds it (Duff et al. 2017, Building an Orthonormal
/// Basis, Revisited).
dvec3 beside(const dvec3& n);

} // namespace photongrid::mitsuba
