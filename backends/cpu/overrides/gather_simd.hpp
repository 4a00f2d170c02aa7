// SIMD code that sums the photons that a search found, and makes the estimate. Included once per instruction set, so it
// has no include guard; other files include simd.hpp.
//
// Sums have 16 lanes on every machine, whatever the width of its registers, so that results are the same bit for bit.
#include <photongrid/backends/cpu/overrides/packet_simd.hpp>
#include <photongrid/estimate/irradiance_estimate.kernel.hpp>
#include <photongrid/estimate/search_radius.kernel.hpp>
#include <photongrid/estimate/search_tally.kernel.hpp>
#include <photongrid/map/grid.kernel.hpp>

#include <photongrid/core/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A sum in 16 lanes, for any width of registers: up to `few` terms in single precision, then their sums in double.
class lane_sums {
    static constexpr std::size_t width = hn::MaxLanes(floats()), registers = lanes / width, halves = width > 1 ? 2 : 1;
    using doubles = hn::CappedTag<double, std::max<std::size_t>(1, width / 2)>;
    vector few_[registers];
    hn::VFromD<doubles> all_[halves * registers];

public:
    /// The most terms per lane before flush(), for an error of at most 2^-21.
    static constexpr std::size_t few = 8;

    // Not a loop: g++ makes a memset of that, which took a tenth of a search for few photons.
    HWY_INLINE lane_sums()
    {
        const auto zero
            = [&]<std::size_t... I, std::size_t... J>(std::index_sequence<I...>, std::index_sequence<J...>) HWY_ATTR
        {
            ((few_[I] = hn::Zero(floats())), ...);
            ((all_[J] = hn::Zero(doubles())), ...);
        };
        zero(std::make_index_sequence<registers>(), std::make_index_sequence<halves * registers>());
    }
    /// Adds a register of terms to the lanes from group * width on.
    HWY_INLINE void add(std::size_t group, vector term) { few_[group] = hn::Add(few_[group], term); }
    /// Must be called after at most `few` terms per lane.
    HWY_INLINE void flush()
    {
        const doubles d;
        for (std::size_t group = 0; group < registers; ++group) {
#if HWY_TARGET == HWY_SCALAR // has no half vectors
            all_[group] = hn::Add(all_[group], hn::PromoteTo(d, few_[group]));
#else
            const hn::Half<floats> h;
            all_[2 * group] = hn::Add(all_[2 * group], hn::PromoteTo(d, hn::LowerHalf(h, few_[group])));
            all_[2 * group + 1] = hn::Add(all_[2 * group + 1], hn::PromoteTo(d, hn::UpperHalf(h, few_[group])));
#endif
            few_[group] = hn::Zero(floats());
        }
    }
    /// The sum of all lanes and `more`. It adds lanes l and l + 8, then l and l + 4, and so on: the same tree for every
    /// width.
    HWY_INLINE float total(double more) const
    {
        hn::VFromD<doubles> t[halves * registers];
        std::copy(std::begin(all_), std::end(all_), t);
        for (std::size_t half = halves * registers / 2; half > 0; half /= 2)
            for (std::size_t v = 0; v < half; ++v)
                t[v] = hn::Add(t[v], t[v + half]);
        return static_cast<float>(folded(doubles(), t[0]) + more);
    }

private:
    template <class D>
    static HWY_INLINE double folded([[maybe_unused]] D d, hn::VFromD<D> v)
    {
#if HWY_TARGET != HWY_SCALAR // has no half vectors
        if constexpr (hn::MaxLanes(d) > 1) {
            const hn::Half<D> h;
            return folded(h, hn::Add(hn::LowerHalf(h, v), hn::UpperHalf(h, v)));
        }
#endif
        return hn::GetLane(v);
    }
};

/// filter_weight() of estimate/filter.glsl in vectors.
HWY_INLINE vector weight_of(filter_kind filter, vector t)
{
    const floats d;
    const auto one = hn::Set(d, 1.0f);
    switch (filter) {
    case filter_kind::cone: return hn::Sub(one, hn::Sqrt(t));
    case filter_kind::epanechnikov: return hn::Sub(one, t);
    case filter_kind::silverman: return hn::Mul(hn::Sub(one, t), hn::Sub(one, t));
    case filter_kind::constant: break;
    }
    return one;
}

/// The radius of a search.
struct chosen_radius {
    float radius2 = 0;
    bool by_photon = false; ///< true: a photon set it; false: it was given

    /// As kernels have it (search_radius.glsl).
    glm::vec4 packed() const { return kernels::search_radius_of(radius2, by_photon); }
};

/// The sums over the photons within the radius.
struct gathered {
    glm::vec4 sum{0}, squares{0};
    uint held = 0;
};

/// How often the map holds each photon of a register, which begins at photon i of the packet.
HWY_INLINE vector entries_of(const search_job& j, const packet& near, std::size_t i)
{
    const floats d;
    const ints di;
    return hn::GatherIndex(d, j.powers.w, hn::LoadU(di, reinterpret_cast<const int*>(near.indices() + i)));
}

/// The filter's weight of a photon at the radius. `least2`: least_disc2 of the point.
HWY_INLINE float weight_at_radius(const search_job& j, chosen_radius r, float least2)
{
    const float t = r.radius2 * (1.0f / std::max(r.radius2, least2));
    return hn::GetLane(weight_of(j.filter, hn::Set(floats(), std::min(t, 1.0f))));
}

/// The sums over photons at the radius.
struct sums_at_radius {
    double sum[3] = {}, squares[4] = {}; ///< red, green, blue, and of all three

    /// Adds a photon of this power, which the map holds `entries` times.
    HWY_INLINE void add(const glm::vec3& power, float weight, float entries)
    {
        const float f[3] = {power.x * weight, power.y * weight, power.z * weight};
        const float all = f[0] + f[1] + f[2];
        for (int c = 0; c < 3; ++c) {
            sum[c] += static_cast<double>(f[c]);
            squares[c] += static_cast<double>(f[c] * f[c] * entries);
        }
        squares[3] += static_cast<double>(all * all * entries);
    }
};

/// Sums the photons within the radius of a point, as gather_photons.glsl does, from the packet's distances. It is one
/// function, because all of it adds to the same sums, which the compiler keeps in registers.
template <bool ERRORS>
HWY_INLINE gathered gather(
    const search_job& j, uint point, chosen_radius r, const packet& near, std::vector<uint>& at_radius)
{
    const floats d;
    constexpr std::size_t width = hn::MaxLanes(d);
    const std::size_t n = near.size();
    const float* const distances = near.of(packet::squared_distance);
    const float *const p_red = near.of(packet::red), *const p_green = near.of(packet::green),
                       *const p_blue = near.of(packet::blue);
    const float least2 = kernels::least_disc2(j.points[point], j.min_radius2);
    const float inverse_disc2 = 1.0f / std::max(r.radius2, least2);
    const auto radius2 = hn::Set(d, r.radius2), inverse = hn::Set(d, inverse_disc2), one = hn::Set(d, 1.0f);
    const filter_kind filter = j.filter;
    lane_sums red, green, blue, red2, green2, blue2, all2;
    std::size_t within = 0, at_most = 0;
    for (std::size_t i = 0; i < n;) {
        for (const std::size_t stop = std::min(n, i + lane_sums::few * lanes); i < stop;)
            for (std::size_t group = 0; group < lanes / width;
                 ++group, i += width) { // the compiler unrolls it, so that sums stay in registers
                const auto d2 = hn::Load(d, distances + i);
                const auto nearer = hn::Lt(d2, radius2);
                within += hn::CountTrue(d, nearer);
                at_most += hn::CountTrue(d, hn::Le(d2, radius2));
                const auto weight = hn::IfThenElseZero(nearer, weight_of(filter, hn::Min(hn::Mul(d2, inverse), one)));
                const auto r1 = hn::Mul(hn::Load(d, p_red + i), weight), g1 = hn::Mul(hn::Load(d, p_green + i), weight),
                           b1 = hn::Mul(hn::Load(d, p_blue + i), weight);
                red.add(group, r1);
                green.add(group, g1);
                blue.add(group, b1);
                if (ERRORS) {
                    const auto all = hn::Add(hn::Add(r1, g1), b1);
                    const auto entries = j.repeats ? entries_of(j, near, i) : one;
                    red2.add(group, hn::Mul(hn::Mul(r1, r1), entries));
                    green2.add(group, hn::Mul(hn::Mul(g1, g1), entries));
                    blue2.add(group, hn::Mul(hn::Mul(b1, b1), entries));
                    all2.add(group, hn::Mul(hn::Mul(all, all), entries));
                }
            }
        red.flush();
        green.flush();
        blue.flush();
        if (ERRORS) {
            red2.flush();
            green2.flush();
            blue2.flush();
            all2.flush();
        }
    }

    // Photons at the radius: all, or, for the k nearest, as many as are missing, by ascending id. The last of them sets
    // the radius and may be excluded.
    std::size_t counted = at_most - within;
    if (j.search == search_kind::exact_k && r.by_photon && at_most > j.k)
        counted = j.k - within;
    const bool excludes = j.leave_out && kernels::excludes_photon(r.packed(), least2);
    sums_at_radius extra;
    if (counted > (excludes ? 1u : 0u)) {
        const auto by_id = [&](uint a, uint b) { return j.list[near.index(a)] < j.list[near.index(b)]; };
        at_radius.clear();
        for (std::size_t i = 0; i < near.size(); ++i)
            if (distances[i] == r.radius2)
                at_radius.push_back(static_cast<uint>(i));
        std::partial_sort(
            at_radius.begin(), at_radius.begin() + static_cast<std::ptrdiff_t>(counted), at_radius.end(), by_id);
        const float rim = weight_at_radius(j, r, least2);
        for (std::size_t i = 0; i + (excludes ? 1 : 0) < counted; ++i) {
            const std::size_t at = at_radius[i];
            extra.add({p_red[at], p_green[at], p_blue[at]}, rim, j.repeats ? j.powers.w[near.index(at)] : 1.0f);
        }
    }
    gathered g;
    g.sum = {red.total(extra.sum[0]), green.total(extra.sum[1]), blue.total(extra.sum[2]), 0.0f};
    if (ERRORS)
        g.squares = {red2.total(extra.squares[0]), green2.total(extra.squares[1]), blue2.total(extra.squares[2]),
            all2.total(extra.squares[3])};
    g.held = static_cast<uint>(within + counted);
    return g;
}

/// The same, of the only photon, which is at the radius. `index`: its place in the map.
HWY_INLINE gathered gather_one(const search_job& j, uint point, chosen_radius r, std::size_t index)
{
    gathered g;
    g.held = 1;
    const float least2 = kernels::least_disc2(j.points[point], j.min_radius2);
    if (j.leave_out && kernels::excludes_photon(r.packed(), least2))
        return g;
    sums_at_radius s;
    s.add({j.powers.x[index], j.powers.y[index], j.powers.z[index]}, weight_at_radius(j, r, least2),
        j.repeats ? j.powers.w[index] : 1.0f);
    g.sum = glm::vec4(glm::dvec4(s.sum[0], s.sum[1], s.sum[2], 0));
    g.squares = glm::vec4(glm::dvec4(s.squares[0], s.squares[1], s.squares[2], s.squares[3]));
    return g;
}

/// Whether a point gets an estimate.
inline bool needs_estimate(const search_job& j, uint point)
{
    return j.searching && j.points[point].w > 0.0f && kernels::is_finite(j.points[point]);
}

/// A point of the search, with its normal and half space if policies need them.
template <int POLICIES>
HWY_INLINE query query_at(const search_job& j, uint point)
{
    query q{glm::vec3(j.points[point]), glm::vec3(0)};
    if (POLICIES != 0)
        q.normal = glm::vec3(j.point_normals[point]);
    if (POLICIES == 2 && j.half_spaces)
        q.before = kernels::half_space_of(j.point_normals[point], std::sqrt(j.points[point].w));
    return q;
}

/// Computes and stores the estimate from the sums.
inline void finish(const search_job& j, uint point, chosen_radius r, const gathered& g, uint visited)
{
    const glm::vec4 search_radius = r.packed();
    const glm::uvec4 tally = kernels::search_tally(g.held, visited);
    kernels::irradiance_estimate e;
    e.args = {.norm = j.norm, .min_radius2 = j.min_radius2, .leave_out = j.leave_out ? 1u : 0u};
    e.bind(slot<0>{}, std::span(&search_radius, 1));
    e.bind(slot<1>{}, std::span(&g.sum, 1));
    e.bind(slot<2>{}, std::span(&g.squares, 1));
    e.bind(slot<3>{}, std::span(&tally, 1));
    e.bind(slot<4>{}, std::span(j.points + point, 1));
    e.kernel(0);
    j.irradiance[point] = e.irradiance;
    j.used[point] = e.used;
    if (j.errors)
        j.standard_error[point] = e.standard_error;
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/core/exact_end.hpp>
