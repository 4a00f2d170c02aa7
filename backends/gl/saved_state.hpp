// The groups of OpenGL state that calls of this backend change. An object of a group saves it when it is made;
// restore() sets it again.
#pragma once

#include <photongrid/backends/gl/pass_setup.hpp>
#include <photongrid/backends/gl/program_in_use.hpp>

namespace photongrid::gl::detail {

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
            && polygon_mode_[1] != polygon_mode_[0]) // compatibility contexts have separate modes for front and back
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
        : sides_{
            side{GL_FRONT, get_name(gl, GL_STENCIL_FUNC), get(gl, GL_STENCIL_REF), get_name(gl, GL_STENCIL_VALUE_MASK),
                get_name(gl, GL_STENCIL_FAIL), get_name(gl, GL_STENCIL_PASS_DEPTH_FAIL),
                get_name(gl, GL_STENCIL_PASS_DEPTH_PASS), get_name(gl, GL_STENCIL_WRITEMASK)},
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
    static constexpr names pack_names{GL_PACK_ALIGNMENT, GL_PACK_ROW_LENGTH, GL_PACK_IMAGE_HEIGHT, GL_PACK_SKIP_PIXELS,
        GL_PACK_SKIP_ROWS, GL_PACK_SKIP_IMAGES, GL_PACK_SWAP_BYTES};
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

} // namespace photongrid::gl::detail
