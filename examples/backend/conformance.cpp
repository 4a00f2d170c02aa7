// Every test that a backend has to pass, on the tracing backend.
#include "tracing_backend.hpp"

#include <photongrid/backend_tests.hpp>
#include <photongrid/backends/serial/serial.hpp>

PHOTONGRID_TEST_BACKEND(tracing, photongrid::examples::tracing_backend<photongrid::serial_backend>);
