// Linear rgb (Rec. 709) of spectra, by the observer of CIE 1931 (2 degrees).
#pragma once

#include <photongrid/scene/check.hpp>

#include <glm/mat3x3.hpp>

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace photongrid {

/// A spectrum by samples: linear between them, 0 beyond; one sample alone is constant.
struct sampled_spectrum {
    std::vector<double> wavelengths; ///< nm, ascending; at least one
    std::vector<double> values;      ///< one for each

    double at(double wavelength) const;
};

/// The matching functions x, y and z of CIE 1931 at a wavelength, nm: linear between those of the table in steps of
/// 10 nm (CIE 15), 0 outside of 380 to 780 nm.
dvec3 matching_functions(double wavelength);

/// Daylight D65, relative, 100 at 560 nm: linear between values in steps of 10 nm (ISO 11664-2), 0 outside of 380 to
/// 780 nm.
double daylight(double wavelength);

/// The tristimulus values X, Y, Z of a spectrum, in units where Y of an equal spectrum of 1 is 1.
dvec3 tristimulus(const sampled_spectrum& s);

/// Linear rgb of tristimulus values; (1, 1, 1) for D65 at Y = 1. Channels of colours outside of Rec. 709 are negative.
dvec3 rgb_of_tristimulus(const dvec3& xyz);

/// The colour of a surface in daylight: (1, 1, 1) for a reflectance of 1. Limited to 0 to 1.
dvec3 reflected_rgb(const sampled_spectrum& reflectance);

/// The colour of a light, with Y = 1. Channels of colours outside of Rec. 709 are 0. (0, 0, 0) for a spectrum without
/// light.
dvec3 emitted_rgb(const sampled_spectrum& emission);

/// The colour of a black body, with Y = 1 (Planck's law). `temperature`: K, above 0.
dvec3 blackbody_rgb(double temperature);

/// The reflectance of a conductor at normal incidence, for an index of refraction eta + i k.
double conductor_reflectance(double eta, double k);

/// Primaries and white point by chromaticities x, y.
struct rgb_primaries {
    std::array<std::array<double, 2>, 3> primaries;
    std::array<double, 2> white;

    bool operator==(const rgb_primaries&) const = default;
};

/// The matrix from linear rgb of these primaries to that of Rec. 709; of those themselves exactly 1. White points are
/// not adapted.
glm::dmat3 to_rec709(const rgb_primaries& from);

/// The reflectance, rgb, of a polished metal by the symbol of its element ("Ag", "Al", "Au", "Cr", "Cu"), or "CuZn"
/// (brass); none if it is not known.
std::optional<dvec3> metal_reflectance(std::string_view symbol);

} // namespace photongrid
