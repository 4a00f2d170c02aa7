// What a type must have to be a backend, no more: a minimal one satisfies the concept, and one without a verb does not.
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/estimate/knn_visit.kernel.hpp>
#include <photongrid/map/bitonic_step.kernel.hpp>
#include <photongrid/map/map_builders.hpp>
#include <photongrid/map/overflowing_cell.kernel.hpp>
#include <photongrid/map/route_photon.kernel.hpp>

#include <gtest/gtest.h>

namespace {

using namespace photongrid;

struct minimal_backend {
    template <element T>
    struct buffer {
        using value_type = T;
        std::size_t size() const { return 0; }
    };
    template <element T>
    buffer<T> make(std::size_t)
    {
        return {};
    }
    template <element T, std::size_t E>
    buffer<T> upload(std::span<const T, E>)
    {
        return {};
    }
    template <element T>
    std::vector<T> download(const buffer<T>&)
    {
        return {};
    }
    template <gather_kernel K, class R, class W>
    void run(launch, const typename K::Params&, R, W)
    {
    }
    template <iterative_kernel K, class R, class W>
    progress run_until_done(launch, const typename K::Params&, R, W, uint)
    {
        return {.passes = 0, .finished = true, .active = {}};
    }
    template <predicate_kernel K, class R>
    std::uint64_t count(launch, const typename K::Params&, R)
    {
        return 0;
    }
    template <route_kernel K, class R>
    void route(launch, const typename K::Params&, R, const route_shape&, buffer<uint>&, buffer<glm::vec4>&)
    {
    }
    void finish() {}
    const capabilities& caps() const { return caps_; }
    std::uint64_t bytes() const { return 0; }
    std::uint64_t peak_bytes() const { return 0; }
    const std::map<std::string, kernel_cost>& costs() const { return costs_; }

    capabilities caps_;
    std::map<std::string, kernel_cost> costs_;
};

struct backend_without_route : minimal_backend {
    template <class K>
    void route() = delete;
};

static_assert(backend<minimal_backend>);
static_assert(!backend<backend_without_route>);
static_assert(!backend<int>);

// Kernels are told apart by what they define.
static_assert(
    gather_kernel<
        kernels::bitonic_step> && !iterative_kernel<kernels::bitonic_step> && !predicate_kernel<kernels::bitonic_step>);
static_assert(iterative_kernel<kernels::knn_visit>);
static_assert(predicate_kernel<kernels::overflowing_cell>);
static_assert(route_kernel<kernels::route_photon> && !route_kernel<kernels::bitonic_step>);
static_assert(kernel_name<kernels::knn_visit>() == "knn_visit");
static_assert(input_count<kernels::knn_visit> == 7 && output_count<kernels::knn_visit> == 3);

// No word of the dialect survives the headers.
#if defined(PARAMS) || defined(INPUT) || defined(OUTPUT) || defined(STATE) || defined(SWITCH) || defined(precise)
#error "a word of the kernel dialect reached user code"
#endif

TEST(backend_concept, every_algorithm_compiles_for_a_minimal_backend)
{
    minimal_backend b;
    minimal_backend::buffer<glm::uvec2> pairs;
    EXPECT_EQ(bitonic_sort(b, pairs).passes, 0u);
    const auto g = make_grid(glm::vec3(0), glm::vec3(1), {2, 2, 2});
    const auto sorted = sorted_map(b, photons<minimal_backend>{}, g);
    EXPECT_THROW(routed_map(b, photons<minimal_backend>{}, g, 4),
        backend_error); // its max_elements is 0: every slot is too many
    const auto e = knn_grid_estimate(b, sorted, {}, {.k = 1, .max_radius = 1});
    EXPECT_EQ(e.used.size(), 0u);
}

TEST(make_grid, throws_for_wrong_resolutions_and_bounds)
{
    EXPECT_THROW(make_grid(glm::vec3(0), glm::vec3(1), {0, 1, 1}), std::invalid_argument);
    EXPECT_THROW(make_grid(glm::vec3(0), glm::vec3(1), {2048, 2048, 2048}), std::invalid_argument);
    EXPECT_THROW(make_grid(glm::vec3(0), glm::vec3(1), {0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu}), std::invalid_argument);
    EXPECT_THROW(make_grid(glm::vec3(1), glm::vec3(0), {1, 1, 1}), std::invalid_argument);
    EXPECT_THROW(
        make_grid(glm::vec3(0), glm::vec3(std::numeric_limits<float>::infinity()), {1, 1, 1}), std::invalid_argument);
    EXPECT_THROW(
        make_grid(glm::vec3(0), glm::vec3(std::numeric_limits<float>::quiet_NaN()), {1, 1, 1}), std::invalid_argument);
    EXPECT_EQ(cell_count(make_grid(glm::vec3(0), glm::vec3(0), {250, 1, 250})), 62500u); // no extent at all
}

TEST(launch, throws_for_more_elements_than_it_can_number)
{
    EXPECT_THROW(launch(std::size_t{1} << 32), std::invalid_argument);
    EXPECT_THROW(launch(0xFFFFFFFFu, 1u), std::invalid_argument);
}

} // namespace
