// Searches that complete their elements in order, so many a pass.
#pragma once

#include <photongrid/core/backend.hpp>

#include <algorithm>
#include <cstddef>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::cpu {

/// The elements that the next passes complete, and what advance() returns for them.
struct next_part {
    std::size_t end = 0; ///< one past the last
    progress made;
};

/// At most `passes` more passes over n elements, `begin` of which are complete.
inline next_part next_passes(std::size_t n, std::size_t begin, std::size_t per_pass, uint passes)
{
    const std::size_t left = (n - begin + per_pass - 1) / per_pass;
    const auto now = static_cast<uint>(std::min<std::size_t>(passes, left));
    next_part p;
    p.end = std::min(n, begin + now * per_pass);
    p.made.passes = now;
    for (uint i = 0; i < now; ++i)
        p.made.active.push_back(n - begin - i * per_pass);
    p.made.finished = p.end == n;
    return p;
}

} // namespace photongrid::cpu

#include <photongrid/core/exact_end.hpp>
