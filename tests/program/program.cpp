// The program from outside: what it prints, writes and returns.
#include "command_tests.hpp"
#include "estimate_option_tests.hpp"
#include "interrupt_tests.hpp"
