// The Vulkan backend: compute shaders on storage buffers, with many passes per submission (docs/design/design.md).
#pragma once

#include <photongrid/backends/vulkan/frames.hpp>
#include <photongrid/backends/vulkan/routing.hpp>
#include <photongrid/core/self_test.hpp>

#include <bit>
#include <cassert>

namespace photongrid {

/// Runs kernels as compute shaders, on the best Vulkan 1.1 device, on a selected one, or on a device that the caller
/// has opened.
///
/// Work is deferred: passes are recorded and submitted in batches; download, count, route, run_until_done and finish
/// wait for them. One thread at a time may use a backend and its buffers. A buffer may outlive the backend. The memory
/// of a destroyed buffer is released when the last pass that uses it is done: bytes() counts the buffers that exist,
/// peak_bytes() the most memory in use. It keeps free memory for new buffers, which neither counts: up to 64 MiB, of a
/// discrete GPU up to a sixteenth of its own memory and 1 GiB.
///
/// costs()[kernel].instructions is the number of SPIR-V instructions in the functions of the kernel's largest
/// specialisation so far, after optimisation.
/// \headerfile backends/vulkan/vulkan.hpp <photongrid/backends/vulkan/vulkan.hpp>
/// \snippet snippets_vulkan.cpp vulkan_backend
class vulkan_backend {
    using memory = vulkan::memory;

public:
    /// Elements in device memory.
    /// \headerfile backends/vulkan/vulkan.hpp <photongrid/backends/vulkan/vulkan.hpp>
    template <element T>
    class buffer {
    public:
        /// \name A buffer's members, the same on every backend
        /// @{

        /// A buffer has size() elements T. It can be moved but not copied. A moved-from or default-constructed buffer
        /// is empty.
        using value_type = T;
        buffer() = default;
        buffer(buffer&& other) noexcept : memory_(std::move(other.memory_)), n_(std::exchange(other.n_, 0)) {}
        buffer& operator=(buffer&& other) noexcept
        {
            buffer old(std::move(other));
            std::swap(memory_, old.memory_);
            std::swap(n_, old.n_);
            return *this;
        }
        buffer(const buffer&) = delete;
        buffer& operator=(const buffer&) = delete;
        ~buffer()
        {
            if (memory_)
                memory_->forget();
        }
        std::size_t size() const noexcept { return n_; }
        /// @}

    private:
        friend vulkan_backend;
        buffer(memory m, std::size_t n) : memory_(std::move(m)), n_(n) {}
        memory memory_;
        std::size_t n_ = 0;
    };

private:
    // Defined before its uses, because its return type is deduced.
    /// Whether a buffer belongs to this backend, for check_call.
    auto owns() const
    {
        return [this](const auto& b) { return !b.memory_ || b.memory_->is_of(*context_); };
    }
    template <element T>
    void check_owner(const char* what, const buffer<T>& b) const
    {
        if (!owns()(b))
            throw std::invalid_argument(std::string("vulkan_backend: ") + what
                + ": the buffer belongs to another backend; download it there and upload it here");
    }

public:
    /// Opens a device.
    /// \throws backend_error if there is no driver, no such device, or no validation layer although it was requested.
    explicit vulkan_backend(const vulkan_options& options = {})
        : vulkan_backend(std::make_shared<vulkan::context>(options), options)
    {
    }

    /// Works on a device that the caller owns, which must outlive this backend and its buffers. It does not change the
    /// caller's objects: it uses its own command pool, descriptors and pipelines, and submits to the queue. Of the
    /// options, only those for kernels and timing apply.
    /// \throws backend_error for a device without the required features, std::invalid_argument for a null handle.
    /// \snippet snippets_vulkan.cpp callers_device
    explicit vulkan_backend(const vulkan_handles& handles, const vulkan_options& options = {})
        : vulkan_backend(std::make_shared<vulkan::context>(handles), options)
    {
    }

    /// Adds your own kernel texts, embedded by photongrid_embed(). They must outlive the backend.
    void add_texts(std::span<const text_file> texts) { passes_.made.add_texts(texts); }

    /// \name The verbs of a backend, as backend.hpp describes them: buffers
    /// @{

    /// See the concept photongrid::backend.
    template <element T>
    buffer<T> make(std::size_t n)
    {
        return buffer<T>(passes_.make<T>(n), n);
    }
    template <element T, std::size_t E>
    buffer<T> upload(std::span<const T, E> data)
    {
        auto b = make<T>(data.size());
        passes_.batches.write(b.memory_, data.data(), data.size_bytes());
        return b;
    }
    template <element T>
    std::vector<T> download(const buffer<T>& b)
    {
        check_owner("download: b", b);
        std::vector<T> data(b.n_);
        passes_.batches.read(b.memory_, data.data(), data.size() * sizeof(T));
        return data;
    }

    /// @}

    /// The Vulkan buffer of `b`: element i begins at byte i * sizeof(T). The backend continues to own it, and it lives
    /// as long as `b`. Null for a default-constructed buffer. It submits all recorded passes. Commands that the caller
    /// submits to the queue afterwards see their results without a barrier, and passes that are recorded after such a
    /// submission see its results. Call it again before each of your submissions that uses a buffer of this backend.
    /// \throws std::invalid_argument for a buffer of another backend.
    /// \snippet snippets_vulkan.cpp handle
    template <element T>
    VkBuffer handle(const buffer<T>& b)
    {
        check_owner("handle: b", b);
        passes_.batches.take_turns();
        return b.memory_ ? b.memory_->buffer() : VK_NULL_HANDLE;
    }

    /// The usage flags that an adopted Vulkan buffer needs.
    static constexpr VkBufferUsageFlags adopted_usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT
        | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT
        | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

    /// A buffer over the first n elements of a caller's buffer on the same device. The caller continues to own it, and
    /// it must exist, with its memory, until the adopting buffer is destroyed and finish() has returned. bytes() does
    /// not count it. Commands on the queue are synchronised as with handle().
    /// \throws std::invalid_argument for a null handle, 0 elements, or more than the device binds.
    /// \snippet snippets_vulkan.cpp adopt
    template <element T>
    buffer<T> adopt(VkBuffer callers, std::size_t n)
    {
        const auto limit = context_->max_buffer_bytes() / sizeof(T);
        if (callers == VK_NULL_HANDLE || n < 1 || n > limit)
            throw std::invalid_argument("vulkan_backend: adopt: callers, n: " + std::to_string(n) + " elements of "
                + (callers == VK_NULL_HANDLE ? "no buffer" : "a buffer") + " were given; this device binds 1 to "
                + std::to_string(limit) + " of " + std::to_string(sizeof(T)) + " bytes");
        passes_.batches.take_turns();
        return buffer<T>(
            std::make_shared<vulkan::allocation>(context_, callers, n * sizeof(T), vulkan::format_of<T>), n);
    }

    /// A buffer that the caller must destroy, and its memory, which no other buffer uses.
    /// \headerfile backends/vulkan/vulkan.hpp <photongrid/backends/vulkan/vulkan.hpp>
    struct released_buffer {
        VkBuffer buffer = VK_NULL_HANDLE;       ///< null for a default-constructed buffer
        VkDeviceMemory memory = VK_NULL_HANDLE; ///< null if the buffer had been adopted
        VkDeviceSize bytes = 0;                 ///< size of the buffer
    };
    /// Waits for all passes and releases a buffer to the caller, who must destroy both objects.
    /// \throws std::invalid_argument for a buffer of another backend.
    /// \snippet snippets_vulkan.cpp release
    template <element T>
    released_buffer release(buffer<T>&& b)
    {
        check_owner("release: b", b);
        passes_.batches.finish();
        const buffer<T> given = std::move(b);
        if (!given.memory_)
            return {};
        const auto block = given.memory_->give_up();
        return {block.buffer, block.memory, block.bytes};
    }

    /// \name The verbs of a backend, as backend.hpp describes them: passes
    /// @{

    /// See the concept photongrid::backend.
    template <gather_kernel K, class Reads, class Writes>
    void run(launch l, const typename K::Params& args, Reads reads, Writes writes)
    {
        detail::check_call<K>("run", l, reads, writes, owns());
        ++passes_.made.cost<K>().passes;
        if (l.elements > 0)
            passes_.run<K>(verb::run, l, l.first, args, bound(reads, writes));
    }

    template <iterative_kernel K, class Reads, class Writes>
    progress run_until_done(launch l, const typename K::Params& args, Reads reads, Writes writes, uint max_passes)
    {
        return run_frames<K>(l, 0, args, reads, writes, max_passes);
    }

    template <predicate_kernel K, class Reads>
    std::uint64_t count(launch l, const typename K::Params& args, Reads reads)
    {
        detail::check_call<K>("count", l, reads, std::tuple<>{}, owns());
        ++passes_.made.cost<K>().passes;
        if (l.elements == 0)
            return 0;
        const auto held = passes_.allocate(sizeof(uint));
        auto buffers = bound(reads, std::tuple<>{});
        buffers.push_back(held);
        passes_.batches.fill(held, 0, sizeof(uint), 0);
        passes_.run<K>(verb::count, l, l.first, args, buffers);
        uint n = 0;
        passes_.batches.read(held, &n, sizeof n);
        return n;
    }

    /// Deterministic: it sorts draws stably by destination, so that ranks follow the draw order, and adds amounts in
    /// that order. It needs 40 bytes per draw and 8 per destination while it runs.
    template <route_kernel K, class Reads>
    void route(launch l, const typename K::Params& args, Reads reads, const route_shape& to, buffer<uint>& slots,
        buffer<glm::vec4>& totals)
    {
        detail::check_route(to, caps_.max_route_slots, slots.size(), totals.size());
        const auto [destinations, m] = to;
        detail::check_reads<K>("route", reads, owns());
        check_owner("route: slots", slots);
        check_owner("route: totals", totals);
        ++passes_.made.cost<K>().passes;
        vulkan::routing routing(passes_, l.elements, destinations);
        auto buffers = bound(reads, std::tuple<>{});
        for (const auto& output : routing.outputs())
            buffers.push_back(output);
        if (l.elements > 0)
            passes_.run<K>(verb::run, l, 0, args, buffers);
        routing.deliver(slots.memory_, slots.size(), m, totals.memory_, totals.size());
    }

    void finish() { passes_.batches.finish(); }
    const capabilities& caps() const { return caps_; }
    std::uint64_t bytes() const { return context_->bytes(); }
    std::uint64_t peak_bytes() const { return context_->peak_bytes(); }
    const std::map<std::string, kernel_cost>& costs() const { return passes_.made.costs; }
    /// @}

    // For overrides.

    /// Runs a pass of a shader of the backend or of an override: `elements` invocations, with the buffers bound from 0
    /// on. Different defines make a different pipeline. costs() has it under the shader's name.
    template <class... Buffers>
    void own_pass(const std::string& name, const std::string& more_defines, std::uint64_t elements,
        std::initializer_list<uint> args, Buffers&... buffers)
    {
        passes_.own(name, elements, args, {buffers.memory_...}, more_defines);
    }

    /// run_until_done over frames: pass q of element i, from 0, computes element i + q * stride, for those elements
    /// whose last frame was not done(). Before the first pass no element is done if the kernel has no states.
    template <iterative_kernel K, class Reads, class Writes>
    progress run_frames(
        launch l, uint stride, const typename K::Params& args, Reads reads, Writes writes, uint max_passes)
    {
        detail::check_call<K>("run_until_done", l, reads, writes, owns());
        progress p;
        p.finished = true;
        if (l.elements == 0)
            return p;
        return vulkan::run_frames<K>(passes_, l, stride, args, bound(reads, writes), max_passes);
    }

    /// Fills n elements from `first` on with a word.
    template <element T>
    void fill(buffer<T>& b, std::size_t first, std::size_t n, uint word)
    {
        assert(first + n <= b.n_);
        if (n > 0)
            passes_.batches.fill(b.memory_, first * sizeof(T), n * sizeof(T), word);
    }

    /// The number of kernels found in options.cache_folder.
    std::uint64_t kernels_found() const { return passes_.made.found(); }

    /// The validation layer's messages so far; always empty without options.validation.
    std::vector<std::string> validation_messages() const { return context_->messages(); }

    /// The optimized SPIR-V of a kernel for `run` (or `count`, if it has no `kernel`), for tools and tests.
    template <kernel_struct K>
    std::vector<std::uint32_t> spirv(uint switches = ~0u)
    {
        return passes_.made.compile<K>(gather_kernel<K> ? verb::run : verb::count, switches);
    }
    /// The same for the passes of run_until_done.
    template <iterative_kernel K>
    std::vector<std::uint32_t> iterate_spirv(uint switches = ~0u)
    {
        return passes_.made.compile<K>(verb::iterate, switches);
    }

private:
    using verb = vulkan::verb;

    vulkan_backend(std::shared_ptr<vulkan::context> c, const vulkan_options& options)
        : context_(std::move(c)), passes_(context_, options)
    {
        const auto info = vulkan::describe(context_->physical(), 0);
        if (!info.unusable.empty())
            throw backend_error("vulkan: " + info.name + " cannot be used: " + info.unusable);
        caps_.backend = "vulkan";
        caps_.device = info.name + ", " + info.driver;
        caps_.software = info.software;
        caps_.max_elements = context_->max_buffer_bytes() / sizeof(glm::vec4);
        caps_.max_route_slots = 16;
        if (!caps_.software)
            caps_.photon_batch = 1u << 22; // as many as there is memory for
        // lavapipe ends loops silently after so many iterations, counted over a group of invocations.
        caps_.loop_limit = info.name.find("llvmpipe") != std::string::npos ? 65535u : 0u;
        std::tie(caps_.exact_division, caps_.exact_sqrt) = choose_arithmetic(
            *this, options.arithmetic, [&](bool rewrite) { passes_.made.rewrite_arithmetic(rewrite); });
    }

    /// The buffers of a call in the order of the kernel's bindings. A buffer without memory is replaced by an empty
    /// one.
    template <class Reads, class Writes>
    std::vector<memory> bound(const Reads& reads, const Writes& writes) const
    {
        std::vector<memory> all;
        const auto add = [&](const auto& b) {
            using value_type = typename std::remove_cvref_t<decltype(b)>::value_type;
            all.push_back(b.memory_);
            if (!all.back()) {
                all.back() = passes_.make<value_type>(0);
                all.back()->forget(); // bytes() counts the caller's buffers only
            }
        };
        std::apply([&](const auto&... b) { (add(b), ...); }, reads);
        std::apply([&](const auto&... b) { (add(b), ...); }, writes);
        return all;
    }

    std::shared_ptr<vulkan::context> context_;
    capabilities caps_;
    vulkan::passes passes_;
};

static_assert(backend<vulkan_backend>);

} // namespace photongrid

// Declared with the backend, so that all files of a program use the same overrides.
#include <photongrid/backends/vulkan/overrides/bitonic_sort.hpp>
#include <photongrid/backends/vulkan/overrides/trace_batch.hpp>
