// All state of an OpenGL 4.5 core context, a piece at a time: how to set it to something else than OpenGL starts with,
// and how to read it. For tests that a library leaves it alone.
#pragma once

#define GL_GLEXT_PROTOTYPES // types of functions; none is linked
#include <GL/glcorearb.h>

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace photongrid::testing {

// clang-format off
// NOLINTBEGIN: a list is written once and read twice
#define PHOTONGRID_TEST_GL_CALLS(X)                                                                                    \
    X(ActiveTexture) X(AttachShader) X(BeginConditionalRender) X(BeginQuery) X(BeginTransformFeedback)                 \
    X(BindBuffer) X(BindBufferBase) X(BindBufferRange) X(BindFramebuffer) X(BindImageTexture)                          \
    X(BindProgramPipeline) X(BindRenderbuffer) X(BindSampler) X(BindTexture) X(BindTransformFeedback)                  \
    X(BindVertexArray) X(BlendColor) X(BlendEquationSeparatei) X(BlendFuncSeparatei) X(ClampColor) X(ClearColor)       \
    X(ClearDepth) X(ClearStencil) X(ClipControl) X(ColorMaski) X(CompileShader) X(CreateBuffers)                       \
    X(CreateFramebuffers) X(CreateProgram) X(CreateProgramPipelines) X(CreateQueries) X(CreateRenderbuffers)           \
    X(CreateSamplers) X(CreateShader) X(CreateShaderProgramv) X(CreateTextures) X(CreateTransformFeedbacks)            \
    X(CreateVertexArrays) X(CullFace) X(DebugMessageCallback) X(DeleteProgram) X(DeleteTextures) X(DepthFunc)          \
    X(DepthMask) X(DepthRangeIndexed) X(Disable) X(DrawArrays) X(Enable) X(Enablei) X(EndConditionalRender)            \
    X(EndQuery) X(EndTransformFeedback) X(FrontFace) X(GetBooleani_v) X(GetDoublei_v) X(GetDoublev) X(GetError)        \
    X(GetInteger64i_v) X(GetIntegeri_v) X(GetPointerv) X(GetProgramiv) X(GetQueryiv) X(GetTextureImage)                \
    X(GetUniformSubroutineuiv) X(GetVertexAttribdv) X(Hint) X(IsEnabled) X(IsEnabledi) X(IsTexture) X(LineWidth)       \
    X(LinkProgram) X(LogicOp) X(MinSampleShading) X(NamedBufferData) X(NamedFramebufferRenderbuffer)                   \
    X(NamedRenderbufferStorage) X(PatchParameterfv) X(PatchParameteri) X(PauseTransformFeedback) X(PixelStorei)        \
    X(PointParameterf) X(PointParameteri) X(PointSize) X(PolygonMode) X(PolygonOffset) X(PrimitiveRestartIndex)        \
    X(ProgramUniform1i) X(ProvokingVertex) X(PushDebugGroup) X(ReadPixels) X(ResumeTransformFeedback)                  \
    X(SampleCoverage) X(SampleMaski) X(ScissorIndexed) X(ShaderSource) X(StencilFuncSeparate)                          \
    X(StencilMaskSeparate) X(StencilOpSeparate) X(TexImage2D) X(TextureParameteri) X(TextureStorage2D)                 \
    X(TextureStorage3D) X(TextureSubImage2D) X(TransformFeedbackVaryings) X(UniformSubroutinesuiv) X(UseProgram)       \
    X(UseProgramStages) X(VertexAttrib4f) X(Viewport) X(ViewportIndexedf)

struct test_gl {
#define X(NAME) decltype(&gl##NAME) NAME = nullptr;
    PHOTONGRID_TEST_GL_CALLS(X)
#undef X
    explicit test_gl(void (*(*find)(const char*))())
    {
#define X(NAME)                                                                                                        \
    NAME = reinterpret_cast<decltype(&gl##NAME)>(find("gl" #NAME));                                                    \
    if (NAME == nullptr)                                                                                               \
        throw std::runtime_error("no gl" #NAME);
        PHOTONGRID_TEST_GL_CALLS(X)
#undef X
    }
};
#undef PHOTONGRID_TEST_GL_CALLS
// NOLINTEND
// clang-format on

using state_dump = std::map<std::string, std::vector<double>>;

/// A program of one vertex and one fragment shader.
inline GLuint make_program(const test_gl& gl, const char* vertex, const char* fragment)
{
    const GLuint program = gl.CreateProgram();
    for (const auto& [stage, text] : {std::pair{GL_VERTEX_SHADER, vertex}, std::pair{GL_FRAGMENT_SHADER, fragment}}) {
        const GLuint shader = gl.CreateShader(static_cast<GLenum>(stage));
        gl.ShaderSource(shader, 1, &text, nullptr);
        gl.CompileShader(shader);
        gl.AttachShader(program, shader);
    }
    gl.LinkProgram(program);
    GLint good = 0;
    gl.GetProgramiv(program, GL_LINK_STATUS, &good);
    if (!good)
        throw std::runtime_error("a test's program does not link");
    return program;
}

inline constexpr const char* any_vertex
    = "#version 450\nout gl_PerVertex { vec4 gl_Position; };\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 "
      ": -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }\n";
/// Two subroutines of which the first is in use unless one says otherwise.
inline constexpr const char* fragment_of_two = R"(#version 450
subroutine vec4 colour_of();
layout(location = 0) subroutine uniform colour_of chosen;
layout(index = 0) subroutine(colour_of) vec4 red() { return vec4(1, 0, 0, 1); }
layout(index = 1) subroutine(colour_of) vec4 blue() { return vec4(0, 0, 1, 1); }
out vec4 colour;
void main() { colour = chosen(); }
)";

/// Every piece of state. Objects of their own are made at construction and die with the context.
class gl_state {
public:
    explicit gl_state(const test_gl& functions) : gl(functions) { fill(); }

    /// Sets every piece, or every `step`-th from `first` on beside those that others need.
    void set(std::size_t first = 0, std::size_t step = 1)
    {
        for (std::size_t p = 0; p < pieces_.size(); ++p)
            if (p % step == first || pieces_[p].needed)
                pieces_[p].set();
    }
    state_dump dump() const
    {
        state_dump all;
        for (const piece& p : pieces_)
            all[p.name] = p.read();
        return all;
    }

    GLuint program = 0, pipeline = 0, draw_target = 0;

private:
    struct piece {
        std::string name;
        std::function<void()> set;
        std::function<std::vector<double>()> read;
        bool needed = false;
    };
    const test_gl gl;
    std::vector<piece> pieces_;

    void add(
        std::string name, std::function<void()> set, std::function<std::vector<double>()> read, bool needed = false)
    {
        pieces_.push_back({std::move(name), std::move(set), std::move(read), needed});
    }
    std::vector<double> get(GLenum what, std::size_t n) const
    {
        std::array<double, 16> v{};
        gl.GetDoublev(what, v.data());
        return {v.begin(), v.begin() + static_cast<std::ptrdiff_t>(n)};
    }
    void add(std::string name, GLenum what, std::function<void()> set, std::size_t values = 1, bool needed = false)
    {
        add(
            std::move(name), std::move(set), [this, what, values] { return get(what, values); }, needed);
    }
    std::vector<double> get_indexed(const std::vector<GLenum>& what, GLuint index) const
    {
        std::vector<double> v;
        for (const GLenum w : what) {
            GLint64 value = 0;
            gl.GetInteger64i_v(w, index, &value);
            v.push_back(static_cast<double>(value));
        }
        return v;
    }
    void add_switch(const std::string& name, GLenum what)
    {
        add(
            name, [this, what] { gl.IsEnabled(what) ? gl.Disable(what) : gl.Enable(what); },
            [this, what] { return std::vector<double>{double(gl.IsEnabled(what))}; });
    }
    void add_switches(const std::string& name, GLenum what, GLuint n)
    {
        for (GLuint i = 0; i < n; ++i)
            add(
                name + "[" + std::to_string(i) + "]", [this, what, i] { gl.Enablei(what, i); },
                [this, what, i] { return std::vector<double>{double(gl.IsEnabledi(what, i))}; });
    }
    GLuint make_buffer() const
    {
        GLuint buffer = 0;
        gl.CreateBuffers(1, &buffer);
        gl.NamedBufferData(buffer, 65536, nullptr, GL_STATIC_DRAW);
        return buffer;
    }
    GLuint make_target() const
    {
        std::array<GLuint, 2> parts{};
        gl.CreateRenderbuffers(2, parts.data());
        gl.NamedRenderbufferStorage(parts[0], GL_RGBA8, 8, 8);
        gl.NamedRenderbufferStorage(parts[1], GL_DEPTH24_STENCIL8, 8, 8);
        GLuint target = 0;
        gl.CreateFramebuffers(1, &target);
        gl.NamedFramebufferRenderbuffer(target, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, parts[0]);
        gl.NamedFramebufferRenderbuffer(target, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, parts[1]);
        return target;
    }
    /// Reads per-unit state with the unit active and leaves the active one as it was.
    std::vector<double> get_of_unit(GLuint unit, GLenum what) const
    {
        const auto active = static_cast<GLenum>(get(GL_ACTIVE_TEXTURE, 1)[0]);
        gl.ActiveTexture(GL_TEXTURE0 + unit);
        const auto v = get(what, 1);
        gl.ActiveTexture(active);
        return v;
    }

    void fill()
    {
        add_switches_of_the_context();
        add_viewports();
        add_rasterization();
        add_blending();
        add_fragments();
        add_stencil();
        add_objects();
        add_program_and_attribute();
        add_debugging();
        add_buffers();
        add_pixel_store();
        add_units();
    }

    void add_switches_of_the_context()
    {
#define SWITCH_PIECE(NAME) add_switch(#NAME, NAME)
        SWITCH_PIECE(GL_COLOR_LOGIC_OP);
        SWITCH_PIECE(GL_CULL_FACE);
        SWITCH_PIECE(GL_DEBUG_OUTPUT);
        SWITCH_PIECE(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        SWITCH_PIECE(GL_DEPTH_CLAMP);
        SWITCH_PIECE(GL_DEPTH_TEST);
        SWITCH_PIECE(GL_DITHER);
        SWITCH_PIECE(GL_FRAMEBUFFER_SRGB);
        SWITCH_PIECE(GL_LINE_SMOOTH);
        SWITCH_PIECE(GL_MULTISAMPLE);
        SWITCH_PIECE(GL_POLYGON_OFFSET_FILL);
        SWITCH_PIECE(GL_POLYGON_OFFSET_LINE);
        SWITCH_PIECE(GL_POLYGON_OFFSET_POINT);
        SWITCH_PIECE(GL_POLYGON_SMOOTH);
        SWITCH_PIECE(GL_PRIMITIVE_RESTART);
        SWITCH_PIECE(GL_PRIMITIVE_RESTART_FIXED_INDEX);
        SWITCH_PIECE(GL_PROGRAM_POINT_SIZE);
        SWITCH_PIECE(GL_RASTERIZER_DISCARD);
        SWITCH_PIECE(GL_SAMPLE_ALPHA_TO_COVERAGE);
        SWITCH_PIECE(GL_SAMPLE_ALPHA_TO_ONE);
        SWITCH_PIECE(GL_SAMPLE_COVERAGE);
        SWITCH_PIECE(GL_SAMPLE_MASK);
        SWITCH_PIECE(GL_SAMPLE_SHADING);
        SWITCH_PIECE(GL_STENCIL_TEST);
        SWITCH_PIECE(GL_TEXTURE_CUBE_MAP_SEAMLESS);
#undef SWITCH_PIECE
        for (GLenum plane = 0; plane < 8; ++plane)
            add_switch("GL_CLIP_DISTANCE" + std::to_string(plane), GL_CLIP_DISTANCE0 + plane);
        add_switches("GL_BLEND", GL_BLEND, 8);
        add_switches("GL_SCISSOR_TEST", GL_SCISSOR_TEST, 16);
    }

    void add_viewports()
    {
        for (GLuint i = 0; i < 16; ++i) {
            const auto n = std::to_string(i);
            const auto f = static_cast<float>(i);
            add(
                "GL_VIEWPORT[" + n + "]",
                [this, i, f] { gl.ViewportIndexedf(i, 1.25f + f, 2.5f + f, 3.5f + f, 4.75f + f); },
                [this, i] {
                    std::vector<double> v(4);
                    gl.GetDoublei_v(GL_VIEWPORT, i, v.data());
                    return v;
                });
            add(
                "GL_SCISSOR_BOX[" + n + "]",
                [this, i] { gl.ScissorIndexed(i, GLint(1 + i), GLint(2 + i), GLint(13 + i), GLint(14 + i)); },
                [this, i] {
                    std::vector<double> v(4);
                    gl.GetDoublei_v(GL_SCISSOR_BOX, i, v.data());
                    return v;
                });
            add(
                "GL_DEPTH_RANGE[" + n + "]", [this, i] { gl.DepthRangeIndexed(i, 0.25, 0.5); },
                [this, i] {
                    std::vector<double> v(2);
                    gl.GetDoublei_v(GL_DEPTH_RANGE, i, v.data());
                    return v;
                });
        }
    }

    void add_rasterization()
    {
        add("GL_CLIP_ORIGIN", GL_CLIP_ORIGIN,
            [this] { gl.ClipControl(GL_UPPER_LEFT, GLenum(get(GL_CLIP_DEPTH_MODE, 1)[0])); });
        add("GL_CLIP_DEPTH_MODE", GL_CLIP_DEPTH_MODE,
            [this] { gl.ClipControl(GLenum(get(GL_CLIP_ORIGIN, 1)[0]), GL_ZERO_TO_ONE); });
        add("GL_POLYGON_MODE", GL_POLYGON_MODE, [this] { gl.PolygonMode(GL_FRONT_AND_BACK, GL_LINE); });
        add("GL_POLYGON_OFFSET_FACTOR", GL_POLYGON_OFFSET_FACTOR,
            [this] { gl.PolygonOffset(1.5f, float(get(GL_POLYGON_OFFSET_UNITS, 1)[0])); });
        add("GL_POLYGON_OFFSET_UNITS", GL_POLYGON_OFFSET_UNITS,
            [this] { gl.PolygonOffset(float(get(GL_POLYGON_OFFSET_FACTOR, 1)[0]), 2.5f); });
        add("GL_CULL_FACE_MODE", GL_CULL_FACE_MODE, [this] { gl.CullFace(GL_FRONT_AND_BACK); });
        add("GL_FRONT_FACE", GL_FRONT_FACE, [this] { gl.FrontFace(GL_CW); });
        add("GL_PROVOKING_VERTEX", GL_PROVOKING_VERTEX, [this] { gl.ProvokingVertex(GL_FIRST_VERTEX_CONVENTION); });
        add("GL_LINE_WIDTH", GL_LINE_WIDTH, [this] { gl.LineWidth(2.0f); });
        add("GL_POINT_SIZE", GL_POINT_SIZE, [this] { gl.PointSize(7.5f); });
        add("GL_POINT_FADE_THRESHOLD_SIZE", GL_POINT_FADE_THRESHOLD_SIZE,
            [this] { gl.PointParameterf(GL_POINT_FADE_THRESHOLD_SIZE, 9.0f); });
        add("GL_POINT_SPRITE_COORD_ORIGIN", GL_POINT_SPRITE_COORD_ORIGIN,
            [this] { gl.PointParameteri(GL_POINT_SPRITE_COORD_ORIGIN, GL_LOWER_LEFT); });
        add("GL_PRIMITIVE_RESTART_INDEX", GL_PRIMITIVE_RESTART_INDEX, [this] { gl.PrimitiveRestartIndex(2); });
        add("GL_PATCH_VERTICES", GL_PATCH_VERTICES, [this] { gl.PatchParameteri(GL_PATCH_VERTICES, 4); });
        add(
            "GL_PATCH_DEFAULT_OUTER_LEVEL", GL_PATCH_DEFAULT_OUTER_LEVEL,
            [this] {
                gl.PatchParameterfv(GL_PATCH_DEFAULT_OUTER_LEVEL, std::array{2.f, 3.f, 4.f, 5.f}.data());
            },
            4);
        add(
            "GL_PATCH_DEFAULT_INNER_LEVEL", GL_PATCH_DEFAULT_INNER_LEVEL,
            [this] {
                gl.PatchParameterfv(GL_PATCH_DEFAULT_INNER_LEVEL, std::array{2.f, 3.f}.data());
            },
            2);
        for (const auto& [what, name] : {std::pair{GL_LINE_SMOOTH_HINT, "GL_LINE_SMOOTH_HINT"},
                 std::pair{GL_POLYGON_SMOOTH_HINT, "GL_POLYGON_SMOOTH_HINT"},
                 std::pair{GL_TEXTURE_COMPRESSION_HINT, "GL_TEXTURE_COMPRESSION_HINT"},
                 std::pair{GL_FRAGMENT_SHADER_DERIVATIVE_HINT, "GL_FRAGMENT_SHADER_DERIVATIVE_HINT"}})
            add(name, GLenum(what), [this, w = GLenum(what)] { gl.Hint(w, GL_NICEST); });
    }

    void add_blending()
    {
        for (GLuint i = 0; i < 8; ++i) {
            const auto n = "[" + std::to_string(i) + "]";
            add(
                "GL_COLOR_WRITEMASK" + n, [this, i] { gl.ColorMaski(i, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE); },
                [this, i] {
                    std::array<GLboolean, 4> m{};
                    gl.GetBooleani_v(GL_COLOR_WRITEMASK, i, m.data());
                    return std::vector<double>(m.begin(), m.end());
                });
            add(
                "GL_BLEND_EQUATION" + n,
                [this, i] {
                    gl.BlendEquationSeparatei(
                        i, i % 2 == 0 ? GL_FUNC_SUBTRACT : GL_MAX, i % 2 == 0 ? GL_MIN : GL_FUNC_REVERSE_SUBTRACT);
                },
                [this, i] {
                    return get_indexed({GL_BLEND_EQUATION_RGB, GL_BLEND_EQUATION_ALPHA}, i);
                });
            add(
                "GL_BLEND_FUNC" + n,
                [this, i] {
                    gl.BlendFuncSeparatei(
                        i, GL_DST_COLOR, GL_SRC_COLOR, GL_DST_ALPHA, i % 2 == 0 ? GL_SRC_ALPHA : GL_CONSTANT_COLOR);
                },
                [this, i] {
                    return get_indexed({GL_BLEND_SRC_RGB, GL_BLEND_DST_RGB, GL_BLEND_SRC_ALPHA, GL_BLEND_DST_ALPHA}, i);
                });
        }
        add(
            "GL_BLEND_COLOR", GL_BLEND_COLOR, [this] { gl.BlendColor(0.25f, 0.5f, 0.75f, 1.0f); }, 4);
    }

    void add_fragments()
    {
        add(
            "GL_COLOR_CLEAR_VALUE", GL_COLOR_CLEAR_VALUE, [this] { gl.ClearColor(0.25f, 0.5f, 0.75f, 1.0f); }, 4);
        add("GL_DEPTH_CLEAR_VALUE", GL_DEPTH_CLEAR_VALUE, [this] { gl.ClearDepth(0.5); });
        add("GL_STENCIL_CLEAR_VALUE", GL_STENCIL_CLEAR_VALUE, [this] { gl.ClearStencil(3); });
        add("GL_DEPTH_FUNC", GL_DEPTH_FUNC, [this] { gl.DepthFunc(GL_NEVER); });
        add("GL_DEPTH_WRITEMASK", GL_DEPTH_WRITEMASK, [this] { gl.DepthMask(GL_FALSE); });
        add("GL_LOGIC_OP_MODE", GL_LOGIC_OP_MODE, [this] { gl.LogicOp(GL_XOR); });
        add("GL_MIN_SAMPLE_SHADING_VALUE", GL_MIN_SAMPLE_SHADING_VALUE, [this] { gl.MinSampleShading(0.5f); });
        add("GL_SAMPLE_COVERAGE_VALUE", GL_SAMPLE_COVERAGE_VALUE, [this] { gl.SampleCoverage(0.25f, GL_FALSE); });
        add("GL_SAMPLE_COVERAGE_INVERT", GL_SAMPLE_COVERAGE_INVERT,
            [this] { gl.SampleCoverage(float(get(GL_SAMPLE_COVERAGE_VALUE, 1)[0]), GL_TRUE); });
        add(
            "GL_SAMPLE_MASK_VALUE", [this] { gl.SampleMaski(0, 6u); },
            [this] { return get_indexed({GL_SAMPLE_MASK_VALUE}, 0); });
        add("GL_CLAMP_READ_COLOR", GL_CLAMP_READ_COLOR, [this] { gl.ClampColor(GL_CLAMP_READ_COLOR, GL_TRUE); });
        draw_target = make_target();
        add(
            "GL_DRAW_FRAMEBUFFER_BINDING", GL_DRAW_FRAMEBUFFER_BINDING,
            [this] { gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, draw_target); }, 1, true);
    }

    void add_stencil()
    {
        add(
            "GL_STENCIL front",
            [this] {
                gl.StencilFuncSeparate(GL_FRONT, GL_GREATER, 5, 0x1Fu);
                gl.StencilOpSeparate(GL_FRONT, GL_INVERT, GL_INCR_WRAP, GL_ZERO);
                gl.StencilMaskSeparate(GL_FRONT, 0x2Fu);
            },
            [this] {
                std::vector<double> v;
                for (const int what : {GL_STENCIL_FUNC, GL_STENCIL_REF, GL_STENCIL_VALUE_MASK, GL_STENCIL_FAIL,
                         GL_STENCIL_PASS_DEPTH_FAIL, GL_STENCIL_PASS_DEPTH_PASS, GL_STENCIL_WRITEMASK})
                    v.push_back(get(GLenum(what), 1)[0]);
                return v;
            });
        add(
            "GL_STENCIL back",
            [this] {
                gl.StencilFuncSeparate(GL_BACK, GL_LESS, 6, 0x3Fu);
                gl.StencilOpSeparate(GL_BACK, GL_DECR, GL_REPLACE, GL_DECR_WRAP);
                gl.StencilMaskSeparate(GL_BACK, 0x4Fu);
            },
            [this] {
                std::vector<double> v;
                for (const int what :
                    {GL_STENCIL_BACK_FUNC, GL_STENCIL_BACK_REF, GL_STENCIL_BACK_VALUE_MASK, GL_STENCIL_BACK_FAIL,
                        GL_STENCIL_BACK_PASS_DEPTH_FAIL, GL_STENCIL_BACK_PASS_DEPTH_PASS, GL_STENCIL_BACK_WRITEMASK})
                    v.push_back(get(GLenum(what), 1)[0]);
                return v;
            });
    }

    void add_objects()
    {
        add("GL_READ_FRAMEBUFFER_BINDING", GL_READ_FRAMEBUFFER_BINDING,
            [this, f = make_target()] { gl.BindFramebuffer(GL_READ_FRAMEBUFFER, f); });
        GLuint renderbuffer = 0, vertices = 0, feedback = 0;
        gl.CreateRenderbuffers(1, &renderbuffer);
        gl.CreateVertexArrays(1, &vertices);
        gl.CreateTransformFeedbacks(1, &feedback);
        add("GL_RENDERBUFFER_BINDING", GL_RENDERBUFFER_BINDING,
            [this, renderbuffer] { gl.BindRenderbuffer(GL_RENDERBUFFER, renderbuffer); });
        add(
            "GL_VERTEX_ARRAY_BINDING", GL_VERTEX_ARRAY_BINDING, [this, vertices] { gl.BindVertexArray(vertices); }, 1,
            true);
        add(
            "GL_TRANSFORM_FEEDBACK_BINDING", GL_TRANSFORM_FEEDBACK_BINDING,
            [this, feedback] { gl.BindTransformFeedback(GL_TRANSFORM_FEEDBACK, feedback); }, 1, true);
    }

    void add_program_and_attribute()
    {
        program = make_program(gl, any_vertex, fragment_of_two);
        add(
            "GL_CURRENT_PROGRAM", GL_CURRENT_PROGRAM, [this] { gl.UseProgram(program); }, 1, true);
        add(
            "subroutine", [this] { gl.UniformSubroutinesuiv(GL_FRAGMENT_SHADER, 1, std::array{1u}.data()); },
            [this] {
                GLuint chosen = 0;
                if (get(GL_CURRENT_PROGRAM, 1)[0] != 0 || get(GL_PROGRAM_PIPELINE_BINDING, 1)[0] != 0)
                    gl.GetUniformSubroutineuiv(GL_FRAGMENT_SHADER, 0, &chosen);
                return std::vector<double>{double(chosen)};
            });
        gl.CreateProgramPipelines(1, &pipeline);
        gl.UseProgramStages(
            pipeline, GL_FRAGMENT_SHADER_BIT, gl.CreateShaderProgramv(GL_FRAGMENT_SHADER, 1, &fragment_of_two));
        add("GL_PROGRAM_PIPELINE_BINDING", GL_PROGRAM_PIPELINE_BINDING, [this] { gl.BindProgramPipeline(pipeline); });
        add(
            "current vertex attribute 3", [this] { gl.VertexAttrib4f(3, 1, 2, 3, 4); },
            [this] {
                std::vector<double> v(4);
                gl.GetVertexAttribdv(3, GL_CURRENT_VERTEX_ATTRIB, v.data());
                return v;
            });
    }

    void add_debugging()
    {
        GLuint query = 0;
        gl.CreateQueries(GL_TIME_ELAPSED, 1, &query);
        add(
            "query of GL_TIME_ELAPSED", [this, query] { gl.BeginQuery(GL_TIME_ELAPSED, query); },
            [this] {
                GLint active = 0;
                gl.GetQueryiv(GL_TIME_ELAPSED, GL_CURRENT_QUERY, &active);
                return std::vector<double>{double(active)};
            });
        add("GL_DEBUG_GROUP_STACK_DEPTH", GL_DEBUG_GROUP_STACK_DEPTH,
            [this] { gl.PushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 1, -1, "group"); });
        add(
            "debug callback",
            [this] {
                gl.DebugMessageCallback(
                    [](GLenum, GLenum, GLuint, GLenum, GLsizei, const GLchar*, const void*) {}, this);
            },
            [this] {
                void *callback = nullptr, *user = nullptr;
                gl.GetPointerv(GL_DEBUG_CALLBACK_FUNCTION, &callback);
                gl.GetPointerv(GL_DEBUG_CALLBACK_USER_PARAM, &user);
                return std::vector<double>{
                    double(reinterpret_cast<std::uintptr_t>(callback)), double(reinterpret_cast<std::uintptr_t>(user))};
            });
    }

    void add_buffers()
    {
        struct indexed {
            const char* name;
            GLenum target, binding, start, size;
        };
        for (const auto& b : {indexed{"GL_UNIFORM_BUFFER", GL_UNIFORM_BUFFER, GL_UNIFORM_BUFFER_BINDING,
                                  GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE},
                 indexed{"GL_SHADER_STORAGE_BUFFER", GL_SHADER_STORAGE_BUFFER, GL_SHADER_STORAGE_BUFFER_BINDING,
                     GL_SHADER_STORAGE_BUFFER_START, GL_SHADER_STORAGE_BUFFER_SIZE},
                 indexed{"GL_ATOMIC_COUNTER_BUFFER", GL_ATOMIC_COUNTER_BUFFER, GL_ATOMIC_COUNTER_BUFFER_BINDING,
                     GL_ATOMIC_COUNTER_BUFFER_START, GL_ATOMIC_COUNTER_BUFFER_SIZE},
                 indexed{"GL_TRANSFORM_FEEDBACK_BUFFER", GL_TRANSFORM_FEEDBACK_BUFFER,
                     GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, GL_TRANSFORM_FEEDBACK_BUFFER_START,
                     GL_TRANSFORM_FEEDBACK_BUFFER_SIZE}})
            for (GLuint i = 0; i < 4; ++i)
                add(
                    std::string(b.name) + "[" + std::to_string(i) + "]",
                    [this, b, i, buffer = make_buffer()] {
                        gl.BindBufferRange(b.target, i, buffer, 1024 * GLintptr(i + 1), 256 * GLsizeiptr(i + 1));
                    },
                    [this, b, i] {
                        return get_indexed({b.binding, b.start, b.size}, i);
                    });
        for (const auto& [name, target, binding] :
            {std::tuple{"GL_ARRAY_BUFFER", GL_ARRAY_BUFFER, GL_ARRAY_BUFFER_BINDING},
                {"GL_ELEMENT_ARRAY_BUFFER", GL_ELEMENT_ARRAY_BUFFER, GL_ELEMENT_ARRAY_BUFFER_BINDING},
                {"GL_UNIFORM_BUFFER", GL_UNIFORM_BUFFER, GL_UNIFORM_BUFFER_BINDING},
                {"GL_SHADER_STORAGE_BUFFER", GL_SHADER_STORAGE_BUFFER, GL_SHADER_STORAGE_BUFFER_BINDING},
                {"GL_ATOMIC_COUNTER_BUFFER", GL_ATOMIC_COUNTER_BUFFER, GL_ATOMIC_COUNTER_BUFFER_BINDING},
                {"GL_TRANSFORM_FEEDBACK_BUFFER", GL_TRANSFORM_FEEDBACK_BUFFER, GL_TRANSFORM_FEEDBACK_BUFFER_BINDING},
                {"GL_DRAW_INDIRECT_BUFFER", GL_DRAW_INDIRECT_BUFFER, GL_DRAW_INDIRECT_BUFFER_BINDING},
                {"GL_DISPATCH_INDIRECT_BUFFER", GL_DISPATCH_INDIRECT_BUFFER, GL_DISPATCH_INDIRECT_BUFFER_BINDING},
                {"GL_COPY_READ_BUFFER", GL_COPY_READ_BUFFER, GL_COPY_READ_BUFFER_BINDING},
                {"GL_COPY_WRITE_BUFFER", GL_COPY_WRITE_BUFFER, GL_COPY_WRITE_BUFFER_BINDING},
                {"GL_QUERY_BUFFER", GL_QUERY_BUFFER, GL_QUERY_BUFFER_BINDING},
                {"GL_TEXTURE_BUFFER", GL_TEXTURE_BUFFER, GL_TEXTURE_BUFFER_BINDING},
                {"GL_PIXEL_PACK_BUFFER", GL_PIXEL_PACK_BUFFER, GL_PIXEL_PACK_BUFFER_BINDING},
                {"GL_PIXEL_UNPACK_BUFFER", GL_PIXEL_UNPACK_BUFFER, GL_PIXEL_UNPACK_BUFFER_BINDING}})
            add(name, GLenum(binding),
                [this, t = GLenum(target), buffer = make_buffer()] { gl.BindBuffer(t, buffer); });
    }

    void add_pixel_store()
    {
#define STORE_PIECES(DIRECTION)                                                                                        \
    for (const auto& [name, what, value] :                                                                             \
        {std::tuple{"GL_" #DIRECTION "_SWAP_BYTES", GL_##DIRECTION##_SWAP_BYTES, 1},                                   \
            {"GL_" #DIRECTION "_LSB_FIRST", GL_##DIRECTION##_LSB_FIRST, 1},                                            \
            {"GL_" #DIRECTION "_ROW_LENGTH", GL_##DIRECTION##_ROW_LENGTH, 7},                                          \
            {"GL_" #DIRECTION "_IMAGE_HEIGHT", GL_##DIRECTION##_IMAGE_HEIGHT, 9},                                      \
            {"GL_" #DIRECTION "_SKIP_ROWS", GL_##DIRECTION##_SKIP_ROWS, 2},                                            \
            {"GL_" #DIRECTION "_SKIP_PIXELS", GL_##DIRECTION##_SKIP_PIXELS, 3},                                        \
            {"GL_" #DIRECTION "_SKIP_IMAGES", GL_##DIRECTION##_SKIP_IMAGES, 5},                                        \
            {"GL_" #DIRECTION "_ALIGNMENT", GL_##DIRECTION##_ALIGNMENT, 2},                                            \
            {"GL_" #DIRECTION "_COMPRESSED_BLOCK_WIDTH", GL_##DIRECTION##_COMPRESSED_BLOCK_WIDTH, 4},                  \
            {"GL_" #DIRECTION "_COMPRESSED_BLOCK_HEIGHT", GL_##DIRECTION##_COMPRESSED_BLOCK_HEIGHT, 4},                \
            {"GL_" #DIRECTION "_COMPRESSED_BLOCK_DEPTH", GL_##DIRECTION##_COMPRESSED_BLOCK_DEPTH, 4},                  \
            {"GL_" #DIRECTION "_COMPRESSED_BLOCK_SIZE", GL_##DIRECTION##_COMPRESSED_BLOCK_SIZE, 16}})                  \
        add(name, GLenum(what), [this, w = GLenum(what), v = value] { gl.PixelStorei(w, v); });
        STORE_PIECES(PACK)
        STORE_PIECES(UNPACK)
#undef STORE_PIECES
    }

    void add_units()
    {
        GLuint array = 0;
        gl.CreateTextures(GL_TEXTURE_2D_ARRAY, 1, &array);
        gl.TextureStorage3D(array, 2, GL_R32UI, 4, 4, 4);
        for (GLuint unit = 0; unit < 8; ++unit)
            add(
                "image unit " + std::to_string(unit),
                [this, unit, array] { gl.BindImageTexture(unit, array, 1, GL_FALSE, 1, GL_WRITE_ONLY, GL_R32UI); },
                [this, unit] {
                    return get_indexed({GL_IMAGE_BINDING_NAME, GL_IMAGE_BINDING_LEVEL, GL_IMAGE_BINDING_LAYER,
                                           GL_IMAGE_BINDING_ACCESS, GL_IMAGE_BINDING_FORMAT},
                        unit);
                });
        for (GLuint unit = 0; unit < 32; ++unit) {
            for (const auto& [name, target, binding] :
                {std::tuple{"GL_TEXTURE_1D", GL_TEXTURE_1D, GL_TEXTURE_BINDING_1D},
                    {"GL_TEXTURE_2D", GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D},
                    {"GL_TEXTURE_3D", GL_TEXTURE_3D, GL_TEXTURE_BINDING_3D},
                    {"GL_TEXTURE_1D_ARRAY", GL_TEXTURE_1D_ARRAY, GL_TEXTURE_BINDING_1D_ARRAY},
                    {"GL_TEXTURE_2D_ARRAY", GL_TEXTURE_2D_ARRAY, GL_TEXTURE_BINDING_2D_ARRAY},
                    {"GL_TEXTURE_RECTANGLE", GL_TEXTURE_RECTANGLE, GL_TEXTURE_BINDING_RECTANGLE},
                    {"GL_TEXTURE_BUFFER", GL_TEXTURE_BUFFER, GL_TEXTURE_BINDING_BUFFER},
                    {"GL_TEXTURE_CUBE_MAP", GL_TEXTURE_CUBE_MAP, GL_TEXTURE_BINDING_CUBE_MAP},
                    {"GL_TEXTURE_CUBE_MAP_ARRAY", GL_TEXTURE_CUBE_MAP_ARRAY, GL_TEXTURE_BINDING_CUBE_MAP_ARRAY},
                    {"GL_TEXTURE_2D_MULTISAMPLE", GL_TEXTURE_2D_MULTISAMPLE, GL_TEXTURE_BINDING_2D_MULTISAMPLE},
                    {"GL_TEXTURE_2D_MULTISAMPLE_ARRAY", GL_TEXTURE_2D_MULTISAMPLE_ARRAY,
                        GL_TEXTURE_BINDING_2D_MULTISAMPLE_ARRAY}}) {
                GLuint texture = 0;
                gl.CreateTextures(GLenum(target), 1, &texture);
                add(
                    "unit " + std::to_string(unit) + " " + name,
                    [this, unit, t = GLenum(target), texture] {
                        gl.ActiveTexture(GL_TEXTURE0 + unit);
                        gl.BindTexture(t, texture);
                    },
                    [this, unit, b = GLenum(binding)] { return get_of_unit(unit, b); });
            }
            GLuint sampler = 0;
            gl.CreateSamplers(1, &sampler);
            add(
                "unit " + std::to_string(unit) + " sampler", [this, unit, sampler] { gl.BindSampler(unit, sampler); },
                [this, unit] { return get_of_unit(unit, GL_SAMPLER_BINDING); });
        }
        add(
            "GL_ACTIVE_TEXTURE", GL_ACTIVE_TEXTURE, [this] { gl.ActiveTexture(GL_TEXTURE0 + 29); }, 1, true);
    }
};

} // namespace photongrid::testing
