// What is the Vulkan backend's own: that it equals the serial one bit for bit, that the validation layer (core and
// synchronization) has nothing to say, and how it fails. What every backend promises is in algorithm_tests.hpp.
#include "params_layout.hpp"
#include "photon_sets.hpp"
#include "serial_algorithms.hpp"
#include "under_test.hpp"

#include <photongrid/backends/vulkan/vulkan.hpp>
#include <photongrid/knn_grid_estimate.hpp>
#include <photongrid/trace_kernels.hpp>

#include <spirv-tools/libspirv.hpp>

#include <filesystem>
#include <fstream>
#include <numeric>
#include <random>

// Kernels of this test: one text, read as C++ here and kept for glslang.
#include <photongrid/kernels/begin.hpp>
#undef PARAMS
#define PARAMS(P) P args{};
#define TEST_KERNEL(NAME, ...)                                                                                         \
    struct NAME {                                                                                                      \
        static constexpr std::string_view path = "test/" #NAME ".glsl";                                                \
        __VA_ARGS__                                                                                                    \
    };                                                                                                                 \
    inline constexpr text_file NAME##_text{"test/" #NAME ".glsl", #__VA_ARGS__ "\n"};

namespace photongrid::test_kernels {
using namespace glm;

// One frame of a buffer from another frame of it.
TEST_KERNEL(
    next_frame, struct Params { uint frame; }; PARAMS(Params) INPUT(0, uint, before)
        OUTPUT(0, uint, after) void kernel(uint i) { after = before(i - args.frame) * 2u + 1u; })

// Element i takes as many passes as its state says.
TEST_KERNEL(
    countdown, struct Params { uint step; }; PARAMS(Params) STATE(0, uvec2, state) bool done() {
        return state.x == 0u;
    } void kernel(uint i) { state = uvec2(state.x - args.step, state.y + i); })

// What the elements of a group tell each other, for as many passes as the state says.
TEST_KERNEL(
    group_probe, struct Params { uint unused; }; PARAMS(Params) IN_GROUPS(3) INPUT(0, uint, numbers) STATE(0, uvec2,
        state) OUTPUT(1, uvec4, over_all) OUTPUT(2, uvec4, of_lanes) bool done() { return state.x == 0u; } uint weighed;
    uint number; void weigh(uint lane) { weighed += from_lane(number, lane) * (lane + 1u); } void kernel(uint i) {
        number = numbers(i);
        weighed = 0u;
        EACH_LANE(weigh)
        over_all = uvec4(
            group_min(number), group_max(number), group_sum_up_to(number), group_any(number % 5u == 0u) ? 1u : 0u);
        of_lanes = uvec4(GROUP_LANES, group_lane(), lane_value(number, GROUP_LANES / 2u), weighed);
        state = uvec2(state.x - min(state.x, 1u), state.y + 1u);
    })

TEST_KERNEL(
    switched, struct Params { uint factor; };
    PARAMS(Params) SWITCH(0, FIRST) SWITCH(5, OTHER) OUTPUT(0, uint, result) void kernel(uint i) {
        result = i;
        if (FIRST) {
            for (uint j = 0u; j < args.factor; ++j)
                result = result * 3u + j;
        }
        if (OTHER) {
            for (uint j = 0u; j < args.factor; ++j)
                result = (result ^ j) * 5u;
        }
    })

// Arithmetic that compilers fuse, reassociate, fold and turn into reciprocals wherever they may.
TEST_KERNEL(
    contracts, struct Params { uint unused; };
    PARAMS(Params) INPUT(0, vec4, numbers) OUTPUT(0, vec4, result) void kernel(uint i) {
        vec4 v = numbers(i);
        float fused = v.x * v.y + v.z;
        float reassociated = (v.x + 1.0e6f) - 1.0e6f;
        float folded = (v.y * 3.3f) * 7.7f;
        vec4 scaled = v * 0.1f + vec4(0.3f, 0.3f, 0.3f, 0.3f);
        float reciprocal = v.z / 3.3f;
        result = vec4(fused, reassociated, folded - scaled.x, reciprocal + scaled.w);
    })

TEST_KERNEL(
    sends, struct Params { uint destinations; }; PARAMS(Params) INPUT(0, vec4, numbers) OUTPUT(0, uint, destination)
        OUTPUT(1, uint, payload) OUTPUT(2, vec4, amount) void kernel(uint i) {
            vec4 v = numbers(i);
            destination = uint(v.x * float(args.destinations));
            payload = i * 3u;
            amount = v;
        })

TEST_KERNEL(
    eight_states, struct Params { uint unused; }; PARAMS(Params) INPUT(0, uint, a) INPUT(1, uint, b) INPUT(2, uint, c)
        INPUT(3, uint, d) INPUT(4, uint, e) INPUT(5, uint, f) INPUT(6, uint, g) INPUT(7, uint, h) STATE(0, uint, s)
            STATE(1, uint, t) STATE(2, uint, u) STATE(3, uint, v) STATE(4, uint, w) STATE(5, uint, x) STATE(6, uint, y)
                OUTPUT(7, uint, z) void kernel(uint i) {
                    s += a(i);
                    t += b(i);
                    u += c(i);
                    v += d(i);
                    w += e(i);
                    x += f(i);
                    y += g(i);
                    z = h(i);
                })

// The interface alone; the text that glslang gets has errors.
struct broken {
    static constexpr std::string_view path = "test/broken.glsl";
    struct Params {
        uint unused;
    };
    Params args{};
    OUTPUT(0, uint, result)
    void kernel(uint) {}
};
inline constexpr text_file broken_text{"test/broken.glsl", R"(// A kernel with an error in line 8.
struct Params {
    uint unused;
};
PARAMS(Params)
OUTPUT(0, uint, result)
void kernel(uint i) {
    result = i * 2.5f;
}
)"};

inline constexpr text_file texts[] = {next_frame_text, countdown_text, group_probe_text, switched_text, contracts_text,
    sends_text, eight_states_text, broken_text};
} // namespace photongrid::test_kernels
#include <photongrid/kernels/end.hpp>

namespace photongrid::testing {

using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec4;

struct vulkan_tag {
    using type = vulkan_backend;
    static constexpr const char* name = "vulkan";
    static std::unique_ptr<type> make()
    {
        vulkan_options o;
        o.hardware_only = hardware_wanted();
        try {
            o.validation = true;
            auto b = std::make_unique<type>(o);
            b->add_texts(test_kernels::texts);
            return b;
        } catch (const backend_error& e) {
            if (every_backend_required() || std::string(e.what()).find("vulkan-validationlayers") == std::string::npos)
                throw;
        }
        o.validation = false;
        auto b = std::make_unique<type>(o);
        b->add_texts(test_kernels::texts);
        return b;
    }
};

class vulkan : public on_backend<vulkan_tag> {
protected:
    void TearDown() override
    {
        if (IsSkipped() || HasFatalFailure())
            return;
        b().finish();
        const auto messages = b().validation_messages();
        for (std::size_t m = seen_; m < messages.size(); ++m)
            ADD_FAILURE() << "validation: " << messages[m];
        seen_ = messages.size();
    }
    serial_backend serial;

private:
    static inline std::size_t seen_ = 0;
};

template <class T, backend B>
auto up(B& b, const std::vector<T>& host)
{
    return b.upload(std::span<const T>(host));
}

std::vector<vec4> numbers(std::size_t n, std::uint64_t seed)
{
    random_source u(seed);
    std::vector<vec4> v;
    for (std::size_t i = 0; i < n; ++i)
        v.emplace_back(u(), u() * 100.0f - 50.0f, u() * 1e-3f, u());
    return v;
}

// --- buffers
// ----------------------------------------------------------------------------------------------------------

template <backend B>
void expect_round_trips(B& b)
{
    for (const std::size_t n : {0u, 1u, 63u, 64u, 65u, 100000u}) {
        random_source u(n);
        const auto check = [&](auto make) {
            std::vector<decltype(make())> host(n);
            for (auto& x : host)
                x = make();
            const auto device = up(b, host);
            ASSERT_EQ(device.size(), n);
            EXPECT_EQ(count_different_bits(b.download(device), host), 0u);
        };
        const auto integer = [&] { return u.below(0xFFFFFFFFu); };
        check([&] { return integer(); });
        check([&] { return uvec2(integer(), integer()); });
        check([&] { return uvec4(integer(), integer(), integer(), integer()); });
        check([&] { return u() - 0.5f; });
        check([&] { return glm::vec2(u(), -u()); });
        check([&] { return vec4(u(), u(), u() * 1e30f, u() * 1e-30f); });
    }
}

TEST_F(vulkan, buffers_keep_every_bit) { expect_round_trips(b()); }

TEST_F(vulkan, buffers_move_and_may_outlive_their_backend)
{
    vulkan_backend::buffer<uint> kept;
    EXPECT_EQ(kept.size(), 0u);
    {
        vulkan_backend other;
        kept = other.make<uint>(1000);
        auto gone = other.make<uint>(1000);
        gone = std::move(kept);
        EXPECT_EQ(kept.size(), 0u); // NOLINT(bugprone-use-after-move)
        kept = std::move(gone);
    }
    EXPECT_EQ(kept.size(), 1000u);
}

TEST_F(vulkan, a_buffer_that_recorded_passes_use_may_go_first)
{
    const std::vector<uint> host(5000, 1u);
    auto last = up(b(), host);
    for (int pass = 0; pass < 200; ++pass) {
        auto next = b().make<uint>(host.size());
        b().run<test_kernels::next_frame>(host.size(), {.frame = 0}, reads(last), writes(next));
        last = std::move(next);
    }
    const auto result = b().download(last);
    EXPECT_EQ(result, std::vector<uint>(host.size(), 0xFFFFFFFFu)); // 2^201 - 1 modulo 2^32
}

TEST_F(vulkan, a_buffer_beyond_the_limit_is_refused_with_the_numbers)
{
    const auto n = b().caps().max_elements + 1;
    try {
        (void)b().make<vec4>(n);
        FAIL() << "a buffer of " << n << " elements was made";
    } catch (const backend_error& e) {
        EXPECT_NE(std::string(e.what()).find(std::to_string(n)), std::string::npos) << e.what();
        EXPECT_NE(std::string(e.what()).find(std::to_string(n - 1)), std::string::npos) << e.what();
    }
}

// --- passes
// -----------------------------------------------------------------------------------------------------------

TEST_F(vulkan, frames_of_one_buffer_are_read_and_written_in_one_pass)
{
    const uint n = 1000, frames = 5;
    const auto run = [&](auto& backend) {
        std::vector<uint> host(n * frames, 7u);
        std::iota(host.begin(), host.begin() + n, 0u);
        auto buffer = up(backend, host);
        for (uint f = 1; f < frames; ++f)
            backend.template run<test_kernels::next_frame>({n, f * n}, {.frame = n}, reads(buffer), writes(buffer));
        return backend.download(buffer);
    };
    EXPECT_EQ(run(b()), run(serial));
}

TEST_F(vulkan, passes_of_many_workgroups_reach_every_element)
{
    const uint n = 65535u * 64u + 100u; // more groups than one dimension takes
    const auto before = up(b(), std::vector<uint>(n, 3u));
    auto after = b().make<uint>(n);
    b().run<test_kernels::next_frame>(n, {.frame = 0}, reads(before), writes(after));
    EXPECT_EQ(b().download(after), std::vector<uint>(n, 7u));
}

TEST_F(vulkan, eight_inputs_and_eight_outputs)
{
    const auto run = [&](auto& backend) {
        std::vector<uint> host(300);
        std::iota(host.begin(), host.end(), 5u);
        const auto in = up(backend, host);
        std::array<decltype(up(backend, host)), 8> out;
        for (auto& o : out)
            o = up(backend, host);
        for (int pass = 0; pass < 2; ++pass)
            backend.template run<test_kernels::eight_states>(host.size(), {}, reads(in, in, in, in, in, in, in, in),
                writes(out[0], out[1], out[2], out[3], out[4], out[5], out[6], out[7]));
        std::vector<uint> all;
        for (auto& o : out)
            for (const uint x : backend.download(o))
                all.push_back(x);
        return all;
    };
    EXPECT_EQ(run(b()), run(serial));
}

TEST_F(vulkan, float_arithmetic_is_neither_fused_nor_folded)
{
    const auto host = numbers(100000, 1);
    const auto run = [&](auto& backend) {
        const auto in = up(backend, host);
        auto out = backend.template make<vec4>(host.size());
        backend.template run<test_kernels::contracts>(host.size(), {}, reads(in), writes(out));
        return backend.download(out);
    };
    EXPECT_EQ(count_different_bits(run(b()), run(serial)), 0u);
}

TEST_F(vulkan, passes_over_unfinished_elements_fall_and_can_be_resumed)
{
    for (const uint n : {0u, 1u, 64u, 65u, 100000u}) {
        std::vector<uvec2> host(n);
        for (uint i = 0; i < n; ++i)
            host[i] = uvec2(i % 21u, 0u);
        const auto expected = [&] {
            auto state = up(serial, host);
            auto p = serial.run_until_done<test_kernels::countdown>(n, {.step = 1}, reads(), writes(state), nowhere);
            return std::pair(serial.download(state), p);
        }();
        auto state = up(b(), host);
        const auto p = b().run_until_done<test_kernels::countdown>(n, {.step = 1}, reads(), writes(state), nowhere);
        EXPECT_EQ(b().download(state), expected.first);
        EXPECT_TRUE(p.finished);
        EXPECT_EQ(p.passes, expected.second.passes);
        EXPECT_EQ(p.active, expected.second.active);
        EXPECT_TRUE(std::is_sorted(p.active.rbegin(), p.active.rend()));

        state = up(b(), host);
        uint passes = 0;
        for (bool finished = n == 0; !finished; ++passes) {
            const auto one = b().run_until_done<test_kernels::countdown>(n, {.step = 1}, reads(), writes(state), 1);
            ASSERT_LE(one.passes, 1u);
            ASSERT_LT(passes, 30u);
            finished = one.finished;
        }
        EXPECT_EQ(b().download(state), expected.first);
        for (const uint most : {0u, 7u, 8u, 9u, 16u, 17u}) {
            state = up(b(), host);
            auto reference = up(serial, host);
            const auto some = b().run_until_done<test_kernels::countdown>(n, {.step = 1}, reads(), writes(state), most);
            const auto same
                = serial.run_until_done<test_kernels::countdown>(n, {.step = 1}, reads(), writes(reference), most);
            EXPECT_EQ(some.passes, same.passes) << most;
            EXPECT_EQ(some.finished, same.finished) << most;
            EXPECT_EQ(some.active, same.active) << most;
            EXPECT_EQ(b().download(state), serial.download(reference)) << most;
        }
    }
}

/// Neighbours of a subgroup tell each other the truth, in all of `run` and `run_until_done`, of any number of elements,
/// done or not; and a group is one element where the switch is off or subgroups are.
TEST_F(vulkan, elements_of_a_group_hear_of_each_other)
{
    uint most_lanes = 1;
    for (const bool staging : {false, true})
        for (const bool subgroups : {true, false})
            for (const uint switches : {0u, 8u})
                for (const uint n : {1u, 7u, 64u, 1003u}) {
                    vulkan_options o;
                    o.validation = true;
                    o.staging = staging;
                    o.subgroups = subgroups;
                    vulkan_backend device(o);
                    device.add_texts(test_kernels::texts);
                    random_source u(n);
                    std::vector<uint> numbers(n);
                    std::vector<uvec2> states(n);
                    for (uint i = 0; i < n; ++i) {
                        numbers[i] = u.below(1000000);
                        states[i] = {1 + u.below(11), 0};
                    }
                    const auto input = up(device, numbers);
                    auto state = up(device, states);
                    auto over_all = device.make<uvec4>(n), of_lanes = device.make<uvec4>(n);
                    const auto check = [&](bool whole) {
                        const auto all = device.download(over_all), lanes = device.download(of_lanes);
                        const uint width = lanes[0].x;
                        ASSERT_TRUE(width >= 1 && width <= 64 && 64 % width == 0) << width;
                        EXPECT_TRUE(width == 1 || (switches != 0 && subgroups)) << width;
                        most_lanes = std::max(most_lanes, width);
                        for (uint i = 0; i < n; ++i) {
                            const uint first = i - i % width, past = std::min(first + width, n);
                            uint low = ~0u, high = 0, up_to = 0, weighed = 0;
                            bool any = false;
                            for (uint j = first; j < past; ++j) {
                                low = std::min(low, numbers[j]);
                                high = std::max(high, numbers[j]);
                                up_to += j <= i ? numbers[j] : 0;
                                weighed += numbers[j] * (j - first + 1);
                                any = any || numbers[j] % 5 == 0;
                            }
                            ASSERT_EQ(all[i], uvec4(low, high, up_to, any ? 1 : 0))
                                << i << " of " << n << ", groups of " << width;
                            ASSERT_EQ(lanes[i].y, i - first);
                            if (whole && past - first == width) {
                                ASSERT_EQ(lanes[i].z, numbers[first + width / 2]);
                                ASSERT_EQ(lanes[i].w, weighed);
                            }
                        }
                    };
                    device.run<test_kernels::group_probe>(
                        {n, 0u, switches}, {}, reads(input), writes(state, over_all, of_lanes));
                    check(true);
                    state = up(device, states);
                    const auto p = device.run_until_done<test_kernels::group_probe>(
                        {n, 0u, switches}, {}, reads(input), writes(state, over_all, of_lanes), nowhere);
                    const auto ends = device.download(state);
                    uint longest = 0;
                    for (uint i = 0; i < n; ++i) {
                        ASSERT_EQ(ends[i], uvec2(0, states[i].x)) << i;
                        longest = std::max(longest, states[i].x);
                    }
                    EXPECT_EQ(p.passes, longest);
                    ASSERT_EQ(p.active.size(), longest);
                    for (uint q = 0; q < longest; ++q)
                        EXPECT_EQ(p.active[q],
                            static_cast<std::uint64_t>(
                                std::count_if(states.begin(), states.end(), [&](uvec2 s) { return s.x > q; })));
                    check(true);
                    EXPECT_EQ(device.validation_messages(), std::vector<std::string>{});
                }
    RecordProperty("lanes", static_cast<int>(most_lanes));
    std::printf("groups of up to %u elements\n", most_lanes);
}

/// Points that search together find what each finds alone, bit for bit: close to each other, far apart, or at one
/// place.
TEST_F(vulkan, points_that_search_together_find_what_each_finds_alone)
{
    vulkan_options apart;
    apart.subgroups = false;
    vulkan_options loops;
    loops.staging = true;
    vulkan_backend alone(apart), looping(loops);
    std::size_t number = 0;
    for (const auto d : all_distributions) {
        constexpr float steps[] = {0.003f, 0.05f, 1e-5f, 2.0f};
        const float step = steps[number++ % 4];
        const auto s = make_photons(d, 3000, uvec3(9, 7, 5), 5);
        random_source u(7);
        std::vector<vec4> points;
        for (const auto& p : make_points(s, 40, 3))
            for (int i = 0; i < 25; ++i) // runs of neighbours that begin anywhere in a group; some unwanted
                points.emplace_back(p.x + step * u(), p.y + step * u(), p.z + step * u(), i % 9 == 4 ? 0.0f : 1.0f);
        // Many of many, so that guesses fail for some of a group and not for others; few, to the radius; in small
        // passes.
        for (auto k : {knn_settings{.k = 50, .max_radius = 0.4f},
                 knn_settings{.k = 50, .max_radius = 0.4f, .search = search_kind::fixed_radius},
                 knn_settings{.k = 1000, .max_radius = 50}})
            for (const uint visits : {3072u, 50u}) {
                k.errors = true;
                k.visits_per_pass = k.k < 1000 ? visits : 20 * visits / 3;
                const auto run = [&](vulkan_backend& device) {
                    const auto map = sorted_map(device, upload_photons(device, s), s.g);
                    const auto e = knn_grid_estimate(device, map, device.upload(std::span<const vec4>(points)), k);
                    return std::tuple(
                        device.download(e.irradiance), device.download(e.standard_error), device.download(e.used));
                };
                const auto [light, error, used] = run(alone);
                for (auto* device : {&b(), &looping}) {
                    const auto [light_too, error_too, used_too] = run(*device);
                    EXPECT_EQ(count_different_bits(light, light_too), 0u);
                    EXPECT_EQ(count_different_bits(error, error_too), 0u);
                    std::size_t differ = 0;
                    for (std::size_t i = 0; i < used.size(); ++i)
                        differ += used[i].x != used_too[i].x ? 1u : 0u;
                    EXPECT_EQ(differ, 0u);
                    if (device == &looping)
                        continue;
                    EXPECT_EQ(count_different_bits(used_too, std::get<2>(run(*device))),
                        0u); // also what they visited, run to run
                }
            }
    }
}

TEST_F(vulkan, unfinished_elements_of_a_part_of_a_buffer)
{
    const std::vector<uvec2> host(1000, uvec2(12u, 0u));
    const auto run = [&](auto& backend) {
        auto state = up(backend, host);
        backend.template run_until_done<test_kernels::countdown>({333, 400}, {.step = 1}, reads(), writes(state), 10u);
        return backend.download(state);
    };
    EXPECT_EQ(run(b()), run(serial));
}

TEST_F(vulkan, route_equals_serial_bit_for_bit)
{
    for (const std::size_t n : {0u, 1u, 255u, 257u, 5000u, 100000u})
        for (const uint destinations : {1u, 15u, 16u, 1000u})
            for (const uint m : {1u, 4u, 16u}) {
                const auto host = numbers(n, n + destinations);
                const auto run = [&](auto& backend) {
                    const auto in = up(backend, host);
                    // Larger than needed: what nothing is destined for is emptied too. Some draws have no destination.
                    auto slots = up(backend, std::vector<uint>((destinations + 3) * route_capacity(m), 5u));
                    auto totals = up(backend, std::vector<vec4>(destinations + 3, vec4(5)));
                    backend.template route<test_kernels::sends>(launch(n),
                        {.destinations = destinations + destinations / 10}, reads(in), destinations, m, slots, totals);
                    return std::pair(backend.download(slots), backend.download(totals));
                };
                const auto [slots, totals] = run(b());
                const auto [expected_slots, expected_totals] = run(serial);
                EXPECT_EQ(slots, expected_slots) << n << " draws, " << destinations << " destinations, m " << m;
                EXPECT_EQ(count_different_bits(totals, expected_totals), 0u)
                    << n << " draws, " << destinations << " destinations, m " << m;
            }
}

// --- the algorithms against serial
// ------------------------------------------------------------------------------------

struct everything {
    std::vector<uvec2> cells;
    std::vector<uint> list;
    std::vector<vec4> powers, irradiance;
    std::vector<uvec2> used;
    uint invalid = 0, overfull = 0;
};

template <backend B>
everything map_and_estimate(
    B& b, const photon_set& s, const std::vector<vec4>& points, uint m, const knn_settings& settings)
{
    auto map = m == 0 ? sorted_map(b, upload_photons(b, s), s.g) : routed_map(b, upload_photons(b, s), s.g, m, 3u);
    const auto q = up(b, points);
    auto e = knn_grid_estimate(b, map, q, settings);
    return {b.download(map.cells), b.download(map.list), b.download(map.photons.powers), b.download(e.irradiance),
        b.download(e.used), map.invalid, map.overfull_cells};
}

void expect_equal(const everything& a, const everything& b)
{
    EXPECT_EQ(count_different_bits(a.cells, b.cells), 0u);
    EXPECT_EQ(count_different_bits(a.list, b.list), 0u);
    EXPECT_EQ(count_different_bits(a.powers, b.powers), 0u);
    EXPECT_EQ(count_different_bits(a.irradiance, b.irradiance), 0u);
    EXPECT_EQ(count_different_bits(a.used, b.used), 0u);
    EXPECT_EQ(a.invalid, b.invalid);
    EXPECT_EQ(a.overfull, b.overfull);
}

TEST_F(vulkan, sort_equals_serial)
{
    for (const std::size_t n : {0u, 1u, 2u, 3u, 5u, 1000u, 65536u}) {
        random_source u(n);
        std::vector<uvec2> host(n);
        for (auto& x : host)
            x = uvec2(u.below(50), u.below(1000));
        const auto run = [&](auto& backend) {
            auto pairs = up(backend, host);
            bitonic_sort(backend, pairs);
            return backend.download(pairs);
        };
        EXPECT_EQ(run(b()), run(serial)) << n << " pairs";
    }
}

TEST_F(vulkan, maps_and_estimates_equal_serial)
{
    for (const auto d : all_distributions)
        for (const std::size_t n : {0u, 1u, 1000u, 20000u})
            for (const uint m : {0u, 1u, 2u, 4u, 15u, 16u}) {
                SCOPED_TRACE(std::string(name_of(d)) + ", " + std::to_string(n) + " photons, m " + std::to_string(m));
                auto s = make_photons(d, n, uvec3(9, 7, 11), n + m);
                if (n > 10) {
                    s.positions[3].y = std::numeric_limits<float>::quiet_NaN();
                    s.powers[7].x = std::numeric_limits<float>::infinity();
                }
                const auto points = make_points(s, 300, n);
                const knn_settings settings{.k = 50, .max_radius = 0.4f};
                expect_equal(
                    map_and_estimate(b(), s, points, m, settings), map_and_estimate(serial, s, points, m, settings));
            }
}

TEST_F(vulkan, a_crowded_cell_is_read_to_its_end)
{
    photon_set s;
    s.g = make_grid(glm::vec3(0), glm::vec3(1), uvec3(3, 3, 3));
    random_source u(5);
    for (uint i = 0; i < 100000; ++i) {
        s.positions.emplace_back(0.5f + 0.01f * u(), 0.5f + 0.01f * u(), 0.5f + 0.01f * u(), 0.0f);
        s.powers.emplace_back(u(), u(), u(), 0.0f);
    }
    const auto points = make_points(s, 100, 1);
    for (const uint m : {0u, 16u})
        expect_equal(map_and_estimate(b(), s, points, m, {.k = 32, .max_radius = 2.0f}),
            map_and_estimate(serial, s, points, m, {.k = 32, .max_radius = 2.0f}));
}

// --- compiling
// --------------------------------------------------------------------------------------------------------

TEST_F(vulkan, a_kernels_error_names_its_file_and_line)
{
    auto out = b().make<uint>(1);
    try {
        b().run<test_kernels::broken>(1, {}, reads(), writes(out));
        FAIL() << "a broken kernel compiled";
    } catch (const backend_error& e) {
        const std::string text = e.what();
        EXPECT_NE(text.find("test/broken.glsl:8: error:"), std::string::npos) << text;
        EXPECT_NE(text.find("result = i * 2.5f;"), std::string::npos) << text;
    }
}

template <class... K>
struct kernel_list {
};
using all_kernels = kernel_list<kernels::arithmetic_probe, kernels::photon_cell, kernels::bitonic_step,
    kernels::pad_pairs, kernels::pair_value, kernels::first_in_cell, kernels::invalid_photon, kernels::route_photon,
    kernels::routed_cell, kernels::redistribute_power, kernels::overfull_cell, kernels::knn_start, kernels::knn_visit,
    kernels::knn_result, kernels::emit_photon, kernels::bounce_photon, kernels::path_goes_on, kernels::tally_path,
    kernels::sum_tallies, kernels::prefix_sum_step, kernels::path_is_emitted, kernels::is_found, kernels::gather_photon,
    kernels::divide_power, kernels::eye_ray, kernels::eye_bounce, kernels::direct_light, kernels::no_light,
    kernels::copy_light, kernels::shade, kernels::take_vector, kernels::other_part, kernels::packed_cell,
    kernels::packed_photon, kernels::kth_guess, kernels::kth_distance, kernels::kth_result, kernels::kth_tie,
    kernels::given_radius, kernels::grown_radius, kernels::gather_start, kernels::gather_photons, kernels::no_estimate,
    kernels::irradiance_estimate, kernels::gather_normal, kernels::tally_error, kernels::covered_share,
    kernels::divide_by_share, kernels::neighbours_start, kernels::list_neighbours, kernels::neighbour_pair,
    kernels::sort_neighbours, kernels::neighbour, test_kernels::contracts, test_kernels::countdown,
    test_kernels::eight_states>;

/// Every float operation of a module that lacks NoContraction.
std::size_t free_to_contract(const std::vector<std::uint32_t>& words)
{
    std::set<std::uint32_t> decorated;
    std::size_t n = 0;
    vulkan_detail::for_each_instruction(words, [&](std::uint32_t op, std::size_t at, std::size_t) {
        if (op == 71 && words[at + 2] == 42)
            decorated.insert(words[at + 1]);
        if (op == 127 || op == 129 || op == 131 || op == 133 || op == 136 || op == 142)
            n += decorated.count(words[at + 2]) == 0 ? 1u : 0u;
    });
    return n;
}

template <class... K>
void expect_valid(vulkan_backend& b, kernel_list<K...>)
{
    spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_1);
    std::string complaints;
    tools.SetMessageConsumer([&](spv_message_level_t, const char*, const spv_position_t&, const char* m) {
        complaints += std::string(m) + "\n";
    });
    const auto check = [&](std::string_view name, const std::vector<std::uint32_t>& words) {
        complaints.clear();
        EXPECT_TRUE(tools.Validate(words)) << name << ": " << complaints;
        EXPECT_EQ(free_to_contract(words), 0u) << name;
        EXPECT_GT(vulkan_detail::count_instructions(words), 0u) << name;
    };
    const auto one = [&]<class Kernel>(std::type_identity<Kernel>) {
        for (const uint switches : {~0u, 0u})
            check(kernel_name<Kernel>(), b.spirv<Kernel>(switches));
        if constexpr (iterative_kernel<Kernel>)
            check(kernel_name<Kernel>(), b.iterate_spirv<Kernel>());
        EXPECT_GT(b.costs().at(std::string(kernel_name<Kernel>())).instructions, 0u);
        EXPECT_GT(b.costs().at(std::string(kernel_name<Kernel>())).compile_ms, 0.0);
    };
    (one(std::type_identity<K>{}), ...);
}

/// Kernels of the library: texts that define one.
std::size_t kernels_in_texts()
{
    return static_cast<std::size_t>(
        std::count_if(std::begin(kernel_texts), std::end(kernel_texts), [](const text_file& f) {
            return f.text.find("void kernel(uint i)") != std::string_view::npos
                || f.text.find("bool holds(uint i)") != std::string_view::npos;
        }));
}

template <class... K>
std::size_t library_kernels(kernel_list<K...>)
{
    return ((K::path.find("include/photongrid/kernels/") != std::string_view::npos ? 1u : 0u) + ...);
}

// Hard case G6.
TEST_F(vulkan, every_kernel_compiles_to_valid_spirv_without_contraction)
{
    EXPECT_EQ(library_kernels(all_kernels{}), kernels_in_texts()) << "a kernel is missing from all_kernels";
    expect_valid(b(), all_kernels{});
}

// Params travel as bytes, to GL too: std140 and std430 place scalars, vectors and structs of whole 16 bytes alike.
template <class... K>
void expect_equal_layouts(vulkan_backend& b, kernel_list<K...>)
{
    std::size_t compared = 0;
    const auto one = [&]<class Kernel>(std::type_identity<Kernel>) {
        const auto in_spirv = testing::offsets_in_spirv(b.spirv<Kernel>(~0u));
        if (in_spirv.empty())
            return; // reads no parameter
        EXPECT_EQ(testing::offsets_in_cpp(typename Kernel::Params{}), in_spirv) << kernel_name<Kernel>();
        ++compared;
    };
    (one(std::type_identity<K>{}), ...);
    EXPECT_GT(compared, sizeof...(K) / 2);
}

TEST_F(vulkan, parameters_stand_where_cpp_has_them)
{
    expect_equal_layouts(b(), all_kernels{});
    static_assert(sizeof(kernels::Grid) % 16 == 0 && sizeof(kernels::Scene) % 16 == 0);
    struct astray { // as it must not be: GLSL aligns uvec2 to 8 bytes, GLM to 4
        uint a;
        glm::uvec2 b;
    };
    EXPECT_EQ(testing::offsets_in_cpp(astray{}), (std::vector<std::size_t>{0, 4}));
}

TEST_F(vulkan, a_switch_that_is_off_leaves_no_code)
{
    const auto size
        = [&](uint switches) { return vulkan_detail::count_instructions(b().spirv<test_kernels::switched>(switches)); };
    const auto neither = size(0);
    EXPECT_LT(neither, size(1));
    EXPECT_LT(neither, size(1u << 5));
    EXPECT_LT(size(1), size(~0u));
    const auto loops = [&](uint switches) {
        std::size_t n = 0;
        vulkan_detail::for_each_instruction(b().spirv<test_kernels::switched>(switches),
            [&](std::uint32_t op, std::size_t, std::size_t) { n += op == 246 ? 1u : 0u; }); // OpLoopMerge
        return n;
    };
    EXPECT_EQ(loops(0), 0u);
    EXPECT_EQ(loops(1), 1u);
    EXPECT_EQ(loops(~0u), 2u);
    EXPECT_EQ(size(~0u), size(33u)); // switches that the kernel lacks change nothing
    const auto run = [&](auto& backend, uint switches) {
        auto out = backend.template make<uint>(100);
        backend.template run<test_kernels::switched>({100, 0u, switches}, {.factor = 3}, reads(), writes(out));
        return backend.download(out);
    };
    for (const uint switches : {0u, 1u, 32u, ~0u})
        EXPECT_EQ(run(b(), switches), run(serial, switches)) << switches;
}

// --- devices
// ----------------------------------------------------------------------------------------------------------

TEST_F(vulkan, devices_are_listed_and_chosen_by_index_or_name)
{
    const auto all = vulkan_devices();
    ASSERT_FALSE(all.empty());
    for (const auto& d : all) {
        if (!d.unusable.empty())
            continue;
        vulkan_options by_index, by_name;
        by_index.device = std::to_string(d.index);
        by_name.device = d.name.substr(0, d.name.find(' '));
        EXPECT_NE(vulkan_backend(by_index).caps().device.find(d.name), std::string::npos);
        EXPECT_FALSE(vulkan_backend(by_name).caps().device.empty());
    }
    const auto message_of = [](const vulkan_options& o) -> std::string {
        try {
            vulkan_backend none(o);
        } catch (const backend_error& e) {
            return e.what();
        }
        return "";
    };
    vulkan_options absent;
    absent.device = "Voodoo 2";
    EXPECT_NE(message_of(absent).find("Voodoo 2"), std::string::npos);
    EXPECT_NE(message_of(absent).find(all[0].name), std::string::npos);
    if (std::all_of(all.begin(), all.end(), [](const auto& d) { return d.software; })) {
        vulkan_options hardware;
        hardware.hardware_only = true;
        EXPECT_NE(message_of(hardware).find("hardware"), std::string::npos);
    }
}

TEST_F(vulkan, works_through_staging_buffers)
{
    vulkan_options o;
    o.validation = true;
    o.staging = true;
    std::unique_ptr<vulkan_backend> staged;
    try {
        staged = std::make_unique<vulkan_backend>(o);
    } catch (const backend_error& e) {
        GTEST_SKIP() << e.what();
    }
    expect_round_trips(*staged);
    const auto s = make_photons(distribution::clustered, 3000, uvec3(5), 1);
    const auto points = make_points(s, 100, 1);
    for (const uint m : {0u, 4u})
        expect_equal(map_and_estimate(*staged, s, points, m, {.k = 20, .max_radius = 1.0f}),
            map_and_estimate(serial, s, points, m, {.k = 20, .max_radius = 1.0f}));
    EXPECT_EQ(staged->validation_messages(), std::vector<std::string>{});
}

// Without this, silence of the layer would prove nothing.
TEST_F(vulkan, the_validation_layer_is_listening)
{
    vulkan_options o;
    o.validation = true;
    std::shared_ptr<vulkan_detail::context> c;
    try {
        c = std::make_shared<vulkan_detail::context>(o);
    } catch (const backend_error& e) {
        GTEST_SKIP() << e.what();
    }
    const auto make
        = [&] { return std::make_shared<vulkan_detail::allocation>(c, 64, vulkan_detail::memory_kind::device); };
    // Synchronization: a fill and a copy of the same bytes with no barrier between them.
    const auto from = make(), to = make();
    VkCommandPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool_info.queueFamilyIndex = c->family();
    VkCommandPool pool = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateCommandPool(c->device(), &pool_info, nullptr, &pool), VK_SUCCESS);
    VkCommandBufferAllocateInfo commands_info{};
    commands_info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    commands_info.commandPool = pool;
    commands_info.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    ASSERT_EQ(vkAllocateCommandBuffers(c->device(), &commands_info, &commands), VK_SUCCESS);
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    ASSERT_EQ(vkBeginCommandBuffer(commands, &begin), VK_SUCCESS);
    vkCmdFillBuffer(commands, from->buffer(), 0, 64, 0);
    const VkBufferCopy region{0, 0, 64};
    vkCmdCopyBuffer(commands, from->buffer(), to->buffer(), 1, &region);
    vkEndCommandBuffer(commands);
    vkDestroyCommandPool(c->device(), pool, nullptr);
    const auto messages = c->messages();
    ASSERT_FALSE(messages.empty());
    EXPECT_NE(messages[0].find("SYNC-HAZARD"), std::string::npos) << messages[0];
}

// A kernel that reads past the end of its input, as texels and (staging) as a storage buffer.
TEST_F(vulkan, gpu_assisted_validation_sees_a_read_out_of_bounds)
{
    for (const bool staging : {false, true}) {
        SCOPED_TRACE(staging ? "storage buffers" : "texel buffers");
        std::unique_ptr<vulkan_backend> watched;
        try {
            watched = std::make_unique<vulkan_backend>(
                vulkan_options{.validation = true, .gpu_assisted = true, .staging = staging});
        } catch (const backend_error& e) {
            GTEST_SKIP() << e.what();
        }
        watched->add_texts(test_kernels::texts);
        const std::vector<uint> host(16, 7u);
        const auto input = watched->upload(std::span<const uint>(host));
        auto output = watched->make<uint>(16);
        watched->run<test_kernels::next_frame>(16, {.frame = 0u}, reads(input), writes(output));
        EXPECT_EQ(watched->download(output), std::vector<uint>(16, 15u));
        EXPECT_EQ(watched->validation_messages(), std::vector<std::string>{});
        watched->run<test_kernels::next_frame>(
            16, {.frame = 0u - 1000u}, reads(input), writes(output)); // elements 1000 to 1015
        watched->finish();
        const auto messages = watched->validation_messages();
        ASSERT_FALSE(messages.empty());
        EXPECT_NE(messages[0].find("out of bounds"), std::string::npos) << messages[0];
    }
}

// Instrumenting breaks some loops of optimized kernels: the search's did not compile.
TEST_F(vulkan, gpu_assisted_validation_takes_the_search)
{
    std::unique_ptr<vulkan_backend> watched;
    try {
        watched = std::make_unique<vulkan_backend>(vulkan_options{.validation = true, .gpu_assisted = true});
    } catch (const backend_error& e) {
        GTEST_SKIP() << e.what();
    }
    const auto set = make_photons(distribution::uniform, 200, {3, 3, 3}, 4);
    const auto points = make_points(set, 20, 4);
    const auto radii = [&](auto& device) {
        const auto map = sorted_map(device, upload_photons(device, set), set.g);
        std::vector<float> found;
        for (const auto& e : device.download(knn_grid_estimate(
                 device, map, device.upload(std::span<const vec4>(points)), {.k = 10, .max_radius = 1})
                                                 .irradiance))
            found.push_back(e.w);
        return found;
    };
    serial_backend serial;
    EXPECT_EQ(radii(*watched), radii(serial));
    EXPECT_EQ(watched->validation_messages(), std::vector<std::string>{});
}

// --- the cache of compiled kernels
// --------------------------------------------------------------------------------------

/// A folder of this process's own that goes with it.
struct own_folder {
    std::filesystem::path path
        = std::filesystem::temp_directory_path() / ("photongrid-cache-test-" + std::to_string(std::random_device()()));
    ~own_folder()
    {
        std::error_code failed;
        std::filesystem::remove_all(path, failed);
    }
};

TEST(file_cache, finds_what_it_kept_and_nothing_else)
{
    const own_folder folder;
    vulkan_detail::file_cache cache(folder.path.string()), none("");
    EXPECT_FALSE(cache.find("a"));
    const std::string binary("\0\1\xFF\n", 4);
    cache.keep("a", binary);
    cache.keep("b", "");
    cache.keep("b", "newer");
    none.keep("a", "x");
    EXPECT_FALSE(none.find("a"));
    const auto text
        = [](const auto& found) { return found ? std::string(found->begin(), found->end()) : std::string("none"); };
    EXPECT_EQ(text(vulkan_detail::file_cache(folder.path.string()).find("a")), binary);
    EXPECT_EQ(text(cache.find("b")), "newer");
    EXPECT_FALSE(cache.find("c"));
    // A folder that cannot be made: nothing kept, no error.
    vulkan_detail::file_cache nowhere_to_go((folder.path / "0").string());
    std::ofstream(folder.path / "0") << "a file";
    nowhere_to_go.keep("a", "x");
    EXPECT_FALSE(nowhere_to_go.find("a"));
}

TEST(file_cache, a_damaged_file_counts_as_not_there)
{
    const own_folder folder;
    vulkan_detail::file_cache cache(folder.path.string());
    cache.keep("key", "some value");
    const auto file = std::filesystem::directory_iterator(folder.path)->path();
    std::ifstream in(file, std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    const auto found_with = [&](const std::string& contents) {
        std::ofstream(file, std::ios::binary) << contents;
        return cache.find("key").has_value();
    };
    EXPECT_TRUE(found_with(whole));
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_FALSE(found_with(whole.substr(0, size))) << size << " bytes of it";
    EXPECT_FALSE(found_with(whole + "x"));
    for (std::size_t at = 0; at < whole.size(); ++at) {
        auto damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 4);
        EXPECT_FALSE(found_with(damaged)) << "byte " << at;
    }
}

TEST(file_cache, too_many_files_lose_the_oldest)
{
    const own_folder folder;
    std::filesystem::create_directories(folder.path);
    for (int i = 0; i < 1200; ++i) {
        char name[32];
        std::snprintf(name, sizeof name, "%016x.bin", i);
        std::ofstream(folder.path / name) << "old";
    }
    std::ofstream(folder.path / "another's file") << "stays";
    vulkan_detail::file_cache cache(folder.path.string());
    cache.keep("key", "value");
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path))
        ++files;
    EXPECT_EQ(files, 600u + 2u);
    EXPECT_TRUE(cache.find("key"));
    EXPECT_TRUE(std::filesystem::exists(folder.path / "another's file"));
}

TEST_F(vulkan, the_second_start_finds_its_kernels_compiled)
{
    const own_folder folder;
    const auto sorted = [&] {
        vulkan_backend b({.validation = true, .cache_folder = folder.path.string()});
        std::vector<uvec2> pairs;
        for (uint i = 0; i < 100; ++i)
            pairs.emplace_back(i * 37 % 101, i);
        auto buffer = b.upload(std::span<const uvec2>(pairs));
        bitonic_sort(b, buffer);
        const auto result = b.download(buffer);
        const auto messages = b.validation_messages();
        EXPECT_TRUE(messages.empty()) << messages.front();
        return std::tuple(result, b.kernels_found(), b.spirv<kernels::bitonic_step>());
    };
    const auto [first, found_first, words_first] = sorted();
    const auto [second, found_second, words_second] = sorted();
    EXPECT_EQ(found_first, 1u); // spirv() asks for one that bitonic_sort had compiled
    EXPECT_GT(found_second, 2u);
    EXPECT_EQ(first, second);
    EXPECT_EQ(words_first, words_second);
    // All files spoilt: compiled again, with the same result.
    for (const auto& entry : std::filesystem::directory_iterator(folder.path))
        std::filesystem::resize_file(entry.path(), std::filesystem::file_size(entry.path()) / 2);
    const auto [third, found_third, words_third] = sorted();
    EXPECT_EQ(found_third, 1u);
    EXPECT_EQ(first, third);
}

TEST_F(vulkan, knows_what_its_device_is)
{
    const auto& c = b().caps();
    EXPECT_EQ(c.backend, "vulkan");
    EXPECT_GE(c.max_elements, std::uint64_t{1} << 23);
    EXPECT_EQ(c.max_route_slots, 16u);
    if (c.device.find("llvmpipe") != std::string::npos) {
        EXPECT_TRUE(c.software && c.exact_division && c.exact_sqrt);
        EXPECT_EQ(c.loop_limit, 65535u);
    }
}

} // namespace photongrid::testing
