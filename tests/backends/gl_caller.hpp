// A caller with an OpenGL context of its own.
#pragma once

#include "gl_broken_kernels.hpp"
#include "gl_state.hpp"

#include "gl_algorithms.hpp"
#include "serial_algorithms.hpp"

#include <photongrid/backends/gl/gl.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/map/first_in_cell.kernel.hpp>
#include <photongrid/map/grid_index.hpp>
#include <photongrid/map/pair_value.kernel.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

namespace photongrid::testing {
namespace {

    template <class T>
    std::span<const T> view(const std::vector<T>& v)
    {
        return v;
    }
    template <class T>
    bool same_bits(const std::vector<T>& a, const std::vector<T>& b)
    {
        return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
    }
    std::vector<glm::uvec2> random_pairs(std::size_t n)
    {
        std::mt19937 random(3);
        std::vector<glm::uvec2> pairs(n);
        for (auto& p : pairs)
            p = {uint(random()), uint(random())};
        return pairs;
    }
    bool before(const glm::uvec2& a, const glm::uvec2& b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); }
    std::vector<glm::uvec2> sorted(std::vector<glm::uvec2> pairs)
    {
        std::sort(pairs.begin(), pairs.end(), before);
        return pairs;
    }

    struct egl {
        static std::shared_ptr<gl::context> make()
        {
            std::string tried;
            return gl::make_egl_context(true, tried);
        }
        static constexpr auto find = gl::find_by_egl;
    };
    struct osmesa {
        static std::shared_ptr<gl::context> make()
        {
            std::string tried;
            return gl::make_osmesa_context(tried);
        }
        static constexpr auto find = gl::find_by_osmesa;
    };

    template <class Kind>
    class gl_callers_context : public ::testing::Test {
    protected:
        void SetUp() override
        {
            callers = Kind::make();
            if (!callers)
                GTEST_SKIP() << "no such context can be had here";
            callers->use();
            call.emplace(Kind::find);
        }
        std::unique_ptr<gl_backend> make_backend(bool debug = false, bool time_passes = false)
        {
            auto b = std::make_unique<gl_backend>(gl_options{
                .context = gl_context_kind::current, .find = Kind::find, .time_passes = time_passes, .debug = debug});
            b->add_texts(test_texts);
            return b;
        }
        std::shared_ptr<gl::context> callers;
        std::optional<test_gl> call;
    };
    using kinds = ::testing::Types<egl, osmesa>;
    TYPED_TEST_SUITE(gl_callers_context, kinds);

    void expect_same(const state_dump& now, const state_dump& then, const std::string& after)
    {
        for (const auto& [name, values] : then)
            if (const auto& found = now.at(name); found != values)
                ADD_FAILURE() << after << " changed " << name << " from " << ::testing::PrintToString(values) << " to "
                              << ::testing::PrintToString(found);
    }

    /// What all algorithms give, to be compared between backends.
    template <class B>
    auto results(B& b, uint m)
    {
        std::mt19937 random(7);
        std::uniform_real_distribution<float> unit(0.0f, 1.0f);
        std::vector<glm::vec4> positions(3000), powers(3000), points(200);
        for (auto* v : {&positions, &powers, &points})
            for (auto& p : *v)
                p = {unit(random), unit(random), unit(random), v == &points ? 1.0f : 0.0f};
        const grid g = make_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(6));
        photons<B> p{b.upload(view(positions)), b.upload(view(powers)), {}};
        const auto map = m == 0 ? sorted_map(b, std::move(p), g) : routed_map(b, std::move(p), g, {m, 99});
        const auto e = knn_grid_estimate(b, map, b.upload(view(points)), {.k = 20, .max_radius = 0.3f});
        return std::tuple(b.download(map.list), b.download(map.cells), b.download(map.photons.powers),
            b.download(e.irradiance), b.download(e.used));
    }
    template <class Tuple>
    bool same_results(const Tuple& a, const Tuple& b)
    {
        bool same = true;
        photongrid::detail::for_each_slot<std::tuple_size_v<Tuple>>(
            [&](auto s) { same = same && same_bits(std::get<s.index>(a), std::get<s.index>(b)); });
        return same;
    }

    /// Calls that throw: before a pass, in the compiler, and between a pass's state and its drawing. `pairs` has 5000
    /// elements, `few` fewer.
    template <class Check>
    void call_what_throws(
        gl_backend& b, const buffer_of<gl_backend, glm::uvec2>& pairs, buffer_of<gl_backend, uint>& few, Check&& check)
    {
        EXPECT_THROW((b.run<kernels::pair_value>(5000, {}, reads(pairs), writes(few))), std::invalid_argument);
        check("run with too small a buffer");
        EXPECT_THROW(b.compile<test_kernels::broken>(), backend_error);
        check("compile of a broken kernel");
        EXPECT_THROW((b.run<test_kernels::broken>(10, {}, std::tuple<>{}, writes(few))), backend_error);
        check("run of a broken kernel");
        b.run<kernels::pair_value>(10, {}, reads(b.make<glm::uvec2>(0)), writes(few));
        check("run that reads a buffer without elements");
    }

    /// Gives `few`, of 10 elements, to the caller and takes it back; then uses a texture that the caller deleted.
    template <class Check>
    void exchange_textures(gl_backend& b, const buffer_of<gl_backend, glm::uvec2>& pairs,
        buffer_of<gl_backend, uint>& few, const test_gl& gl, Check&& check)
    {
        gl_texture given = b.texture_of(few);
        check("texture_of");
        given = b.release(std::move(few));
        check("release");
        {
            auto taken = b.adopt<uint>(given.name, 10);
            check("adopt");
            EXPECT_THROW(b.adopt<float>(given.name, 10), std::invalid_argument);
            check("adopt of another format");
        }
        check("the destructor of an adopted buffer");
        gl.DeleteTextures(1, &given.name);
        GLuint mine = 0; // which no pass can draw into when this is done with it
        gl.CreateTextures(GL_TEXTURE_2D, 1, &mine);
        gl.TextureStorage2D(mine, 1, GL_R32UI, 2048, 1);
        auto taken = b.adopt<uint>(mine, 2048);
        gl.DeleteTextures(1, &mine);
        EXPECT_THROW((b.run<kernels::pair_value>(2048, {}, reads(pairs), writes(taken))), backend_error);
        check("run into a texture that is gone");
    }

    /// Calls everything that the backend has; `check` after each.
    template <class Check>
    void call_everything(auto&& make_backend, const test_gl& gl, Check&& check)
    {
        serial_backend cpu;
        std::unique_ptr<gl_backend> b = make_backend();
        check("the constructor");
        {
            auto made = b->make<glm::vec4>(5000);
            check("make");
            const auto pairs = random_pairs(5000);
            auto up = b->upload(view(pairs));
            check("upload");
            EXPECT_TRUE(same_bits(b->download(up), pairs));
            check("download");
            b->compile<kernels::first_in_cell>();
            check("compile");
            auto values = b->make<uint>(5000);
            b->run<kernels::pair_value>(5000, {}, reads(up), writes(values));
            check("run");
            EXPECT_EQ(b->download(values)[4999], pairs[4999].y);
            b->finish();
            check("finish");
            bitonic_sort(*b, up);
            check("bitonic_sort");
            EXPECT_TRUE(same_bits(b->download(up), sorted(pairs)));
            for (const uint m : {0u, 4u}) {
                EXPECT_TRUE(same_results(results(*b, m), results(cpu, m))) << "m " << m;
                check(m == 0 ? "sorted_map, knn_grid_estimate" : "routed_map, knn_grid_estimate");
            }
            auto few = b->make<uint>(10);
            call_what_throws(*b, up, few, check);
            exchange_textures(*b, up, few, gl, check);
        }
        check("destructors of buffers");
        b.reset();
        check("the destructor");
    }

} // namespace
} // namespace photongrid::testing
