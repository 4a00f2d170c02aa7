// Saves and restores the OpenGL state of a caller's context, so that a call of this backend leaves it unchanged, also
// after an exception. device.hpp (set_state) and routing.hpp change the state; each group of state is saved before it
// is first changed. The backend's own contexts do not use this.
#pragma once

#include <photongrid/backends/gl/functions.hpp>

#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace photongrid::gl {

/// The render targets of a pass, and the texture units of inputs and states (textures.glsl, fragment_prelude.glsl).
inline constexpr GLuint max_outputs = 8, max_inputs = 8, state_unit = 8, units = state_unit + max_outputs;

/// Capabilities that are disabled in passes. Blending, which is per draw buffer, and the scissor test, which is per
/// viewport, are disabled separately; a pass uses the first viewport only.
inline constexpr std::array<GLenum, 22> off_in_passes{GL_CULL_FACE, GL_DEPTH_TEST, GL_STENCIL_TEST,
    GL_RASTERIZER_DISCARD, GL_COLOR_LOGIC_OP, GL_DEPTH_CLAMP, GL_POLYGON_OFFSET_FILL, GL_POLYGON_SMOOTH, GL_SAMPLE_MASK,
    GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_ALPHA_TO_ONE, GL_SAMPLE_COVERAGE, GL_SAMPLE_SHADING, GL_DITHER,
    GL_CLIP_DISTANCE0, GL_CLIP_DISTANCE1, GL_CLIP_DISTANCE2, GL_CLIP_DISTANCE3, GL_CLIP_DISTANCE4, GL_CLIP_DISTANCE5,
    GL_CLIP_DISTANCE6, GL_CLIP_DISTANCE7};

inline const char* error_name(GLenum code)
{
    switch (code) {
    case GL_INVALID_ENUM: return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE: return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION: return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION: return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY: return "GL_OUT_OF_MEMORY: the device is out of memory";
    case GL_CONTEXT_LOST: return "GL_CONTEXT_LOST: the device was reset";
    default: return "an unknown OpenGL error";
    }
}

namespace detail {
    inline GLint get(functions& gl, GLenum what)
    {
        GLint value = 0;
        gl.GetIntegerv(what, &value);
        return value;
    }
    inline GLuint get_name(functions& gl, GLenum what) { return static_cast<GLuint>(get(gl, what)); }
    inline void turn(functions& gl, GLenum what, bool on) { on ? gl.Enable(what) : gl.Disable(what); }
    inline void turn(functions& gl, GLenum what, GLuint index, bool on)
    {
        on ? gl.Enablei(what, index) : gl.Disablei(what, index);
    }

    /// The program in use, and the selected subroutines, which glUseProgram resets, also those of a program pipeline.
    class program_in_use {
    public:
        explicit program_in_use(functions& gl) : program_(get_name(gl, GL_CURRENT_PROGRAM))
        {
            if (program_ != 0) {
                GLint dying = 0, linked = 0;
                gl.GetProgramiv(program_, GL_DELETE_STATUS, &dying);
                gl.GetProgramiv(program_, GL_LINK_STATUS, &linked);
                if (dying || !linked)
                    throw backend_error("gl: the program in use, " + std::to_string(program_)
                        + (dying ? ", is marked for deletion" : ", failed to link again after glUseProgram")
                        + ": it could not be restored; call glUseProgram with another program, or with 0, before the "
                          "library");
            }
            const GLuint pipeline = program_ != 0 ? 0 : get_name(gl, GL_PROGRAM_PIPELINE_BINDING);
            if (program_ == 0 && pipeline == 0)
                return;
            for (std::size_t s = 0; s < stages.size(); ++s) {
                GLint program = static_cast<GLint>(program_), n = 0;
                if (pipeline != 0)
                    gl.GetProgramPipelineiv(pipeline, stages[s], &program);
                if (program != 0)
                    gl.GetProgramInterfaceiv(
                        static_cast<GLuint>(program), subroutine_uniforms[s], GL_ACTIVE_RESOURCES, &n);
                if (n == 0) // also if the program lacks this stage, for which the next call would be an error
                    continue;
                gl.GetProgramStageiv(
                    static_cast<GLuint>(program), stages[s], GL_ACTIVE_SUBROUTINE_UNIFORM_LOCATIONS, &n);
                subroutines_[s].resize(static_cast<std::size_t>(n));
                for (GLint l = 0; l < n; ++l)
                    gl.GetUniformSubroutineuiv(stages[s], l, &subroutines_[s][static_cast<std::size_t>(l)]);
            }
        }
        void restore(functions& gl) const
        {
            gl.UseProgram(program_);
            for (std::size_t s = 0; s < stages.size(); ++s)
                if (!subroutines_[s].empty())
                    gl.UniformSubroutinesuiv(
                        stages[s], static_cast<GLsizei>(subroutines_[s].size()), subroutines_[s].data());
        }

    private:
        static constexpr std::array<GLenum, 6> stages{GL_VERTEX_SHADER, GL_TESS_CONTROL_SHADER,
            GL_TESS_EVALUATION_SHADER, GL_GEOMETRY_SHADER, GL_FRAGMENT_SHADER, GL_COMPUTE_SHADER};
        static constexpr std::array<GLenum, 6> subroutine_uniforms{GL_VERTEX_SUBROUTINE_UNIFORM,
            GL_TESS_CONTROL_SUBROUTINE_UNIFORM, GL_TESS_EVALUATION_SUBROUTINE_UNIFORM, GL_GEOMETRY_SUBROUTINE_UNIFORM,
            GL_FRAGMENT_SUBROUTINE_UNIFORM, GL_COMPUTE_SUBROUTINE_UNIFORM};
        GLuint program_;
        std::array<std::vector<GLuint>, 6> subroutines_;
    };

    /// The state that every pass changes.
    class pass_state {
    public:
        explicit pass_state(functions& gl) : program_(gl)
        {
            for (std::size_t c = 0; c < off_in_passes.size(); ++c)
                on_[c] = gl.IsEnabled(off_in_passes[c]) != GL_FALSE;
            point_size_ = gl.IsEnabled(GL_PROGRAM_POINT_SIZE) != GL_FALSE;
            scissor_test_ = gl.IsEnabledi(GL_SCISSOR_TEST, 0) != GL_FALSE;
            for (GLuint t = 0; t < max_outputs; ++t) {
                blend_[t] = gl.IsEnabledi(GL_BLEND, t) != GL_FALSE;
                gl.GetBooleani_v(GL_COLOR_WRITEMASK, t, masks_[t].data());
            }
            gl.GetFloati_v(GL_VIEWPORT, 0, viewport_.data());
            gl.GetIntegeri_v(GL_SCISSOR_BOX, 0, scissor_.data());
            gl.GetIntegerv(GL_POLYGON_MODE, polygon_mode_.data());
            clip_origin_ = get_name(gl, GL_CLIP_ORIGIN);
            clip_depth_ = get_name(gl, GL_CLIP_DEPTH_MODE);
            vertices_ = get_name(gl, GL_VERTEX_ARRAY_BINDING);
            targets_ = get_name(gl, GL_DRAW_FRAMEBUFFER_BINDING);
            results_ = get_name(gl, GL_QUERY_BUFFER_BINDING);
            uniforms_ = get_name(gl, GL_UNIFORM_BUFFER_BINDING);
            GLint block = 0;
            gl.GetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, 0, &block);
            block_ = static_cast<GLuint>(block);
            gl.GetInteger64i_v(GL_UNIFORM_BUFFER_START, 0, &block_start_);
            gl.GetInteger64i_v(GL_UNIFORM_BUFFER_SIZE, 0, &block_size_);
        }
        void restore(functions& gl) const
        {
            for (std::size_t c = 0; c < off_in_passes.size(); ++c)
                turn(gl, off_in_passes[c], on_[c]);
            turn(gl, GL_PROGRAM_POINT_SIZE, point_size_);
            turn(gl, GL_SCISSOR_TEST, 0, scissor_test_);
            for (GLuint t = 0; t < max_outputs; ++t) {
                turn(gl, GL_BLEND, t, blend_[t]);
                gl.ColorMaski(t, masks_[t][0], masks_[t][1], masks_[t][2], masks_[t][3]);
            }
            gl.ViewportIndexedf(0, viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
            gl.ScissorIndexed(0, scissor_[0], scissor_[1], scissor_[2], scissor_[3]);
            gl.PolygonMode(GL_FRONT_AND_BACK, static_cast<GLenum>(polygon_mode_[0]));
            if (polygon_mode_[1] != 0
                && polygon_mode_[1]
                    != polygon_mode_[0]) // compatibility contexts have separate modes for front and back
                gl.PolygonMode(GL_BACK, static_cast<GLenum>(polygon_mode_[1]));
            gl.ClipControl(clip_origin_, clip_depth_);
            gl.BindVertexArray(vertices_);
            gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, targets_);
            gl.BindBuffer(GL_QUERY_BUFFER, results_);
            if (block_size_ != 0)
                gl.BindBufferRange(GL_UNIFORM_BUFFER, 0, block_, static_cast<GLintptr>(block_start_),
                    static_cast<GLsizeiptr>(block_size_));
            else
                gl.BindBufferBase(GL_UNIFORM_BUFFER, 0, block_);
            gl.BindBuffer(GL_UNIFORM_BUFFER, uniforms_); // after the indexed binding, which changes it too
            program_.restore(gl);
        }

    private:
        std::array<bool, off_in_passes.size()> on_{};
        bool point_size_, scissor_test_;
        std::array<bool, max_outputs> blend_{};
        std::array<std::array<GLboolean, 4>, max_outputs> masks_{};
        std::array<GLfloat, 4> viewport_{};
        std::array<GLint, 4> scissor_{};
        std::array<GLint, 2> polygon_mode_{};
        GLenum clip_origin_, clip_depth_;
        GLuint vertices_, targets_, results_, uniforms_, block_;
        GLint64 block_start_ = 0, block_size_ = 0;
        program_in_use program_;
    };

    /// The state that only routing changes. Save it while an 8-bit stencil buffer is bound: OpenGL clamps the reference
    /// value that it returns to the bits of the bound stencil buffer, and the caller may have set it for another
    /// framebuffer.
    class stencil_state {
    public:
        explicit stencil_state(functions& gl)
            : sides_{side{GL_FRONT, get_name(gl, GL_STENCIL_FUNC), get(gl, GL_STENCIL_REF),
                         get_name(gl, GL_STENCIL_VALUE_MASK), get_name(gl, GL_STENCIL_FAIL),
                         get_name(gl, GL_STENCIL_PASS_DEPTH_FAIL), get_name(gl, GL_STENCIL_PASS_DEPTH_PASS),
                         get_name(gl, GL_STENCIL_WRITEMASK)},
                side{GL_BACK, get_name(gl, GL_STENCIL_BACK_FUNC), get(gl, GL_STENCIL_BACK_REF),
                    get_name(gl, GL_STENCIL_BACK_VALUE_MASK), get_name(gl, GL_STENCIL_BACK_FAIL),
                    get_name(gl, GL_STENCIL_BACK_PASS_DEPTH_FAIL), get_name(gl, GL_STENCIL_BACK_PASS_DEPTH_PASS),
                    get_name(gl, GL_STENCIL_BACK_WRITEMASK)}}
        {
        }
        void restore(functions& gl) const
        {
            for (const side& s : sides_) {
                gl.StencilFuncSeparate(s.face, s.func, s.reference, s.value_mask);
                gl.StencilOpSeparate(s.face, s.fail, s.depth_fail, s.pass);
                gl.StencilMaskSeparate(s.face, s.write_mask);
            }
        }

    private:
        struct side {
            GLenum face, func;
            GLint reference;
            GLuint value_mask;
            GLenum fail, depth_fail, pass;
            GLuint write_mask;
        };
        std::array<side, 2> sides_;
    };

    /// Blending of the first draw buffer.
    class blend_state {
    public:
        explicit blend_state(functions& gl)
        {
            constexpr std::array<GLenum, 6> names{GL_BLEND_EQUATION_RGB, GL_BLEND_EQUATION_ALPHA, GL_BLEND_SRC_RGB,
                GL_BLEND_DST_RGB, GL_BLEND_SRC_ALPHA, GL_BLEND_DST_ALPHA};
            for (std::size_t v = 0; v < names.size(); ++v) {
                GLint value = 0;
                gl.GetIntegeri_v(names[v], 0, &value);
                values_[v] = static_cast<GLenum>(value);
            }
        }
        void restore(functions& gl) const
        {
            gl.BlendEquationSeparatei(0, values_[0], values_[1]);
            gl.BlendFuncSeparatei(0, values_[2], values_[3], values_[4], values_[5]);
        }

    private:
        std::array<GLenum, 6> values_{};
    };

    /// Pixel storage modes for packing (to memory) or unpacking (from memory), and the pixel buffer binding.
    class pixel_state {
    public:
        enum direction { pack, unpack };
        pixel_state(functions& gl, direction d)
            : names_(d == pack ? pack_names : unpack_names),
              target_(d == pack ? GL_PIXEL_PACK_BUFFER : GL_PIXEL_UNPACK_BUFFER)
        {
            buffer_ = get_name(gl, d == pack ? GL_PIXEL_PACK_BUFFER_BINDING : GL_PIXEL_UNPACK_BUFFER_BINDING);
            for (std::size_t v = 0; v < names_.size(); ++v)
                values_[v] = get(gl, names_[v]);
        }
        /// Sets the modes for transfers: rows without gaps, no pixel buffer.
        void clear(functions& gl) const
        {
            gl.BindBuffer(target_, 0);
            for (const GLenum name : names_)
                gl.PixelStorei(name, name == names_[0] ? 4 : 0);
        }
        void restore(functions& gl) const
        {
            gl.BindBuffer(target_, buffer_);
            for (std::size_t v = 0; v < names_.size(); ++v)
                gl.PixelStorei(names_[v], values_[v]);
        }

    private:
        using names = std::array<GLenum, 7>;
        static constexpr names pack_names{GL_PACK_ALIGNMENT, GL_PACK_ROW_LENGTH, GL_PACK_IMAGE_HEIGHT,
            GL_PACK_SKIP_PIXELS, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_IMAGES, GL_PACK_SWAP_BYTES};
        static constexpr names unpack_names{GL_UNPACK_ALIGNMENT, GL_UNPACK_ROW_LENGTH, GL_UNPACK_IMAGE_HEIGHT,
            GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_IMAGES, GL_UNPACK_SWAP_BYTES};
        const names& names_;
        GLenum target_;
        GLuint buffer_;
        std::array<GLint, 7> values_{};
    };

    /// The 2D texture and the sampler of a unit. Textures of other targets are not changed.
    struct unit_state {
        GLuint texture, sampler;
    };

    /// Makes messages synchronous: from the failing call, in its thread.
    inline void hear_driver(functions& gl, GLDEBUGPROC hear, const void* user)
    {
        gl.Enable(GL_DEBUG_OUTPUT);
        gl.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        gl.DebugMessageCallback(hear, user);
    }

    /// The debug callback.
    class debug_state {
    public:
        explicit debug_state(functions& gl)
            : output_(gl.IsEnabled(GL_DEBUG_OUTPUT)), synchronous_(gl.IsEnabled(GL_DEBUG_OUTPUT_SYNCHRONOUS))
        {
            gl.GetPointerv(GL_DEBUG_CALLBACK_FUNCTION, &callback_);
            gl.GetPointerv(GL_DEBUG_CALLBACK_USER_PARAM, &user_);
        }
        void restore(functions& gl) const
        {
            turn(gl, GL_DEBUG_OUTPUT, output_);
            turn(gl, GL_DEBUG_OUTPUT_SYNCHRONOUS, synchronous_);
            gl.DebugMessageCallback(reinterpret_cast<GLDEBUGPROC>(callback_), user_);
        }

    private:
        bool output_, synchronous_;
        void *callback_ = nullptr, *user_ = nullptr;
    };
} // namespace detail

/// Keeps a caller's state during a call. Calls may nest; each group of state is saved once and restored at the end of
/// the outermost call.
class callers_state {
public:
    /// `question`: an occlusion query for internal use. `hear`: debug callback during calls; may be null.
    callers_state(functions& call, GLuint question, GLDEBUGPROC hear, const void* user)
        : gl_(call), question_(question), hear_(hear), user_(user)
    {
    }
    callers_state(const callers_state&) = delete;
    callers_state& operator=(const callers_state&) = delete;

    /// Begins a call. Errors that are already pending belong to the caller: they are saved, and restored at the end.
    /// \throws backend_error for a pending error that cannot be restored, such as GL_OUT_OF_MEMORY.
    void enter()
    {
        if (depth_ == 0) {
            keep_errors();
            if (hear_ != nullptr) {
                debug_.emplace(gl_);
                detail::hear_driver(gl_, hear_, user_);
            }
        }
        ++depth_;
    }
    /// Ends a call. The outermost one restores everything.
    void leave() noexcept
    {
        if (--depth_ > 0)
            return;
        if (stencil_)
            stencil_->restore(gl_);
        if (blending_)
            blending_->restore(gl_);
        restore_units();
        if (pack_)
            pack_->restore(gl_);
        if (unpack_)
            unpack_->restore(gl_);
        if (passes_)
            passes_->restore(gl_);
        stencil_.reset();
        blending_.reset();
        pack_.reset();
        unpack_.reset();
        passes_.reset();
        give_errors_back();
        if (debug_)
            debug_->restore(gl_);
        debug_.reset();
    }

    /// Saves the state on first use; returns true if it did, and the caller then sets its own.
    /// \throws backend_error for state that a pass would disturb and that cannot be restored.
    bool save_passes()
    {
        if (passes_)
            return false;
        refuse_what_counts_or_discards();
        return save(passes_);
    }
    bool save_stencil() { return save(stencil_); }
    bool save_blending() { return save(blending_); }
    bool save_unit(GLuint unit)
    {
        if (active_unit_ == 0)
            active_unit_ = detail::get_name(gl_, GL_ACTIVE_TEXTURE);
        if (unit_states_[unit])
            return false;
        gl_.ActiveTexture(GL_TEXTURE0 + unit);
        unit_states_[unit] = detail::unit_state{
            detail::get_name(gl_, GL_TEXTURE_BINDING_2D), detail::get_name(gl_, GL_SAMPLER_BINDING)};
        return true;
    }
    /// Saves the pixel storage modes and sets those for transfers.
    void set_transfer(detail::pixel_state::direction d)
    {
        auto& saved = d == detail::pixel_state::pack ? pack_ : unpack_;
        if (!saved)
            saved.emplace(gl_, d).clear(gl_);
    }

private:
    template <class State>
    bool save(std::optional<State>& saved)
    {
        if (saved)
            return false;
        saved.emplace(gl_);
        return true;
    }
    void restore_units()
    {
        if (active_unit_ == 0)
            return;
        for (GLuint unit = 0; unit < units; ++unit)
            if (const auto saved = std::exchange(unit_states_[unit], {})) {
                gl_.ActiveTexture(GL_TEXTURE0 + unit);
                gl_.BindTexture(GL_TEXTURE_2D, saved->texture); // glBindTextureUnit(unit, 0) would unbind all targets
                gl_.BindSampler(unit, saved->sampler);
            }
        gl_.ActiveTexture(std::exchange(active_unit_, 0));
    }

    void keep_errors()
    {
        for (int n = 0; n < 8; ++n) { // a lost context may return errors forever
            const GLenum code = gl_.GetError();
            if (code == GL_NO_ERROR)
                return;
            if (code != GL_INVALID_ENUM && code != GL_INVALID_VALUE && code != GL_INVALID_OPERATION
                && code != GL_INVALID_FRAMEBUFFER_OPERATION) {
                errors_.clear();
                throw backend_error(std::string("gl: before this call glGetError had a pending ") + error_name(code)
                    + "; an earlier OpenGL call of the program has failed");
            }
            errors_.push_back(code);
        }
    }
    /// Clears errors of this call that no exception has reported, and causes the caller's pending errors again.
    void give_errors_back() noexcept
    {
        for (int n = 0; n < 8 && gl_.GetError() != GL_NO_ERROR; ++n) {}
        if (errors_.empty())
            return;
        const bool heard = gl_.IsEnabled(GL_DEBUG_OUTPUT) != GL_FALSE;
        gl_.Disable(GL_DEBUG_OUTPUT);
        for (const GLenum code : errors_)
            switch (code) {
            case GL_INVALID_ENUM: gl_.Enable(GL_NONE); break;
            case GL_INVALID_VALUE: gl_.BindSampler(~0u, 0); break;        // there is no such unit
            case GL_INVALID_OPERATION: gl_.EndConditionalRender(); break; // none is active
            default: clear_without_targets();
            }
        detail::turn(gl_, GL_DEBUG_OUTPUT, heard);
        errors_.clear();
    }
    /// Clears an incomplete framebuffer, which is an error.
    void clear_without_targets()
    {
        GLuint framebuffer = 0;
        constexpr std::array<GLfloat, 4> zero{};
        gl_.CreateFramebuffers(1, &framebuffer);
        gl_.ClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, zero.data());
        gl_.DeleteFramebuffers(1, &framebuffer);
    }

    void refuse_what_counts_or_discards()
    {
        constexpr std::array counters{std::pair{GL_SAMPLES_PASSED, "GL_SAMPLES_PASSED"},
            std::pair{GL_ANY_SAMPLES_PASSED, "GL_ANY_SAMPLES_PASSED"},
            std::pair{GL_ANY_SAMPLES_PASSED_CONSERVATIVE, "GL_ANY_SAMPLES_PASSED_CONSERVATIVE"},
            std::pair{GL_PRIMITIVES_GENERATED, "GL_PRIMITIVES_GENERATED"}};
        for (const auto& [target, name] : counters) {
            GLint active = 0;
            gl_.GetQueryiv(static_cast<GLenum>(target), GL_CURRENT_QUERY, &active);
            if (active != 0)
                throw backend_error(std::string("gl: a query of ") + name
                    + " is active and would count the library's drawing; call glEndQuery before the library");
        }
        if (detail::get(gl_, GL_TRANSFORM_FEEDBACK_ACTIVE) != 0 && detail::get(gl_, GL_TRANSFORM_FEEDBACK_PAUSED) == 0)
            throw backend_error("gl: transform feedback is active and would record the library's drawing; call "
                                "glPauseTransformFeedback or glEndTransformFeedback before the library");
        refuse_conditional_rendering();
    }
    /// OpenGL has no query for active conditional rendering, but beginning it twice is an error.
    void refuse_conditional_rendering()
    {
        if (!std::exchange(asked_, true)) { // conditional rendering needs a query that has a result
            gl_.BeginQuery(GL_SAMPLES_PASSED, question_);
            gl_.EndQuery(GL_SAMPLES_PASSED);
        }
        gl_.BeginConditionalRender(question_, GL_QUERY_NO_WAIT);
        if (gl_.GetError() != GL_NO_ERROR)
            throw backend_error("gl: conditional rendering is active and may discard the library's drawing; call "
                                "glEndConditionalRender before the library");
        gl_.EndConditionalRender();
    }

    functions& gl_;
    int depth_ = 0;
    std::vector<GLenum> errors_;
    std::optional<detail::debug_state> debug_;
    std::optional<detail::pass_state> passes_;
    std::optional<detail::stencil_state> stencil_;
    std::optional<detail::blend_state> blending_;
    std::optional<detail::pixel_state> pack_, unpack_;
    std::array<std::optional<detail::unit_state>, units> unit_states_;
    GLenum active_unit_ = 0; ///< 0: not saved
    GLuint question_;
    bool asked_ = false;
    GLDEBUGPROC hear_;
    const void* user_;
};

/// The scope of a call of the backend. `state` is null in the backend's own contexts.
class call_scope {
public:
    explicit call_scope(callers_state* state) : state_(state)
    {
        if (state_ != nullptr)
            state_->enter();
    }
    call_scope(const call_scope&) = delete;
    call_scope& operator=(const call_scope&) = delete;
    ~call_scope()
    {
        if (state_ != nullptr)
            state_->leave();
    }

private:
    callers_state* state_;
};

} // namespace photongrid::gl
