// SIMD code that builds a map. Included once per instruction set, after curve_simd.hpp, which includes
// photons_simd.hpp; so it has no include guard, and other files include simd.hpp.
//
// Photons are sorted in two steps. The first moves them to buckets, which are ranges of cells: it moves a photon's data
// too, in whole cache lines and past the caches, because reading the data later by the sorted ids would fetch a line
// per photon. The second step orders each bucket, which fits the caches, by cell. Both steps are stable, so ids ascend
// within a cell.
#include <hwy/cache_control.h>

#include <photongrid/backends/cpu/overrides/map_job.hpp>

#include <photongrid/core/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Jobs are passed by value, so that the compiler can assume that stores do not change them.

/// Finds the cells of photons first to past - 1, as photon_cell.glsl does, and counts the photons of each bucket, the
/// invalid ones and those of other parts of the light.
inline void find_cells(map_job j, std::size_t first, std::size_t past, uint* in_bucket, uint& invalid, uint& left_out)
{
    const hn::CappedTag<float, lanes> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const hn::RebindToSigned<decltype(d)> di;
    const std::size_t width = hn::Lanes(d);
    const grid& g = j.cells_of;
    const auto cell = [&](hn::VFromD<decltype(d)> x, int axis) HWY_ATTR {
        const uint resolution = g.resolution[axis];
        auto u = hn::Mul(hn::Sub(x, hn::Set(d, g.origin[axis])), hn::Set(d, g.inverse_cell[axis]));
        u = hn::IfThenElseZero(hn::Gt(u, hn::Zero(d)), u);
        // For numbers that are not negative, truncation rounds down.
        const auto c = hn::ConvertTo(di, hn::Min(u, hn::Set(d, static_cast<float>(resolution - 1u))));
        return hn::BitCast(du, hn::Min(c, hn::Set(di, static_cast<int>(resolution - 1u))));
    };
    const auto times = [&](auto a, uint b) HWY_ATTR {
        return hn::BitCast(du, hn::Mul(hn::BitCast(di, a), hn::Set(di, static_cast<int>(b))));
    };
    std::size_t i = first;
    for (; i + width <= past; i += width) {
        const auto p = load_photons(j.positions, j.powers, j.parts, i);
        const auto key
            = hn::Add(times(hn::Add(times(cell(p.z, 2), g.resolution.y), cell(p.y, 1)), g.resolution.x), cell(p.x, 0));
        const auto in_none = hn::Or(p.is_invalid, p.is_left_out);
        hn::StoreU(hn::IfThenElse(in_none, hn::Set(du, j.cells), key), du, j.keys + i);
        invalid += static_cast<uint>(hn::CountTrue(du, p.is_invalid));
        left_out += static_cast<uint>(hn::CountTrue(du, p.is_left_out));
        for (std::size_t lane = 0; lane < width; ++lane)
            ++in_bucket[j.keys[i + lane] >> j.shift];
    }
    for (; i < past; ++i) {
        const bool good = kernels::is_finite(j.positions[i]) && kernels::is_finite(j.powers[i]),
                   of_parts = kernels::is_of_parts(j.positions[i], j.parts);
        invalid += good ? 0u : 1u;
        left_out += of_parts ? 0u : 1u;
        j.keys[i] = j.cells;
        if (good && of_parts) {
            const glm::uvec4 c = kernels::cell_coordinates(g, j.positions[i]);
            j.keys[i] = kernels::cell_number(g, c.x, c.y, c.z);
        }
        ++in_bucket[j.keys[i] >> j.shift];
    }
}

/// Moves photons first to past - 1 to their buckets; the next one of bucket v goes to index next[v]. Cache lines are
/// collected and then written past the caches (software write-combining; Satish et al., Fast Sort on CPUs and GPUs,
/// 2010).
inline void scatter_photons(map_job j, std::size_t first, std::size_t past, uint* next, scatter_lines& lines)
{
    uint begin[map_job::most_buckets]; // the beginning of a line may belong to another thread
    std::copy(next, next + j.buckets(), begin);
    // Writes the cache line that ends before index `end`, or the part of it that belongs to this call.
    const auto write = [&]<class T>(const T* line, uint size, T* to, uint bucket, uint end) HWY_ATTR {
        const hn::CappedTag<float, lanes> d;
        const uint start = (end - 1) / size * size;
        if (end - start == size && start >= begin[bucket]) {
            for (std::size_t lane = 0; lane < lanes; lane += hn::Lanes(d))
                hn::Stream(hn::Load(d, reinterpret_cast<const float*>(line) + lane), d,
                    reinterpret_cast<float*>(to + start) + lane);
        } else {
            for (uint p = std::max(begin[bucket], start); p < end; ++p)
                to[p] = line[p % size];
        }
    };
    constexpr uint records = scatter_lines::records_per_line, pairs = scatter_lines::pairs_per_line;
    for (std::size_t i = first; i < past; ++i) {
        const uint key = j.keys[i], v = key >> j.shift, at = next[v]++;
        lines.records[v][at % records] = {j.positions[i], j.powers[i]};
        lines.pairs[v][at % pairs] = {key, static_cast<uint>(i)};
        if ((at + 1) % records == 0)
            write(lines.records[v], records, j.records, v, at + 1);
        if ((at + 1) % pairs == 0)
            write(lines.pairs[v], pairs, j.pairs, v, at + 1);
    }
    for (uint v = 0; v < j.buckets(); ++v) {
        if (next[v] > begin[v] && next[v] % records != 0)
            write(lines.records[v], records, j.records, v, next[v]);
        if (next[v] > begin[v] && next[v] % pairs != 0)
            write(lines.pairs[v], pairs, j.pairs, v, next[v]);
    }
    hwy::FlushStream();
}

/// Orders the bucket at begin to end - 1 by cell.
inline void order_bucket(map_job j, uint bucket, std::size_t begin, std::size_t end, bucket_scratch& s)
{
    const uint first_cell = bucket << j.shift, bins = std::min(1u << j.shift, j.cells + 1 - first_cell);
    s.next.assign(bins, 0);
    s.order.resize(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
        hwy::Prefetch(&j.records[i]); // they are read out of order below
        ++s.next[j.pairs[i].x - first_cell];
    }
    auto next_index = static_cast<uint>(begin);
    for (uint c = 0; c < bins; ++c) {
        const uint count = s.next[c];
        s.next[c] = next_index;
        if (first_cell + c < j.cells)
            j.index[first_cell + c] = {next_index, count};
        next_index += count;
    }
    for (std::size_t i = begin; i < end; ++i)
        s.order[s.next[j.pairs[i].x - first_cell]++ - begin] = static_cast<uint>(i);

    const auto one = [&](std::size_t to) {
        const uint from = s.order[to - begin];
        const auto put = [&](const glm::vec4& v, const soa_vectors<float>& p) {
            p.x[to] = v.x;
            p.y[to] = v.y;
            p.z[to] = v.z;
            p.w[to] = v.w;
        };
        put(j.records[from].position, j.out_positions);
        put(j.records[from].power, j.out_powers);
        j.list[to] = j.pairs[from].y;
    };
    std::size_t to = begin;
    for (; to < end && to % lanes != 0; ++to)
        one(to);
    const hn::CappedTag<float, lanes> d;
    const std::size_t width = hn::Lanes(d);
    HWY_ALIGN glm::vec4 positions[lanes];
    HWY_ALIGN glm::vec4 powers[lanes];
    for (; to + lanes <= end; to += lanes) { // a cache line of each component
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const uint from = s.order[to - begin + lane];
            positions[lane] = j.records[from].position;
            powers[lane] = j.records[from].power;
            j.list[to + lane] = j.pairs[from].y;
        }
        const auto spread = [&](const glm::vec4* vectors, const soa_vectors<float>& p) HWY_ATTR {
            for (std::size_t lane = 0; lane < lanes; lane += width) {
                auto x = hn::Zero(d), y = x, z = x, w = x;
                hn::LoadInterleaved4(d, &vectors[lane].x, x, y, z, w);
                const auto put = [&](auto v, float* component) HWY_ATTR {
                    if (j.large)
                        hn::Stream(v, d, component + to + lane);
                    else
                        hn::Store(v, d, component + to + lane);
                };
                put(x, p.x);
                put(y, p.y);
                put(z, p.z);
                put(w, p.w);
            }
        };
        spread(positions, j.out_positions);
        spread(powers, j.out_powers);
    }
    for (; to < end; ++to)
        one(to);
    hwy::FlushStream();
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/core/exact_end.hpp>
