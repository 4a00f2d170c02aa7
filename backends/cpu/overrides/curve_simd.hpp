// SIMD code that orders photons along the Hilbert curve of a block map, and makes the boxes of its blocks. Included
// once per instruction set, so it has no include guard; other files include simd.hpp.
#include <photongrid/backends/cpu/overrides/curve_job.hpp>
#include <photongrid/backends/cpu/overrides/photons_simd.hpp>
#include <photongrid/map/block_tree.kernel.hpp>
#include <photongrid/map/hilbert.kernel.hpp>

#include <algorithm>

#include <photongrid/core/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Makes the pairs of photons first to past - 1: {0, photon}, or {no_id, photon} for those that are in no block.
inline void begin_order(curve_job j, std::size_t first, std::size_t past, glm::uvec2* pairs, curve_summary& seen)
{
    const hn::CappedTag<float, lanes> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const std::size_t width = hn::Lanes(d);
    const auto none = hn::Set(du, no_id);
    auto low_x = hn::Set(d, seen.low.x), low_y = hn::Set(d, seen.low.y), low_z = hn::Set(d, seen.low.z);
    auto high_x = hn::Set(d, seen.high.x), high_y = hn::Set(d, seen.high.y), high_z = hn::Set(d, seen.high.z);
    std::size_t i = first;
    for (; i + width <= past; i += width) {
        const auto p = load_photons(j.positions, j.powers, j.parts, i);
        const auto in_none = hn::Or(p.is_invalid, p.is_left_out);
        hn::StoreInterleaved2(hn::IfThenElseZero(in_none, none),
            hn::Add(hn::Set(du, static_cast<uint>(i)), hn::Iota(du, 0)), du, &pairs[i].x);
        const auto take = hn::RebindMask(d, in_none);
        const auto lower = [&](auto& low, auto v) HWY_ATTR { low = hn::Min(low, hn::IfThenElse(take, low, v)); };
        const auto higher = [&](auto& high, auto v) HWY_ATTR { high = hn::Max(high, hn::IfThenElse(take, high, v)); };
        lower(low_x, p.x);
        lower(low_y, p.y);
        lower(low_z, p.z);
        higher(high_x, p.x);
        higher(high_y, p.y);
        higher(high_z, p.z);
        seen.ordered += static_cast<uint>(width - hn::CountTrue(du, in_none));
        seen.invalid += static_cast<uint>(hn::CountTrue(du, p.is_invalid));
        seen.left_out += static_cast<uint>(hn::CountTrue(du, p.is_left_out));
    }
    seen.low = {hn::GetLane(hn::MinOfLanes(d, low_x)), hn::GetLane(hn::MinOfLanes(d, low_y)),
        hn::GetLane(hn::MinOfLanes(d, low_z))};
    seen.high = {hn::GetLane(hn::MaxOfLanes(d, high_x)), hn::GetLane(hn::MaxOfLanes(d, high_y)),
        hn::GetLane(hn::MaxOfLanes(d, high_z))};
    for (; i < past; ++i) {
        const bool good
            = kernels::is_finite(j.positions[i]) && (j.powers == nullptr || kernels::is_finite(j.powers[i])),
            of_parts = kernels::is_of_parts(j.positions[i], j.parts), counts = good && of_parts;
        pairs[i] = {counts ? 0u : no_id, static_cast<uint>(i)};
        seen.ordered += counts ? 1u : 0u;
        seen.invalid += good ? 0u : 1u;
        seen.left_out += of_parts ? 0u : 1u;
        if (counts) {
            seen.low = glm::min(seen.low, glm::vec3(j.positions[i]));
            seen.high = glm::max(seen.high, glm::vec3(j.positions[i]));
        }
    }
}

/// Replaces the first number of pairs by word number `word` of the position that the second one names, except where it
/// is no_id. It does what curve_key.glsl does.
inline void find_words(curve_job j, uint word, glm::uvec2* pairs, std::size_t n)
{
    const hn::CappedTag<float, lanes> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const hn::RebindToSigned<decltype(d)> di;
    using integers = hn::VFromD<decltype(du)>;
    const std::size_t width = hn::Lanes(d);
    const auto one = hn::Set(du, 1u), three = hn::Set(du, 3u), seven = hn::Set(du, 7u);
    const auto coordinate = [&](hn::VFromD<decltype(di)> index, int axis) HWY_ATTR {
        const float low = j.curve.low[axis], high = j.curve.high[axis], most = j.curve.scale.y;
        const auto p = hn::GatherIndex(d, &j.positions->x + axis, index);
        const auto q = hn::Sub(p, hn::Set(d, std::min(std::max(0.0f, low), high)));
        return hn::Min(hn::Max(q, hn::Set(d, -most)), hn::Set(d, most * 0.99999994f));
    };
    const auto digits = [&](hn::VFromD<decltype(d)> q, float scale, uint w) HWY_ATTR {
        const auto large = hn::Ge(hn::Abs(q), hn::Set(d, std::numeric_limits<float>::min()));
        const auto steps = hn::IfThenElseZero(large, hn::Mul(q, hn::Set(d, scale)));
        const auto rest = hn::Sub(steps, hn::Floor(steps));
        const auto of_word
            = hn::BitCast(du, hn::Min(hn::ConvertTo(di, hn::Mul(rest, hn::Set(d, 1024.0f))), hn::Set(di, 1023)));
        return w == 0 ? hn::Xor(of_word, hn::Set(du, 512u)) : of_word;
    };
    const auto rotated = [&](integers v, integers left, integers right)
                             HWY_ATTR { return hn::And(hn::Or(hn::Shl(v, left), hn::Shr(v, right)), seven); };
    constexpr std::size_t ahead = 32; // pairs are in any order, so that their positions are not in a cache
    HWY_ALIGN uint last[2 * lanes];
    for (std::size_t i = 0; i < n; i += width) {
        uint* here = &pairs[i].x;
        if (n - i < width) { // the last few, repeated
            for (std::size_t lane = 0; lane < width; ++lane) {
                last[2 * lane] = pairs[std::min(i + lane, n - 1)].x;
                last[2 * lane + 1] = pairs[std::min(i + lane, n - 1)].y;
            }
            here = last;
        }
        if (i + ahead + width <= n)
            for (std::size_t lane = 0; lane < width; ++lane)
                hwy::Prefetch(j.positions + pairs[i + ahead + lane].y);
        auto old = hn::Zero(du), photon = old;
        hn::LoadInterleaved2(du, here, old, photon);
        const auto index = hn::BitCast(di, hn::ShiftLeft<2>(photon));
        const auto qx = coordinate(index, 0), qy = coordinate(index, 1), qz = coordinate(index, 2);
        auto corner = hn::Zero(du), axis = corner, along = corner;
        float scale = j.curve.scale.x;
        for (uint w = 0; w <= word; ++w, scale *= 1024.0f) {
            const auto x = digits(qx, scale, w), y = digits(qy, scale, w), z = digits(qz, scale, w);
            along = hn::Zero(du);
            for (uint level = 0; level < 10; ++level) { // kernels::curve_level()
                const auto shift = hn::Set(du, 9 - level);
                const auto bit = [&](integers v) HWY_ATTR { return hn::And(hn::Shr(v, shift), one); };
                const auto octant = hn::Or(bit(x), hn::Or(hn::ShiftLeft<1>(bit(y)), hn::ShiftLeft<2>(bit(z))));
                const auto turn = hn::Add(axis, one), back = hn::Sub(three, turn);
                const auto gray = rotated(hn::Xor(octant, corner), back, turn);
                const auto number = hn::Xor(gray, hn::Xor(hn::ShiftRight<1>(gray), hn::ShiftRight<2>(gray)));
                const auto twice = hn::Add(number, number);
                const auto enters = hn::And(hn::Shr(hn::Set(du, kernels::CURVE_ENTERS), hn::Add(twice, number)), seven);
                const auto leaves = hn::And(hn::Shr(hn::Set(du, kernels::CURVE_LEAVES), twice), three);
                corner = hn::Xor(corner, rotated(enters, turn, back));
                const auto next = hn::Add(turn, leaves); // 1 to 5
                axis = hn::IfThenElse(hn::Gt(next, hn::Set(du, 2u)), hn::Sub(next, three), next);
                along = hn::Or(hn::ShiftLeft<3>(along), number);
            }
        }
        hn::StoreInterleaved2(hn::IfThenElse(hn::Eq(old, hn::Set(du, no_id)), old, along), photon, du, here);
        if (here == last)
            for (std::size_t lane = 0; i + lane < n; ++lane)
                pairs[i + lane].x = last[2 * lane];
    }
}

/// Makes the lowest and highest corners of the boxes around blocks first to past - 1. `p`: the photons in their order.
inline void find_boxes(soa_vectors<const float> p, uint in_blocks, std::size_t first, std::size_t past, uint first_node,
    soa_vectors<float> corners)
{
    const hn::CappedTag<float, lanes> d;
    const std::size_t width = hn::Lanes(d);
    for (std::size_t block = first; block < past; ++block) {
        const uint node = first_node + static_cast<uint>(block), low = kernels::low_corner(node),
                   high = kernels::high_corner(node);
        const std::size_t begin = block * kernels::BLOCK,
                          held = begin < in_blocks ? std::min<std::size_t>(in_blocks - begin, kernels::BLOCK) : 0;
        const auto find = [&](const float* from, float* to) HWY_ATTR {
            auto lowest = hn::Set(d, 3e38f), highest = hn::Set(d, -3e38f);
            for (std::size_t lane = 0; lane < held; lane += width) {
                const auto v = hn::Load(d, from + begin + lane);
                const auto some = hn::FirstN(d, held - lane);
                lowest = hn::Min(lowest, hn::IfThenElse(some, v, lowest));
                highest = hn::Max(highest, hn::IfThenElse(some, v, highest));
            }
            to[low] = hn::GetLane(hn::MinOfLanes(d, lowest));
            to[high] = hn::GetLane(hn::MaxOfLanes(d, highest));
        };
        find(p.x, corners.x);
        find(p.y, corners.y);
        find(p.z, corners.z);
        corners.w[low] = corners.w[high] = 0;
    }
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/core/exact_end.hpp>
