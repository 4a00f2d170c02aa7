// A program with an OpenGL context of its own: the library sorts the program's texture and returns a texture.
#include <photongrid/backends/gl/gl.hpp>
#include <photongrid/map/grid_index.hpp>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <iostream>

namespace {

template <class Function>
Function find(const char* name)
{
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

/// A context without a window; a program with a window creates its context as usual.
bool make_context_current()
{
    const EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API))
        return false;
    constexpr EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5,
        EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    return context != EGL_NO_CONTEXT && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
}

} // namespace

int main()
{
    if (!make_context_current()) {
        std::cerr << "no OpenGL 4.5 here (Debian packages libegl1, libgl1-mesa-dri)\n";
        return 77; // ctest: skipped
    }
    const auto create_textures = find<PFNGLCREATETEXTURESPROC>("glCreateTextures");
    const auto texture_storage = find<PFNGLTEXTURESTORAGE2DPROC>("glTextureStorage2D");
    const auto write_texels = find<PFNGLTEXTURESUBIMAGE2DPROC>("glTextureSubImage2D");
    const auto read_texels = find<PFNGLGETTEXTUREIMAGEPROC>("glGetTextureImage");
    const auto delete_textures = find<PFNGLDELETETEXTURESPROC>("glDeleteTextures");

    // The program's texture: (key, value) pairs, which a shader of its own may have drawn there.
    const std::array<glm::uvec2, 4> texels{glm::uvec2(30, 0), {10, 1}, {20, 2}, {10, 3}};
    GLuint texture = 0;
    create_textures(GL_TEXTURE_2D, 1, &texture);
    texture_storage(texture, 1, GL_RG32UI, 4, 1);
    write_texels(texture, 0, 0, 0, 4, 1, GL_RG_INTEGER, GL_UNSIGNED_INT, texels.data());

    photongrid::gl_texture index;
    {
        photongrid::gl_backend backend({.context = photongrid::gl_context_kind::current});
        auto pairs = backend.adopt<glm::uvec2>(texture, 4); // a buffer over the program's texture
        photongrid::bitonic_sort(backend, pairs);           // the texture is now sorted
        auto first_of_key = photongrid::grid_index(backend, pairs, 40);
        index = backend.release(std::move(first_of_key)); // now owned by the program
    }

    std::array<glm::uvec2, 4> sorted{};
    read_texels(texture, 0, GL_RG_INTEGER, GL_UNSIGNED_INT, sizeof sorted, sorted.data());
    for (const auto& pair : sorted)
        std::cout << pair.x << " -> " << pair.y << '\n'; // 10 -> 1, 10 -> 3, 20 -> 2, 30 -> 0
    std::cout << "an index of " << index.width << " x " << index.height << " texels\n";
    delete_textures(1, &texture);
    delete_textures(1, &index.name);
}
