// Refuses to draw while the caller's OpenGL state would count, record or discard the drawing, and cannot be restored.
#pragma once

#include <photongrid/backends/gl/state_values.hpp>

#include <array>
#include <utility>

namespace photongrid::gl::detail {

/// The check for such state.
class undisturbed {
public:
    /// `question`: an occlusion query for internal use.
    undisturbed(functions& call, GLuint question) : gl_(call), question_(question) {}

    /// \throws backend_error that says what is active.
    void check()
    {
        constexpr std::array counters{std::pair{GL_SAMPLES_PASSED, "GL_SAMPLES_PASSED"},
            std::pair{GL_ANY_SAMPLES_PASSED, "GL_ANY_SAMPLES_PASSED"},
            std::pair{GL_ANY_SAMPLES_PASSED_CONSERVATIVE, "GL_ANY_SAMPLES_PASSED_CONSERVATIVE"},
            std::pair{GL_PRIMITIVES_GENERATED, "GL_PRIMITIVES_GENERATED"}};
        for (const auto& [target, name] : counters) {
            GLint active = 0;
            gl_.GetQueryiv(static_cast<GLenum>(target), GL_CURRENT_QUERY, &active);
            if (active != 0)
                throw backend_error(std::string("gl: a query of ") + name
                    + " is active and would count the library's drawing; call glEndQuery before the library");
        }
        if (detail::get(gl_, GL_TRANSFORM_FEEDBACK_ACTIVE) != 0 && detail::get(gl_, GL_TRANSFORM_FEEDBACK_PAUSED) == 0)
            throw backend_error("gl: transform feedback is active and would record the library's drawing; call "
                                "glPauseTransformFeedback or glEndTransformFeedback before the library");
        refuse_conditional_rendering();
    }

private:
    /// OpenGL has no query for active conditional rendering, but beginning it twice is an error.
    void refuse_conditional_rendering()
    {
        if (!std::exchange(asked_, true)) { // conditional rendering needs a query that has a result
            gl_.BeginQuery(GL_SAMPLES_PASSED, question_);
            gl_.EndQuery(GL_SAMPLES_PASSED);
        }
        gl_.BeginConditionalRender(question_, GL_QUERY_NO_WAIT);
        if (gl_.GetError() != GL_NO_ERROR)
            throw backend_error("gl: conditional rendering is active and may discard the library's drawing; call "
                                "glEndConditionalRender before the library");
        gl_.EndConditionalRender();
    }

    functions& gl_;
    GLuint question_;
    bool asked_ = false;
};

} // namespace photongrid::gl::detail
