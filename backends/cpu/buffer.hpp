// A buffer of the cpu backend. Vectors of four can lie as rows (x y z w, x y z w, …), as kernels read them, or as
// planes (all x, all y, …), as SIMD reads them: a pass or an override asks for the one it needs, and the buffer is
// turned over when it lies the other way.
#pragma once

#include <photongrid/backend/backend.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <vector>

#if __has_include(<sys/mman.h>)
#include <sys/mman.h>
#endif

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {
class cpu_by_kernels;
}

namespace photongrid::cpu {

/// Elements that a vector register holds at most, and that may be read past a plane's end.
inline constexpr std::size_t lanes = 16;

/// Memory that begins on a cache line, contents undefined; large blocks in large pages where the system has them, since
/// touching a megabyte for the first time in small ones takes longer than sorting it.
class storage {
public:
    storage() = default;
    explicit storage(std::size_t bytes)
    {
        constexpr std::size_t line = 64, large_page = std::size_t{2} << 20;
        const std::size_t unit = bytes < 2 * large_page ? line : large_page;
        size_ = (std::max<std::size_t>(bytes, 1) + unit - 1) / unit * unit;
        block_.reset(std::aligned_alloc(unit, size_));
        if (block_ == nullptr)
            throw std::bad_alloc();
#if defined(MADV_HUGEPAGE)
        if (unit == large_page)
            (void)::madvise(block_.get(), size_, MADV_HUGEPAGE); // a wish; nothing depends on it
#endif
    }
    std::byte* begin() const { return static_cast<std::byte*>(block_.get()); }
    std::size_t size() const { return block_ ? size_ : 0; }

private:
    struct free_block {
        void operator()(void* p) const { std::free(p); }
    };
    std::unique_ptr<void, free_block> block_;
    std::size_t size_ = 0;
};

/// What a backend's buffers hold, and free memory that is kept for the next ones: the system clears what it gives out,
/// and that takes longer than building a map in it.
class account {
public:
    std::uint64_t now = 0, peak = 0; ///< bytes in buffers now, and at most

    storage take(std::size_t bytes)
    {
        auto best = kept_.end();
        for (auto s = kept_.begin(); s != kept_.end(); ++s)
            if (s->size() >= bytes && s->size() / 2 <= bytes && (best == kept_.end() || s->size() < best->size()))
                best = s;
        if (best == kept_.end())
            return storage(bytes);
        storage found = std::move(*best);
        kept_.erase(best);
        bytes_kept_ -= found.size();
        return found;
    }
    void give_back(storage s)
    {
        if (s.size() < least_kept || s.size() > most_kept)
            return;
        bytes_kept_ += s.size();
        kept_.push_back(std::move(s));
        while (bytes_kept_ > most_kept) { // the oldest goes first
            bytes_kept_ -= kept_.front().size();
            kept_.erase(kept_.begin());
        }
    }

private:
    static constexpr std::size_t least_kept = std::size_t{64} << 10, most_kept = std::size_t{128} << 20;
    std::vector<storage> kept_;
    std::size_t bytes_kept_ = 0;
};

/// The four planes of a buffer of vectors. Each begins on a cache line and may be read `lanes` elements past its end.
template <class Float>
struct planes {
    Float* x = nullptr;
    Float* y = nullptr;
    Float* z = nullptr;
    Float* w = nullptr;
};

/// Floats from one plane to the next, of n vectors.
constexpr std::size_t plane_stride(std::size_t n) { return (n + 2 * lanes - 1) / lanes * lanes; }

template <element T>
class buffer {
    static constexpr bool has_planes = std::same_as<T, glm::vec4>;

public:
    using value_type = T;
    buffer() = default;
    buffer(buffer&& other) noexcept { swap(other); }
    buffer& operator=(buffer&& other) noexcept
    {
        buffer(std::move(other)).swap(*this);
        return *this;
    }
    buffer(const buffer&) = delete;
    buffer& operator=(const buffer&) = delete;
    ~buffer()
    {
        if (account_) {
            account_->now -= bytes(size_);
            account_->give_back(std::move(data_));
        }
    }
    std::size_t size() const noexcept { return size_; }

private:
    friend photongrid::cpu_by_kernels;
    buffer(std::shared_ptr<account> a, std::size_t n)
        : account_(std::move(a)), data_(account_->take(bytes(n))), size_(n)
    {
        account_->now += bytes(n);
        account_->peak = std::max(account_->peak, account_->now);
    }
    void swap(buffer& other) noexcept
    {
        std::swap(account_, other.account_);
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        std::swap(as_planes_, other.as_planes_);
    }
    static std::size_t bytes(std::size_t n) { return has_planes ? 4 * plane_stride(n) * sizeof(float) : n * sizeof(T); }
    T* rows() const { return reinterpret_cast<T*>(data_.begin()); }
    planes<float> in_planes() const
    {
        auto* x = reinterpret_cast<float*>(data_.begin());
        const auto stride = plane_stride(size_);
        return {x, x + stride, x + 2 * stride, x + 3 * stride};
    }

    std::shared_ptr<account> account_;
    mutable storage data_; // turned over by passes that read, too
    std::size_t size_ = 0;
    mutable bool as_planes_ = false;
};

} // namespace photongrid::cpu

#include <photongrid/backend/exact_end.hpp>
