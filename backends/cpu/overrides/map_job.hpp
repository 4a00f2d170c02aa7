// The parameters of the SIMD code that builds maps: plain pointers, because it is compiled once per instruction set.
#pragma once

#include <photongrid/backends/cpu/buffer.hpp>
#include <photongrid/map/map_buffers.hpp>

#include <algorithm>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::cpu {

/// A photon that is being sorted.
struct photon_record {
    glm::vec4 position, power;
};

/// Photons to sort, and the results. A bucket is a range of 2^shift cells. One extra cell after the last holds the
/// photons that are in no cell.
struct map_job {
    static constexpr uint most_buckets = 512, most_shift = 18;
    grid cells_of{};
    uint cells = 0;
    uint parts = every_part; ///< parts of the light
    uint shift = 0;
    bool large = false; ///< write results past the caches, which are too small for them
    const glm::vec4* positions = nullptr;
    const glm::vec4* powers = nullptr;
    uint* keys = nullptr;             ///< cell of each photon
    photon_record* records = nullptr; ///< by bucket; begins on a cache line
    glm::uvec2* pairs = nullptr;      ///< the same: (cell, photon)
    glm::uvec2* index = nullptr;      ///< (first, count) of each cell
    uint* list = nullptr;             ///< photon ids in the order of cells
    soa_vectors<float> out_positions, out_powers;

    uint buckets() const { return (cells >> shift) + 1; }
};

/// Collects the photons of each bucket until they fill a cache line.
struct scatter_lines {
    static constexpr std::size_t records_per_line = 2, pairs_per_line = 8;
    alignas(64) photon_record records[map_job::most_buckets][records_per_line];
    alignas(64) glm::uvec2 pairs[map_job::most_buckets][pairs_per_line];
};

/// Scratch memory for ordering a bucket.
struct bucket_scratch {
    std::vector<uint> next, order;
};

} // namespace photongrid::cpu

#include <photongrid/core/exact_end.hpp>
