// A backend that fails on purpose: wraps any other and, at the n-th call of a kind, fails as a device may fail.
#pragma once

#include <photongrid/core/backend.hpp>

#include <cstring>
#include <limits>
#include <random>

namespace photongrid::testing {

/// What goes wrong, and which calls are counted for it.
enum class fault {
    none,
    out_of_memory, ///< the n-th `make` or `upload` throws
    submit_failed, ///< the n-th `run`, `run_until_done`, `count`, `route`, `download` or `finish` throws
    device_lost,   ///< the n-th call of any verb throws, and all after it
    garbage,       ///< the n-th pass runs, then its outputs are overwritten
    wrong_count,   ///< the n-th `count` answers something else
    wrong_contents ///< the n-th `download` answers random bits
};

/// B with an optional fault. Its exceptions contain "injected".
template <backend B>
class faulty_backend {
public:
    template <element T>
    using buffer = typename B::template buffer<T>;

    explicit faulty_backend(B& inner) : inner_(&inner) {}

    /// From now on counts calls, and at the n-th (from 1) that `f` counts, fails as `f` says. n = 0: never.
    void set(fault f, std::uint64_t n, std::uint64_t wrong = 0)
    {
        fault_ = f;
        at_ = n;
        wrong_ = wrong;
        calls_ = 0;
        lost_ = false;
        random_.seed(static_cast<std::mt19937_64::result_type>(n));
    }
    /// Calls counted since.
    std::uint64_t calls() const { return calls_; }

    template <element T>
    buffer<T> make(std::size_t n)
    {
        memory();
        return inner_->template make<T>(n);
    }
    template <element T, std::size_t E>
    buffer<T> upload(std::span<const T, E> data)
    {
        memory();
        return inner_->upload(data);
    }
    template <element T>
    std::vector<T> download(const buffer<T>& b)
    {
        work();
        auto data = inner_->download(b);
        if (due(fault::wrong_contents))
            for (auto& x : data)
                x = random_bits<T>();
        return data;
    }
    template <gather_kernel K, class Reads, class Writes>
    void run(launch l, const typename K::Params& args, Reads reads, Writes writes)
    {
        work();
        inner_->template run<K>(l, args, reads, writes);
        if (due(fault::garbage))
            spoil_all(writes);
    }
    template <iterative_kernel K, class Reads, class Writes>
    progress run_until_done(launch l, const typename K::Params& args, Reads reads, Writes writes, uint passes)
    {
        work();
        auto p = inner_->template run_until_done<K>(l, args, reads, writes, passes);
        if (due(fault::garbage)) {
            spoil_all(writes);
            p = {.passes = 0xFFFFFFFFu, .finished = !p.finished, .active = {~std::uint64_t{0}}};
        }
        return p;
    }
    template <predicate_kernel K, class Reads>
    std::uint64_t count(launch l, const typename K::Params& args, Reads reads)
    {
        work();
        const auto n = inner_->template count<K>(l, args, reads);
        return due(fault::wrong_count) ? wrong_ : n;
    }
    template <route_kernel K, class Reads>
    void route(launch l, const typename K::Params& args, Reads reads, const route_shape& to, buffer<uint>& slots,
        buffer<glm::vec4>& totals)
    {
        work();
        inner_->template route<K>(l, args, reads, to, slots, totals);
        if (due(fault::garbage))
            spoil_all(writes(slots, totals));
    }
    void finish()
    {
        work();
        inner_->finish();
    }
    const capabilities& caps() const { return inner_->caps(); }
    std::uint64_t bytes() const { return inner_->bytes(); }
    std::uint64_t peak_bytes() const { return inner_->peak_bytes(); }
    const std::map<std::string, kernel_cost>& costs() const { return inner_->costs(); }

private:
    /// Counts a call for fault f; true at the n-th.
    bool due(fault f) { return fault_ == f && ++calls_ == at_; }
    void memory()
    {
        loss();
        if (due(fault::out_of_memory))
            throw backend_error("injected: out of memory");
    }
    void work()
    {
        loss();
        if (due(fault::submit_failed))
            throw backend_error("injected: submit failed");
    }
    void loss()
    {
        lost_ = due(fault::device_lost) || lost_;
        if (lost_)
            throw backend_error("injected: device lost");
    }

    template <class T>
    T random_bits()
    {
        T x{};
        unsigned char bytes[sizeof(T)];
        for (auto& byte : bytes)
            byte = static_cast<unsigned char>(random_());
        std::memcpy(&x, bytes, sizeof(T));
        return x;
    }
    float random_float()
    {
        constexpr float inf = std::numeric_limits<float>::infinity();
        constexpr float odd[]
            = {std::numeric_limits<float>::quiet_NaN(), inf, -inf, 3e38f, -3e38f, 1e-45f, -0.0f, 1.0f};
        const auto which = random_() % 16;
        return which < 8 ? odd[which] : random_bits<float>();
    }
    /// A whole number: as it may be, a little past what it may be, far past it, or NONE.
    uint random_whole(std::size_t elements)
    {
        const auto which = random_() % 16;
        return which == 0 ? 0xFFFFFFFFu : static_cast<uint>(random_() % (which < 4 ? 100000 : 2 * elements + 2));
    }
    template <class Writes>
    void spoil_all(const Writes& writes)
    {
        std::apply([&](auto&... buffers) { (spoil(buffers), ...); }, writes);
    }
    /// Overwrites a buffer.
    template <class Buffer>
    void spoil(Buffer& b)
    {
        using T = typename Buffer::value_type;
        auto data = inner_->download(b);
        for (auto& x : data)
            if constexpr (std::same_as<T, float>)
                x = random_float();
            else if constexpr (std::same_as<T, uint>)
                x = random_whole(data.size());
            else
                for (typename T::length_type c = 0; c < T::length(); ++c)
                    if constexpr (std::same_as<typename T::value_type, float>)
                        x[c] = random_float();
                    else
                        x[c] = random_whole(data.size());
        b = inner_->upload(std::span<const T>(data));
    }

    B* inner_;
    fault fault_ = fault::none;
    std::uint64_t at_ = 0, wrong_ = 0, calls_ = 0;
    bool lost_ = false;
    std::mt19937_64 random_;
};

} // namespace photongrid::testing
