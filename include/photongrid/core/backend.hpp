// The interface of a backend: buffers and a few verbs. docs/design/design.md says where the paper has each verb.
#pragma once

#include <photongrid/core/kernel.hpp>

#include <cstdint>
#include <limits>
#include <map>
#include <ranges>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

/// The library. Lengths are in m, power in W, irradiance in W/m^2, radiance in W/(m^2 sr), linear rgb.
namespace photongrid {

/// A missing driver, a context that cannot be created, an exceeded device limit, or a lost device. The message says
/// what was tried, what failed, and what to install or change.
struct backend_error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Which elements a pass computes: `first`, `first + 1`, … `first + elements - 1`. Bit B of `switches` is the kernel's
/// Where route sends draws: m x m slots for each of some destinations.
struct route_shape {
    uint destinations = 0;
    uint m = 1;
};

/// SWITCH B. Implicitly constructible from an element count.
struct launch {
    uint elements = 0;   ///< how many; 0: the pass does nothing
    uint first = 0;      ///< index of the first
    uint switches = ~0u; ///< ~0: all on

    /// \throws std::invalid_argument for an index beyond 2^32 - 1.
    constexpr launch(std::size_t elements_, uint first_ = 0, uint switches_ = ~0u)
        : elements(static_cast<uint>(elements_)), first(first_), switches(switches_)
    {
        if (elements_ > std::numeric_limits<uint>::max() - first_)
            throw std::invalid_argument("launch: elements: more than 2^32 - 1 elements in one pass");
    }
};

/// The buffers that a kernel reads, in the order of its INPUT slots.
template <class... Buffers>
std::tuple<const Buffers&...> reads(const Buffers&... buffers)
{
    return {buffers...};
}

/// The buffers that a kernel writes, in the order of its OUTPUT and STATE slots.
template <class... Buffers>
std::tuple<Buffers&...> writes(Buffers&... buffers)
{
    return {buffers...};
}

/// The result of run_until_done.
struct progress {
    uint passes = 0;                   ///< passes run
    bool finished = false;             ///< true when every element is done
    std::vector<std::uint64_t> active; ///< per pass: the elements that were not done when it began
};

/// The cost of one kernel so far.
struct kernel_cost {
    std::uint64_t instructions = 0; ///< SPIR-V instructions; 0 if the backend compiles no SPIR-V
    double compile_ms = 0;          ///< all specialisations together
    double ms = 0; ///< time of its passes, if the backend measures it: cpu always, vulkan and gl with time_passes
    std::uint64_t passes = 0; ///< passes run so far
};

/// The cost of all kernels together; `costs` are a backend's.
inline kernel_cost total_cost(const std::map<std::string, kernel_cost>& costs)
{
    kernel_cost all;
    for (const auto& [kernel, cost] : costs) {
        all.instructions += cost.instructions;
        all.compile_ms += cost.compile_ms;
        all.ms += cost.ms;
        all.passes += cost.passes;
    }
    return all;
}

/// The properties of a device. They do not change after the backend's construction.
struct capabilities {
    std::string backend;            ///< "serial", "cpu", "gl", "gl-osmesa", "vulkan", or a name of your own
    std::string device;             ///< the driver's name for it
    bool software = true;           ///< true if the device is a CPU
    std::uint64_t max_elements = 0; ///< of one buffer
    uint max_route_slots = 0;       ///< the largest m of route's m x m slots per destination
    bool exact_division = false;    ///< a / b rounds correctly, by itself or rewritten (self-test)
    bool exact_sqrt = false;        ///< sqrt rounds correctly, by itself or rewritten (self-test)
    float cells_per_radius = 2;     ///< the grid resolution at which searches are fastest: cells per search radius
    /// Block maps are searched about as fast as grid maps, and faster where one photon is sought or from afar.
    bool prefers_blocks = false;
    uint loop_limit = 0; ///< iterations after which the driver silently ends loops; 0: none known
    /// The number of photon paths traced together with which it is fastest; a power of two, at least 1024.
    uint photon_batch = 32768;
};

namespace detail {
    /// For backends that accept any buffer: no check of ownership.
    inline constexpr auto any_owner = [](const auto&) { return true; };

    // These two are not inlined: each verb of each kernel would give the compiler their words again.
    [[noreturn, gnu::cold, gnu::noinline]] inline void refuse_owner(
        const char* verb, std::string_view kernel, std::string_view buffer)
    {
        throw std::invalid_argument(std::string(verb) + "<" + std::string(kernel) + ">: buffer '" + std::string(buffer)
            + "' belongs to another backend; download it there and upload it here");
    }
    [[noreturn, gnu::cold, gnu::noinline]] inline void refuse_size(
        const char* verb, std::string_view kernel, std::string_view buffer, std::size_t size, const launch& l)
    {
        throw std::invalid_argument(std::string(verb) + "<" + std::string(kernel) + ">: buffer '" + std::string(buffer)
            + "' holds " + std::to_string(size) + " elements; the pass writes elements " + std::to_string(l.first)
            + " to " + std::to_string(std::uint64_t{l.first} + l.elements) + " (exclusive)");
    }

    inline void check_owner(bool owned, const char* verb, std::string_view kernel, std::string_view buffer)
    {
        if (!owned)
            refuse_owner(verb, kernel, buffer);
    }

    /// Checks a call's inputs against kernel K: types at compile time, ownership at run time by `owns`.
    template <kernel_struct K, class Reads, class Owns>
    void check_reads(
        [[maybe_unused]] const char* verb, [[maybe_unused]] const Reads& reads, [[maybe_unused]] const Owns& owns)
    {
        static_assert(
            std::tuple_size_v<Reads> == input_count<K>, "reads(...) must name one buffer per INPUT of the kernel");
        if constexpr (input_count<K> != 0)
            for_each_slot<input_count<K>>([&](auto s) {
                using buffer = std::remove_cvref_t<std::tuple_element_t<s.index, Reads>>;
                static_assert(std::same_as<typename buffer::value_type, input_t<K, s.index>>,
                    "a buffer's element type differs from the kernel's INPUT");
                check_owner(owns(std::get<s.index>(reads)), verb, kernel_name<K>(), K::input_name(s));
            });
    }

    /// Checks a call's arguments against kernel K: types at compile time, sizes and ownership at run time.
    template <kernel_struct K, class Reads, class Writes, class Owns = decltype(any_owner)>
    void check_call(const char* verb, const launch& l, const Reads& reads, [[maybe_unused]] const Writes& writes,
        const Owns& owns = any_owner)
    {
        check_reads<K>(verb, reads, owns);
        static_assert(
            std::tuple_size_v<Writes> == output_count<K>, "writes(...) must name one buffer per OUTPUT and STATE");
        if constexpr (output_count<K> != 0)
            for_each_slot<output_count<K>>([&](auto s) {
                using buffer = std::remove_cvref_t<std::tuple_element_t<s.index, Writes>>;
                static_assert(std::same_as<typename buffer::value_type, output_t<K, s.index>>,
                    "a buffer's element type differs from the kernel's OUTPUT or STATE");
                if (const std::size_t size = std::get<s.index>(writes).size();
                    size < std::uint64_t{l.first} + l.elements)
                    refuse_size(verb, kernel_name<K>(), K::output_name(s), size, l);
                check_owner(owns(std::get<s.index>(writes)), verb, kernel_name<K>(), K::output_name(s));
            });
    }

    /// Checks the sizes of a route call; `limit` is the device's largest m.
    inline void check_route(const route_shape& to, uint limit, std::size_t slots, std::size_t totals)
    {
        const auto [destinations, m] = to;
        const std::uint64_t capacity = m * m < 255u ? m * m : 255u;
        if (m < 1 || m > limit)
            throw std::invalid_argument("route: m: " + std::to_string(m) + " by " + std::to_string(m)
                + " slots asked for; this device takes 1 to " + std::to_string(limit));
        if (slots < destinations * capacity || totals < destinations)
            throw std::invalid_argument("route: slots, totals: " + std::to_string(destinations) + " destinations of "
                + std::to_string(capacity) + " slots need buffers of " + std::to_string(destinations * capacity)
                + " and " + std::to_string(destinations) + " elements, not " + std::to_string(slots) + " and "
                + std::to_string(totals));
    }

    /// A kernel with one input and one output, for the concept below.
    struct concept_probe {
        struct Params {
            uint unused;
        };
        Params args{};
        static constexpr std::string_view path = "concept_probe.glsl";
        static uint input_type(slot<0>);
        static constexpr std::string_view input_name(slot<0>) { return "in"; }
        void bind(slot<0>, std::span<const uint>) {}
        uint out{};
        uint& output(slot<0>) { return out; }
        static constexpr std::string_view output_name(slot<0>) { return "out"; }
        static constexpr bool is_state(slot<0>) { return true; }
        void kernel(uint) {}
        bool done() { return true; }
        bool holds(uint) { return true; }
    };

    struct route_probe : concept_probe {
        uint payload{};
        glm::vec4 amount{};
        using concept_probe::is_state;
        using concept_probe::output;
        using concept_probe::output_name;
        uint& output(slot<1>) { return payload; }
        glm::vec4& output(slot<2>) { return amount; }
        static constexpr std::string_view output_name(slot<1>) { return "payload"; }
        static constexpr std::string_view output_name(slot<2>) { return "amount"; }
        static constexpr bool is_state(slot<1>) { return false; }
        static constexpr bool is_state(slot<2>) { return false; }
    };
} // namespace detail

/// A backend runs kernels over buffers. Work may be deferred; `download` and `finish` wait for it. Every verb throws
/// backend_error when the device refuses and std::invalid_argument when a buffer is too small.
///
/// After a backend_error, destructors still free every buffer, the outputs of the failed verb are undefined, and the
/// backend may be used again, unless the device was lost: then every verb throws. Algorithms pass exceptions on;
/// buffers that they were given to consume or to sort are then undefined. Kernels trust ids that earlier passes wrote,
/// unless they are compiled with PHOTONGRID_GUARD_READS (core/begin.hpp); host code throws backend_error for a count
/// from the device that is impossible.
///
/// A verb sees the results of all verbs before it. A pass may read a buffer that it also writes, if it reads none of
/// the elements that it writes (a STATE is its own element's old value). The outputs of one pass are different buffers.
/// Elements outside the launch keep their values.
///
/// - `make<T>(n)`: a buffer of n elements, n from 0 up, contents undefined
/// - `upload(span<const T>)`: a buffer with a copy of these contents, every bit
/// - `download(buffer)`: its contents as std::vector<T>, every bit
/// - `run<K>(launch, params, reads(…), writes(…))`: one pass (the paper's screen-sized quad)
/// - `run_until_done<K>(launch, params, reads, writes, passes)`: passes over the elements not yet done (3.3, 4.3), at
///   most `passes` of them, or `all_passes`; call it again to continue. Elements that are done are not written
/// - `count<K>(launch, params, reads(…))`: the number of elements for which `holds` is true (occlusion query)
/// - `route<K>(launch, params, reads, {destinations, m}, slots, totals)`: many-to-one scatter (2.2.2). With
///   cap = min(m*m, 255), slots[d*cap + r] is the payload of the r-th draw (in index order) with destination d, for
///   r < cap; other slots are `no_id`. totals[d] is the sum of all amounts with destination d, added in that order.
///   Draws with a destination past the last one are dropped. If `totals` has P elements per destination, there are P
///   partial sums: totals[d*P + p] is the sum, in order, of the draws of the p-th of P equal blocks. Shorter sums have
///   smaller rounding errors
/// - `finish()`: waits until all passes are done
/// - `caps()`, `bytes()`, `peak_bytes()`, `costs()`: the device's properties, the bytes in buffers now and at most, and
///   the cost of each kernel: one pass for each run, count and route, and the passes of run_until_done; further
///   draws or dispatches of a backend's own shaders count under their names
///
/// A buffer can be moved but not copied; a moved-from buffer is empty. It may be destroyed as soon as the call that
/// uses it has returned, and may outlive the backend.
// Not formatted: clang-format 14 breaks each of these lines in three.
// clang-format off
template <class B>
concept backend = requires(B& device, const B& const_device, typename B::template buffer<uint>& u,
    typename B::template buffer<glm::vec4>& v, launch l, detail::concept_probe::Params p, std::span<const uint> host) {
    { device.template make<uint>(std::size_t{}) } -> std::same_as<typename B::template buffer<uint>>;
    { device.upload(host) } -> std::same_as<typename B::template buffer<uint>>;
    { device.download(u) } -> std::same_as<std::vector<uint>>;
    { u.size() } -> std::same_as<std::size_t>;
    device.template run<detail::concept_probe>(l, p, reads(u), writes(u));
    { device.template run_until_done<detail::concept_probe>(l, p, reads(u), writes(u), uint{}) }
        -> std::same_as<progress>;
    { device.template count<detail::concept_probe>(l, p, reads(u)) } -> std::same_as<std::uint64_t>;
    device.template route<detail::route_probe>(l, p, reads(u), route_shape{}, u, v);
    device.finish();
    { const_device.caps() } -> std::same_as<const capabilities&>;
    { const_device.bytes() } -> std::same_as<std::uint64_t>;
    { const_device.peak_bytes() } -> std::same_as<std::uint64_t>;
    { const_device.costs() } -> std::same_as<const std::map<std::string, kernel_cost>&>;
};
// clang-format on

namespace detail {
    /// The number of elements for which predicate K holds. Throws backend_error if the device returns an impossible
    /// count.
    template <predicate_kernel K, backend B, class Reads>
    uint checked_count(B& device, launch l, const typename K::Params& args, Reads reads)
    {
        const std::uint64_t n = device.template count<K>(l, args, reads);
        if (n > l.elements)
            throw backend_error(device.caps().backend + ": count<" + std::string(kernel_name<K>())
                + ">: the device returned " + std::to_string(n) + "; there are " + std::to_string(l.elements)
                + " elements");
        return static_cast<uint>(n);
    }
} // namespace detail

/// The buffer type of backend B with elements T.
template <class B, element T>
using buffer_of = typename B::template buffer<T>;

/// A buffer with the elements of a contiguous range.
/// \throws backend_error if the device has no room.
/// \snippet snippets.cpp upload
template <backend B, std::ranges::contiguous_range Range>
requires std::ranges::sized_range<Range> && element<std::ranges::range_value_t<Range>>
    buffer_of<B, std::ranges::range_value_t<Range>> upload(B& device, const Range& elements)
{
    return device.upload(std::span<const std::ranges::range_value_t<Range>>(elements));
}

/// The number of slots of a routed destination: m*m, but at most 255, since an 8-bit stencil cannot count further
/// (docs/design/decisions.md).
constexpr uint route_capacity(uint m) { return m * m < 255u ? m * m : 255u; }

/// The number of partial sums per destination in route, if the buffer of totals has `totals` elements.
constexpr uint route_sums(std::size_t totals, uint destinations)
{
    return destinations == 0 ? 1u : static_cast<uint>(totals / destinations);
}
/// The number of draws per partial sum in route: `draws` cut into `sums` equal blocks, of which the last may be
/// shorter. At least 1.
constexpr uint route_block(uint draws, uint sums)
{
    const uint block = draws / sums + (draws % sums != 0 ? 1u : 0u);
    return block > 0 ? block : 1u;
}

/// Stands where there is no id: in a slot of route without a draw, in a list of fewer neighbours than were asked for.
/// As a draw's destination it means none.
inline constexpr uint no_id = 0xFFFFFFFFu;

/// As a limit of passes, in run_until_done and in the searches' advance(): as many as are needed.
inline constexpr uint all_passes = 0xFFFFFFFFu;

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
