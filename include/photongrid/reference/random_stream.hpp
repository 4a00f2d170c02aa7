// Random numbers of the reference renderer: one stream per pixel and per group of light paths, so that results do not
// depend on threads. It shares nothing with core/random.glsl.
#pragma once

#include <cstdint>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// Stream number `id` of `seed` for a purpose. xoshiro256++ filled by splitmix64 (Blackman and Vigna, Scrambled
/// Linear Pseudorandom Number Generators, ACM TOMS 47(4), 2021).
class random_stream {
public:
    /// `purpose` distinguishes streams with the same seed and id: 1 for groups of light paths, 2 for pixels.
    random_stream(std::uint64_t seed, std::uint64_t purpose, std::uint64_t id)
    {
        std::uint64_t x = mixed(mixed(mixed(seed) ^ purpose) ^ id);
        for (auto& s : state_)
            s = mixed(x += 0x9E3779B97F4A7C15u);
    }

    /// In [0, 1), 53 bits.
    double operator()()
    {
        const std::uint64_t bits = rotated(state_[0] + state_[3], 23) + state_[0];
        const std::uint64_t t = state_[1] << 17;
        state_[2] ^= state_[0];
        state_[3] ^= state_[1];
        state_[1] ^= state_[2];
        state_[0] ^= state_[3];
        state_[2] ^= t;
        state_[3] = rotated(state_[3], 45);
        return static_cast<double>(bits >> 11) * 0x1p-53;
    }

private:
    static std::uint64_t rotated(std::uint64_t x, int n) { return (x << n) | (x >> (64 - n)); }
    static std::uint64_t mixed(std::uint64_t z)
    {
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        return z ^ (z >> 31);
    }
    std::uint64_t state_[4];
};

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
