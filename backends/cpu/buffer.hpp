// A buffer of the cpu backend. A buffer of vec4 is stored either as an array of structures (x y z w, x y z w, …), which
// kernels read, or as a structure of arrays (all x, all y, …), which SIMD code reads. A pass or an override asks for
// the layout that it needs; the buffer is transposed if it has the other one.
#pragma once

#include <photongrid/core/backend.hpp>

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

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {
class cpu_by_kernels;
}

namespace photongrid::cpu {

/// The most floats that a vector register holds; so many may be read past the end of a component's array.
inline constexpr std::size_t lanes = 16;

/// Memory that begins on a cache line; its contents are undefined. Large blocks are in huge pages if the system has
/// them: touching a megabyte of small pages for the first time takes longer than sorting it.
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
            (void)::madvise(block_.get(), size_, MADV_HUGEPAGE); // only a hint
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

/// Counts the bytes in a backend's buffers, and keeps freed memory for new buffers: the system clears the memory that
/// it hands out, which takes longer than building a map in it.
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
    static constexpr std::size_t least_kept = std::size_t{64} << 10, most_kept = std::size_t{512} << 20;
    std::vector<storage> kept_;
    std::size_t bytes_kept_ = 0;
};

/// A buffer of vec4 as a structure of arrays. Each array begins on a cache line and may be read `lanes` floats past its
/// end.
template <class Float>
struct soa_vectors {
    Float* x = nullptr;
    Float* y = nullptr;
    Float* z = nullptr;
    Float* w = nullptr;
};

/// The number of floats between the beginnings of two components' arrays, for n vectors.
constexpr std::size_t component_stride(std::size_t n) { return (n + 2 * lanes - 1) / lanes * lanes; }

template <element T>
class buffer {
    static constexpr bool is_vectors = std::same_as<T, glm::vec4>;

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
        std::swap(is_soa_, other.is_soa_);
    }
    static std::size_t bytes(std::size_t n)
    {
        return is_vectors ? 4 * component_stride(n) * sizeof(float) : n * sizeof(T);
    }
    T* elements() const { return reinterpret_cast<T*>(data_.begin()); }
    soa_vectors<float> components() const
    {
        auto* x = reinterpret_cast<float*>(data_.begin());
        const auto stride = component_stride(size_);
        return {x, x + stride, x + 2 * stride, x + 3 * stride};
    }

    std::shared_ptr<account> account_;
    mutable storage data_; // passes that only read the buffer may transpose it
    std::size_t size_ = 0;
    mutable bool is_soa_ = false;
};

} // namespace photongrid::cpu

#include <photongrid/core/exact_end.hpp>
