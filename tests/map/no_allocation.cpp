// Queries for single points do not allocate memory once their scratch has grown. A program of its own, since it
// replaces the global operator new to count.
#include "../backends/serial_algorithms.hpp"
#include "host_photons.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::size_t> allocations{0};
}

void* operator new(std::size_t size)
{
    ++allocations;
    if (void* p = std::malloc(std::max<std::size_t>(size, 1)))
        return p;
    throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment)
{
    ++allocations;
    const auto a = static_cast<std::size_t>(alignment);
    if (void* p = std::aligned_alloc(a, (std::max<std::size_t>(size, 1) + a - 1) / a * a))
        return p;
    throw std::bad_alloc();
}
// The forms for arrays and those that do not throw call these.
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

namespace photongrid::testing {

TEST(no_allocation, in_queries_for_single_points)
{
    const auto photons = some_photons(7, 2000, false);
    const auto points = some_query_points(7, 200, false);
    serial_backend device;
    for (const auto& settings : {knn_settings{.k = 50}, knn_settings{.k = 50, .bias = bias_kind::unbiased},
             knn_settings{.k = 50, .max_radius = 0.1f, .search = search_kind::fixed_radius},
             knn_settings{.k = 50, .leaks = {.side = true, .min_cosine = 0.3f, .flattening = 3}}}) {
        const photon_map map(device, photons, settings);
        query_scratch scratch;
        float sum = 0;
        const auto ask_everywhere = [&] {
            const auto before = allocations.load();
            for (const auto& p : points) {
                sum += map.irradiance(p, up, scratch).value.x;
                map.for_each_nearest(p, 50, scratch, [&](photon_id, float d2) { sum += d2; });
                map.for_each_within(p, 0.1f, [&](photon_id, float d2) { sum += d2; });
            }
            return allocations.load() - before;
        };
        EXPECT_GT(ask_everywhere(), 0u) << "the scratch grows, and this test sees it";
        EXPECT_EQ(ask_everywhere(), 0u);
        EXPECT_GT(sum, 0.0f);
    }
}

} // namespace photongrid::testing
