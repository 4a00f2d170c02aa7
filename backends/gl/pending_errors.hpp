// Keeps the errors that were pending before a call of this backend, so that the caller's next glGetError returns them.
#pragma once

#include <photongrid/backends/gl/state_values.hpp>

#include <array>
#include <vector>

namespace photongrid::gl {

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
    /// The caller's pending errors, during one call.
    class pending_errors {
    public:
        explicit pending_errors(functions& call) : gl_(call) {}

        /// Takes them.
        /// \throws backend_error for one that cannot be caused again, such as GL_OUT_OF_MEMORY.
        void keep()
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
        void give_back() noexcept
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

    private:
        /// Clears an incomplete framebuffer, which is an error.
        void clear_without_targets()
        {
            GLuint framebuffer = 0;
            constexpr std::array<GLfloat, 4> zero{};
            gl_.CreateFramebuffers(1, &framebuffer);
            gl_.ClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, zero.data());
            gl_.DeleteFramebuffers(1, &framebuffer);
        }

        functions& gl_;
        std::vector<GLenum> errors_;
    };
} // namespace detail

} // namespace photongrid::gl
