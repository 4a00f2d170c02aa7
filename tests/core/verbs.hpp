// The fixture of tests of a backend's verbs.
#pragma once

#include "../map/photon_sets.hpp"
#include "under_test.hpp"
#include "verb_kernels.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

namespace photongrid::testing {

/// What std::invalid_argument says when `call` is refused; nothing where it is not.
template <class F>
std::string refusal(F&& call)
{
    try {
        call();
    } catch (const std::invalid_argument& e) {
        return e.what();
    }
    return {};
}

template <class Tag>
class verbs : public on_backend<Tag> {
protected:
    using B = typename Tag::type;

    template <class T>
    auto up(const std::vector<T>& host)
    {
        return this->b().upload(std::span<const T>(host));
    }
    static std::vector<uint> random_words(std::size_t n, std::uint64_t seed)
    {
        random_source u(seed);
        std::vector<uint> words(n);
        for (auto& w : words)
            w = u.below(0xFFFFFFFFu);
        return words;
    }
    /// Every n-th word a number that careless copies change: NaNs, infinities, the smallest numbers, minus zero.
    static std::vector<uint> delicate_words(std::size_t n)
    {
        constexpr uint delicate[] = {
            0x7FC12345u, 0x7F812345u, 0xFFC00000u, 0x7F800000u, 0xFF800000u, 1u, 0x807FFFFFu, 0x80000000u, 0xFFFFFFFFu};
        auto words = random_words(n, n);
        for (std::size_t i = 0; i < n; i += 3)
            words[i] = delicate[i / 3 % std::size(delicate)];
        return words;
    }

    template <class T>
    void expect_kept(std::size_t n)
    {
        const auto words = delicate_words(n * sizeof(T) / 4);
        std::vector<T> host(n), copy(n);
        if (n > 0)
            std::memcpy(host.data(), words.data(), n * sizeof(T));
        copy = host;
        auto buffer = up(host);
        std::fill(host.begin(), host.end(), T(1)); // the caller's own again
        EXPECT_EQ(buffer.size(), n);
        EXPECT_EQ(count_different_bits(this->b().download(buffer), copy), 0u)
            << n << " elements of " << sizeof(T) << " bytes";
        const auto moved = std::move(buffer);
        EXPECT_EQ(buffer.size(), 0u); // NOLINT(bugprone-use-after-move)
        EXPECT_EQ(moved.size(), n);
        EXPECT_EQ(count_different_bits(this->b().download(moved), copy), 0u);
        EXPECT_EQ(this->b().template make<T>(n).size(), n);
    }
};
TYPED_TEST_SUITE_P(verbs);

// --- buffers
// ----------------------------------------------------------------------------------------------------------

} // namespace photongrid::testing
