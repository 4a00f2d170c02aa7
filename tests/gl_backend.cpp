// The OpenGL backend against the serial one, bit for bit, on every kind of context that this machine has.
#include "serial_algorithms.hpp"

#include <photongrid/backends/gl/gl.hpp>
#include <photongrid/bitonic_sort.hpp>
#include <photongrid/build_map.hpp>
#include <photongrid/grid_index.hpp>
#include <photongrid/knn_grid_estimate.hpp>
#include <photongrid/trace_kernels.hpp>

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <numeric>
#include <optional>
#include <random>
#include <thread>

namespace photongrid {
namespace {

    // --- kernels of these tests: the same text for C++ and, below, for OpenGL
    // -----------------------------------------
    namespace test_kernels {
        using namespace glm;
#include <photongrid/kernels/begin.hpp>
#define TEST_KERNEL(FILE)                                                                                              \
    Params args{};                                                                                                     \
    static constexpr std::string_view path = FILE;

        // Reads element i - args.stride of its own output: the frame before.
        struct next_frame {
            struct Params {
                uint stride;
            };
            TEST_KERNEL("next_frame.glsl")
            INPUT(0, uvec2, frames)
            OUTPUT(0, uvec2, frame)
            void kernel(uint i) { frame = frames(i - args.stride) + uvec2(1u, i); }
        };
        // Eight states and eight inputs; element i takes i % 37 + 1 passes.
        struct eight {
            struct Params {
                uint add;
            };
            TEST_KERNEL("eight.glsl")
            SWITCH(1, DOUBLED)
            INPUT(0, float, in0)
            INPUT(1, vec2, in1)
            INPUT(2, vec4, in2)
            INPUT(3, uint, in3)
            INPUT(4, uvec2, in4)
            INPUT(5, uvec4, in5)
            INPUT(6, uint, in6)
            INPUT(7, uint, in7)
            STATE(0, float, s0)
            STATE(1, vec2, s1)
            STATE(2, vec4, s2)
            STATE(3, uint, s3)
            STATE(4, uvec2, s4)
            STATE(5, uvec4, s5)
            STATE(6, uint, s6)
            STATE(7, uint, left)
            bool done() { return left == 0u; }
            void kernel(uint i)
            {
                s0 += in0(i);
                s1 += in1(i);
                s2 += in2(i);
                s3 += in3(i) + args.add;
                s4 += in4(i);
                s5 += in5(i);
                s6 += in6(i) + in7(i);
                left -= 1u;
                if (DOUBLED)
                    s6 += 1000u;
            }
        };
        struct is_odd {
            struct Params {
                uint unused;
            };
            TEST_KERNEL("is_odd.glsl")
            INPUT(0, uint, numbers)
            bool holds(uint i) { return (numbers(i) & 1u) == 1u; }
        };
        // Draw i goes to destination x of the i-th pair, if that exists.
        struct to_place {
            struct Params {
                uint unused;
            };
            TEST_KERNEL("to_place.glsl")
            INPUT(0, uvec2, pairs)
            INPUT(1, vec4, amounts)
            OUTPUT(0, uint, destination)
            OUTPUT(1, uint, payload)
            OUTPUT(2, vec4, amount)
            void kernel(uint i)
            {
                destination = pairs(i).x;
                payload = pairs(i).y;
                amount = amounts(i);
            }
        };
        struct broken {
            struct Params {
                uint unused;
            };
            TEST_KERNEL("broken.glsl")
            OUTPUT(0, uint, value)
            void kernel(uint i) { value = i; }
        };
        struct misspelt : broken {
            static constexpr std::string_view path = "misspelt.glsl";
        };
        struct wrongly_laid_out {
            struct Params {
                vec2 a;
                float b;
                vec4 c;
                uint d;
            };
            TEST_KERNEL("wrongly_laid_out.glsl")
            OUTPUT(0, uint, value)
            void kernel(uint i) { value = i; }
        };
#undef TEST_KERNEL
#include <photongrid/kernels/end.hpp>
    } // namespace test_kernels

    constexpr text_file test_texts[] = {
        {"tests/next_frame.glsl", R"glsl(struct Params {
    uint stride;
};
PARAMS(Params)
INPUT(0, uvec2, frames)
OUTPUT(0, uvec2, frame)
void kernel(uint i) { frame = frames(i - args.stride) + uvec2(1u, i); }
)glsl"},
        {"tests/eight.glsl", R"glsl(struct Params {
    uint add;
};
PARAMS(Params)
SWITCH(1, DOUBLED)
INPUT(0, float, in0)
INPUT(1, vec2, in1)
INPUT(2, vec4, in2)
INPUT(3, uint, in3)
INPUT(4, uvec2, in4)
INPUT(5, uvec4, in5)
INPUT(6, uint, in6)
INPUT(7, uint, in7)
STATE(0, float, s0)
STATE(1, vec2, s1)
STATE(2, vec4, s2)
STATE(3, uint, s3)
STATE(4, uvec2, s4)
STATE(5, uvec4, s5)
STATE(6, uint, s6)
STATE(7, uint, left)
bool done() { return left == 0u; }
void kernel(uint i)
{
    s0 += in0(i);
    s1 += in1(i);
    s2 += in2(i);
    s3 += in3(i) + args.add;
    s4 += in4(i);
    s5 += in5(i);
    s6 += in6(i) + in7(i);
    left -= 1u;
    if (DOUBLED)
        s6 += 1000u;
}
)glsl"},
        {"tests/is_odd.glsl", R"glsl(struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uint, numbers)
bool holds(uint i) { return (numbers(i) & 1u) == 1u; }
)glsl"},
        {"tests/to_place.glsl", R"glsl(struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uvec2, pairs)
INPUT(1, vec4, amounts)
OUTPUT(0, uint, destination)
OUTPUT(1, uint, payload)
OUTPUT(2, vec4, amount)
void kernel(uint i)
{
    destination = pairs(i).x;
    payload = pairs(i).y;
    amount = amounts(i);
}
)glsl"},
        // An error that only the compiler proper finds (line 6) and one of syntax (line 7).
        {"tests/broken.glsl", R"glsl(struct Params {
    uint unused;
};
PARAMS(Params)
OUTPUT(0, uint, value)
void kernel(uint i) { value = i.w; }
)glsl"},
        {"tests/misspelt.glsl", R"glsl(#include "grid.glsl"
struct Params {
    uint unused;
};
PARAMS(Params)
OUTPUT(0, uint, value)
void kernel(uint i) { value = i }
)glsl"},
        {"tests/wrongly_laid_out.glsl", R"glsl(struct Params {
    vec2 a;
    float b;
    vec4 c;
    uint d;
};
PARAMS(Params)
OUTPUT(0, uint, value)
void kernel(uint i) { value = i; }
)glsl"},
    };

    // --- helpers
    // ------------------------------------------------------------------------------------------------------
    template <class T>
    std::span<const T> view(const std::vector<T>& v)
    {
        return v;
    }
    template <class T>
    testing::AssertionResult same_bits(const std::vector<T>& a, const std::vector<T>& b)
    {
        if (a.size() != b.size())
            return testing::AssertionFailure() << a.size() << " elements against " << b.size();
        for (std::size_t i = 0; i < a.size(); ++i)
            if (std::memcmp(&a[i], &b[i], sizeof(T)) != 0)
                return testing::AssertionFailure() << "first difference at element " << i << " of " << a.size();
        return testing::AssertionSuccess();
    }
    template <element T>
    std::vector<T> noise(std::size_t n, std::uint32_t seed)
    {
        // Any bits at all, NaNs and denormals among them: buffers must keep them.
        std::mt19937 random(seed);
        std::vector<std::uint32_t> words(n * sizeof(T) / 4);
        for (auto& w : words)
            w = static_cast<std::uint32_t>(random());
        std::vector<T> data(n);
        if (n > 0)
            std::memcpy(static_cast<void*>(data.data()), words.data(), n * sizeof(T));
        return data;
    }

    struct cloud {
        const char* name;
        std::vector<glm::vec4> positions, powers;
    };
    cloud make_cloud(const char* name, std::size_t n, auto&& position)
    {
        cloud c{name, {}, {}};
        std::mt19937 random(7);
        std::uniform_real_distribution<float> unit(0.0f, 1.0f);
        for (std::size_t i = 0; i < n; ++i) {
            c.positions.push_back(position(unit, random));
            c.powers.emplace_back(unit(random), unit(random) * 1e-3f, unit(random) * 1e3f, 0.0f);
        }
        return c;
    }
    std::vector<cloud> clouds(std::size_t n)
    {
        std::vector<cloud> all;
        all.push_back(make_cloud("uniform", n, [](auto& u, auto& r) { return glm::vec4(u(r), u(r), u(r), 0); }));
        all.push_back(make_cloud("clustered", n, [](auto& u, auto& r) {
            return glm::vec4(0.3f + 0.1f * u(r) * u(r), 0.7f - 0.05f * u(r), u(r) < 0.5f ? 0.25f : u(r), 0);
        }));
        all.push_back(make_cloud("in one cell", n,
            [](auto& u, auto& r) { return glm::vec4(0.5f + 0.01f * u(r), 0.52f, 0.52f + 0.001f * u(r), 0); }));
        all.push_back(make_cloud("some invalid", n, [](auto& u, auto& r) {
            const float x = u(r);
            return glm::vec4(x < 0.05f ? std::numeric_limits<float>::quiet_NaN()
                    : x < 0.1f         ? std::numeric_limits<float>::infinity()
                                       : x,
                u(r), u(r), 0);
        }));
        return all;
    }
    template <class B>
    photons<B> upload_cloud(B& b, const cloud& c)
    {
        return {b.upload(view(c.positions)), b.upload(view(c.powers)), {}};
    }

    // --- contexts
    // -----------------------------------------------------------------------------------------------------
    struct egl {
        static constexpr gl_context_kind kind = gl_context_kind::egl;
        static constexpr const char* name = "gl";
    };
    struct osmesa {
        static constexpr gl_context_kind kind = gl_context_kind::osmesa;
        static constexpr const char* name = "gl-osmesa";
    };

    template <class Kind>
    class gl_backend_test : public testing::Test {
    protected:
        // One context for all tests of a kind; debug: every error that OpenGL notes is an exception.
        static void SetUpTestSuite()
        {
            try {
                shared().emplace(gl_options{.context = Kind::kind, .debug = true});
                shared()->add_texts(test_texts);
            } catch (const backend_error& e) {
                why() = e.what();
            }
        }
        static void TearDownTestSuite() { shared().reset(); }
        void SetUp() override
        {
            if (!shared())
                GTEST_SKIP() << why();
        }
        void TearDown() override
        {
            if (shared()) {
                EXPECT_EQ(shared()->take_debug_messages(), "");
            }
        }
        static std::optional<gl_backend>& shared()
        {
            static std::optional<gl_backend> b;
            return b;
        }
        static std::string& why()
        {
            static std::string text;
            return text;
        }
        gl_backend& gpu() { return *shared(); }
        serial_backend cpu;
    };
    using kinds = testing::Types<egl, osmesa>;
    TYPED_TEST_SUITE(gl_backend_test, kinds);

    template <class T>
    void round_trip(gl_backend& b)
    {
        for (std::size_t n : {0u, 1u, 2u, 3u, 2047u, 2048u, 2049u, 4096u, 100000u}) {
            const auto data = noise<T>(n, static_cast<std::uint32_t>(n));
            const auto buffer = b.upload(view(data));
            EXPECT_EQ(buffer.size(), n);
            EXPECT_TRUE(same_bits(b.download(buffer), data)) << n << " elements of " << sizeof(T) << " bytes";
        }
    }

    // Without this, silence of the driver would prove nothing.
    TYPED_TEST(gl_backend_test, hears_the_driver)
    {
        auto& b = this->gpu();
        const auto before = b.upload(view(noise<glm::uvec2>(4, 1)));
        auto after = b.template make<glm::uvec2>(4);
        EXPECT_EQ(b.take_debug_messages(), "");
        gl::functions call; // those of the context that the backend left current
#ifdef PHOTONGRID_HAS_OSMESA
        call.load(TypeParam::kind == gl_context_kind::osmesa ? gl::find_by_osmesa : gl::find_by_egl);
#else
        call.load(gl::find_by_egl);
#endif
        call.Enable(0xDEAD);
        EXPECT_NE(b.take_debug_messages().find("glEnable"), std::string::npos);
        call.Enable(0xDEAD);
        try { // the next pass tells
            b.template run<test_kernels::next_frame>(4, {.stride = 0u}, reads(before), writes(after));
            FAIL();
        } catch (const backend_error& e) {
            EXPECT_NE(std::string_view(e.what()).find("GL_INVALID_ENUM"), std::string_view::npos) << e.what();
            EXPECT_NE(std::string_view(e.what()).find("glEnable"), std::string_view::npos) << e.what();
        }
        EXPECT_EQ(b.take_debug_messages(), "");
    }

    TYPED_TEST(gl_backend_test, says_what_it_is)
    {
        const capabilities& c = this->gpu().caps();
        EXPECT_EQ(c.backend, TypeParam::name);
        EXPECT_FALSE(c.device.empty());
        EXPECT_GE(c.max_elements, 1u << 24);
        EXPECT_EQ(c.max_route_slots, 16u);
        if (c.device.find("llvmpipe") != std::string::npos) {
            EXPECT_TRUE(c.software);
            EXPECT_TRUE(c.exact_division);
            EXPECT_TRUE(c.exact_sqrt);
            EXPECT_EQ(c.loop_limit, 65535u);
        }
    }

    TYPED_TEST(gl_backend_test, buffers_keep_every_bit)
    {
        round_trip<float>(this->gpu());
        round_trip<glm::vec2>(this->gpu());
        round_trip<glm::vec4>(this->gpu());
        round_trip<uint>(this->gpu());
        round_trip<glm::uvec2>(this->gpu());
        round_trip<glm::uvec4>(this->gpu());
    }

    TYPED_TEST(gl_backend_test, counts_its_memory)
    {
        gl_backend& b = this->gpu();
        const auto before = b.bytes();
        {
            auto buffer = b.template make<glm::vec4>(4096);
            EXPECT_EQ(b.bytes(), before + 65536);
            auto moved = std::move(buffer);
            EXPECT_EQ(moved.size(), 4096u);
            EXPECT_EQ(buffer.size(), 0u);
            buffer = std::move(moved);
            EXPECT_EQ(b.bytes(), before + 65536);
        }
        EXPECT_EQ(b.bytes(), before);
        EXPECT_GE(b.peak_bytes(), before + 65536);
    }

    TYPED_TEST(gl_backend_test, refuses_what_it_cannot_hold_with_numbers)
    {
        gl_backend& b = this->gpu();
        const auto before = b.bytes();
        try {
            b.template make<uint>(b.caps().max_elements + 1);
            FAIL();
        } catch (const backend_error& e) {
            EXPECT_NE(std::string(e.what()).find(std::to_string(b.caps().max_elements)), std::string::npos) << e.what();
        }
        auto pairs = b.upload(view(noise<glm::uvec2>(1, 1)));
        auto amounts = b.upload(view(noise<glm::vec4>(1, 1)));
        const uint destinations = 1u << 21; // times 256 pixels: more than 16384 x 16384 texels
        if (b.caps().software) {
            auto totals = b.template make<glm::vec4>(destinations);
            buffer_of<gl_backend, uint> slots;
            EXPECT_THROW((b.template route<test_kernels::to_place>(
                             1, {}, reads(pairs, amounts), destinations, 16u, slots, totals)),
                std::invalid_argument);
        }
        auto small = b.template make<uint>(10);
        EXPECT_THROW((b.template run<kernels::pair_value>(11, {}, reads(pairs), writes(small))), std::invalid_argument);
        pairs = {};
        amounts = {};
        small = {};
        EXPECT_EQ(b.bytes(), before);
    }

    TYPED_TEST(gl_backend_test, compiles_every_kernel_for_every_verb)
    {
        const auto both = [&]<class K>(std::type_identity<K>) {
            this->gpu().template compile<K>(0u);
            this->gpu().template compile<K>(~0u);
        };
        both(std::type_identity<kernels::arithmetic_probe>{});
        both(std::type_identity<kernels::photon_cell>{});
        both(std::type_identity<kernels::bitonic_step>{});
        both(std::type_identity<kernels::pad_pairs>{});
        both(std::type_identity<kernels::pair_value>{});
        both(std::type_identity<kernels::first_in_cell>{});
        both(std::type_identity<kernels::invalid_photon>{});
        both(std::type_identity<kernels::route_photon>{});
        both(std::type_identity<kernels::routed_cell>{});
        both(std::type_identity<kernels::redistribute_power>{});
        both(std::type_identity<kernels::overfull_cell>{});
        both(std::type_identity<kernels::knn_start>{});
        both(std::type_identity<kernels::knn_visit>{});
        both(std::type_identity<kernels::knn_result>{});
        both(std::type_identity<kernels::emit_photon>{});
        both(std::type_identity<kernels::bounce_photon>{});
        both(std::type_identity<kernels::path_goes_on>{});
        both(std::type_identity<kernels::tally_path>{});
        both(std::type_identity<kernels::sum_tallies>{});
        both(std::type_identity<kernels::prefix_sum_step>{});
        both(std::type_identity<kernels::path_is_emitted>{});
        both(std::type_identity<kernels::is_found>{});
        both(std::type_identity<kernels::gather_photon>{});
        both(std::type_identity<kernels::divide_power>{});
        both(std::type_identity<kernels::eye_ray>{});
        both(std::type_identity<kernels::eye_bounce>{});
        both(std::type_identity<kernels::direct_light>{});
        both(std::type_identity<kernels::no_light>{});
        both(std::type_identity<kernels::copy_light>{});
        both(std::type_identity<kernels::shade>{});
        both(std::type_identity<kernels::take_vector>{});
        both(std::type_identity<kernels::other_part>{});
        both(std::type_identity<kernels::packed_cell>{});
        both(std::type_identity<kernels::packed_photon>{});
        both(std::type_identity<kernels::kth_guess>{});
        both(std::type_identity<kernels::kth_distance>{});
        both(std::type_identity<kernels::kth_result>{});
        both(std::type_identity<kernels::kth_tie>{});
        both(std::type_identity<kernels::given_radius>{});
        both(std::type_identity<kernels::grown_radius>{});
        both(std::type_identity<kernels::gather_start>{});
        both(std::type_identity<kernels::gather_photons>{});
        both(std::type_identity<kernels::no_estimate>{});
        both(std::type_identity<kernels::irradiance_estimate>{});
        both(std::type_identity<kernels::gather_normal>{});
        both(std::type_identity<kernels::tally_error>{});
        both(std::type_identity<kernels::covered_share>{});
        both(std::type_identity<kernels::divide_by_share>{});
        both(std::type_identity<kernels::neighbours_start>{});
        both(std::type_identity<kernels::list_neighbours>{});
        both(std::type_identity<kernels::neighbour_pair>{});
        both(std::type_identity<kernels::sort_neighbours>{});
        both(std::type_identity<kernels::neighbour>{});
    }

    TYPED_TEST(gl_backend_test, reports_errors_at_the_kernels_own_line)
    {
        const auto message = [&]<class K>(std::type_identity<K>) -> std::string {
            try {
                this->gpu().template compile<K>();
            } catch (const backend_error& e) {
                return e.what();
            }
            return "no error";
        };
        const std::string semantic = message(std::type_identity<test_kernels::broken>{});
        EXPECT_NE(semantic.find("tests/broken.glsl:6: error:"), std::string::npos) << semantic;
        EXPECT_NE(semantic.find("value = i.w;"), std::string::npos) << semantic;
        const std::string syntax = message(std::type_identity<test_kernels::misspelt>{});
        EXPECT_NE(syntax.find("tests/misspelt.glsl:7: error:"), std::string::npos) << syntax;
        const std::string layout = message(std::type_identity<test_kernels::wrongly_laid_out>{});
        EXPECT_NE(layout.find("std140"), std::string::npos) << layout;
        EXPECT_NE(this->gpu().take_debug_messages(), "") << "the compiler's errors are messages too";
        // And goes on as if nothing had happened.
        EXPECT_EQ(this->gpu().template count<test_kernels::is_odd>(
                      1, {}, reads(this->gpu().upload(view(std::vector<uint>{3u})))),
            1u);
    }

    TYPED_TEST(gl_backend_test, counts_by_occlusion)
    {
        gl_backend& b = this->gpu();
        for (std::size_t n : {0u, 1u, 2048u, 2049u, 100000u}) {
            const auto numbers = noise<uint>(n, 3);
            const auto on_gpu = b.upload(view(numbers));
            const auto on_cpu = this->cpu.upload(view(numbers));
            EXPECT_EQ(b.template count<test_kernels::is_odd>(n, {}, reads(on_gpu)),
                this->cpu.template count<test_kernels::is_odd>(n, {}, reads(on_cpu)));
            if (n > 5000) {
                const launch part{n - 3000, 1234};
                EXPECT_EQ(b.template count<test_kernels::is_odd>(part, {}, reads(on_gpu)),
                    this->cpu.template count<test_kernels::is_odd>(part, {}, reads(on_cpu)));
            }
        }
    }

    TYPED_TEST(gl_backend_test, writes_frame_after_frame_into_one_buffer)
    {
        // Strides that end rows and that do not: what lies outside a launch keeps its value.
        for (uint stride : {1u, 3u, 100u, 2048u, 5000u}) {
            const uint frames = 9;
            const auto data = noise<glm::uvec2>(stride * frames, stride);
            auto on_gpu = this->gpu().upload(view(data));
            auto on_cpu = this->cpu.upload(view(data));
            for (uint f = 1; f + 1 < frames; ++f) {
                this->gpu().template run<test_kernels::next_frame>(
                    {stride, f * stride}, {.stride = stride}, reads(on_gpu), writes(on_gpu));
                this->cpu.template run<test_kernels::next_frame>(
                    {stride, f * stride}, {.stride = stride}, reads(on_cpu), writes(on_cpu));
            }
            EXPECT_TRUE(same_bits(this->gpu().download(on_gpu), this->cpu.download(on_cpu))) << "stride " << stride;
        }
    }

    template <class B>
    auto run_eight(B& b, launch l, std::size_t n, std::initializer_list<uint> max_passes, std::vector<progress>& steps)
    {
        std::vector<uint> left(n);
        for (std::size_t i = 0; i < n; ++i)
            left[i] = static_cast<uint>(i % 37 * (i / 5000 % 2));
        const auto ints = [&](uint seed) { return std::vector<float>(n, static_cast<float>(seed)); };
        const auto in0 = b.upload(view(ints(1)));
        const auto in1 = b.upload(view(std::vector<glm::vec2>(n, {0.1f, 0.7f})));
        const auto in2 = b.upload(view(std::vector<glm::vec4>(n, {0.1f, 0.3f, 1e10f, 1e-3f})));
        const auto in3 = b.upload(view(noise<uint>(n, 1)));
        const auto in4 = b.upload(view(noise<glm::uvec2>(n, 2)));
        const auto in5 = b.upload(view(noise<glm::uvec4>(n, 3)));
        const auto in6 = b.upload(view(noise<uint>(n, 4)));
        const auto in7 = b.upload(view(noise<uint>(n, 5)));
        auto s0 = b.upload(view(ints(0)));
        auto s1 = b.upload(view(std::vector<glm::vec2>(n)));
        auto s2 = b.upload(view(std::vector<glm::vec4>(n)));
        auto s3 = b.upload(view(noise<uint>(n, 11)));
        auto s4 = b.upload(view(noise<glm::uvec2>(n, 12)));
        auto s5 = b.upload(view(noise<glm::uvec4>(n, 13)));
        auto s6 = b.upload(view(noise<uint>(n, 14)));
        auto s7 = b.upload(view(left));
        for (uint most : max_passes)
            steps.push_back(b.template run_until_done<test_kernels::eight>(l, {.add = 5u},
                reads(in0, in1, in2, in3, in4, in5, in6, in7), writes(s0, s1, s2, s3, s4, s5, s6, s7), most));
        return std::tuple(b.download(s0), b.download(s1), b.download(s2), b.download(s3), b.download(s4),
            b.download(s5), b.download(s6), b.download(s7));
    }

    TYPED_TEST(gl_backend_test, passes_only_over_what_is_not_done)
    {
        for (std::size_t n : {1u, 50u, 2048u, 30000u})
            for (std::initializer_list<uint> passes : {std::initializer_list<uint>{~0u},
                     {1u, 1u, 0u, 3u, 8u, 1u, ~0u, ~0u}, {0u}, {7u}, {8u}, {9u}, {36u}, {37u}})
                for (uint switches : {0u, ~0u}) {
                    const launch l = n == 30000 ? launch{n - 5000, 777, switches} : launch{n, 0, switches};
                    std::vector<progress> gpu_steps, cpu_steps;
                    const auto polls = this->gpu().query_polls();
                    const auto a = run_eight(this->gpu(), l, n, passes, gpu_steps);
                    const auto used_polls = this->gpu().query_polls() - polls;
                    const auto c = run_eight(this->cpu, l, n, passes, cpu_steps);
                    EXPECT_TRUE(same_bits(std::get<0>(a), std::get<0>(c)));
                    EXPECT_TRUE(same_bits(std::get<1>(a), std::get<1>(c)));
                    EXPECT_TRUE(same_bits(std::get<2>(a), std::get<2>(c)));
                    EXPECT_TRUE(same_bits(std::get<3>(a), std::get<3>(c)));
                    EXPECT_TRUE(same_bits(std::get<4>(a), std::get<4>(c)));
                    EXPECT_TRUE(same_bits(std::get<5>(a), std::get<5>(c)));
                    EXPECT_TRUE(same_bits(std::get<6>(a), std::get<6>(c)));
                    EXPECT_TRUE(same_bits(std::get<7>(a), std::get<7>(c)));
                    std::size_t most_polls = 0;
                    for (std::size_t s = 0; s < gpu_steps.size(); ++s) {
                        EXPECT_EQ(gpu_steps[s].passes, cpu_steps[s].passes);
                        EXPECT_EQ(gpu_steps[s].finished, cpu_steps[s].finished) << "n " << n << ", call " << s;
                        EXPECT_EQ(gpu_steps[s].active, cpu_steps[s].active);
                        most_polls += gpu_steps[s].passes / 8 + 1;
                    }
                    EXPECT_LE(used_polls, most_polls);
                }
    }

    TYPED_TEST(gl_backend_test, routes_as_serial_does)
    {
        for (uint destinations : {1u, 7u, 3000u})
            for (uint m : {1u, 2u, 3u, 4u, 7u, 15u, 16u})
                for (std::size_t n : {0u, 1u, 255u, 256u, 257u, 20000u}) {
                    std::mt19937 random(m);
                    std::vector<glm::uvec2> pairs(n);
                    std::vector<glm::vec4> amounts(n);
                    for (std::size_t i = 0; i < n; ++i) {
                        const uint d = static_cast<uint>(random()) % (destinations + destinations / 8 + 1);
                        pairs[i] = {i % 3 == 0 ? destinations / 2
                                : i % 17 == 0  ? nowhere
                                               : d,
                            static_cast<uint>(random())};
                        amounts[i]
                            = glm::vec4(1.0f / static_cast<float>(i + 1), static_cast<float>(d) * 0.1f, 1e-3f, 1.0f);
                    }
                    const auto route = [&](auto& b) {
                        const auto p = b.upload(view(pairs));
                        const auto a = b.upload(view(amounts));
                        auto slots = b.template make<uint>(destinations * route_capacity(m) + 5);
                        auto totals = b.template make<glm::vec4>(destinations + 3);
                        const launch l = n > 300 ? launch{n - 200, 100} : launch{n};
                        b.template route<test_kernels::to_place>(l, {}, reads(p, a), destinations, m, slots, totals);
                        return std::pair(b.download(slots), b.download(totals));
                    };
                    const auto a = route(this->gpu());
                    const auto c = route(this->cpu);
                    EXPECT_TRUE(same_bits(a.first, c.first)) << destinations << " destinations, m " << m << ", n " << n;
                    EXPECT_TRUE(same_bits(a.second, c.second))
                        << destinations << " destinations, m " << m << ", n " << n;
                }
    }

    TYPED_TEST(gl_backend_test, sorts_and_indexes_as_serial_does)
    {
        for (std::size_t n : {0u, 1u, 2u, 3u, 5u, 1023u, 1024u, 1025u, 100000u})
            for (uint keys : {1u, 4u, 5000u, ~0u}) {
                auto data = noise<glm::uvec2>(n, keys);
                for (auto& p : data)
                    p.x = keys == ~0u ? p.x : p.x % keys;
                const auto sort = [&](auto& b) {
                    auto pairs = b.upload(view(data));
                    const auto report = bitonic_sort(b, pairs);
                    const auto index = grid_index(b, pairs, 5000);
                    return std::tuple(b.download(pairs), b.download(index), report.passes);
                };
                const auto a = sort(this->gpu());
                const auto c = sort(this->cpu);
                EXPECT_TRUE(same_bits(std::get<0>(a), std::get<0>(c))) << n << " pairs, keys " << keys;
                EXPECT_TRUE(same_bits(std::get<1>(a), std::get<1>(c))) << n << " pairs, keys " << keys;
                EXPECT_EQ(std::get<2>(a), std::get<2>(c));
            }
    }

    template <class B>
    auto map_and_search(
        B& b, const cloud& c, const grid& g, uint m, const std::vector<glm::vec4>& points, const knn_settings& s)
    {
        const auto map = m == 0 ? sorted_map(b, upload_cloud(b, c), g) : routed_map(b, upload_cloud(b, c), g, m, 99);
        const auto queries = b.upload(view(points));
        const auto e = knn_grid_estimate(b, map, queries, s);
        return std::tuple(b.download(map.list), b.download(map.cells), b.download(map.photons.powers),
            b.download(e.irradiance), b.download(e.used), map.invalid, map.overfull_cells);
    }
    template <class Tuple>
    void expect_same(const Tuple& a, const Tuple& c, const std::string& what)
    {
        EXPECT_TRUE(same_bits(std::get<0>(a), std::get<0>(c))) << what << ": list";
        EXPECT_TRUE(same_bits(std::get<1>(a), std::get<1>(c))) << what << ": cells";
        EXPECT_TRUE(same_bits(std::get<2>(a), std::get<2>(c))) << what << ": powers";
        EXPECT_TRUE(same_bits(std::get<3>(a), std::get<3>(c))) << what << ": irradiance";
        EXPECT_TRUE(same_bits(std::get<4>(a), std::get<4>(c))) << what << ": used";
        EXPECT_EQ(std::get<5>(a), std::get<5>(c)) << what << ": invalid";
        EXPECT_EQ(std::get<6>(a), std::get<6>(c)) << what << ": overfull";
    }
    std::vector<glm::vec4> query_points(std::size_t n)
    {
        std::mt19937 random(5);
        std::uniform_real_distribution<float> unit(-0.2f, 1.2f);
        std::vector<glm::vec4> points(n);
        for (auto& p : points)
            p = {unit(random), unit(random), unit(random), unit(random) < 1.0f ? 1.0f : 0.0f};
        for (std::size_t i = 0; i < n; i += 3)
            points[i] = {0.5f + 0.02f * unit(random), 0.52f, 0.52f, 1.0f};
        return points;
    }

    TYPED_TEST(gl_backend_test, maps_and_estimates_as_serial_does)
    {
        const auto points = query_points(400);
        for (const cloud& c : clouds(12000))
            for (const auto& [low, high, resolution] : {std::tuple{glm::vec3(0), glm::vec3(1), glm::uvec3(13, 7, 20)},
                     {glm::vec3(0), glm::vec3(1, 0.52f, 1), glm::uvec3(40, 1, 40)},
                     {glm::vec3(0.1f), glm::vec3(0.9f), glm::uvec3(1)}})
                for (uint m : {0u, 1u, 2u, 4u, 15u, 16u}) {
                    const grid g = make_grid(low, high, resolution);
                    const knn_settings s{.k = 32, .max_radius = 0.3f};
                    expect_same(map_and_search(this->gpu(), c, g, m, points, s),
                        map_and_search(this->cpu, c, g, m, points, s),
                        std::string(c.name) + ", grid of " + std::to_string(resolution.x) + " x "
                            + std::to_string(resolution.y) + ", m " + std::to_string(m));
                }
    }

    TYPED_TEST(gl_backend_test, keeps_70000_photons_of_one_cell)
    {
        // More than the iterations after which llvmpipe ends loops.
        const auto c = clouds(70000)[2];
        const auto points = query_points(200);
        const grid g = make_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(5));
        for (uint m : {0u, 16u}) {
            const knn_settings s{.k = 32, .max_radius = 1.0f};
            const auto a = map_and_search(this->gpu(), c, g, m, points, s);
            expect_same(a, map_and_search(this->cpu, c, g, m, points, s), "m " + std::to_string(m));
            const auto& used = std::get<4>(a);
            EXPECT_GE(std::accumulate(used.begin(), used.end(), 0u,
                          [](uint most, const glm::uvec2& u) { return std::max(most, u.y); }),
                m == 0 ? 70000u : 255u);
        }
    }

    TYPED_TEST(gl_backend_test, routes_100000_photons_to_one_cell)
    {
        const auto c = clouds(100000)[2];
        const grid g = make_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(5));
        const auto points = query_points(10);
        for (uint m : {15u, 16u})
            expect_same(map_and_search(this->gpu(), c, g, m, points, {.k = 8, .max_radius = 1.0f}),
                map_and_search(this->cpu, c, g, m, points, {.k = 8, .max_radius = 1.0f}), "m " + std::to_string(m));
    }

    TYPED_TEST(gl_backend_test, reads_nothing_back_between_passes)
    {
        gl_backend& b = this->gpu();
        const auto c = clouds(20000)[0];
        const grid g = make_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(10));
        const auto points = query_points(5000);
        auto photons_to_sort = upload_cloud(b, c);
        auto photons_to_route = upload_cloud(b, c);
        const auto queries = b.upload(view(points));
        const auto readbacks = b.readbacks();
        const auto polls = b.query_polls();
        const auto sorted = sorted_map(b, std::move(photons_to_sort), g);
        const auto routed = routed_map(b, std::move(photons_to_route), g, 4);
        EXPECT_EQ(b.query_polls() - polls, 3u) << "three counts: invalid photons twice, overfull cells once";
        knn_search search(b, sorted, queries,
            as_paper(knn_settings{.k = 40, .max_radius = 0.4f, .visits_per_pass = 20, .ranges_per_pass = 20}));
        const auto before = b.query_polls();
        const progress p = search.advance();
        const auto e = search.estimates();
        b.finish();
        EXPECT_EQ(b.readbacks(), readbacks);
        EXPECT_TRUE(p.finished);
        EXPECT_GT(p.passes, 20u);
        EXPECT_LE(b.query_polls() - before, p.passes / 8 + 1);
        EXPECT_GT(p.active.front(), p.active.back());
        EXPECT_TRUE(std::is_sorted(p.active.rbegin(), p.active.rend()));
        // Pass by pass it comes to the same.
        knn_search slow(b, sorted, queries,
            as_paper(knn_settings{.k = 40, .max_radius = 0.4f, .visits_per_pass = 20, .ranges_per_pass = 20}));
        uint passes = 0;
        for (progress one = slow.advance(1);; one = slow.advance(1)) {
            passes += one.passes;
            if (one.finished)
                break;
        }
        EXPECT_EQ(passes, p.passes);
        EXPECT_TRUE(same_bits(b.download(slow.estimates().irradiance), b.download(e.irradiance)));
    }

    TYPED_TEST(gl_backend_test, tile_size_changes_nothing)
    {
        const auto c = clouds(2000)[1];
        const grid g = make_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(8));
        const auto points = query_points(1500);
        const knn_settings s{.k = 20, .max_radius = 0.5f, .visits_per_pass = 64};
        const auto reference = map_and_search(this->cpu, c, g, 0, points, s);
        for (uint tile : {1u, 5u, 16u, 2048u}) {
            if (tile == 1) {
                gl_backend b({.context = TypeParam::kind, .tile = tile});
                expect_same(map_and_search(b, c, g, 0, {points.begin(), points.begin() + 100}, s),
                    map_and_search(this->cpu, c, g, 0, {points.begin(), points.begin() + 100}, s), "tile 1");
            } else {
                gl_backend b({.context = TypeParam::kind, .tile = tile});
                expect_same(map_and_search(b, c, g, 0, points, s), reference, "tile " + std::to_string(tile));
            }
        }
        EXPECT_THROW(gl_backend({.context = TypeParam::kind, .tile = 0}), std::invalid_argument);
    }

    TYPED_TEST(gl_backend_test, tells_its_costs)
    {
        gl_backend b({.context = TypeParam::kind});
        EXPECT_TRUE(b.costs().empty());
        auto pairs = b.upload(view(noise<glm::uvec2>(1000, 1)));
        const auto report = bitonic_sort(b, pairs);
        const kernel_cost& cost = b.costs().at("bitonic_step");
        EXPECT_EQ(cost.passes, report.passes);
        EXPECT_GT(cost.compile_ms, 0);
        EXPECT_EQ(cost.instructions, 0u);
        EXPECT_EQ(cost.ms, 0);
    }

    TYPED_TEST(gl_backend_test, times_verbs_by_the_devices_clock_when_asked)
    {
        gl_backend b({.context = TypeParam::kind, .time_passes = true});
        const auto start = std::chrono::steady_clock::now();
        const auto c = clouds(5000)[0];
        // All verbs: sorts, routes, counts and searches.
        map_and_search(b, c, make_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(8)), 2, query_points(5000),
            {.k = 20, .max_radius = 1});
        const double all = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        double sum = 0;
        for (const auto& [name, cost] : b.costs()) {
            EXPECT_GT(cost.ms, 0) << name;
            sum += cost.ms;
        }
        EXPECT_LT(sum, all);
    }

    // Several contexts in one process, used in turn, and a buffer that outlives its backend.
    TEST(gl_contexts, live_side_by_side)
    {
        std::vector<gl_backend> all;
        for (const auto kind :
            {gl_context_kind::egl, gl_context_kind::osmesa, gl_context_kind::egl, gl_context_kind::any})
            try {
                all.emplace_back(gl_options{.context = kind});
            } catch (const backend_error&) {
            }
        if (all.size() < 2)
            GTEST_SKIP() << "fewer than two contexts can be had here";
        std::vector<buffer_of<gl_backend, glm::uvec2>> pairs;
        const auto data = noise<glm::uvec2>(5000, 1);
        for (auto& b : all)
            pairs.push_back(b.upload(view(data)));
        for (std::size_t i = 0; i < all.size(); ++i)
            bitonic_sort(all[i], pairs[i]);
        auto sorted = data;
        std::sort(sorted.begin(), sorted.end(), [](auto a, auto b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); });
        for (std::size_t i = all.size(); i-- > 0;)
            EXPECT_TRUE(same_bits(all[i].download(pairs[i]), sorted)) << all[i].caps().backend;
        auto kept = std::move(pairs[0]);
        pairs.clear();
        all.clear();
        EXPECT_EQ(kept.size(), 5000u);
    }

    // The caller's own context: an EGL one made here by hand.
    TEST(gl_contexts, works_in_the_callers)
    {
        std::string tried;
        const auto callers = gl::make_egl_context(false, tried);
        if (!callers)
            GTEST_SKIP() << tried;
        callers->use();
        auto& call = callers->call;
        {
            gl_backend b({.context = gl_context_kind::current, .debug = true});
            EXPECT_EQ(b.caps().backend, "gl");
            auto pairs = b.upload(view(noise<glm::uvec2>(5000, 1)));
            bitonic_sort(b, pairs);
            const auto first = b.download(pairs);
            // The caller leaves state behind that would spoil every pass.
            call.Enable(GL_SCISSOR_TEST);
            call.ScissorIndexed(0, 0, 0, 1, 1);
            call.ColorMaski(0, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
            call.Enable(GL_BLEND);
            call.Enable(GL_CULL_FACE);
            call.Enable(GL_RASTERIZER_DISCARD);
            call.PixelStorei(GL_UNPACK_ROW_LENGTH, 7);
            call.PixelStorei(GL_PACK_ROW_LENGTH, 9999);
            call.BindVertexArray(0);
            auto again = b.upload(view(noise<glm::uvec2>(5000, 1)));
            bitonic_sort(b, again);
            EXPECT_TRUE(same_bits(b.download(again), first));
            // Another context in between: the caller has to make its own current again, and is told so.
            gl_backend other({.context = gl_context_kind::egl});
            EXPECT_THROW(b.finish(), backend_error);
            callers->use();
            EXPECT_NO_THROW(b.finish());
        }
    }

    TEST(gl_contexts, a_missing_context_says_what_to_do)
    {
        // No context is current in a fresh thread.
        std::string text;
        std::thread([&] {
            try {
                gl_backend b({.context = gl_context_kind::current});
                text = "no error";
            } catch (const backend_error& e) {
                text = e.what();
            }
        }).join();
        EXPECT_NE(text.find("no OpenGL context is current"), std::string::npos) << text;
    }

} // namespace
} // namespace photongrid
