// Does not compile, on purpose: tests/CMakeLists.txt asks the C++ compiler where the mistake is.

#include <photongrid/backend/begin.hpp>
namespace photongrid::kernels {
struct broken {
#include "broken_kernel.glsl"
};
} // namespace photongrid::kernels
#include <photongrid/backend/end.hpp>
