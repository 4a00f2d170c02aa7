// An OpenGL device: a context, its limits, the objects that all passes use, and the caller's state.
#pragma once

#include <photongrid/backends/gl/callers_state.hpp>
#include <photongrid/backends/gl/context.hpp>
#include <photongrid/backends/gl/layout.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <optional>
#include <span>
#include <utility>

namespace photongrid::gl {

/// The state that a backend, its buffers and its programs share. Buffers may outlive the backend.
class device : public std::enable_shared_from_this<device> {
public:
    /// `debug`: collect the driver's messages of high severity.
    device(std::shared_ptr<context> c, bool debug) : context_(std::move(c)), call(context_->call)
    {
        std::array<GLint, 2> viewport{};
        GLint size = 0;
        call.GetIntegerv(GL_MAX_TEXTURE_SIZE, &size);
        call.GetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
        max_size = static_cast<uint>(std::min({size, viewport[0], viewport[1]}));
        std::array<GLfloat, 2> points{};
        call.GetFloatv(GL_POINT_SIZE_RANGE, points.data());
        max_point = static_cast<uint>(points[1]);
        call.GenVertexArrays(1, &vertices_);
        call.CreateFramebuffers(1, &targets_);
        call.CreateFramebuffers(1, &blank_);
        call.CreateBuffers(1, &uniforms_);
        call.NamedFramebufferParameteri(blank_, GL_FRAMEBUFFER_DEFAULT_WIDTH, static_cast<GLint>(row_width));
        // Kernels read unfiltered texels, also from a caller's texture.
        call.CreateSamplers(1, &sampler_);
        call.SamplerParameteri(sampler_, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        call.SamplerParameteri(sampler_, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        if (context_->is_callers()) {
            call.CreateQueries(GL_SAMPLES_PASSED, 1, &question_);
            callers_.emplace(call, question_, debug ? note_message : nullptr, this);
            return;
        }
        if (debug)
            detail::hear_driver(call, note_message, this);
        set_state();
        for (GLuint unit = 0; unit < units; ++unit)
            call.BindSampler(unit, sampler_);
    }
    device(const device&) = delete;
    device& operator=(const device&) = delete;
    ~device()
    {
        try {
            context_->use();
        } catch (const backend_error&) {
            return; // the caller's context was destroyed, and all its objects
        }
        call.DeleteVertexArrays(1, &vertices_);
        call.DeleteFramebuffers(1, &targets_);
        call.DeleteFramebuffers(1, &blank_);
        call.DeleteBuffers(1, &uniforms_);
        call.DeleteSamplers(1, &sampler_);
        if (callers_)
            call.DeleteQueries(1, &question_);
        else
            call.DebugMessageCallback(nullptr, nullptr); // the callback's user pointer may be `this`
    }

    /// Every call of the backend creates this scope first. It makes the context current; its destructor restores a
    /// caller's state.
    [[nodiscard]] call_scope use()
    {
        make_current();
        return call_scope(callers_ ? &*callers_ : nullptr);
    }
    /// Sufficient for calls that change no state, such as deleting objects.
    void make_current() { context_->use(); }
    bool is_callers() const { return callers_.has_value(); }

    /// To be called before the first pass of a verb, before an upload, and before a download.
    void prepare_passes()
    {
        if (callers_ && callers_->save_passes())
            set_state();
    }
    void prepare_upload()
    {
        if (callers_)
            callers_->set_transfer(detail::pixel_state::unpack);
    }
    void prepare_download()
    {
        if (callers_)
            callers_->set_transfer(detail::pixel_state::pack);
    }
    /// To be called before this state is changed; keep_stencil() while an 8-bit stencil buffer is bound.
    void keep_stencil()
    {
        if (callers_)
            callers_->save_stencil();
    }
    void keep_blending()
    {
        if (callers_)
            callers_->save_blending();
    }
    /// Binds `texture` to this unit; 0: none.
    void bind_texture(GLuint unit, GLuint texture)
    {
        if (callers_ && callers_->save_unit(unit))
            call.BindSampler(unit, sampler_);
        if (texture != 0) {
            call.BindTextureUnit(unit, texture);
        } else { // glBindTextureUnit(unit, 0) would unbind the textures of all targets
            call.ActiveTexture(GL_TEXTURE0 + unit);
            call.BindTexture(GL_TEXTURE_2D, 0);
        }
    }
    void set_viewport(GLint x, GLint y, GLsizei width, GLsizei height)
    {
        call.ViewportIndexedf(0, static_cast<GLfloat>(x), static_cast<GLfloat>(y), static_cast<GLfloat>(width),
            static_cast<GLfloat>(height));
    }

    /// Binds a framebuffer whose colour targets are `textures`.
    void draw_into(std::span<const GLuint> textures)
    {
        for (std::size_t t = 0; t < max_outputs; ++t) {
            const GLuint id = t < textures.size() ? textures[t] : 0;
            if (attached_[t] != id)
                call.NamedFramebufferTexture(targets_, GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(t), id, 0);
            attached_[t] = id;
        }
        if (textures.size() != target_count_) {
            constexpr std::array<GLenum, max_outputs> all{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1,
                GL_COLOR_ATTACHMENT2, GL_COLOR_ATTACHMENT3, GL_COLOR_ATTACHMENT4, GL_COLOR_ATTACHMENT5,
                GL_COLOR_ATTACHMENT6, GL_COLOR_ATTACHMENT7};
            call.NamedFramebufferDrawBuffers(targets_, static_cast<GLsizei>(textures.size()), all.data());
            target_count_ = textures.size();
        }
        call.BindFramebuffer(GL_DRAW_FRAMEBUFFER, targets_);
        check_framebuffer(targets_);
    }
    /// To be called before a texture is deleted.
    void forget(GLuint id)
    {
        // The name of a deleted texture can be reused; forget that it is attached to the framebuffer.
        for (std::size_t t = 0; t < max_outputs; ++t)
            if (attached_[t] == id) {
                call.NamedFramebufferTexture(targets_, GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(t), 0, 0);
                attached_[t] = 0;
            }
    }
    /// Clears the first target of `draw_into` to `value`.
    void clear_targets(const std::array<GLfloat, 4>& value)
    {
        call.ClearNamedFramebufferfv(targets_, GL_COLOR, 0, value.data());
    }
    /// Binds a framebuffer without targets, with `rows` rows of a buffer, for passes that only count.
    void draw_into_nothing(uint rows)
    {
        const uint height = std::bit_ceil(rows);
        if (height != blank_height_)
            call.NamedFramebufferParameteri(
                blank_, GL_FRAMEBUFFER_DEFAULT_HEIGHT, static_cast<GLint>(std::min(height, max_size)));
        blank_height_ = height;
        call.BindFramebuffer(GL_DRAW_FRAMEBUFFER, blank_);
        check_framebuffer(blank_);
    }
    void check_framebuffer(GLuint framebuffer)
    {
        const GLenum status = call.CheckNamedFramebufferStatus(framebuffer, GL_DRAW_FRAMEBUFFER);
        if (status != GL_FRAMEBUFFER_COMPLETE)
            throw backend_error(name() + ": the driver cannot draw into these targets (framebuffer status "
                + std::to_string(status)
                + "); float and integer render targets and framebuffers without targets are needed, as OpenGL 4.5 "
                  "prescribes");
    }

    /// Sets a kernel's Params, which std140 lays out as C++ does (docs/design/design.md).
    void set_uniforms(const void* data, std::size_t size)
    {
        const auto* first = static_cast<const std::byte*>(data);
        std::vector<std::byte> block(first, first + size);
        block.resize((size + 15) / 16 * 16);
        if (block == uniform_bytes_)
            return;
        call.NamedBufferData(uniforms_, static_cast<GLsizeiptr>(block.size()), block.data(), GL_STREAM_DRAW);
        uniform_bytes_ = std::move(block);
    }

    /// \throws backend_error for an OpenGL error since the last check.
    void check_errors(const std::string& what)
    {
        const GLenum code = call.GetError();
        if (code == GL_NO_ERROR)
            return;
        while (call.GetError() != GL_NO_ERROR) {}
        throw backend_error(name() + ": " + what + ": " + error_name(code)
            + (messages.empty() ? "" : "\n" + std::exchange(messages, {})));
    }

    const std::string& name() const { return context_->name; }

private:
    /// Sets all state that passes rely on; pass_state (saved_state.hpp) saves it. In the backend's own contexts it
    /// stays set.
    void set_state()
    {
        for (const GLenum off : off_in_passes)
            call.Disable(off);
        call.Enable(GL_PROGRAM_POINT_SIZE);
        call.Disablei(GL_SCISSOR_TEST, 0);
        for (GLuint t = 0; t < max_outputs; ++t) {
            call.Disablei(GL_BLEND, t);
            call.ColorMaski(t, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        }
        call.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
        call.ClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
        call.BindVertexArray(vertices_);
        call.BindBuffer(GL_QUERY_BUFFER, 0); // otherwise query results would be written to it
        call.BindBufferBase(GL_UNIFORM_BUFFER, 0, uniforms_);
    }
    static void APIENTRY note_message(
        GLenum, GLenum, GLuint, GLenum severity, GLsizei length, const GLchar* text, const void* user)
    {
        if (severity == GL_DEBUG_SEVERITY_HIGH)
            static_cast<device*>(const_cast<void*>(user))->messages
                += std::string(text, static_cast<std::size_t>(std::max(length, 0))) + "\n";
    }

    std::shared_ptr<context> context_;

public:
    functions& call;
    uint max_size = 0;  ///< texels along an edge
    uint max_point = 0; ///< pixels
    std::uint64_t bytes = 0, peak_bytes = 0;
    std::string messages; ///< from the driver, in debug contexts

private:
    std::optional<callers_state> callers_; ///< empty in the backend's own contexts
    GLuint vertices_ = 0, targets_ = 0, blank_ = 0, uniforms_ = 0, sampler_ = 0, question_ = 0;
    std::array<GLuint, max_outputs> attached_{};
    std::size_t target_count_ = 1;
    uint blank_height_ = 0;
    std::vector<std::byte> uniform_bytes_;
};

} // namespace photongrid::gl
