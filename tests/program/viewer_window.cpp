// The window from outside: on a display of its own (Xvfb), driven by mouse and keys, looked at by screenshots.
#include "window_control_tests.hpp"
#include "window_scene_tests.hpp"
#include "window_tests.hpp"
