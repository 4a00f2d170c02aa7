// Buffers as textures for the caller, and the caller's textures as buffers, without copies through the CPU.
#pragma once

#include <photongrid/backends/gl/layout.hpp>

#include <stdexcept>
#include <string>

namespace photongrid {

/// A buffer as a texture: element i is the texel (i % 2048, i / 2048) of level 0. A buffer of up to 2048 elements is
/// one row, which may be shorter than 2048 texels; others are 2048 texels wide, and the rest of the last row is
/// undefined. The format is R32F, RG32F or RGBA32F for float, vec2 and vec4, R32UI, RG32UI or RGBA32UI for uint, uvec2
/// and uvec4.
/// \headerfile backends/gl/gl.hpp <photongrid/backends/gl/gl.hpp>
struct gl_texture {
    GLuint name = 0;            ///< 0 for a buffer without elements
    uint width = 0;             ///< texels
    uint height = 0;            ///< texels
    GLenum internal_format = 0; ///< GL_R32F, …; 0 for a buffer without elements
};

namespace gl {

    /// Checks that a caller's texture can be a buffer of n elements, and returns its size.
    /// \throws std::invalid_argument that says what is wrong.
    inline gl_texture check_adoptable(
        functions& gl, GLuint texture, std::size_t n, GLenum format, const char* format_name)
    {
        const auto fail = [&](const std::string& text) {
            throw std::invalid_argument("gl_backend::adopt: texture: " + std::to_string(texture) + " " + text);
        };
        if (texture == 0 || gl.IsTexture(texture) == GL_FALSE)
            fail("is not a texture of this context, or was never bound");
        const auto parameter = [&](GLenum what) {
            GLint value = 0;
            gl.GetTextureParameteriv(texture, what, &value);
            return value;
        };
        const auto level = [&](GLenum what) {
            GLint value = 0;
            gl.GetTextureLevelParameteriv(texture, 0, what, &value);
            return value;
        };
        if (parameter(GL_TEXTURE_TARGET) != GL_TEXTURE_2D)
            fail("is not a 2D texture; give one with the target GL_TEXTURE_2D");
        if (level(GL_TEXTURE_INTERNAL_FORMAT) != static_cast<GLint>(format))
            fail(
                std::string("has another internal format at level 0; buffers of this element type are ") + format_name);
        const auto width = static_cast<uint>(level(GL_TEXTURE_WIDTH)),
                   height = static_cast<uint>(level(GL_TEXTURE_HEIGHT));
        const std::size_t rows = (n + row_width - 1) / row_width;
        if (n <= row_width ? width < n : width != row_width || height < rows)
            fail("is " + std::to_string(width) + " x " + std::to_string(height) + "; " + std::to_string(n)
                + " elements need "
                + (n <= row_width ? "a width of " + std::to_string(n) + " at least"
                                  : "a width of " + std::to_string(row_width) + " and a height of "
                            + std::to_string(rows) + " at least"));
        if (parameter(GL_TEXTURE_BASE_LEVEL) != 0)
            fail("has GL_TEXTURE_BASE_LEVEL " + std::to_string(parameter(GL_TEXTURE_BASE_LEVEL))
                + "; elements are read from level 0");
        if (parameter(GL_TEXTURE_SWIZZLE_R) != GL_RED || parameter(GL_TEXTURE_SWIZZLE_G) != GL_GREEN
            || parameter(GL_TEXTURE_SWIZZLE_B) != GL_BLUE || parameter(GL_TEXTURE_SWIZZLE_A) != GL_ALPHA)
            fail("has a GL_TEXTURE_SWIZZLE; reset it, because it would change the elements");
        return {texture, width, height, format};
    }

} // namespace gl
} // namespace photongrid
