// The OpenGL backend in a context of the caller's, made here by hand: all state of OpenGL 4.5 core is as it was after
// every call, whatever it was, and results equal the serial backend's. Buffers as the caller's textures, and back.
#include "gl_state.hpp"

#include "serial_algorithms.hpp"

#include <photongrid/backends/gl/overrides/all.hpp>
#include <photongrid/grid_index.hpp>
#include <photongrid/knn_grid_estimate.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

namespace photongrid::testing {
namespace {

    namespace test_kernels {
        struct broken {
            struct Params {
                uint unused;
            };
            Params args{};
            static constexpr std::string_view path = "broken.glsl";
#include <photongrid/kernels/begin.hpp>
            OUTPUT(0, uint, value)
            void kernel(uint i) { value = i; }
#include <photongrid/kernels/end.hpp>
        };
    } // namespace test_kernels
    constexpr text_file test_texts[] = {{"tests/broken.glsl",
        "struct Params {\n    uint unused;\n};\nPARAMS(Params)\nOUTPUT(0, uint, value)\nvoid kernel(uint i) { value = "
        "i.w; }\n"}};

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
#ifdef PHOTONGRID_HAS_OSMESA
            try {
                return std::make_shared<gl::osmesa_context>();
            } catch (const backend_error&) {
            }
#endif
            return nullptr;
        }
#ifdef PHOTONGRID_HAS_OSMESA
        static constexpr auto find = gl::find_by_osmesa;
#else
        static constexpr auto find = gl::find_by_egl;
#endif
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
        const auto map = m == 0 ? sorted_map(b, std::move(p), g) : routed_map(b, std::move(p), g, m, 99);
        const auto e = knn_grid_estimate(b, map, b.upload(view(points)), {.k = 20, .max_radius = 0.3f});
        return std::tuple(b.download(map.list), b.download(map.cells), b.download(map.photons.powers),
            b.download(e.irradiance), b.download(e.used));
    }
    template <class Tuple>
    bool same_results(const Tuple& a, const Tuple& b)
    {
        return [&]<std::size_t... I>(std::index_sequence<I...>)
        {
            return (same_bits(std::get<I>(a), std::get<I>(b)) && ...);
        }
        (std::make_index_sequence<std::tuple_size_v<Tuple>>{});
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
            // Exceptions: before a pass, in the compiler, and between a pass's state and its drawing.
            auto few = b->make<uint>(10);
            EXPECT_THROW((b->run<kernels::pair_value>(5000, {}, reads(up), writes(few))), std::invalid_argument);
            check("run with too small a buffer");
            EXPECT_THROW(b->compile<test_kernels::broken>(), backend_error);
            check("compile of a broken kernel");
            EXPECT_THROW((b->run<test_kernels::broken>(10, {}, std::tuple<>{}, writes(few))), backend_error);
            check("run of a broken kernel");
            b->run<kernels::pair_value>(10, {}, reads(b->make<glm::uvec2>(0)), writes(few));
            check("run that reads a buffer without elements");
            gl_texture given = b->texture_of(few);
            check("texture_of");
            given = b->release(std::move(few));
            check("release");
            {
                auto taken = b->adopt<uint>(given.name, 10);
                check("adopt");
                EXPECT_THROW(b->adopt<float>(given.name, 10), std::invalid_argument);
                check("adopt of another format");
            }
            check("the destructor of an adopted buffer");
            gl.DeleteTextures(1, &given.name);
            {
                GLuint mine = 0; // which no pass can draw into when this is done with it
                gl.CreateTextures(GL_TEXTURE_2D, 1, &mine);
                gl.TextureStorage2D(mine, 1, GL_R32UI, 2048, 1);
                auto taken = b->adopt<uint>(mine, 2048);
                gl.DeleteTextures(1, &mine);
                EXPECT_THROW((b->run<kernels::pair_value>(2048, {}, reads(up), writes(taken))), backend_error);
                check("run into a texture that is gone");
            }
        }
        check("destructors of buffers");
        b.reset();
        check("the destructor");
    }

    TYPED_TEST(gl_callers_context, every_piece_of_state_is_as_it_was)
    {
        // All of it changed; every second piece; and as OpenGL begins. With and without what options change.
        for (const auto& [first, step] : {std::pair{0u, 1u}, {0u, 2u}, {1u, 2u}, {0u, 1000000u}})
            for (const bool debug : {false, true}) {
                const auto callers = TypeParam::make();
                callers->use();
                gl_state state(*this->call);
                const auto defaults = state.dump();
                ASSERT_EQ(this->call->GetError(), GLenum(GL_NO_ERROR));
                state.set(first, step);
                const auto then = state.dump();
                ASSERT_EQ(this->call->GetError(), GLenum(GL_NO_ERROR));
                for (const auto& [name, values] : then)
                    for (std::size_t v = 0; step == 1 && v < values.size(); ++v)
                        EXPECT_NE(values[v], defaults.at(name)[v]) << name << "[" << v << "] is not set by this test";
                call_everything([&] { return this->make_backend(debug, debug); }, *this->call,
                    [&, first = first, step = step](const std::string& what) {
                        expect_same(
                            state.dump(), then, what + (step == 1 ? "" : ", pieces from " + std::to_string(first)));
                        EXPECT_EQ(this->call->GetError(), GLenum(GL_NO_ERROR)) << what;
                    });
            }
    }

    // OpenGL tells a reference value clamped to the stencil bits of the framebuffer that is bound: none here.
    TYPED_TEST(gl_callers_context, stencil_references_survive_without_a_stencil_buffer)
    {
        const test_gl& gl = *this->call;
        gl_state state(gl);
        GLuint colour = 0, target = 0;
        gl.CreateRenderbuffers(1, &colour);
        gl.NamedRenderbufferStorage(colour, GL_RGBA8, 8, 8);
        gl.CreateFramebuffers(1, &target);
        gl.NamedFramebufferRenderbuffer(target, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour);
        gl.StencilFuncSeparate(GL_FRONT, GL_LESS, 77, 0xFFu);
        gl.StencilFuncSeparate(GL_BACK, GL_LESS, 99, 0xFFu);
        gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
        std::unique_ptr<gl_backend> b = this->make_backend();
        results(*b, 4);
        gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, state.draw_target);
        const auto now = state.dump();
        EXPECT_EQ(now.at("GL_STENCIL front")[1], 77);
        EXPECT_EQ(now.at("GL_STENCIL back")[1], 99);
    }

    // Bound without a range, a buffer has no size that could be given back.
    TYPED_TEST(gl_callers_context, a_uniform_buffer_bound_whole_stays_bound)
    {
        const test_gl& gl = *this->call;
        GLuint buffer = 0;
        gl.CreateBuffers(1, &buffer);
        gl.NamedBufferData(buffer, 256, nullptr, GL_STATIC_DRAW);
        gl.BindBufferBase(GL_UNIFORM_BUFFER, 0, buffer);
        std::unique_ptr<gl_backend> b = this->make_backend();
        GLint bound = 0;
        GLint64 size = -1;
        gl.GetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, 0, &bound);
        gl.GetInteger64i_v(GL_UNIFORM_BUFFER_SIZE, 0, &size);
        EXPECT_EQ(GLuint(bound), buffer);
        EXPECT_EQ(size, 0);
    }

    // In a compatibility context front and back are filled or not each for itself.
    TEST(gl_callers_compatibility_context, either_side_keeps_its_polygon_mode)
    {
        const EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        constexpr std::array<EGLint, 7> wanted{EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5,
            EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT, EGL_NONE};
        EGLContext context = EGL_NO_CONTEXT;
        if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) && eglBindAPI(EGL_OPENGL_API))
            context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted.data());
        if (context == EGL_NO_CONTEXT || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
            GTEST_SKIP() << "no such context can be had here";
        const test_gl gl(gl::find_by_egl);
        gl.PolygonMode(GL_FRONT, GL_LINE);
        gl.PolygonMode(GL_BACK, GL_POINT);
        {
            gl_backend b({.context = gl_context_kind::current});
            const auto data = random_pairs(5000);
            auto pairs = b.upload(view(data));
            bitonic_sort(b, pairs);
            EXPECT_TRUE(same_bits(b.download(pairs), sorted(data)));
        }
        std::array<double, 2> modes{};
        gl.GetDoublev(GL_POLYGON_MODE, modes.data());
        EXPECT_EQ(modes, (std::array<double, 2>{GL_LINE, GL_POINT}));
        EXPECT_EQ(gl.GetError(), GLenum(GL_NO_ERROR));
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display, context);
    }

    // A program pipeline is in force again, with the subroutine chosen: what is drawn is blue.
    TYPED_TEST(gl_callers_context, a_program_pipeline_draws_as_before)
    {
        const test_gl& gl = *this->call;
        gl_state state(gl);
        GLuint vertices = 0;
        gl.CreateVertexArrays(1, &vertices);
        gl.UseProgramStages(
            state.pipeline, GL_VERTEX_SHADER_BIT, gl.CreateShaderProgramv(GL_VERTEX_SHADER, 1, &any_vertex));
        gl.UseProgram(0);
        gl.BindProgramPipeline(state.pipeline);
        const GLuint second = 1;
        gl.UniformSubroutinesuiv(GL_FRAGMENT_SHADER, 1, &second);
        gl.BindVertexArray(vertices);
        gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, state.draw_target);
        gl.BindFramebuffer(GL_READ_FRAMEBUFFER, state.draw_target);
        gl.Viewport(0, 0, 8, 8);
        std::unique_ptr<gl_backend> b = this->make_backend();
        EXPECT_TRUE(same_results(results(*b, 4), [] {
            serial_backend cpu;
            return results(cpu, 4);
        }()));
        gl.DrawArrays(GL_TRIANGLES, 0, 3);
        std::array<std::uint8_t, 4> pixel{};
        gl.ReadPixels(3, 3, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
        EXPECT_EQ(pixel, (std::array<std::uint8_t, 4>{0, 0, 255, 255}));
        EXPECT_EQ(gl.GetError(), GLenum(GL_NO_ERROR));
    }

    TYPED_TEST(gl_callers_context, the_callers_errors_are_neither_ours_nor_lost)
    {
        const test_gl& gl = *this->call;
        std::unique_ptr<gl_backend> b = this->make_backend();
        auto pairs = b->upload(view(random_pairs(100)));
        GLuint incomplete = 0;
        gl.CreateFramebuffers(1, &incomplete);
        int heard = 0;
        gl.Enable(GL_DEBUG_OUTPUT);
        gl.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        gl.DebugMessageCallback([](GLenum, GLenum, GLuint, GLenum, GLsizei, const GLchar*,
                                    const void* n) { ++*static_cast<int*>(const_cast<void*>(n)); },
            &heard);
        const std::array<std::pair<GLenum, std::function<void()>>, 4> mistakes{
            {{GL_INVALID_ENUM, [&] { gl.Enable(0xDEAD); }}, {GL_INVALID_VALUE, [&] { gl.LineWidth(-1); }},
                {GL_INVALID_OPERATION, [&] { gl.EndTransformFeedback(); }},
                {GL_INVALID_FRAMEBUFFER_OPERATION, [&] {
                     gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, incomplete);
                     gl.DrawArrays(GL_POINTS, 0, 1);
                     gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
                 }}}};
        GLuint vertices = 0;
        gl.CreateVertexArrays(1, &vertices);
        gl.BindVertexArray(vertices);
        gl.UseProgram(make_program(gl, any_vertex, fragment_of_two));
        for (const auto& [code, mistake] : mistakes)
            for (const bool fails : {false, true}) {
                mistake();
                heard = 0;
                if (fails) {
                    EXPECT_THROW(b->compile<test_kernels::broken>(), backend_error);
                } else { // where the compiler has nothing to say, the caller hears of no second mistake
                    EXPECT_NO_THROW(bitonic_sort(*b, pairs));
                    EXPECT_EQ(heard, 0);
                }
                EXPECT_TRUE(gl.IsEnabled(GL_DEBUG_OUTPUT));
                EXPECT_EQ(gl.GetError(), code);
                EXPECT_EQ(gl.GetError(), GLenum(GL_NO_ERROR));
            }
        // An error of ours that an exception has told stays with us.
        GLuint gone = 0;
        gl.CreateTextures(GL_TEXTURE_2D, 1, &gone);
        gl.TextureStorage2D(gone, 1, GL_RG32UI, 2048, 1);
        auto taken = b->adopt<glm::uvec2>(gone, 100);
        gl.DeleteTextures(1, &gone);
        auto values = b->make<uint>(100);
        EXPECT_THROW(b->download(taken), backend_error);
        EXPECT_THROW((b->run<kernels::pair_value>(100, {}, reads(taken), writes(values))), backend_error);
        EXPECT_EQ(gl.GetError(), GLenum(GL_NO_ERROR));
    }

    /// What a verb that draws says, or nothing.
    std::string said(gl_backend& b, buffer_of<gl_backend, glm::uvec2>& pairs)
    {
        try {
            bitonic_sort(b, pairs);
        } catch (const backend_error& e) {
            return e.what();
        }
        return {};
    }

    TYPED_TEST(gl_callers_context, refuses_to_disturb_what_nobody_can_put_back)
    {
        const test_gl& gl = *this->call;
        std::unique_ptr<gl_backend> b = this->make_backend();
        const auto data = random_pairs(100);
        auto pairs = b->upload(view(data));
        const auto expect_refusal = [&](const char* name) {
            EXPECT_NE(said(*b, pairs).find(name), std::string::npos) << name << ", but: " << said(*b, pairs);
            EXPECT_TRUE(same_bits(b->download(pairs), data)) << name; // uploads and downloads go on
        };
        for (const auto& [target, name] :
            {std::pair{GL_SAMPLES_PASSED, "GL_SAMPLES_PASSED "}, {GL_ANY_SAMPLES_PASSED, "GL_ANY_SAMPLES_PASSED "},
                {GL_ANY_SAMPLES_PASSED_CONSERVATIVE, "GL_ANY_SAMPLES_PASSED_CONSERVATIVE "},
                {GL_PRIMITIVES_GENERATED, "GL_PRIMITIVES_GENERATED "}}) {
            GLuint query = 0;
            gl.CreateQueries(GLenum(target), 1, &query);
            gl.BeginQuery(GLenum(target), query);
            expect_refusal(name);
            gl.EndQuery(GLenum(target));
            if (target == GL_SAMPLES_PASSED) {
                gl.BeginConditionalRender(query, GL_QUERY_WAIT);
                expect_refusal("conditional rendering");
                EXPECT_EQ(gl.GetError(), GLenum(GL_NO_ERROR));
                gl.EndConditionalRender();
                EXPECT_EQ(gl.GetError(), GLenum(GL_NO_ERROR)) << "it was still in force";
            }
        }

        GLuint program = gl.CreateProgram();
        const GLuint shader = gl.CreateShader(GL_VERTEX_SHADER);
        gl.ShaderSource(shader, 1, &any_vertex, nullptr);
        gl.CompileShader(shader);
        gl.AttachShader(program, shader);
        const char* recorded = "gl_Position";
        gl.TransformFeedbackVaryings(program, 1, &recorded, GL_INTERLEAVED_ATTRIBS);
        gl.LinkProgram(program);
        gl.UseProgram(program);
        GLuint buffer = 0;
        gl.CreateBuffers(1, &buffer);
        gl.NamedBufferData(buffer, 4096, nullptr, GL_STATIC_DRAW);
        gl.BindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer, 0, 4096);
        gl.BeginTransformFeedback(GL_TRIANGLES);
        expect_refusal("transform feedback");
        gl.PauseTransformFeedback();
        auto others = b->upload(view(data));
        EXPECT_EQ(said(*b, others), ""); // while it pauses, nothing is recorded
        gl.ResumeTransformFeedback();
        gl.EndTransformFeedback();
        EXPECT_EQ(gl.GetError(), GLenum(GL_NO_ERROR)) << "it could not go on";

        gl.DeleteProgram(program);
        expect_refusal("marked for deletion");
        GLint marked = 0;
        gl.GetProgramiv(program, GL_DELETE_STATUS, &marked);
        EXPECT_TRUE(marked) << "it was deleted under the caller's hands";
        program = make_program(gl, any_vertex, fragment_of_two);
        gl.UseProgram(program);
        const char* no_varying = "no such";
        gl.TransformFeedbackVaryings(program, 1, &no_varying, GL_INTERLEAVED_ATTRIBS);
        gl.LinkProgram(program);
        expect_refusal("failed to link again");
        gl.UseProgram(0);
        EXPECT_EQ(said(*b, pairs), "");
        EXPECT_TRUE(same_bits(b->download(pairs), sorted(data)));
    }

    GLuint make_texture(const test_gl& gl, GLenum target, GLenum format, GLsizei width, GLsizei height)
    {
        GLuint texture = 0;
        gl.CreateTextures(target, 1, &texture);
        gl.TextureStorage2D(texture, 1, format, width, height);
        return texture;
    }

    TYPED_TEST(gl_callers_context, sorts_in_the_callers_texture)
    {
        const test_gl& gl = *this->call;
        std::unique_ptr<gl_backend> b = this->make_backend();
        const auto readbacks = b->readbacks();
        for (const std::size_t n : {std::size_t{3}, std::size_t{2048}, std::size_t{5000}})
            for (const bool is_mutable : {false, true}) {
                const auto data = random_pairs(n);
                const std::size_t rows = (n + 2047) / 2048 + 1; // one to spare
                std::vector<glm::uvec2> texels(rows * 2048, glm::uvec2(7));
                std::copy(data.begin(), data.end(), texels.begin());
                GLuint mine = 0;
                if (is_mutable) { // with filters as OpenGL begins, which want a pyramid of levels that is not there
                    gl.CreateTextures(GL_TEXTURE_2D, 1, &mine);
                    gl.BindTexture(GL_TEXTURE_2D, mine);
                    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RG32UI, 2048, GLsizei(rows), 0, GL_RG_INTEGER, GL_UNSIGNED_INT,
                        texels.data());
                } else {
                    mine = make_texture(gl, GL_TEXTURE_2D, GL_RG32UI, 2048, GLsizei(rows));
                    gl.TextureSubImage2D(
                        mine, 0, 0, 0, 2048, GLsizei(rows), GL_RG_INTEGER, GL_UNSIGNED_INT, texels.data());
                }
                const auto bytes = b->bytes();
                {
                    auto pairs = b->adopt<glm::uvec2>(mine, n);
                    EXPECT_EQ(pairs.size(), n);
                    EXPECT_EQ(b->bytes(), bytes) << "what is the caller's is not counted";
                    bitonic_sort(*b, pairs);
                }
                EXPECT_EQ(b->bytes(), bytes);
                ASSERT_TRUE(gl.IsTexture(mine)) << "the library deleted the caller's texture";
                gl.GetTextureImage(mine, 0, GL_RG_INTEGER, GL_UNSIGNED_INT, GLsizei(texels.size() * sizeof(glm::uvec2)),
                    texels.data());
                texels.resize(n);
                EXPECT_TRUE(same_bits(texels, sorted(data))) << n << (is_mutable ? ", mutable" : "");
                gl.DeleteTextures(1, &mine);
            }
        EXPECT_EQ(b->readbacks(), readbacks);
        EXPECT_EQ(gl.GetError(), GLenum(GL_NO_ERROR));
    }

    // The caller's shader reads the element that texture_of's layout says.
    TYPED_TEST(gl_callers_context, shows_its_buffers_to_the_callers_shaders)
    {
        const test_gl& gl = *this->call;
        std::unique_ptr<gl_backend> b = this->make_backend();
        gl_state objects(gl);
        const GLuint program = make_program(gl, any_vertex,
            "#version 450\nlayout(binding = 3) uniform usampler2D values;\nlayout(location = 0) uniform int "
            "element;\nout vec4 colour;\n"
            "void main() { colour = vec4(texelFetch(values, ivec2(element % 2048, element / 2048), 0).xy / 255.0, 0, "
            "1); }\n");
        const auto data = [] {
            std::vector<glm::uvec2> v(5000);
            for (uint i = 0; i < v.size(); ++i)
                v[i] = {i % 251, i / 251};
            return v;
        }();
        const auto readbacks = b->readbacks();
        const auto values = b->upload(view(data));
        const gl_texture t = b->texture_of(values);
        EXPECT_EQ(t.width, 2048u);
        EXPECT_EQ(t.height, 3u);
        EXPECT_EQ(t.internal_format, GLenum(GL_RG32UI));
        const gl_texture few = b->texture_of(b->make<float>(5));
        EXPECT_EQ(few.width, 8u);
        EXPECT_EQ(few.height, 1u);
        EXPECT_EQ(few.internal_format, GLenum(GL_R32F));
        EXPECT_EQ(b->texture_of(b->make<float>(0)).name, 0u);
        GLuint vertices = 0;
        gl.CreateVertexArrays(1, &vertices);
        gl.BindVertexArray(vertices);
        gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, objects.draw_target);
        gl.BindFramebuffer(GL_READ_FRAMEBUFFER, objects.draw_target);
        gl.Viewport(0, 0, 8, 8);
        gl.UseProgram(program);
        gl.ActiveTexture(GL_TEXTURE0 + 3);
        gl.BindTexture(GL_TEXTURE_2D, t.name);
        for (const int element : {0, 1, 2047, 2048, 4999}) {
            gl.ProgramUniform1i(program, 0, element);
            gl.DrawArrays(GL_TRIANGLES, 0, 3);
            std::array<std::uint8_t, 4> pixel{};
            gl.ReadPixels(3, 3, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
            EXPECT_EQ(pixel[0], element % 251) << element;
            EXPECT_EQ(pixel[1], element / 251) << element;
        }
        EXPECT_EQ(b->readbacks(), readbacks);
        EXPECT_EQ(gl.GetError(), GLenum(GL_NO_ERROR));
    }

    TYPED_TEST(gl_callers_context, refuses_textures_that_are_no_buffers)
    {
        const test_gl& gl = *this->call;
        std::unique_ptr<gl_backend> b = this->make_backend();
        const auto expect_refusal = [&](GLuint texture, std::size_t n, const char* text) {
            try {
                b->adopt<glm::vec2>(texture, n);
                ADD_FAILURE() << "adopted, instead of: " << text;
            } catch (const std::invalid_argument& e) {
                const std::string said = e.what();
                EXPECT_NE(said.find("gl_backend::adopt: "), std::string::npos) << said;
                EXPECT_NE(said.find(text), std::string::npos) << said;
            }
            EXPECT_EQ(gl.GetError(), GLenum(GL_NO_ERROR)) << text;
        };
        expect_refusal(0, 5, "texture: 0 is no texture");
        expect_refusal(123456, 5, "is no texture");
        expect_refusal(make_texture(gl, GL_TEXTURE_1D_ARRAY, GL_RG32F, 8, 1), 5, "GL_TEXTURE_2D");
        expect_refusal(make_texture(gl, GL_TEXTURE_2D, GL_RG16F, 8, 1), 5, "GL_RG32F");
        expect_refusal(make_texture(gl, GL_TEXTURE_2D, GL_RG32UI, 8, 1), 5, "GL_RG32F");
        expect_refusal(make_texture(gl, GL_TEXTURE_2D, GL_RG32F, 4, 1), 5, "a width of 5 at least");
        expect_refusal(
            make_texture(gl, GL_TEXTURE_2D, GL_RG32F, 1024, 4), 4096, "a width of 2048 and a height of 2 at least");
        expect_refusal(make_texture(gl, GL_TEXTURE_2D, GL_RG32F, 4096, 4), 4096, "a width of 2048");
        expect_refusal(make_texture(gl, GL_TEXTURE_2D, GL_RG32F, 2048, 2), 4097, "a height of 3 at least");
        expect_refusal(1, std::size_t{1} << 40, "n: 1099511627776 elements");
        GLuint odd = 0;
        gl.CreateTextures(GL_TEXTURE_2D, 1, &odd);
        gl.TextureStorage2D(odd, 2, GL_RG32F, 8, 8);
        EXPECT_EQ(b->adopt<glm::vec2>(odd, 5).size(), 5u);
        gl.TextureParameteri(odd, GL_TEXTURE_BASE_LEVEL, 1);
        expect_refusal(odd, 5, "GL_TEXTURE_BASE_LEVEL 1");
        gl.TextureParameteri(odd, GL_TEXTURE_BASE_LEVEL, 0);
        for (const int channel :
            {GL_TEXTURE_SWIZZLE_R, GL_TEXTURE_SWIZZLE_G, GL_TEXTURE_SWIZZLE_B, GL_TEXTURE_SWIZZLE_A}) {
            GLuint swizzled = make_texture(gl, GL_TEXTURE_2D, GL_RG32F, 8, 1);
            gl.TextureParameteri(swizzled, GLenum(channel), GL_ZERO);
            expect_refusal(swizzled, 5, "GL_TEXTURE_SWIZZLE");
        }
    }

    TYPED_TEST(gl_callers_context, a_released_texture_outlives_the_backend)
    {
        const test_gl& gl = *this->call;
        std::unique_ptr<gl_backend> b = this->make_backend();
        const auto bytes = b->bytes();
        const auto data = random_pairs(5000);
        auto pairs = b->upload(view(data));
        bitonic_sort(*b, pairs);
        const GLuint deleted = b->texture_of(b->make<uint>(5)).name;
        EXPECT_FALSE(gl.IsTexture(deleted)) << "what is not released is deleted";
        const gl_texture given = b->release(std::move(pairs));
        EXPECT_EQ(pairs.size(), 0u); // NOLINT(bugprone-use-after-move): empty is what release leaves
        EXPECT_EQ(b->bytes(), bytes);
        EXPECT_GT(b->peak_bytes(), bytes);
        b.reset();
        ASSERT_TRUE(gl.IsTexture(given.name));
        std::vector<glm::uvec2> texels(std::size_t{given.width} * given.height);
        gl.GetTextureImage(
            given.name, 0, GL_RG_INTEGER, GL_UNSIGNED_INT, GLsizei(texels.size() * sizeof(glm::uvec2)), texels.data());
        texels.resize(5000);
        EXPECT_TRUE(same_bits(texels, sorted(data)));
    }

} // namespace
} // namespace photongrid::testing
