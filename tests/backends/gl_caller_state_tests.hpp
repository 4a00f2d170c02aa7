// The caller's state is as it was.
#pragma once

#include "gl_caller.hpp"

namespace photongrid::testing {
namespace {

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
        constexpr std::array<EGLint, 7> attributes{EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5,
            EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT, EGL_NONE};
        EGLContext context = EGL_NO_CONTEXT;
        if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) && eglBindAPI(EGL_OPENGL_API))
            context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
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

    /// The error message of a verb that draws, or "".
    std::string said(gl_backend& b, buffer_of<gl_backend, glm::uvec2>& pairs)
    {
        try {
            bitonic_sort(b, pairs);
        } catch (const backend_error& e) {
            return e.what();
        }
        return {};
    }

} // namespace
} // namespace photongrid::testing
