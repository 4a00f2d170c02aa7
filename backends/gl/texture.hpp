// Textures of a device. They share ownership of it, so a buffer may outlive its backend.
#pragma once

#include <photongrid/backends/gl/device.hpp>

namespace photongrid::gl {

/// A texture, or none.
class texture {
public:
    /// Creates an uninitialised texture.
    /// \throws backend_error with the numbers if the device has no room.
    static texture make(
        device& on, GLenum internal, uint width, uint height, std::size_t texel_bytes, const std::string& what);
    /// Wraps a texture that the caller continues to own.
    static texture adopt(device& on, GLuint id, uint width, uint height);

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
        try {
            if (const GLuint mine = let_go(); mine != 0 && !adopted_)
                device_->call.DeleteTextures(1, &mine);
        } catch (const backend_error&) { // the caller's context is not current; its textures are destroyed with it
        }
    }
    /// Releases the texture to the caller; 0: none.
    GLuint let_go()
    {
        if (id == 0)
            return 0;
        device_->bytes -= std::exchange(bytes_, 0);
        const GLuint given = std::exchange(id, 0);
        device_->make_current();
        device_->forget(given);
        return given;
    }

    /// Whether it belongs to this device; true if there is no texture.
    bool is_of(const device& d) const { return device_ == nullptr || device_.get() == &d; }

    GLuint id = 0;
    uint width = 0, height = 0;

private:
    void swap(texture& other) noexcept
    {
        std::swap(id, other.id);
        std::swap(width, other.width);
        std::swap(height, other.height);
        std::swap(bytes_, other.bytes_);
        std::swap(adopted_, other.adopted_);
        std::swap(device_, other.device_);
    }
    std::uint64_t bytes_ = 0;
    bool adopted_ = false; ///< owned by the caller: neither counted nor deleted
    std::shared_ptr<device> device_;
};

inline texture texture::make(
    device& on, GLenum internal, uint width, uint height, std::size_t texel_bytes, const std::string& what)
{
    const auto text = [&] {
        return what + " (a texture of " + std::to_string(width) + " x " + std::to_string(height) + " texels)";
    };
    if (width > on.max_size || height > on.max_size)
        throw backend_error(on.name() + ": " + text() + ": this device's textures have at most "
            + std::to_string(on.max_size) + " x " + std::to_string(on.max_size));
    on.check_errors("before allocating");
    texture t;
    on.call.CreateTextures(GL_TEXTURE_2D, 1, &t.id);
    t.device_ = on.shared_from_this();
    t.width = width;
    t.height = height;
    t.bytes_ = std::uint64_t{width} * height * texel_bytes;
    on.bytes += t.bytes_;
    on.call.TextureStorage2D(t.id, 1, internal, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
    on.call.TextureParameteri(t.id, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    on.call.TextureParameteri(t.id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    on.check_errors(
        text() + ", " + std::to_string(t.bytes_) + " bytes beside " + std::to_string(on.bytes - t.bytes_) + " held");
    on.peak_bytes = std::max(on.peak_bytes, on.bytes);
    return t;
}

inline texture texture::adopt(device& on, GLuint id, uint width, uint height)
{
    texture t;
    t.id = id;
    t.width = width;
    t.height = height;
    t.adopted_ = true;
    t.device_ = on.shared_from_this();
    return t;
}

} // namespace photongrid::gl
