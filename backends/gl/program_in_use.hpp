// Saves and restores the program in use.
#pragma once

#include <photongrid/backends/gl/state_values.hpp>

#include <array>
#include <vector>

namespace photongrid::gl::detail {

/// The program in use, and the selected subroutines, which glUseProgram resets, also those of a program pipeline.
class program_in_use {
public:
    explicit program_in_use(functions& gl) : program_(get_name(gl, GL_CURRENT_PROGRAM))
    {
        if (program_ != 0) {
            GLint dying = 0, linked = 0;
            gl.GetProgramiv(program_, GL_DELETE_STATUS, &dying);
            gl.GetProgramiv(program_, GL_LINK_STATUS, &linked);
            if (dying || !linked)
                throw backend_error("gl: the program in use, " + std::to_string(program_)
                    + (dying ? ", is marked for deletion" : ", failed to link again after glUseProgram")
                    + ": it could not be restored; call glUseProgram with another program, or with 0, before the "
                      "library");
        }
        const GLuint pipeline = program_ != 0 ? 0 : get_name(gl, GL_PROGRAM_PIPELINE_BINDING);
        if (program_ == 0 && pipeline == 0)
            return;
        for (std::size_t s = 0; s < stages.size(); ++s) {
            GLint program = static_cast<GLint>(program_), n = 0;
            if (pipeline != 0)
                gl.GetProgramPipelineiv(pipeline, stages[s], &program);
            if (program != 0)
                gl.GetProgramInterfaceiv(static_cast<GLuint>(program), subroutine_uniforms[s], GL_ACTIVE_RESOURCES, &n);
            if (n == 0) // also if the program lacks this stage, for which the next call would be an error
                continue;
            gl.GetProgramStageiv(static_cast<GLuint>(program), stages[s], GL_ACTIVE_SUBROUTINE_UNIFORM_LOCATIONS, &n);
            subroutines_[s].resize(static_cast<std::size_t>(n));
            for (GLint l = 0; l < n; ++l)
                gl.GetUniformSubroutineuiv(stages[s], l, &subroutines_[s][static_cast<std::size_t>(l)]);
        }
    }
    void restore(functions& gl) const
    {
        gl.UseProgram(program_);
        for (std::size_t s = 0; s < stages.size(); ++s)
            if (!subroutines_[s].empty())
                gl.UniformSubroutinesuiv(
                    stages[s], static_cast<GLsizei>(subroutines_[s].size()), subroutines_[s].data());
    }

private:
    static constexpr std::array<GLenum, 6> stages{GL_VERTEX_SHADER, GL_TESS_CONTROL_SHADER, GL_TESS_EVALUATION_SHADER,
        GL_GEOMETRY_SHADER, GL_FRAGMENT_SHADER, GL_COMPUTE_SHADER};
    static constexpr std::array<GLenum, 6> subroutine_uniforms{GL_VERTEX_SUBROUTINE_UNIFORM,
        GL_TESS_CONTROL_SUBROUTINE_UNIFORM, GL_TESS_EVALUATION_SUBROUTINE_UNIFORM, GL_GEOMETRY_SUBROUTINE_UNIFORM,
        GL_FRAGMENT_SUBROUTINE_UNIFORM, GL_COMPUTE_SUBROUTINE_UNIFORM};
    GLuint program_;
    std::array<std::vector<GLuint>, 6> subroutines_;
};

} // namespace photongrid::gl::detail
