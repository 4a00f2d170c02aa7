// Whether passes that read what they write are kept apart. Software drivers draw in order, so a missing texture barrier
// gives no wrong result there: the calls themselves are watched.
#pragma once

#include "gl_caller.hpp"

#include <map>
#include <set>

namespace photongrid::testing {
namespace {

    /// Watches draws that read a texture to which they also write. OpenGL defines such a read only if a texture barrier
    /// lies between it and the write of a draw before (OpenGL 4.5, section 9.3.1).
    template <class Kind>
    struct feedback_watch {
        static inline std::uint64_t reads = 0;   ///< textures that draws read and wrote
        static inline std::uint64_t hazards = 0; ///< of these, those that a draw had written since the last barrier

        static void (*find(const char* name))()
        {
            const auto hook = [name](const char* hooked, auto& original, auto replacement) -> void (*)() {
                if (name != std::string(hooked))
                    return nullptr;
                original = reinterpret_cast<std::remove_reference_t<decltype(original)>>(Kind::find(name));
                return reinterpret_cast<void (*)()>(replacement);
            };
            for (auto* found : {hook("glTextureBarrier", barrier_, &barrier), hook("glDrawArrays", draw_, &draw),
                     hook("glBindFramebuffer", bind_target_, &bind_target),
                     hook("glNamedFramebufferTexture", attach_, &attach), hook("glBindTextureUnit", bind_, &bind),
                     hook("glDeleteTextures", remove_, &remove)})
                if (found != nullptr)
                    return found;
            return Kind::find(name);
        }

    private:
        static void APIENTRY barrier()
        {
            written_.clear();
            barrier_();
        }
        static void APIENTRY draw(GLenum mode, GLint first, GLsizei count)
        {
            std::set<GLuint> targets;
            for (const auto& [attachment, texture] : attached_[target_])
                targets.insert(texture);
            for (const GLint unit : units_of_program())
                if (const GLuint texture = units_[static_cast<GLuint>(unit)];
                    texture != 0 && targets.count(texture) > 0) {
                    ++reads;
                    hazards += written_.count(texture);
                }
            written_.insert(targets.begin(), targets.end());
            draw_(mode, first, count);
        }
        /// The texture units that the program in use reads.
        static std::vector<GLint> units_of_program()
        {
            const auto get_integer = reinterpret_cast<PFNGLGETINTEGERVPROC>(Kind::find("glGetIntegerv"));
            const auto get_program = reinterpret_cast<PFNGLGETPROGRAMIVPROC>(Kind::find("glGetProgramiv"));
            const auto get_uniform = reinterpret_cast<PFNGLGETUNIFORMIVPROC>(Kind::find("glGetUniformiv"));
            const auto get_active = reinterpret_cast<PFNGLGETACTIVEUNIFORMPROC>(Kind::find("glGetActiveUniform"));
            const auto get_location = reinterpret_cast<PFNGLGETUNIFORMLOCATIONPROC>(Kind::find("glGetUniformLocation"));
            GLint program = 0, uniforms = 0;
            get_integer(GL_CURRENT_PROGRAM, &program);
            get_program(GLuint(program), GL_ACTIVE_UNIFORMS, &uniforms);
            std::vector<GLint> units;
            for (GLuint u = 0; u < GLuint(uniforms); ++u) {
                char name[256];
                GLint size = 0, unit = 0;
                GLenum type = 0;
                get_active(GLuint(program), u, sizeof name, nullptr, &size, &type, name);
                if (type != GL_SAMPLER_2D && type != GL_UNSIGNED_INT_SAMPLER_2D)
                    continue;
                get_uniform(GLuint(program), get_location(GLuint(program), name), &unit);
                units.push_back(unit);
            }
            return units;
        }
        static void APIENTRY bind_target(GLenum kind, GLuint framebuffer)
        {
            if (kind != GL_READ_FRAMEBUFFER)
                target_ = framebuffer;
            bind_target_(kind, framebuffer);
        }
        static void APIENTRY attach(GLuint framebuffer, GLenum attachment, GLuint texture, GLint level)
        {
            attached_[framebuffer][attachment] = texture;
            attach_(framebuffer, attachment, texture, level);
        }
        static void APIENTRY bind(GLuint unit, GLuint texture)
        {
            units_[unit] = texture;
            bind_(unit, texture);
        }
        static void APIENTRY remove(GLsizei n, const GLuint* textures)
        {
            for (GLsizei i = 0; i < n; ++i) {
                written_.erase(textures[i]);
                for (auto& [unit, texture] : units_)
                    texture = texture == textures[i] ? 0 : texture;
            }
            remove_(n, textures);
        }

        static inline std::map<GLuint, std::map<GLenum, GLuint>> attached_;
        static inline std::map<GLuint, GLuint> units_;
        static inline std::set<GLuint> written_; ///< since the last barrier
        static inline GLuint target_ = 0;
        static inline PFNGLTEXTUREBARRIERPROC barrier_ = nullptr;
        static inline PFNGLDRAWARRAYSPROC draw_ = nullptr;
        static inline PFNGLBINDFRAMEBUFFERPROC bind_target_ = nullptr;
        static inline PFNGLNAMEDFRAMEBUFFERTEXTUREPROC attach_ = nullptr;
        static inline PFNGLBINDTEXTUREUNITPROC bind_ = nullptr;
        static inline PFNGLDELETETEXTURESPROC remove_ = nullptr;
    };

    TYPED_TEST(gl_callers_context, draws_that_read_what_they_write_are_kept_apart)
    {
        using watch = feedback_watch<TypeParam>;
        gl_backend b({.context = gl_context_kind::current, .find = &watch::find});
        for (const uint m : {0u, 4u})
            (void)results(b, m);
        EXPECT_GT(watch::reads, 100u);
        EXPECT_EQ(watch::hazards, 0u);
    }

} // namespace
} // namespace photongrid::testing
