// What the SIMD code shares: its vectors of up to 16 lanes, and masks as bits. for_each_target.hpp includes it once per
// instruction set, before the files that use it, so it has no include guard; other files include simd.hpp.
#include <hwy/highway.h>

#include <photongrid/backends/cpu/buffer.hpp>
#include <photongrid/backends/cpu/overrides/compress_table.hpp>

#include <photongrid/core/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using floats = hn::CappedTag<float, lanes>;
using uints = hn::RebindToUnsigned<floats>;
using ints = hn::RebindToSigned<floats>;
using vector = hn::VFromD<floats>;

/// Stores the lanes of the mask contiguously, and undefined values in the rest of a register's width. Returns the
/// number of lanes in the mask. It does not use Highway's CompressStore: for short registers g++ copies its tables to
/// the stack at every call, which made the whole search five times slower with AVX2, and AVX-512's instruction that
/// compresses to memory is microcode on AMD's Zen 4, where it did the same.
template <class D, class Mask>
HWY_INLINE std::size_t store_some(D d, hn::VFromD<D> v, Mask mask, hn::TFromD<D>* to)
{
    constexpr std::size_t width = hn::MaxLanes(d);
    if constexpr (width > 1 && width <= 8) {
        std::uint8_t bits[8]; // StoreMaskBits writes up to 8 bytes
        const std::size_t some = hn::CountTrue(d, mask);
        hn::StoreMaskBits(d, mask, bits);
        const std::int32_t* const order = compress_table<width>[bits[0]].data();
        hn::StoreU(hn::TableLookupLanes(v, hn::SetTableIndices(d, order)), d, to);
        return some;
    } else {
        hn::StoreU(hn::Compress(v, mask), d, to);
        return hn::CountTrue(d, mask);
    }
}

/// The lanes of a mask as bits, the first lane lowest.
template <class D>
HWY_INLINE uint bits_of(D d, hn::Mask<D> mask)
{
    std::uint8_t bits[8] = {}; // StoreMaskBits writes up to 8 bytes
    hn::StoreMaskBits(d, mask, bits);
    return bits[0] | static_cast<uint>(bits[1]) << 8;
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/core/exact_end.hpp>
