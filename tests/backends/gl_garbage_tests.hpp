// Whether results depend on what memory held before. Drivers clear new textures or leave what was there, so a clear
// that is forgotten may never show: here every new texture is filled with a pattern of bits.
#pragma once

#include "gl_caller.hpp"

namespace photongrid::testing {
namespace {

    /// Finds OpenGL functions of a context, whose new textures hold a pattern of bits.
    template <class Kind>
    struct dirty_textures {
        static inline std::uint64_t filled = 0;

        static void (*find(const char* name))()
        {
            if (name != std::string("glTextureStorage2D"))
                return Kind::find(name);
            storage_ = reinterpret_cast<PFNGLTEXTURESTORAGE2DPROC>(Kind::find(name));
            fill_ = reinterpret_cast<PFNGLCLEARTEXIMAGEPROC>(Kind::find("glClearTexImage"));
            return reinterpret_cast<void (*)()>(&storage);
        }

    private:
        static void APIENTRY storage(GLuint texture, GLsizei levels, GLenum internal, GLsizei width, GLsizei height)
        {
            storage_(texture, levels, internal, width, height);
            constexpr GLuint pattern = 0x4B5A5A5Au; // as a float 1.4e7
            constexpr std::array<GLuint, 4> texel{pattern, pattern, pattern, pattern};
            constexpr std::array<std::array<GLenum, 3>, 8> formats{
                {{GL_R32F, GL_RED, GL_FLOAT}, {GL_RG32F, GL_RG, GL_FLOAT}, {GL_RGBA32F, GL_RGBA, GL_FLOAT},
                    {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT}, {GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT},
                    {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT},
                    {GL_STENCIL_INDEX8, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE},
                    {GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8}}};
            const auto* const f
                = std::find_if(formats.begin(), formats.end(), [&](const auto& of) { return of[0] == internal; });
            if (f == formats.end()) {
                ADD_FAILURE() << "a texture of the internal format " << internal << ", which this test does not know";
                return;
            }
            fill_(texture, 0, (*f)[1], (*f)[2], texel.data());
            ++filled;
        }

        static inline PFNGLTEXTURESTORAGE2DPROC storage_ = nullptr;
        static inline PFNGLCLEARTEXIMAGEPROC fill_ = nullptr;
    };

    TYPED_TEST(gl_callers_context, results_do_not_depend_on_what_memory_held)
    {
        using dirty = dirty_textures<TypeParam>;
        gl_backend b({.context = gl_context_kind::current, .find = &dirty::find});
        serial_backend cpu;
        for (const uint m : {0u, 1u, 2u, 4u}) // 0: sorted
            EXPECT_TRUE(same_results(results(b, m), results(cpu, m))) << "m " << m;
        EXPECT_GT(dirty::filled, 10u);
    }

} // namespace
} // namespace photongrid::testing
