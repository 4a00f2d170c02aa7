// The OpenGL backend in an EGL and in an OSMesa context, under test.
#pragma once

#include "gl_test_kernels.hpp"

namespace photongrid {
namespace {

    // --- helpers
    // ------------------------------------------------------------------------------------------------------
    template <class T>
    std::span<const T> view(const std::vector<T>& v)
    {
        return v;
    }
    template <class T>
    ::testing::AssertionResult same_bits(const std::vector<T>& a, const std::vector<T>& b)
    {
        if (a.size() != b.size())
            return ::testing::AssertionFailure() << a.size() << " elements against " << b.size();
        for (std::size_t i = 0; i < a.size(); ++i)
            if (std::memcmp(&a[i], &b[i], sizeof(T)) != 0)
                return ::testing::AssertionFailure() << "first difference at element " << i << " of " << a.size();
        return ::testing::AssertionSuccess();
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
    class gl_backend_test : public ::testing::Test {
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
    using kinds = ::testing::Types<egl, osmesa>;
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

} // namespace
} // namespace photongrid
