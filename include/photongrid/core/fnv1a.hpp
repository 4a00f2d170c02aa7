// 64-bit FNV-1a: checksum of cached GPU programs, --resume files and (on 8-byte words) map files.
#pragma once

#include <cstdint>
#include <string_view>

namespace photongrid::detail {

inline constexpr std::uint64_t fnv1a_offset = 0xCBF29CE484222325u;
inline constexpr std::uint64_t fnv1a_prime = 0x100000001B3u;

/// The 64-bit FNV-1a hash of some bytes (Fowler, Noll and Vo).
constexpr std::uint64_t fnv1a(std::string_view bytes)
{
    std::uint64_t h = fnv1a_offset;
    for (const char c : bytes)
        h = (h ^ static_cast<unsigned char>(c)) * fnv1a_prime;
    return h;
}
static_assert(fnv1a("foobar") == 0x85944171F73967E8u); // from the authors' test vectors

} // namespace photongrid::detail
