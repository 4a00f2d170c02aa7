// How the elements of a buffer lie in a texture.
#pragma once

#include <photongrid/backends/gl/functions.hpp>

namespace photongrid::gl {

/// The elements per row of a buffer's texture. textures.glsl has it as 2047u and 11u.
inline constexpr uint row_width = 2048;

/// The texture format of element type T.
template <element T>
struct texture_format {
    static constexpr bool is_integer
        = std::same_as<T, uint> || std::same_as<T, glm::uvec2> || std::same_as<T, glm::uvec4>;
    static constexpr GLenum type = is_integer ? GL_UNSIGNED_INT : GL_FLOAT;
    static constexpr GLenum format = sizeof(T) == 4 ? (is_integer ? GL_RED_INTEGER : GL_RED)
        : sizeof(T) == 8                            ? (is_integer ? GL_RG_INTEGER : GL_RG)
                                                    : (is_integer ? GL_RGBA_INTEGER : GL_RGBA);
    static constexpr GLenum internal = sizeof(T) == 4 ? (is_integer ? GL_R32UI : GL_R32F)
        : sizeof(T) == 8                              ? (is_integer ? GL_RG32UI : GL_RG32F)
                                                      : (is_integer ? GL_RGBA32UI : GL_RGBA32F);
    static constexpr const char* internal_name = sizeof(T) == 4 ? (is_integer ? "GL_R32UI" : "GL_R32F")
        : sizeof(T) == 8                                        ? (is_integer ? "GL_RG32UI" : "GL_RG32F")
                                                                : (is_integer ? "GL_RGBA32UI" : "GL_RGBA32F");
};

} // namespace photongrid::gl
