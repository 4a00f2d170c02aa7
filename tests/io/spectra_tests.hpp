// Colours of spectra against published values.
#pragma once

#include <photongrid/io/import/spectra.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace photongrid {
namespace {

    struct chromaticity {
        double x, y;
    };
    chromaticity chromaticity_of(const dvec3& xyz)
    {
        const double sum = xyz.x + xyz.y + xyz.z;
        return {xyz.x / sum, xyz.y / sum};
    }

    /// Planck's law with the constants as CIE has them, relative.
    sampled_spectrum black_body(double temperature)
    {
        sampled_spectrum s;
        for (double nm = 380; nm <= 780; nm += 5) {
            s.wavelengths.push_back(nm);
            s.values.push_back(std::pow(nm / 560, -5) / (std::exp(1.4388e7 / (nm * temperature)) - 1));
        }
        return s;
    }

    // CIE 15: the equal-energy stimulus is 1/3, 1/3; D65 is 0.3127, 0.3290; illuminant A is 0.4476, 0.4074.
    TEST(spectra, have_their_published_chromaticities)
    {
        const auto equal = chromaticity_of(tristimulus({{500}, {1}}));
        EXPECT_NEAR(equal.x, 1.0 / 3, 2e-4);
        EXPECT_NEAR(equal.y, 1.0 / 3, 2e-4);
        sampled_spectrum d65;
        for (double nm = 380; nm <= 780; nm += 10) {
            d65.wavelengths.push_back(nm);
            d65.values.push_back(daylight(nm));
        }
        const auto day = chromaticity_of(tristimulus(d65));
        EXPECT_NEAR(day.x, 0.3127, 4e-4); // the table ends at 380 and 780 nm and has steps of 10
        EXPECT_NEAR(day.y, 0.3290, 4e-4);
        const auto lamp = chromaticity_of(tristimulus(black_body(2855.5)));
        EXPECT_NEAR(lamp.x, 0.4476, 3e-4);
        EXPECT_NEAR(lamp.y, 0.4074, 3e-4);
        // The spectral locus.
        const auto green = chromaticity_of(matching_functions(520)), red = chromaticity_of(matching_functions(600));
        EXPECT_NEAR(green.x, 0.0743, 1e-4);
        EXPECT_NEAR(green.y, 0.8338, 1e-4);
        EXPECT_NEAR(red.x, 0.6270, 1e-4);
        EXPECT_NEAR(red.y, 0.3725, 1e-4);
    }

    TEST(spectra, white_is_white)
    {
        const auto white = reflected_rgb({{500}, {1}}), grey = reflected_rgb({{300, 900}, {0.25, 0.25}});
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(white[c], 1, 1e-9);
            EXPECT_NEAR(grey[c], 0.25, 1e-9);
        }
        const auto red = reflected_rgb({{380, 590, 600, 780}, {0, 0, 1, 1}});
        EXPECT_GT(red.x, 0.7);
        EXPECT_LT(red.y, 0.1);
        EXPECT_LT(red.z, 0.05);
    }

    // ITU-R BT.2087 has the matrix from BT.2020; BT.709 that of its luminance.
    TEST(spectra, colour_spaces_are_those_of_their_standards)
    {
        const auto m = to_rec709({{{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}}}, {0.3127, 0.3290}});
        const double expected[3][3]
            = {{1.6605, -0.5876, -0.0728}, {-0.1246, 1.1329, -0.0083}, {-0.0182, -0.1006, 1.1187}};
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                EXPECT_NEAR(m[column][row], expected[row][column], 1e-4);
        const auto luminance_of = [](const dvec3& rgb) { return 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z; };
        for (const double temperature : {1000.0, 2855.5, 6500.0, 20'000.0}) {
            const auto rgb = blackbody_rgb(temperature), again = emitted_rgb(black_body(temperature));
            EXPECT_LT(glm::length(rgb - again), 2e-3 * glm::length(rgb)) << temperature;
            if (temperature > 2000) { // below, blue is out of gamut and cut off
                EXPECT_NEAR(luminance_of(rgb), 1, 2e-3) << temperature;
            }
        }
        EXPECT_GT(blackbody_rgb(2000).x, blackbody_rgb(2000).z);
        EXPECT_LT(blackbody_rgb(20'000).x, blackbody_rgb(20'000).z);
        EXPECT_TRUE(std::isfinite(blackbody_rgb(1e-3).x));
        EXPECT_TRUE(std::isfinite(blackbody_rgb(1e30).x));
        EXPECT_EQ(emitted_rgb({{400, 700}, {0, 0}}), dvec3(0));
    }

    TEST(spectra, samples_are_joined_by_lines_and_end_at_0)
    {
        const sampled_spectrum s{{400, 500, 700}, {1, 3, 2}};
        EXPECT_EQ(s.at(399), 0);
        EXPECT_EQ(s.at(400), 1);
        EXPECT_EQ(s.at(450), 2);
        EXPECT_EQ(s.at(500), 3);
        EXPECT_EQ(s.at(600), 2.5);
        EXPECT_EQ(s.at(700), 2);
        EXPECT_EQ(s.at(701), 0);
        EXPECT_NEAR(conductor_reflectance(1.5, 0), 0.04, 1e-12); // Fresnel's, of glass
    }

} // namespace
} // namespace photongrid
