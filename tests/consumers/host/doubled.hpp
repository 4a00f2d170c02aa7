// Vector code of the host's own, as Highway would have it: read once for every instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace host::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline void doubled(const float* from, float* to)
{
    const hn::CappedTag<float, 4> d;
    for (std::size_t i = 0; i < 4; i += hn::Lanes(d))
        hn::StoreU(hn::Add(hn::LoadU(d, from + i), hn::LoadU(d, from + i)), d, to + i);
}

} // namespace host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
