// A file with vector code of its own and photongrid's cpu backend.
#include <photongrid/backends/cpu/cpu.hpp>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "doubled.hpp"
#include <hwy/foreach_target.h>
// The last of the instruction sets.
#include "doubled.hpp"

#include "../nearest.hpp"

namespace host {
HWY_EXPORT(doubled);
static void twice(const float* from, float* to) { HWY_DYNAMIC_DISPATCH(doubled)(from, to); }
} // namespace host

int main()
{
    const float numbers[] = {1, 2, 3, 4};
    float results[4];
    host::twice(numbers, results);
    photongrid::cpu_backend device;
    return results[3] == 8.0f ? consumer::nearest(device) : 1;
}
