// Runs kernels, and shaders of the backend's own, as passes over memory.
#pragma once

#include <photongrid/backends/vulkan/elements.hpp>
#include <photongrid/backends/vulkan/pipelines.hpp>

#include <cassert>
#include <map>

namespace photongrid::vulkan {

class passes {
public:
    passes(std::shared_ptr<context> c, const vulkan_options& options)
        : context_(std::move(c)), made(context_, options), batches(context_, options.time_passes), empty_(allocate(0))
    {
    }

    /// Memory for `bytes` bytes of any kind.
    memory allocate(std::size_t bytes) const
    {
        return std::make_shared<allocation>(context_, bytes, memory_kind::device, VK_FORMAT_UNDEFINED);
    }
    /// Memory for n elements; see make_memory().
    template <element T>
    memory make(std::size_t n) const
    {
        return make_memory<T>(context_, n);
    }

    /// One pass of kernel K for `v` over the launch. `where`: the index at which an invocation of element l.first
    /// reads and writes.
    template <class K>
    void run(verb v, const launch& l, uint where, const typename K::Params& args, const std::vector<memory>& buffers)
    {
        batches.dispatch(made.get<K>(v, l.switches, buffers), buffers, push(l, made.groups(l.elements), where, args),
            made.groups(l.elements), made.cost<K>().ms);
    }

    /// One pass of a shader of the backend or of an override, with the buffers bound from 0 on.
    void own(const std::string& name, std::uint64_t elements, std::initializer_list<uint> args,
        std::initializer_list<memory> buffers, const std::string& more_defines = {})
    {
        std::vector<memory> bound_buffers;
        for (const auto& b : buffers)
            bound_buffers.push_back(b ? b : empty_);
        std::array<uint, 8> params{};
        assert(args.size() <= params.size());
        std::copy(args.begin(), args.end(), params.begin());
        if (elements == 0)
            return;
        auto& cost = made.costs[name];
        batches.dispatch(made.own(name, buffers.size(), more_defines), bound_buffers,
            push(launch(elements), made.groups(elements), 0, params), made.groups(elements), cost.ms);
        ++cost.passes;
    }

    /// The passes that a kernel's last run until done took, at least 1.
    uint& usual_passes(const std::string& kernel) { return usual_passes_.try_emplace(kernel, 1u).first->second; }

    /// The launch header, 16 bytes, followed by the parameters.
    template <class Params>
    static std::array<std::byte, pipeline::push_bytes> push(
        const launch& l, std::uint64_t groups, uint where, const Params& args)
    {
        static_assert(sizeof(Params) <= pipeline::push_bytes - 16, "a kernel's Params are at most 112 bytes");
        static_assert(std::is_trivially_copyable_v<Params>);
        std::array<std::byte, pipeline::push_bytes> bytes{};
        const uint header[4] = {l.elements, l.first, static_cast<uint>(groups), where};
        std::memcpy(bytes.data(), header, sizeof header);
        std::memcpy(bytes.data() + sizeof header, &args, sizeof args);
        return bytes;
    }

private:
    std::shared_ptr<context> context_;

public:
    // Declared before the recorder, so that pipelines and costs outlive its last batch.
    pipelines made;
    recorder batches;

private:
    memory empty_;
    std::map<std::string, uint> usual_passes_;
};

} // namespace photongrid::vulkan
