// Reads and sets single values of OpenGL's state.
#pragma once

#include <photongrid/backends/gl/functions.hpp>

namespace photongrid::gl::detail {

inline GLint get(functions& gl, GLenum what)
{
    GLint value = 0;
    gl.GetIntegerv(what, &value);
    return value;
}
inline GLuint get_name(functions& gl, GLenum what) { return static_cast<GLuint>(get(gl, what)); }
inline void turn(functions& gl, GLenum what, bool on) { on ? gl.Enable(what) : gl.Disable(what); }
inline void turn(functions& gl, GLenum what, GLuint index, bool on)
{
    on ? gl.Enablei(what, index) : gl.Disablei(what, index);
}

} // namespace photongrid::gl::detail
