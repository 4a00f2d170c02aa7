// A photon map for any distribution of photons: blocks of 16 photons along a Hilbert curve, and a tree of boxes around
// them. There is no grid to choose, empty space costs nothing, and dense clusters do not share a cell.
//
//     curve_key -> bitonic_sort -> reordered, for each word of the curve, the last one first
//     block_box -> parent_box, for each level of the tree, the lowest one first
#pragma once

#include <photongrid/map/block_box.kernel.hpp>
#include <photongrid/map/block_layout.hpp>
#include <photongrid/map/counted_photon.kernel.hpp>
#include <photongrid/map/curve_key.kernel.hpp>
#include <photongrid/map/grid_maps.hpp>
#include <photongrid/map/parent_box.kernel.hpp>
#include <photongrid/map/reordered.kernel.hpp>
#include <photongrid/map/sample_positions.hpp>

#include <array>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

namespace detail {
    inline constexpr uint curve_sample = 4096; // positions from which the number of words follows

    /// The boxes of a tree over the first `photons` photons, as block_tree.glsl stores them.
    template <backend B>
    buffer_of<B, glm::vec4> boxes_around(B& device, const photons<B>& p, uint photons, uint parts)
    {
        const uint nodes = tree_nodes(photons);
        uint level = tree_levels(photons) - 1, first = kernels::first_of_level(level);
        auto corners = device.template make<glm::vec4>(std::size_t{2} * nodes);
        device.template run<kernels::block_box>({std::size_t{2} * (nodes - first), 2 * first},
            {.first = first, .photons = photons, .parts = parts}, reads(p.positions, p.powers), writes(corners));
        while (level > 0) {
            const uint past = first;
            first = kernels::first_of_level(--level);
            device.template run<kernels::parent_box>(
                {std::size_t{2} * (past - first), 2 * first}, {.nodes = nodes}, reads(corners), writes(corners));
        }
        return corners;
    }

    /// How many words of the curve separate `photons` photons, of which `sample` is a part, so that few of them lie in
    /// the order of their ids.
    inline uint words_needed(const std::vector<glm::vec3>& sample, const kernels::Curve& curve, uint photons)
    {
        struct entry {
            std::array<uint, most_words> words{};
            uint state = 0;
            glm::vec4 at;
        };
        if (sample.empty())
            return 1;
        std::vector<entry> along;
        along.reserve(sample.size());
        for (const auto& p : sample)
            along.push_back({{}, 0, kernels::curve_coordinates(curve, glm::vec4(p, 0))});
        // All photons are denser than the sample. Along a line each further level halves their number in a cube.
        const double per_sample = static_cast<double>(photons) / static_cast<double>(sample.size()); // at least 1
        const auto denser = std::max(1u, static_cast<uint>(std::ceil(std::log2(per_sample))));
        float scale = curve.scale.x;
        for (uint word = 0; word < most_words; ++word, scale *= 1024.0f) {
            for (auto& e : along) {
                const glm::uvec2 next = kernels::word_along(e.at, scale, word, e.state);
                e.words[word] = next.x;
                e.state = next.y;
            }
            std::sort(along.begin(), along.end(), [](const entry& a, const entry& c) { return a.words < c.words; });
            // How many levels the neighbours in the sample share, but for photons at the same place. Not more than one
            // pair in 512 may share more than the words separate.
            std::vector<uint> shared;
            for (std::size_t i = 1; i < along.size(); ++i) {
                const auto &a = along[i - 1], &c = along[i];
                if (a.at == c.at)
                    continue;
                uint w = 0;
                while (w < word && a.words[w] == c.words[w])
                    ++w;
                shared.push_back(10 * w + (static_cast<uint>(std::countl_zero(a.words[w] ^ c.words[w])) - 2) / 3);
            }
            if (shared.empty())
                return 1;
            const auto most = shared.end() - 1 - static_cast<std::ptrdiff_t>(shared.size() / 512);
            std::nth_element(shared.begin(), most, shared.end());
            if (*most + 1 + denser <= 10 * (word + 1))
                return word + 1;
        }
        return most_words;
    }

} // namespace detail

/// Builds a map of blocks: photons along a Hilbert curve, ties by id, 16 to a block, and a tree of boxes around the
/// blocks. It consumes the photons. Photons of other parts of the light than `parts` are in no block.
///
/// It needs no setting. It takes 36 bytes per photon and 2 to 4 more for the boxes, and one more attribute while it is
/// built; passes as those of one sort per word of the curve: one or two words where photons spread evenly, up to nine
/// where clusters are dense. Reads back a sample of 4,096 positions, from which that number follows.
/// \throws backend_error if the device has no room.
/// \snippet snippets.cpp block_map
template <backend B>
map_buffers<B> block_map(B& device, photons<B> p, uint parts = every_part)
{
    const uint n = p.size();
    map_buffers<B> map;
    map.invalid = detail::checked_count<kernels::invalid_photon>(device, n, {}, reads(p.positions, p.powers));
    map.in_blocks
        = detail::checked_count<kernels::counted_photon>(device, n, {.parts = parts}, reads(p.positions, p.powers));
    if (parts != every_part)
        map.left_out = detail::checked_count<kernels::other_part>(device, n, {.parts = parts}, reads(p.positions));
    {
        glm::vec4 low = kernels::low_of_nothing(), high = kernels::high_of_nothing();
        const auto whole = device.download(detail::boxes_around(device, p, n, parts));
        for (uint node = 0; node < kernels::BLOCK; ++node) {
            low = kernels::lower_corner(low, whole[kernels::low_corner(node)]);
            high = kernels::higher_corner(high, whole[kernels::high_corner(node)]);
        }
        map.curve = detail::curve_through(low, high);
    }
    map.words = detail::words_needed(detail::sample_positions(device, p, detail::curve_sample), map.curve, n);

    auto pairs = device.template make<glm::uvec2>(n == 0 ? 0 : std::bit_ceil(n)); // with the sort's padding
    auto next = device.template make<uint>(n);
    for (uint word = map.words; word-- > 0;) {
        const bool ordered = word + 1 < map.words;
        device.template run<kernels::curve_key>({pairs.size(), 0, ordered ? 1u : 0u},
            {.curve = map.curve, .word = word, .photons = n, .parts = parts}, reads(p.positions, p.powers, map.list),
            writes(pairs));
        bitonic_sort(device, pairs);
        if (ordered) {
            device.template run<kernels::reordered>(n, {}, reads(pairs, map.list), writes(next));
        } else {
            map.list = device.template make<uint>(n);
            device.template run<kernels::pair_value>(n, {}, reads(pairs), writes(next));
        }
        std::swap(map.list, next);
    }
    pairs = {};
    next = {};
    detail::reorder(device, p, map.list);
    map.photons = std::move(p);
    map.levels = detail::tree_levels(map.in_blocks);
    map.boxes = detail::boxes_around(device, map.photons, map.in_blocks, parts);
    return map;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
