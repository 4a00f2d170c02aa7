// Hard cases of floats on devices (docs/reference/hard_cases.md, G), on any backend. References are double
// arithmetic, whole numbers and other runs. Included by each on_<backend>.cpp.
#pragma once

#include "../backends/serial_algorithms.hpp"
#include "../map/photon_sets.hpp"
#include "under_test.hpp"

#include <photongrid/map/prefix_sum_step.kernel.hpp>

#include <algorithm>

namespace photongrid::testing {

template <class Tag>
class hard_cases_of_numbers : public on_backend<Tag> {
};
TYPED_TEST_SUITE_P(hard_cases_of_numbers);

// --- G: floats on devices
// ---------------------------------------------------------------------------------------------

TYPED_TEST_P(hard_cases_of_numbers, g2_a_million_photons_add_up)
{
    // All in one disc: thirds; twelve decades in random order; twelve decades in descending order.
    auto& b = this->b();
    const uint n = 1000000;
    random_source u(81);
    std::vector<glm::vec4> positions, powers;
    std::vector<float> decades;
    for (uint i = 0; i < n; ++i) {
        positions.emplace_back(0.5f + 0.1f * u(), 0.5f, 0.5f + 0.1f * u(), 0.0f);
        decades.push_back(std::pow(10.0f, 12 * u() - 6));
        powers.emplace_back(1.0f / 3, decades.back(), 0.0f, 0.0f);
    }
    std::sort(decades.rbegin(), decades.rend());
    glm::dvec3 power(0), squares(0);
    for (uint i = 0; i < n; ++i) {
        powers[i].z = decades[i];
        power += glm::dvec3(powers[i]);
        squares += glm::dvec3(powers[i]) * glm::dvec3(powers[i]);
    }
    // A map of one cell, made here: sorting a million photons is another test.
    map_buffers<typename TestFixture::B> map;
    map.cells_of = make_grid(glm::vec3(0), glm::vec3(1), {1, 1, 1});
    map.photons = {b.upload(std::span<const glm::vec4>(positions)), b.upload(std::span<const glm::vec4>(powers)), {}};
    std::vector<uint> ids(n);
    for (uint i = 0; i < n; ++i)
        ids[i] = i;
    map.list = b.upload(std::span<const uint>(ids));
    map.cells = b.upload(std::span<const glm::uvec2>(std::vector<glm::uvec2>(1, {0, n})));
    const auto points = b.upload(std::span<const glm::vec4>(std::vector<glm::vec4>(1, {0.5f, 0.5f, 0.5f, 1.0f})));

    knn_settings s{.max_radius = 0.5f, .visits_per_pass = 4096};
    s.search = search_kind::fixed_radius;
    s.errors = true;
    const auto e = knn_grid_estimate(b, map, points, s);
    ASSERT_EQ(b.download(e.used)[0].x, n);
    const auto irradiance = b.download(e.irradiance)[0], standard_error = b.download(e.standard_error)[0];
    const auto paper = b.download(knn_grid_estimate(
        b, map, points, as_paper(knn_settings{.k = 2 * n, .max_radius = 0.5f, .visits_per_pass = 4096}))
                                      .irradiance)[0];
    const double area = M_PI * 0.25;
    double largest = 0, largest_of_errors = 0, largest_of_the_papers = 0;
    for (int c = 0; c < 3; ++c) {
        largest = std::max(largest, std::abs(static_cast<double>(irradiance[c]) * area / power[c] - 1));
        largest_of_errors = std::max(
            largest_of_errors, std::abs(static_cast<double>(standard_error[c]) * area / std::sqrt(squares[c]) - 1));
        largest_of_the_papers
            = std::max(largest_of_the_papers, std::abs(static_cast<double>(paper[c]) * area / power[c] - 1));
    }
    this->report("G2", "compensated sum of 1,000,000 photons, relative error:", largest);
    this->report("G2_standard_error", "its standard error, plainly added:", largest_of_errors);
    this->report("G2_paper", "at_least_k, plainly added:", largest_of_the_papers);
    // 2 units of 2^-24 for the sum, 3.5 for the division by the area.
    EXPECT_LE(largest, 5.5 * 0x1p-24);
    // Plain sums lose at most 2^-24 for each addition, the root halves it; they lose half of that when all roundings
    // agree.
    EXPECT_LE(largest_of_errors, 0.5 * n * 0x1p-24);
    EXPECT_LE(largest_of_the_papers, n * 0x1p-24);
}

TYPED_TEST_P(hard_cases_of_numbers, g3_sums_come_out_the_same_every_run)
{
    // Sums whose bits depend on their order, of many terms, in few cells: blending on GL, sorted lists on Vulkan.
    const auto set = make_photons(distribution::clustered, 60000, {3, 3, 3}, 83);
    const auto totals
        = [&](auto& b) { return b.download(stencil_route(b, upload_photons(b, set), set.g, 4, 7).totals); };
    serial_backend serial;
    const auto expected = totals(serial);
    std::size_t different = 0;
    for (int run = 0; run < 3; ++run)
        different += count_different_bits(totals(this->b()), expected);
    this->report("G3", "sums of three runs that differ from serial's in any bit:", static_cast<double>(different));
    EXPECT_EQ(different, 0u);
    // That the order matters at all: another one gives other bits.
    EXPECT_GT(count_different_bits(
                  serial.download(stencil_route(serial, upload_photons(serial, set), set.g, 4, 8).totals), expected),
        0u);
}

TYPED_TEST_P(hard_cases_of_numbers, g5_elements_are_found_about_the_ends_of_texture_rows)
{
    // Reads of element i - stride, over launches that begin and end anywhere; rows are 2,048 elements on gl. Beyond
    // 2^24 elements a float no longer holds a number of one.
    auto& b = this->b();
    std::size_t wrong = 0;
    const auto check = [&](const std::vector<uint>& host, const buffer_of<typename TestFixture::B, uint>& device,
                           uint first, uint count, uint stride) {
        const auto n = static_cast<uint>(host.size());
        auto out = b.template make<uint>(n);
        b.template run<kernels::prefix_sum_step>({count, first}, {.stride = stride}, reads(device), writes(out));
        const auto result = b.download(out);
        for (uint i = first; i < first + count; ++i) {
            uint sum = 0;
            for (uint s = 0; s < 4 && i >= s * stride; ++s)
                sum += host[i - s * stride];
            wrong += result[i] != sum ? 1u : 0u;
        }
    };
    for (const uint n : {1u, 2047u, 2048u, 2049u, 4095u, 4096u, 4099u, (1u << 24) + 4099u}) {
        random_source u(n);
        std::vector<uint> host(n);
        for (uint i = 0; i < n; ++i)
            host[i] = u.below(0xFFFFFFFFu);
        const auto device = b.upload(std::span<const uint>(host));
        ASSERT_EQ(count_different_bits(b.download(device), host), 0u) << n << " elements";
        for (const uint stride : {1u, 2047u, 2048u, 2049u}) {
            if (n < 10000)
                check(host, device, 0, n, stride);
            const uint first = n < 5000 ? n / 3 : n - 5000;
            check(host, device, first, n - first, stride);
        }
    }
    this->report("G5", "elements read from a wrong place:", static_cast<double>(wrong));
    EXPECT_EQ(wrong, 0u);
}

REGISTER_TYPED_TEST_SUITE_P(hard_cases_of_numbers, g2_a_million_photons_add_up, g3_sums_come_out_the_same_every_run,
    g5_elements_are_found_about_the_ends_of_texture_rows);

} // namespace photongrid::testing
