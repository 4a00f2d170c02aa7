// The OpenGL backend against the serial one, bit for bit, on every kind of context that this machine has.
#include "gl_algorithm_tests.hpp"
#include "gl_buffer_tests.hpp"
#include "gl_context_tests.hpp"
#include "gl_contexts.hpp"
#include "gl_pass_tests.hpp"
