// A complete small backend: it wraps any other, forwards every verb to it, and records each call.
#pragma once

#include <photongrid/core/backend.hpp>

#include <chrono>
#include <iomanip>
#include <numeric>
#include <ostream>

namespace photongrid::examples {

/// The calls of one verb with one kernel.
struct trace_entry {
    std::uint64_t calls = 0;
    std::uint64_t elements = 0; ///< over all passes
    std::uint64_t passes = 0;
    std::uint64_t bytes = 0; ///< uploaded, downloaded, or written by passes
    double ms = 0;           ///< until the call returned, or until the work was done if the tracer waits
};

/// Has a backend of its own, made from the constructor's arguments; tracing_backend<B&> works on one of yours.
/// Overrides are for a backend's own type: a wrapped one runs the algorithms by kernels.
template <class Inner>
requires backend<std::remove_reference_t<Inner>>
class tracing_backend {
public:
    template <class T>
    using buffer = typename std::remove_reference_t<Inner>::template buffer<T>;

    template <class... Arguments>
    requires std::constructible_from<Inner, Arguments...>
    explicit tracing_backend(Arguments&&... arguments) : inner_(std::forward<Arguments>(arguments)...) {}

    /// Whether each verb waits until the device is done, so that its time is its own. Slower: nothing overlaps.
    void wait_for_each_verb(bool waits) { waits_ = waits; }
    /// By verb and kernel; no kernel: "-".
    const auto& entries() const { return entries_; }
    void print(std::ostream& out) const;

    template <element T>
    buffer<T> make(std::size_t n)
    {
        const auto start = clock::now();
        auto b = inner_.template make<T>(n);
        note("make", "-", start, {.elements = n});
        return b;
    }
    template <element T, std::size_t E>
    buffer<T> upload(std::span<const T, E> data)
    {
        const auto start = clock::now();
        auto b = inner_.upload(data);
        note("upload", "-", start, {.elements = data.size(), .bytes = data.size_bytes()});
        return b;
    }
    template <element T>
    std::vector<T> download(const buffer<T>& b)
    {
        const auto start = clock::now();
        auto data = inner_.download(b);
        note("download", "-", start, {.elements = data.size(), .bytes = data.size() * sizeof(T)});
        return data;
    }

    template <gather_kernel K, class Reads, class Writes>
    void run(launch l, const typename K::Params& args, Reads reads, Writes writes)
    {
        const auto start = clock::now();
        inner_.template run<K>(l, args, reads, writes);
        note("run", kernel_name<K>(), start,
            {.elements = l.elements, .passes = 1, .bytes = l.elements * element_bytes(writes)});
    }
    template <iterative_kernel K, class Reads, class Writes>
    progress run_until_done(launch l, const typename K::Params& args, Reads reads, Writes writes, uint max_passes)
    {
        const auto start = clock::now();
        auto p = inner_.template run_until_done<K>(l, args, reads, writes, max_passes);
        const auto computed = std::accumulate(p.active.begin(), p.active.end(), std::uint64_t{0});
        note("run_until_done", kernel_name<K>(), start,
            {.elements = computed, .passes = p.passes, .bytes = computed * element_bytes(writes)});
        return p;
    }
    template <predicate_kernel K, class Reads>
    std::uint64_t count(launch l, const typename K::Params& args, Reads reads)
    {
        const auto start = clock::now();
        const auto n = inner_.template count<K>(l, args, reads);
        note("count", kernel_name<K>(), start, {.elements = l.elements, .passes = 1});
        return n;
    }
    template <route_kernel K, class Reads>
    void route(launch l, const typename K::Params& args, Reads reads, const route_shape& to, buffer<uint>& slots,
        buffer<glm::vec4>& totals)
    {
        const auto start = clock::now();
        inner_.template route<K>(l, args, reads, to, slots, totals);
        note("route", kernel_name<K>(), start,
            {.elements = l.elements,
                .passes = 1,
                .bytes = slots.size() * sizeof(uint) + totals.size() * sizeof(glm::vec4)});
    }

    void finish()
    {
        const auto start = clock::now();
        inner_.finish();
        note("finish", "-", start, {});
    }
    const capabilities& caps() const { return inner_.caps(); }
    std::uint64_t bytes() const { return inner_.bytes(); }
    std::uint64_t peak_bytes() const { return inner_.peak_bytes(); }
    const std::map<std::string, kernel_cost>& costs() const { return inner_.costs(); }

private:
    using clock = std::chrono::steady_clock;

    /// Bytes of one element in all buffers that a kernel writes.
    template <class... Buffers>
    static constexpr std::uint64_t element_bytes(const std::tuple<Buffers&...>&)
    {
        return (sizeof(typename Buffers::value_type) + ... + 0u);
    }
    void note(std::string_view verb, std::string_view kernel, clock::time_point start, const trace_entry& more)
    {
        if (waits_)
            inner_.finish();
        auto& e = entries_[{std::string(verb), std::string(kernel)}];
        ++e.calls;
        e.elements += more.elements;
        e.passes += more.passes;
        e.bytes += more.bytes;
        e.ms += std::chrono::duration<double, std::milli>(clock::now() - start).count();
    }

    Inner inner_;
    bool waits_ = false;
    std::map<std::pair<std::string, std::string>, trace_entry> entries_;
};

template <class Inner>
requires backend<std::remove_reference_t<Inner>>
void tracing_backend<Inner>::print(std::ostream& out) const
{
    const auto flags = out.flags();
    const auto row = [&](const auto&... columns) { ((out << columns), ...) << '\n'; };
    const auto right = [](int width) { return std::setw(width); };
    row(std::left, right(16), "verb", right(24), "kernel", std::right, right(8), "calls", right(8), "passes", right(14),
        "elements", right(16), "bytes", right(12), "ms");
    for (const auto& [key, e] : entries_)
        row(std::left, right(16), key.first, right(24), key.second, std::right, right(8), e.calls, right(8), e.passes,
            right(14), e.elements, right(16), e.bytes, std::fixed, std::setprecision(2), right(12), e.ms);
    out.flags(flags);
}

} // namespace photongrid::examples
