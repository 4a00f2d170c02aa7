// The serial backend: plain loops over the kernel structs. It is the specification of all other backends. In debug
// builds its accessors check every index of a kernel.
#pragma once

#include <photongrid/core/backend.hpp>

#include <algorithm>
#include <memory>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Runs kernels in plain loops on one thread, in IEEE 754 single precision. The other backends are compared with it.
/// One thread at a time may use a backend and its buffers; a buffer may outlive it.
/// \headerfile backends/serial/serial.hpp <photongrid/backends/serial/serial.hpp>
/// \snippet snippets.cpp serial_backend
class serial_backend {
    struct account {
        std::uint64_t now = 0, peak = 0;
    };

public:
    /// Elements in memory.
    /// \headerfile backends/serial/serial.hpp <photongrid/backends/serial/serial.hpp>
    template <element T>
    class buffer {
    public:
        /// \name A buffer's members, the same on every backend
        /// @{

        /// A buffer has size() elements T. It can be moved but not copied. A moved-from or default-constructed buffer
        /// is empty.
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
            if (account_)
                account_->now -= data_.size() * sizeof(T);
        }
        std::size_t size() const noexcept { return data_.size(); }
        /// @}

    private:
        friend serial_backend;
        buffer(std::shared_ptr<account> a, std::vector<T> data) : account_(std::move(a)), data_(std::move(data))
        {
            account_->now += data_.size() * sizeof(T);
            account_->peak = std::max(account_->peak, account_->now);
        }
        void swap(buffer& other) noexcept
        {
            std::swap(account_, other.account_);
            std::swap(data_, other.data_);
        }
        std::shared_ptr<account> account_;
        std::vector<T> data_;
    };

    /// It needs no device.
    serial_backend()
    {
        caps_.backend = "serial";
        caps_.device = "this CPU, one thread";
        caps_.max_elements = std::uint64_t{1} << 31;
        caps_.max_route_slots = 16;
        caps_.exact_division = true; // IEEE 754, as C++ on every platform with std::numeric_limits<float>::is_iec559
        caps_.exact_sqrt = true;
        static_assert(std::numeric_limits<float>::is_iec559);
    }

    /// \name The verbs of a backend, as backend.hpp describes them
    /// @{

    /// See the concept photongrid::backend.
    template <element T>
    buffer<T> make(std::size_t n)
    {
        check_size(n);
        return buffer<T>(account_, std::vector<T>(n));
    }
    template <element T, std::size_t E>
    buffer<T> upload(std::span<const T, E> data)
    {
        check_size(data.size());
        return buffer<T>(account_, std::vector<T>(data.begin(), data.end()));
    }
    template <element T>
    std::vector<T> download(const buffer<T>& b)
    {
        return b.data_;
    }

    template <gather_kernel K, class Reads, class Writes>
    void run(launch l, const typename K::Params& args, Reads reads, Writes writes)
    {
        detail::check_call<K>("run", l, reads, writes);
        run_all(prepare<K>(l, args, reads), l, writes);
        ++costs_[std::string(kernel_name<K>())].passes;
    }

    template <iterative_kernel K, class Reads, class Writes>
    progress run_until_done(launch l, const typename K::Params& args, Reads reads, Writes writes, uint max_passes)
    {
        detail::check_call<K>("run_until_done", l, reads, writes);
        K k = prepare<K>(l, args, reads);
        progress p;
        p.finished = true;
        std::vector<std::uint64_t> ended; // ended[q]: elements that took q passes
        for (uint i = l.first; i != l.first + l.elements; ++i) {
            load(k, i, writes);
            uint q = 0;
            for (; q < max_passes && !k.done(); ++q)
                k.kernel(i);
            p.finished = k.done() && p.finished;
            if (q > 0) // else the outputs still belong to the previous element
                store(k, i, writes);
            if (q >= ended.size())
                ended.resize(q + std::size_t{1});
            ++ended[q];
        }
        p.passes = ended.empty() ? 0u : static_cast<uint>(ended.size() - 1);
        p.active.assign(p.passes, 0);
        for (std::uint64_t q = p.passes, still = 0; q > 0; --q)
            p.active[q - 1] = still += ended[q];
        costs_[std::string(kernel_name<K>())].passes += p.passes;
        return p;
    }

    template <predicate_kernel K, class Reads>
    std::uint64_t count(launch l, const typename K::Params& args, Reads reads)
    {
        detail::check_call<K>("count", l, reads, std::tuple<>{});
        K k = prepare<K>(l, args, reads);
        std::uint64_t n = 0;
        for (uint i = l.first; i != l.first + l.elements; ++i)
            n += k.holds(i) ? 1u : 0u;
        ++costs_[std::string(kernel_name<K>())].passes;
        return n;
    }

    template <route_kernel K, class Reads>
    void route(launch l, const typename K::Params& args, Reads reads, const route_shape& to, buffer<uint>& slots,
        buffer<glm::vec4>& totals)
    {
        detail::check_route(to, caps_.max_route_slots, slots.size(), totals.size());
        const auto [destinations, m] = to;
        K k = prepare<K>(l, args, reads);
        const uint capacity = route_capacity(m);
        const uint sums = route_sums(totals.size(), destinations);
        const uint block = route_block(l.elements, sums);
        std::vector<uint> arrived(destinations);
        std::fill(slots.data_.begin(), slots.data_.end(), no_id);
        std::fill(totals.data_.begin(), totals.data_.end(), glm::vec4(0));
        route_all(std::move(k), l, arrived, {slots.data_.data(), capacity, totals.data_.data(), sums, block});
        ++costs_[std::string(kernel_name<K>())].passes;
    }

    void finish() {}
    const capabilities& caps() const { return caps_; }
    std::uint64_t bytes() const { return account_->now; }
    std::uint64_t peak_bytes() const { return account_->peak; }
    const std::map<std::string, kernel_cost>& costs() const { return costs_; }
    /// @}

private:
    void check_size(std::size_t elements) const
    {
        if (elements > caps_.max_elements)
            throw backend_error("serial: a buffer of " + std::to_string(elements)
                + " elements was asked for; the limit is " + std::to_string(caps_.max_elements));
    }
    template <class K, class Reads>
    static K prepare(const launch& l, const typename K::Params& args, [[maybe_unused]] const Reads& reads)
    {
        K k{};
        k.args = args;
        turn_switches(k, l.switches);
        if constexpr (input_count<K> != 0)
            detail::for_each_slot<input_count<K>>(
                [&](auto s) { k.bind(s, std::span<const input_t<K, s.index>>(std::get<s.index>(reads).data_)); });
        return k;
    }
    // g++ leaves the larger kernels out of line if it may, which costs a twentieth of tracing.
    template <class K, class Writes>
    [[gnu::noinline, gnu::flatten]] static void run_all(K k, const launch& l, Writes& writes)
    {
        for (uint i = l.first; i != l.first + l.elements; ++i) {
            load(k, i, writes);
            k.kernel(i);
            store(k, i, writes);
        }
    }
    struct deliveries {
        uint* slots;
        uint capacity; ///< slots per destination
        glm::vec4* totals;
        uint sums;  ///< per destination
        uint block; ///< draws per sum
    };
    /// Delivers each draw: `arrived` has an element per destination.
    template <class K>
    [[gnu::noinline, gnu::flatten]] static void route_all(
        K k, const launch& l, std::vector<uint>& arrived, const deliveries to)
    {
        for (uint i = l.first; i != l.first + l.elements; ++i) {
            k.kernel(i);
            const uint d = k.output(slot<0>{});
            if (d >= arrived.size())
                continue;
            if (arrived[d] < to.capacity)
                to.slots[std::size_t{d} * to.capacity + arrived[d]++] = k.output(slot<1>{});
            to.totals[std::size_t{d} * to.sums + (i - l.first) / to.block] += k.output(slot<2>{});
        }
    }
    template <class K, class Writes>
    static void load(K& k, uint i, Writes& writes)
    {
        if constexpr (output_count<K> != 0)
            detail::for_each_slot<output_count<K>>([&](auto s) {
                if constexpr (K::is_state(s))
                    k.output(s) = std::get<s.index>(writes).data_[i];
            });
    }
    template <class K, class Writes>
    static void store(K& k, uint i, Writes& writes)
    {
        if constexpr (output_count<K> != 0)
            detail::for_each_slot<output_count<K>>([&](auto s) { std::get<s.index>(writes).data_[i] = k.output(s); });
    }

    capabilities caps_;
    std::shared_ptr<account> account_ = std::make_shared<account>();
    std::map<std::string, kernel_cost> costs_;
};

static_assert(backend<serial_backend>);

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
