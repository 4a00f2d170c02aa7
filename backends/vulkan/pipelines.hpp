// The pipelines of a backend: of each kernel one per verb, set of switches and way of reading, and those of its own
// shaders. Each is compiled when it is first needed.
#pragma once

#include <photongrid/backend_texts/vulkan.hpp>
#include <photongrid/backends/vulkan/compiled_kernels.hpp>
#include <photongrid/backends/vulkan/recorder.hpp>

#include <chrono>

namespace photongrid::vulkan {

/// What a kernel's pipeline does: run, begin run_until_done's list of elements, one pass over that list, or count.
enum class verb { run, list, iterate, count };

class pipelines {
public:
    /// The backend's options; of these, `cache_folder`, `gpu_assisted` and `subgroups`.
    pipelines(std::shared_ptr<context> c, const vulkan_options& options)
        : context_(std::move(c)), kernels_(context_, options.cache_folder, !options.gpu_assisted)
    {
        group_ = std::min(64u, context_->properties().limits.maxComputeWorkGroupInvocations);
        if (const uint lanes = lanes_of_subgroups(context_->physical());
            options.subgroups && lanes >= 4 && group_ % lanes == 0)
            lanes_ = lanes;
        if (context_->properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU && !context_->staging())
            texel_limit_ = std::uint64_t{context_->properties().limits.maxTexelBufferElements} * sizeof(float);
    }

    /// More kernel texts, in addition to the library's. They must outlive the backend.
    void add_texts(std::span<const text_file> texts) { texts_.insert(texts_.end(), texts.begin(), texts.end()); }

    /// Kernels that are compiled from now on take quotients and square roots from exact_arithmetic.glsl, or do not.
    void rewrite_arithmetic(bool rewrite)
    {
        pipelines_.clear();
        exact_arithmetic_ = rewrite ? &own_text("exact_arithmetic") : nullptr;
    }

    /// The elements per workgroup, and the workgroups for so many elements.
    uint group() const { return group_; }
    std::uint64_t groups(std::uint64_t elements) const { return (elements + group_ - 1) / group_; }
    /// The kernels found in the cache folder.
    std::uint64_t found() const { return kernels_.found(); }

    template <class K>
    kernel_cost& cost()
    {
        return costs[std::string(kernel_name<K>())];
    }

    /// The SPIR-V of kernel K. Inputs are read as texels where the device can do so.
    template <class K>
    spirv_words compile(verb v, uint switches)
    {
        return compile<K>(v, switches, texel_limit_ > 0);
    }

    /// The pipeline of kernel K for verb `v` with these switches and buffers.
    template <class K>
    const pipeline& get(verb v, uint switches, const std::vector<memory>& buffers)
    {
        switches &= known_switches<K>();
        const bool texels = std::all_of(buffers.begin(), buffers.begin() + input_count<K>,
            [&](const memory& m) { return m->bytes() <= texel_limit_; });
        auto& p = pipelines_[{std::string(K::path), v, switches, texels}];
        if (p)
            return *p;
        std::vector<binding> bindings;
        for (std::uint32_t i = 0; i < input_count<K>; ++i)
            bindings.push_back(
                {i, texels ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
        for (std::uint32_t o = 0; v != verb::count && o < output_count<K>; ++o)
            bindings.push_back({first_output + o});
        static_assert(input_count<K> <= max_inputs && output_count<K> <= max_outputs,
            "a kernel has at most 10 inputs and 8 outputs and states");
        const std::uint32_t own = v == verb::count ? 1 : v == verb::run ? 0 : 3;
        for (std::uint32_t e = 0; e < own; ++e)
            bindings.push_back({first_own + e});
        const auto words = compile<K>(v, switches, texels);
        const auto begin = std::chrono::steady_clock::now();
        p = std::make_unique<pipeline>(
            *context_, kernels_.drivers(), words, std::move(bindings), std::string(kernel_name<K>()));
        cost<K>().compile_ms
            += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
        return *p;
    }

    /// The pipeline of the shader `name`, of the backend or of an override. Different defines make a different one.
    const pipeline& own(const std::string& name, std::size_t buffers, const std::string& more_defines)
    {
        auto& p = own_pipelines_[name + more_defines];
        if (p)
            return *p;
        const auto source = splice(own_text("compute_prelude"), defines(0, 0, false, false, 1) + more_defines,
            own_text(name), text_file{name + " (end)", ""}, {});
        std::vector<binding> bindings;
        for (std::uint32_t b = 0; b < buffers; ++b)
            bindings.push_back({b});
        const auto begin = std::chrono::steady_clock::now();
        p = std::make_unique<pipeline>(
            *context_, kernels_.drivers(), kernels_.compile(source, name), std::move(bindings), name);
        costs[name].compile_ms
            += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
        return *p;
    }

    std::map<std::string, kernel_cost> costs;

private:
    std::string defines(std::size_t outputs, uint switches, bool listing, bool texels, uint lanes) const
    {
        return "#define GROUP " + std::to_string(group_) + "\n#define LANES " + std::to_string(lanes)
            + "\n#define LANE_LOOPS " + (lanes > 8 || context_->staging() ? "1" : "0") + "\n#define MOST_GROUPS "
            + std::to_string(context_->properties().limits.maxComputeWorkGroupCount[0]) + "u\n#define OUTPUTS "
            + std::to_string(outputs) + "\n#define SWITCHES " + std::to_string(switches) + "u\n#define LISTING "
            + (listing ? "1" : "0") + "\n#define TEXELS " + (texels ? "1" : "0") + "\n#define FIRST_OUTPUT "
            + std::to_string(first_output) + "\n#define FIRST_OWN " + std::to_string(first_own) + "\n";
    }

    static const text_file& own_text(const std::string& name) { return find_kernel_text(name + ".glsl", vulkan_texts); }

    template <class K>
    spirv_words compile(verb v, uint switches, bool texels)
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
            find_kernel_text(K::path, texts), own_text(epilogues[static_cast<int>(v)]), texts, exact_arithmetic_);
        auto words = kernels_.compile(source, name);
        auto& c = costs[name];
        if (v != verb::list)
            c.instructions = std::max(c.instructions, count_instructions(words));
        c.compile_ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
        return words;
    }

    std::shared_ptr<context> context_;
    compiled_kernels kernels_;
    std::vector<text_file> texts_;
    const text_file* exact_arithmetic_ = nullptr; ///< where kernels are rewritten
    uint group_ = 64;
    uint lanes_ = 1;                ///< elements per group in kernels that are IN_GROUPS
    std::uint64_t texel_limit_ = 0; ///< bytes of the largest buffer that is read as texels; 0: none
    std::map<std::tuple<std::string, verb, uint, bool>, std::unique_ptr<pipeline>> pipelines_;
    std::map<std::string, std::unique_ptr<pipeline>> own_pipelines_;
};

} // namespace photongrid::vulkan
