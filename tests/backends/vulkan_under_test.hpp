// The Vulkan backend under test, and kernels of its tests.
#pragma once

#include "../core/under_test.hpp"
#include "../map/photon_sets.hpp"
#include "serial_algorithms.hpp"
#include "vulkan_algorithms.hpp"
#include "vulkan_kernels.hpp"

#include <photongrid/backends/vulkan/vulkan.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/map/bitonic_step.kernel.hpp>
#include <photongrid/map/grid.kernel.hpp>

#include <filesystem>
#include <fstream>
#include <numeric>
#include <random>

// Kernels of this test: one text, read as C++ here and kept for glslang.
#include <photongrid/core/begin.hpp>
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

// Values that the elements of a group exchange, for as many passes as the state says.
TEST_KERNEL(
    group_probe, struct Params { uint unused; }; PARAMS(Params) IN_GROUPS(3) INPUT(0, uint, numbers) STATE(0, uvec2,
        state) OUTPUT(1, uvec4, over_all) OUTPUT(2, uvec4, of_lanes) bool done() { return state.x == 0u; } uint weighed;
    LANE_VARIABLE(uint, shown) void weigh(uint lane) { weighed += from_lane(shown, lane) * (lane + 1u); } void kernel(
        uint i) {
        uint number = numbers(i);
        begin_lanes();
        set_lane(shown, number);
        end_lanes();
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
#include <photongrid/core/end.hpp>

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

} // namespace photongrid::testing
