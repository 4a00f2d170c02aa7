// The format of map files (map_file.hpp): the header, and the checks of a file that is to be read.
#pragma once

#include <photongrid/core/fnv1a.hpp>
#include <photongrid/map/block_layout.hpp>
#include <photongrid/map/map_buffers.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// load_map() throws it for a file that is not a complete photon map of a known version, save_map() for a file that it
/// cannot write. The message has the file, what is wrong, and what to do.
class map_file_error : public std::runtime_error {
public:
    /// The message is "file: what".
    map_file_error(const std::filesystem::path& file, const std::string& what)
        : std::runtime_error(file.string() + ": " + what)
    {
    }
};

namespace detail {
    inline constexpr std::array<char, 8> map_file_magic{'p', 'h', 'g', 'r', 'i', 'd', 'm', '\n'};
    inline constexpr std::uint32_t map_file_version = 3, map_file_byte_order = 0x01020304u;

    struct map_file_header {
        std::array<char, 8> magic = map_file_magic;
        std::uint32_t version = map_file_version;
        std::uint32_t byte_order = map_file_byte_order;
        grid cells_of{};        ///< grid map; else 0
        kernels::Curve curve{}; ///< block map; else 0
        std::uint32_t photons = 0;
        std::uint32_t cells = 0;      ///< grid map; else 0
        std::uint32_t boxes = 0;      ///< block map: elements, two per node of the tree; else 0
        std::uint32_t levels = 0;     ///< block map; else 0
        std::uint32_t in_blocks = 0;  ///< block map; else 0
        std::uint32_t words = 0;      ///< block map; else 0
        std::uint32_t surpluses = 0;  ///< elements; 0 or as many as cells
        std::uint32_t attributes = 0; ///< bit 0: directions, bit 1: normals
        std::uint32_t invalid = 0, left_out = 0, overflowing_cells = 0;
        std::uint32_t note = 0;     ///< bytes
        std::uint64_t bytes = 0;    ///< of the whole file
        std::uint64_t checksum = 0; ///< of the whole file, taken with 0 here
    };
    static_assert(sizeof(map_file_header) == 192 && std::is_trivially_copyable_v<map_file_header>);

    constexpr std::uint64_t map_file_padded(std::uint64_t bytes) { return (bytes + 63) / 64 * 64; }

    /// The FNV-1a hash (fnv1a.hpp), of words of eight bytes instead of bytes. Any change within one word changes it.
    class map_file_checksum {
    public:
        /// `bytes`: a multiple of eight.
        void add(const std::byte* data, std::uint64_t bytes)
        {
            for (std::uint64_t i = 0; i < bytes; i += 8) {
                std::uint64_t word;
                std::memcpy(&word, data + i, 8);
                value_ = (value_ ^ word) * fnv1a_prime;
            }
        }
        std::uint64_t value() const { return value_; }

    private:
        std::uint64_t value_ = fnv1a_offset;
    };

    /// The header of a file with these bytes.
    /// \throws map_file_error for a file that is damaged, cut short, not a photon map, or of another version.
    inline map_file_header map_header_of(std::span<const std::byte> bytes, const std::filesystem::path& file)
    {
        const auto refuse = [&](const std::string& what) { throw map_file_error(file, what); };
        map_file_header header;
        if (bytes.size() < sizeof header.magic
            || std::memcmp(bytes.data(), map_file_magic.data(), sizeof header.magic) != 0)
            refuse("is not a photon map; give a file that save_map() wrote");
        if (bytes.size() < sizeof header)
            refuse("is cut short; save the map again");
        std::memcpy(&header, bytes.data(), sizeof header);
        if (header.byte_order != map_file_byte_order)
            refuse("is damaged, or from a machine with another byte order; save the map again here");
        if (header.version != map_file_version)
            refuse("is a photon map of version " + std::to_string(header.version)
                + ", and this photongrid reads version " + std::to_string(map_file_version) + "; save the map again");
        if (header.bytes != bytes.size())
            refuse("has " + std::to_string(bytes.size()) + " bytes and should have " + std::to_string(header.bytes)
                + ": it is cut short or damaged; save the map again");
        map_file_checksum sum;
        auto unsummed = header;
        unsummed.checksum = 0;
        sum.add(reinterpret_cast<const std::byte*>(&unsummed), sizeof unsummed);
        sum.add(bytes.data() + sizeof header, (bytes.size() - sizeof header) / 8 * 8);
        if (sum.value() != header.checksum || bytes.size() % 64 != 0)
            refuse("is damaged: its checksum is wrong; save the map again");
        return header;
    }

    [[noreturn]] inline void refuse_map(const std::filesystem::path& file)
    {
        throw map_file_error(file, "is inconsistent; it was not written by save_map()");
    }

    /// Whether all bytes of a grid or a curve are 0, as in a map of the other kind.
    template <class T>
    bool is_unused(const T& part)
    {
        return std::ranges::all_of(std::as_bytes(std::span(&part, 1)), [](std::byte b) { return b == std::byte{0}; });
    }

    /// Whether the header is of a grid map whose grid has as many cells as the file.
    inline bool is_of_grid_map(const map_file_header& header)
    {
        const std::uint64_t cells = header.cells;
        const grid& g = header.cells_of;
        const auto& r = g.resolution;
        if (header.boxes != 0 || header.levels != 0 || header.in_blocks != 0 || header.words != 0
            || !is_unused(header.curve) || (header.surpluses != 0 && header.surpluses != cells) || r[0] < 1 || r[1] < 1
            || r[2] < 1 || r[3] != cells || std::uint64_t{r[0]} * r[1] > cells
            || std::uint64_t{r[0]} * r[1] * r[2] != cells)
            return false;
        for (int axis = 0; axis < 3; ++axis)
            if (!std::isfinite(g.origin[axis]) || !std::isfinite(g.inverse_cell[axis]) || !std::isfinite(g.cell[axis])
                || !(g.inverse_cell[axis] > 0) || !(g.cell[axis] > 0))
                return false;
        return true;
    }

    /// Whether the header is of a block map as block_map() builds it.
    inline bool is_of_block_map(const map_file_header& header)
    {
        const auto &c = header.curve, same = curve_through(c.low, c.high); // NaN equals nothing
        return header.cells == 0 && header.surpluses == 0 && is_unused(header.cells_of)
            && header.in_blocks <= header.photons && header.levels == tree_levels(header.in_blocks)
            && header.boxes == std::uint64_t{2} * tree_nodes(header.in_blocks) && header.words >= 1
            && header.words <= most_words && c.low == same.low && c.high == same.high && c.scale == same.scale;
    }

    /// Validates the header: a checksum detects damage, not forgery, and a search of a forged map must still end.
    inline void check_map_header(const map_file_header& header, const std::filesystem::path& file)
    {
        const std::uint64_t n = header.photons;
        const auto size_of = [&](std::uint64_t count, std::size_t element) { return map_file_padded(count * element); };
        const std::uint64_t expected = size_of(1, sizeof header) + size_of(header.cells, sizeof(glm::uvec2))
            + size_of(header.boxes, sizeof(glm::vec4)) + size_of(n, sizeof(uint))
            + size_of(header.surpluses, sizeof(glm::vec4)) + size_of(header.note, 1)
            + size_of(n, sizeof(glm::vec4)) * (2u + (header.attributes & 1u) + (header.attributes >> 1 & 1u));
        if (header.attributes > 3 || expected != header.bytes
            || !(header.boxes != 0 ? is_of_block_map(header) : is_of_grid_map(header)))
            refuse_map(file);
    }

    /// Validates the index: ranges are contiguous from 0 and end within the photons.
    inline void check_map_index(
        std::span<const glm::uvec2> index, std::uint64_t photons, const std::filesystem::path& file)
    {
        std::uint64_t sum_of_counts = 0;
        for (const auto& cell : index) {
            if (cell.x != sum_of_counts)
                refuse_map(file);
            sum_of_counts += cell.y;
        }
        if (sum_of_counts > photons)
            refuse_map(file);
    }

    /// Validates the boxes of a block map: each contains its photons or its children's boxes, and those of nodes
    /// without photons are boxes of nothing. A search visits the children of each box that it is near to, and nodes
    /// without photons may have none. `photons`: the positions of those in blocks.
    inline void check_map_boxes(
        std::span<const glm::vec4> boxes, std::span<const glm::vec4> photons, const std::filesystem::path& file)
    {
        const auto contains = [&](uint node, const glm::vec4& low, const glm::vec4& high) { // false for NaN
            // Denormals count as 0, and a device may have made them 0.
            constexpr float margin = std::numeric_limits<float>::min();
            const auto below = boxes[kernels::low_corner(node)] - low, above = high - boxes[kernels::high_corner(node)];
            return below.x <= margin && below.y <= margin && below.z <= margin && above.x <= margin && above.y <= margin
                && above.z <= margin;
        };
        auto held = static_cast<uint>(photons.size()); // photons, or used nodes of the level below
        uint past = tree_nodes(held);
        const uint lowest = tree_levels(held) - 1;
        for (uint level = lowest + 1; level-- > 0;) {
            const uint first = kernels::first_of_level(level), used = block_count(held);
            for (uint node = first; node < past; ++node) {
                const auto &low = boxes[kernels::low_corner(node)], &high = boxes[kernels::high_corner(node)];
                const uint begin = (node - first) * kernels::BLOCK;
                if (node - first >= used) {
                    if (low != kernels::low_of_nothing() || high != kernels::high_of_nothing())
                        refuse_map(file);
                    continue;
                }
                bool fits = kernels::is_finite(low) && kernels::is_finite(high);
                for (uint i = 0; i < std::min(held - begin, kernels::BLOCK); ++i) {
                    const uint child = kernels::first_child(node) + i;
                    fits = fits
                        && (level == lowest ? contains(node, photons[begin + i], photons[begin + i])
                                            : contains(node, boxes[kernels::low_corner(child)],
                                                boxes[kernels::high_corner(child)]));
                }
                if (!fits)
                    refuse_map(file);
            }
            past = first;
            held = used;
        }
    }
} // namespace detail

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
