// The program as a process: its output, files and exit codes.
#include "command_tests.hpp"
#include "error_command_tests.hpp"
#include "estimate_option_tests.hpp"
#include "first_scene_tests.hpp"
#include "interrupt_tests.hpp"
#include "module_tests.hpp"
#include "stop_rule_option_tests.hpp"
