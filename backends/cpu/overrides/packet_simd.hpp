// SIMD code for packets of photons. Included once per instruction set, so it has no include guard; other files include
// simd.hpp.
#include <photongrid/backends/cpu/overrides/blocks_simd.hpp>

#include <algorithm>
#include <limits>

#include <photongrid/core/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The photons near several queries, or those found by a query, stored contiguously.
class packet {
public:
    enum component {
        x,
        y,
        z,
        red,
        green,
        blue,
        direction_x,
        direction_y,
        direction_z,
        normal_x,
        normal_y,
        normal_z,
        squared_distance,
        kept, ///< scratch: the distances that scan() keeps, or the photons that list() finds
        count
    };

    std::size_t size() const { return size_; }
    float* of(component p) const { return memory_ + p * stride_; }
    /// The index of photon i in the map.
    uint index(std::size_t i) const { return indices_[i]; }
    const uint* indices() const { return indices_; }
    photon_vectors photons() const
    {
        return {{of(x), of(y), of(z)}, {of(direction_x), of(direction_y), of(direction_z)},
            {of(normal_x), of(normal_y), of(normal_z)}};
    }

    /// Copies the photons within `radius` of `center`, and perhaps some that are a little farther. Returns how many it
    /// examined; if these were more than `most`, it copies none.
    HWY_NOINLINE std::size_t fill(const search_job& j, const glm::vec3& center, float radius, std::size_t most)
    {
        const floats d;
        const uints du;
        const std::size_t width = hn::Lanes(d);
        const float radius2 = radius * radius * 1.000004f + 1e-36f;
        if (j.levels > 0)
            find_blocks(j, center, radius2, most, rows_);
        else
            find_rows(j, center, radius2, rows_);
        std::size_t n = 0;
        for (std::size_t r = 0; r < rows_.rows; ++r)
            n += rows_.past[r] - rows_.first[r];
        clear();
        if (n > most)
            return n;
        reserve(n);
        const auto cx = hn::Set(d, center.x), cy = hn::Set(d, center.y), cz = hn::Set(d, center.z),
                   within2 = hn::Set(d, radius2);
        std::size_t k = 0;
        for (std::size_t r = 0; r < rows_.rows; ++r) {
            const std::size_t past = rows_.past[r];
            for (std::size_t i = rows_.first[r]; i < past; i += width) {
                const auto px = hn::LoadU(d, j.positions.x + i), py = hn::LoadU(d, j.positions.y + i),
                           pz = hn::LoadU(d, j.positions.z + i);
                const auto dx = hn::Sub(px, cx), dy = hn::Sub(py, cy), dz = hn::Sub(pz, cz);
                const auto d2 = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
                const auto near = hn::And(hn::Le(d2, within2), hn::FirstN(d, past - i));
                const std::size_t some = store_some(d, px, near, of(x) + k);
                store_some(d, py, near, of(y) + k);
                store_some(d, pz, near, of(z) + k);
                const auto take = [&](component p, const float* from)
                                      HWY_ATTR { store_some(d, hn::LoadU(d, from + i), near, of(p) + k); };
                // Lists do not use the powers, but a test here would slow estimates more than it would speed up lists.
                take(red, j.powers.x);
                take(green, j.powers.y);
                take(blue, j.powers.z);
                if (j.side) {
                    take(direction_x, j.directions.x);
                    take(direction_y, j.directions.y);
                    take(direction_z, j.directions.z);
                }
                if (j.needs_photon_normals) {
                    take(normal_x, j.normals.x);
                    take(normal_y, j.normals.y);
                    take(normal_z, j.normals.z);
                }
                store_some(du, hn::Add(hn::Set(du, static_cast<uint>(i)), hn::Iota(du, 0)), hn::RebindMask(du, near),
                    indices_ + k);
                k += some;
            }
        }
        // Pad with photons that are infinitely far and have no power.
        const auto far = hn::Set(d, std::numeric_limits<float>::infinity()), none = hn::Zero(d);
        for (std::size_t i = k; i < k + lanes; i += width) {
            for (const component p : {x, y, z})
                hn::StoreU(far, d, of(p) + i);
            for (const component p : {red, green, blue})
                hn::StoreU(none, d, of(p) + i);
            hn::StoreU(hn::Zero(du), du, indices_ + i);
        }
        size_ = k;
        return n;
    }

    /// Removes all photons.
    void clear() { size_ = 0; }
    /// Makes room for n more photons.
    void reserve(std::size_t n)
    {
        if (size_ + n + slack > stride_)
            grow(size_ + n);
    }
    /// The place after the last photon. While photons are added there, the compiler keeps it in registers.
    struct place {
        float* distances2;
        uint* indices;
        std::size_t size;

        /// Adds those photons of a register for which `some` is true. The register begins at photon `index` of the map.
        HWY_INLINE void add(vector d2, hn::Mask<floats> some, std::size_t index)
        {
            const uints du;
            store_some(du, hn::Add(hn::Set(du, static_cast<uint>(index)), hn::Iota(du, 0)), hn::RebindMask(du, some),
                indices + size);
            size += store_some(floats(), d2, some, distances2 + size);
        }
    };
    HWY_INLINE place end() { return {of(squared_distance), indices_, size_}; }
    /// Takes the photons that were added at `end`. There must be room for them: see reserve().
    HWY_INLINE void take(const place& end) { size_ = end.size; }
    /// Copies the squared distances to `kept`, and returns the largest.
    HWY_INLINE float copy_distances()
    {
        const floats d;
        auto largest = hn::Zero(d);
        for (std::size_t i = 0; i < size_; i += hn::Lanes(d)) {
            const auto d2 = hn::Load(d, of(squared_distance) + i);
            hn::Store(d2, d, of(kept) + i);
            largest = hn::Max(largest, hn::IfThenElseZero(hn::FirstN(d, size_ - i), d2));
        }
        return hn::GetLane(hn::MaxOfLanes(d, largest));
    }
    /// Removes the photons beyond the squared distance within2.
    HWY_INLINE void keep(float within2)
    {
        const floats d;
        const uints du;
        const std::size_t n = size_;
        float* const distances2 = of(squared_distance);
        size_ = 0;
        for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
            const auto d2 = hn::Load(d, distances2 + i);
            const auto index = hn::Load(du, indices_ + i);
            const auto some = hn::And(hn::Le(d2, hn::Set(d, within2)), hn::FirstN(d, n - i));
            const std::size_t added = store_some(d, d2, some, distances2 + size_);
            store_some(du, index, hn::RebindMask(du, some), indices_ + size_);
            size_ += added;
        }
    }
    /// Removes photons at the squared distance last2, those of the greatest ids, until only k photons are left. None
    /// may be beyond last2. Returns the greatest id left at that distance.
    uint keep_least_ids(const uint* list, float last2, std::size_t k)
    {
        float* const distances2 = of(squared_distance);
        std::vector<std::pair<uint, uint>> at_last; // ids and indices
        std::size_t n = 0;
        for (std::size_t i = 0; i < size_; ++i) {
            if (distances2[i] == last2) {
                at_last.emplace_back(list[indices_[i]], indices_[i]);
            } else {
                distances2[n] = distances2[i];
                indices_[n++] = indices_[i];
            }
        }
        std::sort(at_last.begin(), at_last.end());
        uint last_id = 0;
        for (std::size_t i = 0; n < k; ++i) {
            distances2[n] = last2;
            last_id = at_last[i].first;
            indices_[n++] = at_last[i].second;
        }
        size_ = n;
        return last_id;
    }
    /// Loads the powers of all photons that add() has added, and their positions if biases are reported.
    HWY_INLINE void fetch_powers(const search_job& j)
    {
        const floats d;
        const ints di;
        reserve(0);
        for (std::size_t i = size_; i < size_ + lanes; i += hn::Lanes(d)) { // padding without power
            hn::StoreU(hn::Set(d, std::numeric_limits<float>::infinity()), d, of(squared_distance) + i);
            hn::StoreU(hn::Zero(di), di, reinterpret_cast<int*>(indices_) + i);
        }
        const std::size_t whole = (size_ + lanes - 1) / lanes * lanes;
        for (std::size_t i = 0; i < whole; i += hn::Lanes(d)) {
            if (i >= size_) { // a gather is slow
                for (const component p : {red, green, blue})
                    hn::Store(hn::Zero(d), d, of(p) + i);
                continue;
            }
            const auto at = hn::Load(di, reinterpret_cast<const int*>(indices_ + i));
            hn::Store(hn::GatherIndex(d, j.powers.x, at), d, of(red) + i);
            hn::Store(hn::GatherIndex(d, j.powers.y, at), d, of(green) + i);
            hn::Store(hn::GatherIndex(d, j.powers.z, at), d, of(blue) + i);
            if (j.biases.bias != nullptr) {
                hn::Store(hn::GatherIndex(d, j.positions.x, at), d, of(x) + i);
                hn::Store(hn::GatherIndex(d, j.positions.y, at), d, of(y) + i);
                hn::Store(hn::GatherIndex(d, j.positions.z, at), d, of(z) + i);
            }
        }
    }

private:
    static constexpr std::size_t slack = 5 * lanes; ///< for stores past the end

    /// Makes room for n photons, and keeps the distances and indices of the present ones.
    void grow(std::size_t n)
    {
        const std::size_t stride = component_stride(2 * n + slack);
        storage block((count + 1) * stride * sizeof(float));
        auto* const memory = reinterpret_cast<float*>(block.begin());
        auto* const indices = reinterpret_cast<uint*>(memory + count * stride);
        std::copy_n(of(squared_distance), size_, memory + squared_distance * stride);
        std::copy_n(indices_, size_, indices);
        block_ = std::move(block);
        memory_ = memory;
        indices_ = indices;
        stride_ = stride;
    }
    rows_found rows_;
    storage block_;
    float* memory_ = nullptr;
    uint* indices_ = nullptr;
    std::size_t size_ = 0, stride_ = 0;
};

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/core/exact_end.hpp>
