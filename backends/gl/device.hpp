// A context with its limits and the account of its memory, and buffers as textures on it.
#pragma once

#include <photongrid/backends/gl/context.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <utility>

namespace photongrid::gl {

/// Elements in a row of a buffer's texture; textures.glsl knows it as 2047u and 11u.
inline constexpr uint row_width = 2048;

/// Render targets of one pass, texture units for inputs, for states (textures.glsl, fragment_prelude.glsl).
inline constexpr std::size_t max_outputs = 8, max_inputs = 8, state_unit = 8;

/// How element type T is stored.
template <element T>
struct texture_format {
    static constexpr bool is_integer = std::same_as<T, uint> || std::same_as<T, glm::uvec2> || std::same_as<T, glm::uvec4>;
    static constexpr GLenum type = is_integer ? GL_UNSIGNED_INT : GL_FLOAT;
    static constexpr GLenum format = sizeof(T) == 4 ? (is_integer ? GL_RED_INTEGER : GL_RED) : sizeof(T) == 8 ? (is_integer ? GL_RG_INTEGER : GL_RG) : (is_integer ? GL_RGBA_INTEGER : GL_RGBA);
    static constexpr GLenum internal = sizeof(T) == 4 ? (is_integer ? GL_R32UI : GL_R32F) : sizeof(T) == 8 ? (is_integer ? GL_RG32UI : GL_RG32F) : (is_integer ? GL_RGBA32UI : GL_RGBA32F);
};

class texture;

/// What a backend, its buffers and its programs share. Buffers may outlive the backend.
class device : public std::enable_shared_from_this<device> {
public:
    explicit device(std::shared_ptr<context> c) : context_(std::move(c)), call(context_->call)
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
        set_state();
    }
    device(const device&) = delete;
    device& operator=(const device&) = delete;
    ~device()
    {
        try {
            context_->use();
        } catch (const backend_error&) {
            return; // the caller's context is gone, and everything in it
        }
        call.DeleteVertexArrays(1, &vertices_);
        call.DeleteFramebuffers(1, &targets_);
        call.DeleteFramebuffers(1, &blank_);
        call.DeleteBuffers(1, &uniforms_);
    }

    /// To be called first by every verb: makes the context current.
    void use()
    {
        context_->use();
        if (context_->is_callers())
            set_state();
    }

    /// An uninitialised texture. \throws backend_error with the numbers when the device refuses.
    texture make(GLenum internal, uint width, uint height, std::size_t texel_bytes, const std::string& what);

    /// Binds a framebuffer whose colour targets are `textures`.
    void draw_into(std::span<const GLuint> textures)
    {
        for (std::size_t t = 0; t < max_outputs; ++t) {
            const GLuint wanted = t < textures.size() ? textures[t] : 0;
            if (attached_[t] != wanted)
                call.NamedFramebufferTexture(targets_, GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(t), wanted, 0);
            attached_[t] = wanted;
        }
        if (textures.size() != target_count_) {
            constexpr std::array<GLenum, max_outputs> all{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2, GL_COLOR_ATTACHMENT3, GL_COLOR_ATTACHMENT4,
                GL_COLOR_ATTACHMENT5, GL_COLOR_ATTACHMENT6, GL_COLOR_ATTACHMENT7};
            call.NamedFramebufferDrawBuffers(targets_, static_cast<GLsizei>(textures.size()), all.data());
            target_count_ = textures.size();
        }
        call.BindFramebuffer(GL_DRAW_FRAMEBUFFER, targets_);
        check_framebuffer(targets_);
    }
    /// Fills the first target of `draw_into` with `value`.
    void clear_targets(const std::array<GLfloat, 4>& value) { call.ClearNamedFramebufferfv(targets_, GL_COLOR, 0, value.data()); }
    /// Binds a framebuffer without targets, of `rows` rows of a buffer: for passes that only count.
    void draw_into_nothing(uint rows)
    {
        const uint height = std::bit_ceil(rows);
        if (height != blank_height_)
            call.NamedFramebufferParameteri(blank_, GL_FRAMEBUFFER_DEFAULT_HEIGHT, static_cast<GLint>(std::min(height, max_size)));
        blank_height_ = height;
        call.BindFramebuffer(GL_DRAW_FRAMEBUFFER, blank_);
        check_framebuffer(blank_);
    }
    void check_framebuffer(GLuint framebuffer)
    {
        const GLenum status = call.CheckNamedFramebufferStatus(framebuffer, GL_DRAW_FRAMEBUFFER);
        if (status != GL_FRAMEBUFFER_COMPLETE)
            throw backend_error(name() + ": the driver cannot draw into these targets (framebuffer status " + std::to_string(status)
                + "); float and integer render targets and framebuffers without targets are needed, as OpenGL 4.5 prescribes");
    }

    /// The values of a kernel's Params, which std140 lays out as C++ does (docs/design.md).
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

    /// \throws backend_error when OpenGL has noted an error since the last check.
    void check_errors(const std::string& what)
    {
        const GLenum code = call.GetError();
        if (code == GL_NO_ERROR)
            return;
        while (call.GetError() != GL_NO_ERROR) { }
        const char* text = code == GL_OUT_OF_MEMORY ? "GL_OUT_OF_MEMORY: the device has no memory left for it"
            : code == GL_INVALID_ENUM               ? "GL_INVALID_ENUM"
            : code == GL_INVALID_VALUE              ? "GL_INVALID_VALUE"
            : code == GL_INVALID_OPERATION          ? "GL_INVALID_OPERATION"
            : code == GL_INVALID_FRAMEBUFFER_OPERATION ? "GL_INVALID_FRAMEBUFFER_OPERATION"
            : code == GL_CONTEXT_LOST               ? "GL_CONTEXT_LOST: the device was reset"
                                                    : "an unknown OpenGL error";
        throw backend_error(name() + ": " + what + ": " + text + (messages.empty() ? "" : "\n" + std::exchange(messages, {})));
    }

    const std::string& name() const { return context_->name; }

private:
    friend texture;
    void forget(GLuint id)
    {
        // A deleted texture's name comes back; the framebuffer must not be thought to hold it still.
        for (std::size_t t = 0; t < max_outputs; ++t)
            if (attached_[t] == id) {
                call.NamedFramebufferTexture(targets_, GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(t), 0, 0);
                attached_[t] = 0;
            }
    }
    /// Everything that the passes rely on. A context of our own keeps it; a caller's may come back changed.
    void set_state()
    {
        for (const int off : {GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_STENCIL_TEST, GL_SCISSOR_TEST, GL_RASTERIZER_DISCARD, GL_COLOR_LOGIC_OP, GL_DEPTH_CLAMP, GL_POLYGON_OFFSET_FILL,
                 GL_SAMPLE_MASK, GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_COVERAGE, GL_DITHER})
            call.Disable(static_cast<GLenum>(off));
        for (GLenum plane = 0; plane < 8; ++plane)
            call.Disable(GL_CLIP_DISTANCE0 + plane);
        call.Enable(GL_PROGRAM_POINT_SIZE);
        call.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        call.StencilMask(0xFFu);
        call.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
        call.ClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
        call.BindVertexArray(vertices_);
        call.BindBufferBase(GL_UNIFORM_BUFFER, 0, uniforms_);
        for (GLuint unit = 0; unit < max_inputs + max_outputs; ++unit)
            call.BindSampler(unit, 0);
        call.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
        call.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
        for (const auto& [name, value] : {std::pair<GLenum, GLint>{GL_PACK_ALIGNMENT, 4}, {GL_PACK_ROW_LENGTH, 0}, {GL_PACK_SKIP_ROWS, 0}, {GL_PACK_SKIP_PIXELS, 0}, {GL_PACK_SWAP_BYTES, 0},
                 {GL_UNPACK_ALIGNMENT, 4}, {GL_UNPACK_ROW_LENGTH, 0}, {GL_UNPACK_SKIP_ROWS, 0}, {GL_UNPACK_SKIP_PIXELS, 0}, {GL_UNPACK_SWAP_BYTES, 0}})
            call.PixelStorei(name, value);
    }

    std::shared_ptr<context> context_;

public:
    functions& call;
    uint max_size = 0;  ///< texels along an edge
    uint max_point = 0; ///< pixels
    std::uint64_t bytes = 0, peak_bytes = 0;
    std::string messages; ///< from the driver, in debug contexts

private:
    GLuint vertices_ = 0, targets_ = 0, blank_ = 0, uniforms_ = 0;
    std::array<GLuint, max_outputs> attached_{};
    std::size_t target_count_ = 1;
    uint blank_height_ = 0;
    std::vector<std::byte> uniform_bytes_;
};

/// A texture, or none.
class texture {
public:
    texture() = default;
    texture(texture&& other) noexcept { swap(other); }
    texture& operator=(texture&& other) noexcept
    {
        texture(std::move(other)).swap(*this);
        return *this;
    }
    texture(const texture&) = delete;
    texture& operator=(const texture&) = delete;
    ~texture()
    {
        if (id == 0)
            return;
        device_->bytes -= bytes_;
        try {
            device_->use();
            device_->forget(id);
            device_->call.DeleteTextures(1, &id);
        } catch (const backend_error&) { // the caller's context is not current: its textures die with it
        }
    }

    GLuint id = 0;
    uint width = 0, height = 0;

private:
    friend device;
    void swap(texture& other) noexcept
    {
        std::swap(id, other.id);
        std::swap(width, other.width);
        std::swap(height, other.height);
        std::swap(bytes_, other.bytes_);
        std::swap(device_, other.device_);
    }
    std::uint64_t bytes_ = 0;
    std::shared_ptr<device> device_;
};

inline texture device::make(GLenum internal, uint width, uint height, std::size_t texel_bytes, const std::string& what)
{
    const auto text = [&] { return what + " (a texture of " + std::to_string(width) + " x " + std::to_string(height) + " texels)"; };
    if (width > max_size || height > max_size)
        throw backend_error(name() + ": " + text() + ": this device's textures have at most " + std::to_string(max_size) + " x " + std::to_string(max_size));
    check_errors("before allocating");
    texture t;
    call.CreateTextures(GL_TEXTURE_2D, 1, &t.id);
    t.device_ = shared_from_this();
    t.width = width;
    t.height = height;
    t.bytes_ = std::uint64_t{width} * height * texel_bytes;
    bytes += t.bytes_;
    call.TextureStorage2D(t.id, 1, internal, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
    call.TextureParameteri(t.id, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    call.TextureParameteri(t.id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    check_errors(text() + ", " + std::to_string(t.bytes_) + " bytes beside " + std::to_string(bytes - t.bytes_) + " held");
    peak_bytes = std::max(peak_bytes, bytes);
    return t;
}

} // namespace photongrid::gl
