#include <photongrid/io/import/spectra.hpp>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace photongrid {

namespace {
    constexpr double first = 380, last = 780, step = 10; // nm

    struct matching_row {
        double x, y, z;
    };
    constexpr std::array<matching_row, 41> matching_table{{{.0014, .0000, .0065}, {.0042, .0001, .0201},
        {.0143, .0004, .0679}, {.0435, .0012, .2074}, {.1344, .0040, .6456}, {.2839, .0116, 1.3856},
        {.3483, .0230, 1.7471}, {.3362, .0380, 1.7721}, {.2908, .0600, 1.6692}, {.1954, .0910, 1.2876},
        {.0956, .1390, .8130}, {.0320, .2080, .4652}, {.0049, .3230, .2720}, {.0093, .5030, .1582},
        {.0633, .7100, .0782}, {.1655, .8620, .0422}, {.2904, .9540, .0203}, {.4334, .9950, .0087},
        {.5945, .9950, .0039}, {.7621, .9520, .0021}, {.9163, .8700, .0017}, {1.0263, .7570, .0011},
        {1.0622, .6310, .0008}, {1.0026, .5030, .0003}, {.8544, .3810, .0002}, {.6424, .2650, .0000},
        {.4479, .1750, .0000}, {.2835, .1070, .0000}, {.1649, .0610, .0000}, {.0874, .0320, .0000},
        {.0468, .0170, .0000}, {.0227, .0082, .0000}, {.0114, .0041, .0000}, {.0058, .0021, .0000},
        {.0029, .0010, .0000}, {.0014, .0005, .0000}, {.0007, .0002, .0000}, {.0003, .0001, .0000},
        {.0002, .0001, .0000}, {.0001, .0000, .0000}, {.0000, .0000, .0000}}};

    constexpr std::array<double, 41> daylight_table{49.9755, 54.6482, 82.7549, 91.486, 93.4318, 86.6823, 104.865,
        117.008, 117.812, 114.861, 115.923, 108.811, 109.354, 107.802, 104.79, 107.689, 104.405, 104.046, 100, 96.3342,
        95.788, 88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213,
        71.6091, 74.349, 61.604, 69.8856, 75.087, 63.5927, 46.4182, 66.8054, 63.3828};

    struct between_rows {
        std::size_t row;
        double share; ///< of the next row
    };
    std::optional<between_rows> rows_at(double wavelength)
    {
        if (!(wavelength >= first && wavelength <= last))
            return std::nullopt;
        const double at = (wavelength - first) / step;
        const auto row = std::min(static_cast<std::size_t>(at), matching_table.size() - 2);
        return between_rows{row, at - static_cast<double>(row)};
    }

    /// The sum of `value` times the matching functions over 1 nm steps, in which spectra of lamps with lines are seen.
    template <class Value>
    dvec3 integral(Value&& value)
    {
        dvec3 sum(0);
        for (double nm = first; nm <= last; nm += 1)
            sum += value(nm) * matching_functions(nm);
        return sum;
    }

    const dvec3& integral_of_one()
    {
        static const dvec3 sum = integral([](double) { return 1.0; });
        return sum;
    }

    const rgb_primaries rec709{{{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}}, {0.3127, 0.3290}};

    dvec3 tristimulus_of(const std::array<double, 2>& xy) { return {xy[0] / xy[1], 1, (1 - xy[0] - xy[1]) / xy[1]}; }

    /// From linear rgb to tristimulus values.
    glm::dmat3 to_tristimulus(const rgb_primaries& p)
    {
        const glm::dmat3 columns(
            tristimulus_of(p.primaries[0]), tristimulus_of(p.primaries[1]), tristimulus_of(p.primaries[2]));
        const dvec3 weights = glm::inverse(columns) * tristimulus_of(p.white);
        return {columns[0] * weights.x, columns[1] * weights.y, columns[2] * weights.z};
    }

    dvec3 with_unit_luminance(const dvec3& xyz)
    {
        return xyz.y > 0 ? glm::max(rgb_of_tristimulus(xyz / xyz.y), dvec3(0)) : dvec3(0);
    }
} // namespace

double sampled_spectrum::at(double wavelength) const
{
    if (wavelengths.size() == 1)
        return values[0];
    const auto after = std::lower_bound(wavelengths.begin(), wavelengths.end(), wavelength);
    if (after == wavelengths.end() || (after == wavelengths.begin() && wavelength < *after))
        return 0;
    const auto i = static_cast<std::size_t>(after - wavelengths.begin());
    if (wavelengths[i] == wavelength)
        return values[i];
    const double share = (wavelength - wavelengths[i - 1]) / (wavelengths[i] - wavelengths[i - 1]);
    return values[i - 1] + share * (values[i] - values[i - 1]);
}

dvec3 matching_functions(double wavelength)
{
    const auto at = rows_at(wavelength);
    if (!at)
        return dvec3(0);
    const auto of = [](const matching_row& r) { return dvec3(r.x, r.y, r.z); };
    return glm::mix(of(matching_table[at->row]), of(matching_table[at->row + 1]), at->share);
}

double daylight(double wavelength)
{
    const auto at = rows_at(wavelength);
    return at ? glm::mix(daylight_table[at->row], daylight_table[at->row + 1], at->share) : 0;
}

dvec3 tristimulus(const sampled_spectrum& s)
{
    return integral([&](double nm) { return s.at(nm); }) / integral_of_one().y;
}

dvec3 rgb_of_tristimulus(const dvec3& xyz)
{
    static const glm::dmat3 matrix = glm::inverse(to_tristimulus(rec709));
    return matrix * xyz;
}

dvec3 reflected_rgb(const sampled_spectrum& reflectance)
{
    static const dvec3 white = integral([](double nm) { return daylight(nm); });
    const auto xyz = integral([&](double nm) { return daylight(nm) * reflectance.at(nm); });
    // Relative to a white surface in the same light, then as seen in the white of Rec. 709.
    const dvec3 white_of_rgb = to_tristimulus(rec709) * dvec3(1);
    return glm::clamp(rgb_of_tristimulus(xyz / white * white_of_rgb), dvec3(0), dvec3(1));
}

dvec3 emitted_rgb(const sampled_spectrum& emission)
{
    return with_unit_luminance(integral([&](double nm) { return emission.at(nm); }));
}

dvec3 blackbody_rgb(double temperature)
{
    // Relative to the radiance at 560 nm, so that nothing overflows. Below 100 K the colour is that of 100 K.
    constexpr double second_constant = 1.438776877e7; // nm K
    temperature = std::max(temperature, 100.0);
    const auto relative = [&](double nm) {
        const double at = second_constant / (nm * temperature), at_middle = second_constant / (560 * temperature);
        return std::pow(560 / nm, 5) * std::exp(at_middle - at) * std::expm1(-at_middle) / std::expm1(-at);
    };
    return with_unit_luminance(integral(relative));
}

double conductor_reflectance(double eta, double k)
{
    return ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
}

glm::dmat3 to_rec709(const rgb_primaries& from)
{
    return from == rec709 ? glm::dmat3(1) : glm::inverse(to_tristimulus(rec709)) * to_tristimulus(from);
}

std::optional<dvec3> metal_reflectance(std::string_view symbol)
{
    struct metal {
        std::string_view symbol;
        dvec3 reflectance;
    };
    static const metal metals[]
        = {{"Ag", {0.972, 0.960, 0.915}}, {"Al", {0.913, 0.922, 0.924}}, {"Au", {1.000, 0.766, 0.336}},
            {"Cr", {0.549, 0.556, 0.554}}, {"Cu", {0.955, 0.638, 0.538}}, {"CuZn", {0.910, 0.778, 0.423}}};
    for (const auto& m : metals)
        if (m.symbol == symbol)
            return m.reflectance;
    return std::nullopt;
}

} // namespace photongrid
