// Does not compile, on purpose: tests/CMakeLists.txt asks the C++ compiler where the mistake is.

#include <photongrid/core/begin.hpp>
namespace photongrid::kernels {
struct broken {
#include "broken_kernel.glsl"
};
} // namespace photongrid::kernels
#include <photongrid/core/end.hpp>
