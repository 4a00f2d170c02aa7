// The Vulkan backend: compute shaders on storage buffers, with many passes per submission (docs/design/design.md).
#pragma once

#include <photongrid/backend/self_test.hpp>
#include <photongrid/backend_texts/vulkan.hpp>
#include <photongrid/backends/vulkan/compiled_kernels.hpp>
#include <photongrid/backends/vulkan/recorder.hpp>

#include <bit>
#include <cassert>
#include <chrono>

namespace photongrid {

/// Runs kernels as compute shaders, on the best Vulkan 1.1 device, on a selected one, or on a device that the caller
/// has opened.
///
/// Work is deferred: passes are recorded and submitted in batches; download, count, route, run_until_done and finish
/// wait for them. One thread at a time may use a backend and its buffers. A buffer may outlive the backend. The memory
/// of a destroyed buffer is released when the last pass that uses it is done: bytes() counts the buffers that exist,
/// peak_bytes() the most memory in use. It keeps up to 64 MiB of free memory for new buffers, which neither counts.
///
/// costs()[kernel].instructions is the number of SPIR-V instructions in the functions of the kernel's largest
/// specialisation so far, after optimisation.
/// \headerfile backends/vulkan/vulkan.hpp <photongrid/backends/vulkan/vulkan.hpp>
/// \snippet snippets_vulkan.cpp vulkan_backend
class vulkan_backend {
    using memory = vulkan_detail::memory;

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
        : vulkan_backend(std::make_shared<vulkan_detail::context>(options), options)
    {
    }

    /// Works on a device that the caller owns, which must outlive this backend and its buffers. It does not change the
    /// caller's objects: it uses its own command pool, descriptors and pipelines, and submits to the queue. Of the
    /// options, only those for kernels and timing apply.
    /// \throws backend_error for a device without the required features, std::invalid_argument for a null handle.
    /// \snippet snippets_vulkan.cpp callers_device
    explicit vulkan_backend(const vulkan_handles& handles, const vulkan_options& options = {})
        : vulkan_backend(std::make_shared<vulkan_detail::context>(handles), options)
    {
    }

    /// Adds your own kernel texts, embedded by photongrid_embed(). They must outlive the backend.
    void add_texts(std::span<const text_file> texts) { texts_.insert(texts_.end(), texts.begin(), texts.end()); }

    /// \name The verbs of a backend, as backend.hpp describes them: buffers
    /// @{

    /// See the concept photongrid::backend.
    template <element T>
    buffer<T> make(std::size_t n)
    {
        const auto limit = context_->max_buffer_bytes() / sizeof(T);
        if (n > limit)
            throw backend_error("vulkan: a buffer of " + std::to_string(n) + " elements of " + std::to_string(sizeof(T))
                + " bytes was requested; " + caps_.device + " binds at most "
                + std::to_string(context_->max_buffer_bytes()) + " bytes (maxStorageBufferRange), "
                + std::to_string(limit) + " elements");
        return buffer<T>(allocate(n * sizeof(T), format_of<T>), n);
    }
    template <element T, std::size_t E>
    buffer<T> upload(std::span<const T, E> data)
    {
        auto b = make<T>(data.size());
        recorder_.write(b.memory_, data.data(), data.size_bytes());
        return b;
    }
    template <element T>
    std::vector<T> download(const buffer<T>& b)
    {
        check_owner("download: b", b);
        std::vector<T> data(b.n_);
        recorder_.read(b.memory_, data.data(), data.size() * sizeof(T));
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
        recorder_.take_turns();
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
        recorder_.take_turns();
        return buffer<T>(
            std::make_shared<vulkan_detail::allocation>(context_, callers, n * sizeof(T), format_of<T>), n);
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
        recorder_.finish();
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
        ++cost<K>().passes;
        if (l.elements > 0)
            gather<K>(l, l.first, args, bound(reads, writes));
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
        ++cost<K>().passes;
        if (l.elements == 0)
            return 0;
        const auto held = allocate(sizeof(uint));
        auto buffers = bound(reads, std::tuple<>{});
        buffers.push_back(held);
        recorder_.fill(held, 0, sizeof(uint), 0);
        recorder_.dispatch(kernel_pipeline<K>(verb::count, l.switches, buffers), buffers,
            push(l, groups(l.elements), l.first, args), groups(l.elements), cost<K>().ms);
        uint n = 0;
        recorder_.read(held, &n, sizeof n);
        return n;
    }

    /// Deterministic: it sorts draws stably by destination, so that ranks follow the draw order, and adds amounts in
    /// that order. It needs 40 bytes per draw and 8 per destination while it runs.
    template <route_kernel K, class Reads>
    void route(launch l, const typename K::Params& args, Reads reads, uint destinations, uint m, buffer<uint>& slots,
        buffer<glm::vec4>& totals)
    {
        detail::check_route(destinations, m, caps_.max_route_slots, slots.size(), totals.size());
        detail::check_reads<K>("route", reads, owns());
        check_owner("route: slots", slots);
        check_owner("route: totals", totals);
        ++cost<K>().passes;
        auto destination = make<uint>(l.elements), payload = make<uint>(l.elements);
        auto amount = make<glm::vec4>(l.elements);
        auto buffers = bound(reads, std::tuple<>{});
        buffers.insert(buffers.end(), {destination.memory_, payload.memory_, amount.memory_});
        if (l.elements > 0)
            gather<K>(l, 0, args, buffers);

        auto keys = make<glm::uvec2>(l.elements);
        own_pass("route_keys", l.elements, {destinations}, {destination.memory_, keys.memory_});
        sort_by_destination(keys, destinations);

        auto ranges = make<glm::uvec2>(destinations);
        const auto most = allocate(sizeof(uint));
        recorder_.fill(most, 0, sizeof(uint), 0);
        own_pass("route_ranges", destinations, {l.elements}, {keys.memory_, ranges.memory_, most});
        own_pass("route_slots", slots.size(), {destinations, route_capacity(m)},
            {keys.memory_, ranges.memory_, payload.memory_, slots.memory_});
        uint longest = 0;
        recorder_.read(most, &longest, sizeof longest);
        constexpr uint at_once = 4096;
        const uint sums = route_sums(totals.size(), destinations), block = route_block(l.elements, sums);
        std::uint64_t begin = 0;
        do { // at least once: it also clears the totals of destinations without draws
            own_pass("route_totals", totals.size(), {destinations, sums, block, static_cast<uint>(begin), at_once},
                {keys.memory_, ranges.memory_, amount.memory_, totals.memory_});
            begin += at_once;
        } while (begin < std::min(longest, block));
    }

    void finish() { recorder_.finish(); }
    const capabilities& caps() const { return caps_; }
    std::uint64_t bytes() const { return context_->bytes(); }
    std::uint64_t peak_bytes() const { return context_->peak_bytes(); }
    const std::map<std::string, kernel_cost>& costs() const { return costs_; }
    /// @}

    // For overrides.

    /// Runs a pass of a shader of the backend or of an override: `elements` invocations, with the buffers bound from 0
    /// on. Different defines make a different pipeline. costs() has it under the shader's name.
    template <class... Buffers>
    void own_pass(const std::string& name, const std::string& more_defines, std::uint64_t elements,
        std::initializer_list<uint> args, Buffers&... buffers)
    {
        own_pass(name, elements, args, {buffers.memory_...}, more_defines);
        ++costs_[name].passes;
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

        // Eight words per pass: the workgroups of its dispatch, the length of its list, and the number of elements that
        // are not done. The host reads them once per `together` passes.
        struct pass_slot {
            glm::uvec4 dispatch;
            glm::uvec4 unfinished;
        };
        constexpr uint together = 8, slot_bytes = sizeof(pass_slot);
        const auto control = allocate((together + 1) * slot_bytes);
        const auto list_bytes = groups(l.elements) * group_ * sizeof(uint);
        std::array<memory, 2> lists{allocate(list_bytes), allocate(list_bytes)};
        auto buffers = bound(reads, writes);
        const auto first_extra = buffers.size();
        buffers.insert(buffers.end(), {lists[1], lists[0], control});
        recorder_.fill(control, 0, control->bytes(), 0);
        recorder_.dispatch(kernel_pipeline<K>(verb::list, l.switches, buffers), buffers,
            push(l, groups(l.elements), l.first, args), groups(l.elements), cost<K>().ms);
        prepare_indirect(control, 0);
        const auto& iterate = kernel_pipeline<K>(verb::iterate, l.switches, buffers);
        for (;;) {
            const uint now = std::min(together, max_passes - p.passes);
            for (uint q = 0; q < now; ++q) {
                buffers[first_extra] = lists[0];
                buffers[first_extra + 1] = lists[1];
                recorder_.dispatch_indirect(
                    iterate, buffers, push(l, q, (p.passes + q) * stride, args), control, q * slot_bytes, cost<K>().ms);
                prepare_indirect(control, q + 1);
                std::swap(lists[0], lists[1]);
            }
            std::array<pass_slot, together + 1> seen{};
            recorder_.read(control, seen.data(), sizeof seen);
            for (uint q = 0; q < now && seen[q].unfinished.x > 0; ++q) {
                p.active.push_back(seen[q].unfinished.x);
                ++p.passes;
            }
            p.finished = seen[now].unfinished.x == 0;
            if (p.finished || p.passes == max_passes)
                break;
            // now == together: the next pass continues where the last one ended.
            recorder_.copy(control, together * slot_bytes, control, 0, slot_bytes);
            recorder_.fill(control, slot_bytes, together * slot_bytes, 0);
        }
        cost<K>().passes += p.passes;
        return p;
    }

    /// Fills n elements from `first` on with a word.
    template <element T>
    void fill(buffer<T>& b, std::size_t first, std::size_t n, uint word)
    {
        assert(first + n <= b.n_);
        if (n > 0)
            recorder_.fill(b.memory_, first * sizeof(T), n * sizeof(T), word);
    }

    /// The number of kernels found in options.cache_folder.
    std::uint64_t kernels_found() const { return kernels_.found(); }

    /// The validation layer's messages so far; always empty without options.validation.
    std::vector<std::string> validation_messages() const { return context_->messages(); }

    /// The optimized SPIR-V of a kernel for `run` (or `count`, if it has no `kernel`), for tools and tests.
    template <kernel_struct K>
    std::vector<std::uint32_t> spirv(uint switches = ~0u)
    {
        return compile<K>(gather_kernel<K> ? verb::run : verb::count, switches, texel_limit_ > 0);
    }
    /// The same for the passes of run_until_done.
    template <iterative_kernel K>
    std::vector<std::uint32_t> iterate_spirv(uint switches = ~0u)
    {
        return compile<K>(verb::iterate, switches, texel_limit_ > 0);
    }

private:
    enum class verb { run, list, iterate, count };

    vulkan_backend(std::shared_ptr<vulkan_detail::context> c, const vulkan_options& options)
        : context_(std::move(c)), kernels_(context_, options.cache_folder, !options.gpu_assisted),
          recorder_(context_, options.time_passes), empty_(allocate(0))
    {
        const auto info = vulkan_detail::describe(context_->physical(), 0);
        if (!info.unusable.empty())
            throw backend_error("vulkan: " + info.name + " cannot be used: " + info.unusable);
        group_ = std::min(64u, context_->properties().limits.maxComputeWorkGroupInvocations);
        if (const uint lanes = vulkan_detail::lanes_of_subgroups(context_->physical());
            options.subgroups && lanes >= 4 && group_ % lanes == 0)
            lanes_ = lanes;
        caps_.backend = "vulkan";
        caps_.device = info.name + ", " + info.driver;
        caps_.software = info.software;
        caps_.max_elements = context_->max_buffer_bytes() / sizeof(glm::vec4);
        caps_.max_route_slots = 16;
        // lavapipe ends loops silently after so many iterations, counted over a group of invocations.
        caps_.loop_limit = info.name.find("llvmpipe") != std::string::npos ? 65535u : 0u;
        if (info.software && !context_->staging())
            texel_limit_ = std::uint64_t{context_->properties().limits.maxTexelBufferElements} * sizeof(float);
        std::tie(caps_.exact_division, caps_.exact_sqrt) = test_arithmetic(*this);
    }

    template <element T>
    static constexpr VkFormat format_of = std::same_as<T, float> ? VK_FORMAT_R32_SFLOAT
        : std::same_as<T, uint>                                  ? VK_FORMAT_R32_UINT
        : std::same_as<T, glm::vec2>                             ? VK_FORMAT_R32G32_SFLOAT
        : std::same_as<T, glm::uvec2>                            ? VK_FORMAT_R32G32_UINT
        : std::same_as<T, glm::vec4>                             ? VK_FORMAT_R32G32B32A32_SFLOAT
                                                                 : VK_FORMAT_R32G32B32A32_UINT;

    memory allocate(std::size_t bytes, VkFormat format = VK_FORMAT_UNDEFINED) const
    {
        return std::make_shared<vulkan_detail::allocation>(context_, bytes, vulkan_detail::memory_kind::device, format);
    }

    /// The buffers of a call in the order of the kernel's bindings. A buffer without memory is replaced by an empty
    /// one.
    template <class Reads, class Writes>
    std::vector<memory> bound(const Reads& reads, const Writes& writes) const
    {
        std::vector<memory> all;
        const auto add = [&](const auto& b) {
            using value_type = typename std::remove_cvref_t<decltype(b)>::value_type;
            all.push_back(b.memory_ ? b.memory_ : allocate(0, format_of<value_type>));
        };
        std::apply([&](const auto&... b) { (add(b), ...); }, reads);
        std::apply([&](const auto&... b) { (add(b), ...); }, writes);
        return all;
    }

    std::uint64_t groups(std::uint64_t elements) const { return (elements + group_ - 1) / group_; }

    /// The launch header, 16 bytes, followed by the parameters.
    template <class Params>
    static std::array<std::byte, vulkan_detail::pipeline::push_bytes> push(
        const launch& l, std::uint64_t groups, uint where, const Params& args)
    {
        static_assert(
            sizeof(Params) <= vulkan_detail::pipeline::push_bytes - 16, "a kernel's Params are at most 112 bytes");
        static_assert(std::is_trivially_copyable_v<Params>);
        std::array<std::byte, vulkan_detail::pipeline::push_bytes> bytes{};
        const uint header[4] = {l.elements, l.first, static_cast<uint>(groups), where};
        std::memcpy(bytes.data(), header, sizeof header);
        std::memcpy(bytes.data() + sizeof header, &args, sizeof args);
        return bytes;
    }

    template <class K>
    void gather(const launch& l, uint where, const typename K::Params& args, const std::vector<memory>& buffers)
    {
        recorder_.dispatch(kernel_pipeline<K>(verb::run, l.switches, buffers), buffers,
            push(l, groups(l.elements), where, args), groups(l.elements), cost<K>().ms);
    }

    /// Runs a pass of the backend's own shader.
    void own_pass(const std::string& name, std::uint64_t elements, std::initializer_list<uint> args,
        std::initializer_list<memory> buffers, const std::string& more_defines = {})
    {
        std::vector<memory> bound_buffers;
        for (const auto& b : buffers)
            bound_buffers.push_back(b ? b : empty_);
        std::array<uint, 8> params{};
        assert(args.size() <= params.size());
        std::copy(args.begin(), args.end(), params.begin());
        if (elements > 0)
            recorder_.dispatch(own_pipeline(name, buffers.size(), more_defines), bound_buffers,
                push(launch(elements), groups(elements), 0, params), groups(elements), costs_[name].ms);
    }

    void prepare_indirect(const memory& control, uint pass)
    {
        own_pass("indirect", 1, {pass, context_->properties().limits.maxComputeWorkGroupCount[0]}, {control});
    }

    /// Sorts (destination, draw) stably by destination: least significant digit first, 4 bits at a time.
    void sort_by_destination(buffer<glm::uvec2>& keys, uint destinations)
    {
        const uint n = static_cast<uint>(keys.size());
        if (n < 2)
            return;
        // One invocation processes a chunk in order. More than 16,384 chunks would make the prefix sums of counters
        // slow.
        const uint chunk = std::max(256u, (n - 1) / 16384u + 1);
        const uint chunks = (n - 1) / chunk + 1;
        auto sorted = make<glm::uvec2>(n);
        auto counters = make<uint>(std::size_t{16} * chunks);
        for (uint shift = 0; shift < 32 && (destinations >> shift) != 0; shift += 4) {
            own_pass("radix_count", chunks, {n, shift, chunk, chunks}, {keys.memory_, counters.memory_});
            own_pass("radix_scan", 1, {16 * chunks}, {counters.memory_});
            own_pass(
                "radix_scatter", chunks, {n, shift, chunk, chunks}, {keys.memory_, counters.memory_, sorted.memory_});
            std::swap(keys, sorted);
        }
    }

    template <class K>
    kernel_cost& cost()
    {
        return costs_[std::string(kernel_name<K>())];
    }

    std::string defines(std::size_t outputs, uint switches, bool listing, bool texels, uint lanes) const
    {
        return "#define GROUP " + std::to_string(group_) + "\n#define LANES " + std::to_string(lanes)
            + "\n#define LANE_LOOPS " + (lanes > 8 || context_->staging() ? "1" : "0") + "\n#define OUTPUTS "
            + std::to_string(outputs) + "\n#define SWITCHES " + std::to_string(switches) + "u\n#define LISTING "
            + (listing ? "1" : "0") + "\n#define TEXELS " + (texels ? "1" : "0") + "\n";
    }

    static const text_file& own_text(const std::string& name) { return find_kernel_text(name + ".glsl", vulkan_texts); }

    template <class K>
    vulkan_detail::spirv_words compile(verb v, uint switches, bool texels)
    {
        constexpr const char* epilogues[] = {"run", "iterate", "iterate", "count"};
        const auto begin = std::chrono::steady_clock::now();
        const std::string name(kernel_name<K>());
        uint lanes = 1;
        if constexpr (requires { K::group_switch; })
            if (v != verb::count && (switches >> K::group_switch & 1u) != 0)
                lanes = lanes_;
        const auto texts = texts_of<K>(texts_);
        const auto source = splice(own_text("compute_prelude"),
            defines(output_count<K>, switches & known_switches<K>(), v == verb::list, texels, lanes),
            find_kernel_text(K::path, texts), own_text(epilogues[static_cast<int>(v)]), texts);
        auto words = kernels_.compile(source, name);
        auto& c = costs_[name];
        if (v != verb::list)
            c.instructions = std::max(c.instructions, vulkan_detail::count_instructions(words));
        c.compile_ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
        return words;
    }

    template <class K>
    const vulkan_detail::pipeline& kernel_pipeline(verb v, uint switches, const std::vector<memory>& buffers)
    {
        switches &= known_switches<K>();
        const bool texels = std::all_of(buffers.begin(), buffers.begin() + input_count<K>,
            [&](const memory& m) { return m->bytes() <= texel_limit_; });
        auto& p = pipelines_[{std::string(K::path), v, switches, texels}];
        if (p)
            return *p;
        std::vector<vulkan_detail::binding> bindings;
        for (std::uint32_t i = 0; i < input_count<K>; ++i)
            bindings.push_back(
                {i, texels ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
        for (std::uint32_t o = 0; v != verb::count && o < output_count<K>; ++o)
            bindings.push_back({8 + o});
        static_assert(
            input_count<K> <= 8 && output_count<K> <= 8, "a kernel has at most 8 inputs and 8 outputs and states");
        const std::uint32_t own = v == verb::count ? 1 : v == verb::run ? 0 : 3;
        for (std::uint32_t e = 0; e < own; ++e)
            bindings.push_back({16 + e});
        const auto words = compile<K>(v, switches, texels);
        const auto begin = std::chrono::steady_clock::now();
        p = std::make_unique<vulkan_detail::pipeline>(
            *context_, kernels_.drivers(), words, std::move(bindings), std::string(kernel_name<K>()));
        cost<K>().compile_ms
            += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
        return *p;
    }

    const vulkan_detail::pipeline& own_pipeline(
        const std::string& name, std::size_t buffers, const std::string& more_defines)
    {
        auto& p = own_pipelines_[name + more_defines];
        if (p)
            return *p;
        const auto source = splice(own_text("compute_prelude"), defines(0, 0, false, false, 1) + more_defines,
            own_text(name), text_file{name + " (end)", ""}, {});
        std::vector<vulkan_detail::binding> bindings;
        for (std::uint32_t b = 0; b < buffers; ++b)
            bindings.push_back({b});
        const auto begin = std::chrono::steady_clock::now();
        p = std::make_unique<vulkan_detail::pipeline>(
            *context_, kernels_.drivers(), kernels_.compile(source, name), std::move(bindings), name);
        costs_[name].compile_ms
            += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
        return *p;
    }

    std::shared_ptr<vulkan_detail::context> context_;
    vulkan_detail::compiled_kernels kernels_;
    capabilities caps_;
    std::vector<text_file> texts_;
    std::map<std::string, kernel_cost> costs_;
    uint group_ = 64;
    uint lanes_ = 1;                ///< elements per group in kernels that are IN_GROUPS
    std::uint64_t texel_limit_ = 0; ///< bytes of the largest buffer that is read as texels; 0: none
    // Declared before the recorder, so that they outlive its last batch.
    std::map<std::tuple<std::string, verb, uint, bool>, std::unique_ptr<vulkan_detail::pipeline>> pipelines_;
    std::map<std::string, std::unique_ptr<vulkan_detail::pipeline>> own_pipelines_;
    vulkan_detail::recorder recorder_;
    memory empty_;
};

static_assert(backend<vulkan_backend>);

} // namespace photongrid

// Declared with the backend, so that all files of a program use the same overrides.
#include <photongrid/backends/vulkan/overrides/bitonic_sort.hpp>
#include <photongrid/backends/vulkan/overrides/trace_batch.hpp>
