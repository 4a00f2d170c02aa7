// The cpu backend (cpu.hpp) without its overrides: it runs every kernel, on any number of threads. The results are the
// same; it is several times slower and compiles in a third of the time. Tests compare the two.
#pragma once

#include <photongrid/backends/cpu/buffer.hpp>
#include <photongrid/backends/cpu/pool.hpp>
#include <photongrid/core/backend.hpp>

#include <atomic>
#include <bit>
#include <chrono>
#include <mutex>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Runs every algorithm by its kernels, on several threads. cpu_backend does so too where it has no override.
/// \headerfile backends/cpu/cpu_by_kernels.hpp <photongrid/backends/cpu/cpu_by_kernels.hpp>
class cpu_by_kernels {
public:
    /// Elements in memory: value_type, size(), moved and not copied. It belongs to the thread that drives the backend.
    template <element T>
    using buffer = cpu::buffer<T>;

    /// `threads`: 0 for as many as the machine has. With 1 there is no thread pool.
    explicit cpu_by_kernels(uint threads = 0) : pool_(threads)
    {
        caps_.backend = "cpu";
        caps_.device = "this CPU, " + std::to_string(pool_.threads()) + (pool_.threads() == 1 ? " thread" : " threads");
        caps_.max_elements = std::uint64_t{1} << 31;
        caps_.cells_per_radius = 1;
        caps_.prefers_blocks = true;
        caps_.max_route_slots = 16;
        caps_.photon_batch = std::bit_ceil(4096 * pool_.threads()); // their frames stay in the caches
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
        if (n > caps_.max_elements)
            refuse(n, "the limit is " + std::to_string(caps_.max_elements));
        try {
            return buffer<T>(account_, n);
        } catch (const std::bad_alloc&) {
            refuse(n, "there is no memory for it");
        }
    }
    template <element T, std::size_t E>
    buffer<T> upload(std::span<const T, E> data)
    {
        auto b = make<T>(data.size());
        if (!data.empty())
            std::memcpy(b.elements(), data.data(), data.size_bytes());
        return b;
    }
    template <element T>
    std::vector<T> download(const buffer<T>& b)
    {
        const auto r = elements(b);
        return {r.begin(), r.end()};
    }

    template <gather_kernel K, class Reads, class Writes>
    void run(launch l, const typename K::Params& args, Reads reads, Writes writes)
    {
        detail::check_call<K>("run", l, reads, writes);
        const stopwatch watch;
        const K prepared = prepare<K>(l, args, reads);
        const auto out = elements_of<K>(writes);
        pool_.for_blocks(l.elements, block, [&](std::size_t first, std::size_t past) {
            run_all(prepared, l.first + static_cast<uint>(first), l.first + static_cast<uint>(past), out);
        });
        count_passes(kernel_name<K>(), 1, watch);
    }

    template <iterative_kernel K, class Reads, class Writes>
    progress run_until_done(launch l, const typename K::Params& args, Reads reads, Writes writes, uint max_passes)
    {
        detail::check_call<K>("run_until_done", l, reads, writes);
        const stopwatch watch;
        const K prepared = prepare<K>(l, args, reads);
        const auto out = elements_of<K>(writes);
        std::mutex adding;
        std::atomic<bool> finished = true;
        std::vector<std::uint64_t> ended; // ended[q]: elements that ran q passes
        pool_.for_blocks(l.elements, iterative_block, [&](std::size_t first, std::size_t past) {
            K k = prepared;
            std::vector<std::uint64_t> mine;
            for (uint i = l.first + static_cast<uint>(first); i != l.first + static_cast<uint>(past); ++i) {
                load(k, i, out);
                uint q = 0;
                for (; q < max_passes && !k.done(); ++q)
                    k.kernel(i);
                if (!k.done())
                    finished = false;
                if (q > 0) // else the outputs are still those of the element before
                    store(k, i, out);
                if (q >= mine.size())
                    mine.resize(q + std::size_t{1});
                ++mine[q];
            }
            const std::lock_guard lock(adding);
            ended.resize(std::max(ended.size(), mine.size()));
            for (std::size_t q = 0; q < mine.size(); ++q)
                ended[q] += mine[q];
        });
        progress p;
        p.finished = finished;
        p.passes = ended.empty() ? 0u : static_cast<uint>(ended.size() - 1);
        p.active.assign(p.passes, 0);
        for (std::uint64_t q = p.passes, still = 0; q > 0; --q)
            p.active[q - 1] = still += ended[q];
        count_passes(kernel_name<K>(), p.passes, watch);
        return p;
    }

    /// Not a verb of the concept. For each element i of the launch, computes elements i, i + stride, i + 2 stride and
    /// so on in turn, each from the one before, until done() or `most` of them. Returns the most for any element.
    template <iterative_kernel K, class Reads, class Writes>
    uint run_frames(launch l, uint stride, const typename K::Params& args, Reads reads, Writes writes, uint most)
    {
        detail::check_call<K>("run_frames", l, reads, writes);
        const stopwatch watch;
        const K prepared = prepare<K>(l, args, reads);
        const auto out = elements_of<K>(writes);
        std::mutex comparing;
        uint longest = 0;
        pool_.for_blocks(l.elements, iterative_block, [&](std::size_t first, std::size_t past) {
            const uint mine = run_in_turn(
                prepared, l.first + static_cast<uint>(first), l.first + static_cast<uint>(past), stride, most, out);
            const std::lock_guard lock(comparing);
            longest = std::max(longest, mine);
        });
        count_passes(kernel_name<K>(), longest, watch);
        return longest;
    }

    template <predicate_kernel K, class Reads>
    std::uint64_t count(launch l, const typename K::Params& args, Reads reads)
    {
        detail::check_call<K>("count", l, reads, std::tuple<>{});
        const stopwatch watch;
        const K prepared = prepare<K>(l, args, reads);
        std::atomic<std::uint64_t> n = 0;
        pool_.for_blocks(l.elements, block, [&](std::size_t first, std::size_t past) {
            K k = prepared;
            std::uint64_t mine = 0;
            for (uint i = l.first + static_cast<uint>(first); i != l.first + static_cast<uint>(past); ++i)
                mine += k.holds(i) ? 1u : 0u;
            n += mine;
        });
        count_passes(kernel_name<K>(), 1, watch);
        return n;
    }

    /// Draws are computed by all threads and delivered by one, in order.
    template <route_kernel K, class Reads>
    void route(launch l, const typename K::Params& args, Reads reads, const route_shape& to, buffer<uint>& slots,
        buffer<glm::vec4>& totals)
    {
        detail::check_route(to, caps_.max_route_slots, slots.size(), totals.size());
        const auto [destinations, m] = to;
        const stopwatch watch;
        const K prepared = prepare<K>(l, args, reads);
        constexpr std::size_t batch = 65536; // draws in memory at a time
        std::vector<draw> draws(std::min<std::size_t>(batch, l.elements));
        const uint capacity = route_capacity(m);
        const uint sums = route_sums(totals.size(), destinations);
        const uint draws_per_sum = route_block(l.elements, sums);
        std::vector<uint> arrived(destinations);
        const auto slot_elements = elements_to_write(slots);
        const auto total_elements = elements_to_write(totals);
        std::fill(slot_elements.begin(), slot_elements.end(), no_id);
        std::fill(total_elements.begin(), total_elements.end(), glm::vec4(0));
        for (std::size_t begin = 0; begin < l.elements; begin += batch) {
            const std::size_t n = std::min(batch, l.elements - begin);
            pool_.for_blocks(n, block, [&](std::size_t first, std::size_t past) {
                draw_all(prepared, l.first + static_cast<uint>(begin), first, past, draws.data());
            });
            for (std::size_t i = 0; i < n; ++i) {
                const auto& [d, payload, amount] = draws[i];
                if (d >= destinations)
                    continue;
                if (arrived[d] < capacity)
                    slot_elements[std::size_t{d} * capacity + arrived[d]++] = payload;
                total_elements[std::size_t{d} * sums + (begin + i) / draws_per_sum] += amount;
            }
        }
        count_passes(kernel_name<K>(), 1, watch);
    }

    void finish() {}
    const capabilities& caps() const { return caps_; }
    std::uint64_t bytes() const { return account_->now; }
    std::uint64_t peak_bytes() const { return account_->peak; }
    const std::map<std::string, kernel_cost>& costs() const { return costs_; }
    /// @}

    // For overrides.

    /// The threads that passes run on, the caller's among them.
    cpu::pool& threads() { return pool_; }

    /// A buffer's elements, as an array of structures.
    template <element T>
    std::span<const T> elements(const buffer<T>& b)
    {
        if constexpr (std::same_as<T, glm::vec4>)
            transpose(b, false);
        return {b.elements(), b.size()};
    }
    /// The same, for writing; the contents are kept.
    template <element T>
    std::span<T> elements_to_write(buffer<T>& b)
    {
        elements(b);
        return {b.elements(), b.size()};
    }
    /// A buffer's elements, as a structure of arrays.
    cpu::soa_vectors<const float> components(const buffer<glm::vec4>& b)
    {
        transpose(b, true);
        const auto p = b.components();
        return {p.x, p.y, p.z, p.w};
    }
    /// The same, for writing; the old contents are discarded.
    cpu::soa_vectors<float> components_to_write(buffer<glm::vec4>& b)
    {
        b.is_soa_ = true;
        return b.components();
    }
    /// Measures the time since its construction.
    /// \headerfile backends/cpu/cpu_by_kernels.hpp <photongrid/backends/cpu/cpu_by_kernels.hpp>
    class stopwatch {
    public:
        /// Milliseconds so far.
        double ms() const
        {
            return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
        }

    private:
        std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    };
    /// Adds passes and their time to costs(), under a kernel's name or an override's own.
    [[gnu::noinline]] void count_passes(std::string_view name, uint passes, const stopwatch& watch)
    {
        auto& cost = costs_[std::string(name)];
        cost.passes += passes;
        cost.ms += watch.ms();
    }

private:
    [[noreturn, gnu::cold, gnu::noinline]] static void refuse(std::size_t n, const std::string& why)
    {
        throw backend_error("cpu: a buffer of " + std::to_string(n) + " elements was asked for; " + why);
    }

    /// One draw of a routing kernel.
    struct draw {
        uint destination, payload;
        glm::vec4 amount;
    };
    static constexpr std::size_t block = 512, iterative_block = 256; // elements that a thread takes at a time

    void transpose(const buffer<glm::vec4>& b, bool to_soa)
    {
        if (b.is_soa_ == to_soa)
            return;
        buffer<glm::vec4> other = make<glm::vec4>(b.size());
        const auto p = to_soa ? other.components() : b.components();
        glm::vec4* const r = to_soa ? b.elements() : other.elements();
        pool_.for_blocks(b.size(), 16 * block, [&](std::size_t first, std::size_t past) {
            for (std::size_t i = first; i != past; ++i) {
                if (to_soa) {
                    p.x[i] = r[i].x;
                    p.y[i] = r[i].y;
                    p.z[i] = r[i].z;
                    p.w[i] = r[i].w;
                } else {
                    r[i] = {p.x[i], p.y[i], p.z[i], p.w[i]};
                }
            }
        });
        std::swap(b.data_, other.data_);
        b.is_soa_ = to_soa;
    }

    template <class K, class Reads>
    K prepare(const launch& l, const typename K::Params& args, [[maybe_unused]] const Reads& reads)
    {
        K k{};
        k.args = args;
        turn_switches(k, l.switches);
        if constexpr (input_count<K> != 0)
            detail::for_each_slot<input_count<K>>([&](auto s) { k.bind(s, elements(std::get<s.index>(reads))); });
        return k;
    }
    template <class K, class Writes>
    auto elements_of(Writes& writes)
    {
        return std::apply([&](auto&... b) { return std::tuple{elements_to_write(b).data()...}; }, writes);
    }
    // Without these attributes g++ does not inline the larger kernels, and tracing takes a sixth longer.
    template <class K, class Elements>
    [[gnu::noinline, gnu::flatten]] static void run_all(K k, uint first, uint past, const Elements& out)
    {
        for (uint i = first; i != past; ++i) {
            load(k, i, out);
            k.kernel(i);
            store(k, i, out);
        }
    }
    template <class K, class Elements>
    [[gnu::noinline, gnu::flatten]] static uint run_in_turn(
        K k, uint first, uint past, uint stride, uint most, const Elements& out)
    {
        uint longest = 0;
        for (uint i = first; i != past; ++i) {
            bool done = false;
            uint q = 0;
            for (uint at = i; q < most && !done; ++q, at += stride) {
                load(k, at, out);
                k.kernel(at);
                store(k, at, out);
                done = k.done();
            }
            longest = std::max(longest, q);
        }
        return longest;
    }
    template <class K>
    [[gnu::noinline, gnu::flatten]] static void draw_all(
        K k, uint begin, std::size_t first, std::size_t past, draw* draws)
    {
        for (std::size_t i = first; i != past; ++i) {
            k.kernel(begin + static_cast<uint>(i));
            draws[i] = {k.output(slot<0>{}), k.output(slot<1>{}), k.output(slot<2>{})};
        }
    }
    template <class K, class Elements>
    static void load(K& k, uint i, const Elements& out)
    {
        if constexpr (output_count<K> != 0)
            detail::for_each_slot<output_count<K>>([&](auto s) {
                if constexpr (K::is_state(s))
                    k.output(s) = std::get<s.index>(out)[i];
            });
    }
    template <class K, class Elements>
    static void store(K& k, uint i, const Elements& out)
    {
        if constexpr (output_count<K> != 0)
            detail::for_each_slot<output_count<K>>([&](auto s) { std::get<s.index>(out)[i] = k.output(s); });
    }

    cpu::pool pool_;
    capabilities caps_;
    std::shared_ptr<cpu::account> account_ = std::make_shared<cpu::account>();
    std::map<std::string, kernel_cost> costs_;
};

static_assert(backend<cpu_by_kernels>);

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
