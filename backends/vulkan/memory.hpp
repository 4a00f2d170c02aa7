// The open device and its memory. Buffers share ownership of it, so a buffer may outlive its backend.
#pragma once

#include <photongrid/backends/vulkan/device.hpp>

#include <cstdint>
#include <map>

namespace photongrid::vulkan {

enum class memory_kind { device, host };

/// A VkBuffer with its memory.
struct block {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize bytes = 0;
    void* mapped = nullptr; ///< the host's address; null if it is not mapped
};

/// An open device, and blocks of memory that can be used again.
class context {
public:
    explicit context(const vulkan_options& o)
        : instance_(o.validation, o.gpu_assisted), physical_(choose_device(instance_, o)), device_(physical_)
    {
        query_device(o.staging);
    }
    explicit context(const vulkan_handles& h) : instance_(h.instance), physical_(h.physical_device), device_(h)
    {
        if (!h.instance || !h.physical_device || !h.device || !h.queue)
            throw std::invalid_argument("vulkan_backend: handles: the instance, the physical device, the device or the "
                                        "queue is null; give all four");
        query_device(false);
    }
    context(const context&) = delete;
    context& operator=(const context&) = delete;
    ~context() { drop_free(); }

    VkDevice device() const { return device_.get(); }
    VkPhysicalDevice physical() const { return physical_; }
    VkQueue queue() const { return device_.queue(); }
    std::uint32_t family() const { return device_.family(); }
    const VkPhysicalDeviceProperties& properties() const { return properties_; }
    /// The names of the device and of its driver.
    std::string title() const
    {
        const auto info = describe(physical_, 0);
        return info.name + ", " + info.driver;
    }
    std::vector<std::string> messages() const { return instance_.messages(); }
    /// Whether staging buffers were requested.
    bool staging() const { return staging_; }
    std::uint64_t max_buffer_bytes() const { return max_buffer_bytes_; }
    /// Bytes in buffers that have not been destroyed.
    std::uint64_t bytes() const { return named_; }
    /// The most bytes allocated at once, including buffers that were waiting for their last pass.
    std::uint64_t peak_bytes() const { return peak_; }
    void forget(const block& b) { named_ -= b.bytes; }

    block acquire(VkDeviceSize size, memory_kind kind)
    {
        // Sizes are multiples of 256 bytes, so that even a buffer without elements can be bound.
        const VkDeviceSize bytes = (std::max<VkDeviceSize>(size, 16) + 255) / 256 * 256;
        auto& free = free_[kind];
        block b;
        if (const auto found = free.find(bytes); found != free.end()) {
            b = found->second;
            free.erase(found);
            free_bytes_ -= b.bytes;
        } else {
            b = allocate(bytes, kind);
        }
        bytes_ += b.bytes;
        named_ += b.bytes;
        peak_ = std::max(peak_, bytes_);
        return b;
    }

    /// Releases a block to the caller.
    void let_go(const block& b)
    {
        bytes_ -= b.bytes;
        if (b.mapped != nullptr)
            vkUnmapMemory(device(), b.memory);
    }

    void release(const block& b, memory_kind kind)
    {
        bytes_ -= b.bytes;
        if (free_bytes_ + b.bytes > keep_bytes_ || free_[kind].size() >= keep_blocks) {
            destroy(b);
            return;
        }
        free_[kind].emplace(b.bytes, b);
        free_bytes_ += b.bytes;
    }

private:
    // Algorithms allocate the same sizes repeatedly, and an allocation costs more than a pass.
    VkDeviceSize keep_bytes_ = VkDeviceSize{64} << 20;
    static constexpr std::size_t keep_blocks = 1024;

    void query_device(bool staging)
    {
        staging_ = staging;
        VkPhysicalDeviceMaintenance3Properties m3{};
        m3.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES;
        VkPhysicalDeviceProperties2 p2{};
        p2.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
        p2.pNext = &m3;
        vkGetPhysicalDeviceProperties2(physical_, &p2);
        properties_ = p2.properties;
        max_buffer_bytes_
            = std::min<std::uint64_t>(properties_.limits.maxStorageBufferRange, m3.maxMemoryAllocationSize);
        vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);
        // If host and device share memory, staging copies are not needed; across a bus, reads by the host are slow.
        // A discrete GPU has memory to spare, and allocates slowly.
        if (properties_.deviceType == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU)
            keep_bytes_ = std::max(keep_bytes_, std::min<VkDeviceSize>(device_bytes() / 16, VkDeviceSize{1} << 30));
        unified_ = !staging && properties_.deviceType != VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU
            && find_type(~0u, shared_memory) != none;
    }

    /// Of its largest local heap.
    VkDeviceSize device_bytes() const
    {
        VkDeviceSize most = 0;
        for (std::uint32_t h = 0; h < memory_.memoryHeapCount; ++h)
            if ((memory_.memoryHeaps[h].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0)
                most = std::max(most, memory_.memoryHeaps[h].size);
        return most;
    }

    static constexpr std::uint32_t none = ~0u;
    static constexpr VkMemoryPropertyFlags host_memory
        = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    static constexpr VkMemoryPropertyFlags shared_memory
        = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | host_memory | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

    std::uint32_t find_type(std::uint32_t allowed, VkMemoryPropertyFlags properties) const
    {
        for (std::uint32_t t = 0; t < memory_.memoryTypeCount; ++t)
            if (((allowed >> t) & 1u) != 0 && (memory_.memoryTypes[t].propertyFlags & properties) == properties)
                return t;
        return none;
    }

    std::uint32_t memory_type(std::uint32_t allowed, memory_kind kind) const
    {
        if (kind == memory_kind::host) {
            const auto cached = find_type(allowed, host_memory | VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
            return cached != none ? cached : find_type(allowed, host_memory);
        }
        if (unified_)
            if (const auto t = find_type(allowed, shared_memory); t != none)
                return t;
        const auto local = find_type(allowed, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
        return local != none ? local : find_type(allowed, 0);
    }

    block allocate(VkDeviceSize bytes, memory_kind kind)
    {
        const std::string what
            = "a buffer of " + std::to_string(bytes) + " bytes (" + std::to_string(bytes_) + " are in use)";
        block b;
        b.bytes = bytes;
        VkBufferCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
        info.size = bytes;
        info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT
            | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT
            | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
        check(vkCreateBuffer(device(), &info, nullptr, &b.buffer), "vkCreateBuffer: " + what);
        VkMemoryRequirements needs;
        vkGetBufferMemoryRequirements(device(), b.buffer, &needs);
        VkMemoryAllocateInfo memory{};
        memory.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
        memory.allocationSize = needs.size;
        memory.memoryTypeIndex = memory_type(needs.memoryTypeBits, kind);
        VkResult r = vkAllocateMemory(device(), &memory, nullptr, &b.memory);
        if (r != VK_SUCCESS && free_bytes_ > 0) {
            drop_free();
            r = vkAllocateMemory(device(), &memory, nullptr, &b.memory);
        }
        if (r == VK_SUCCESS)
            r = vkBindBufferMemory(device(), b.buffer, b.memory, 0);
        const bool seen = kind == memory_kind::host
            || (unified_
                && (memory_.memoryTypes[memory.memoryTypeIndex].propertyFlags & shared_memory) == shared_memory);
        if (r == VK_SUCCESS && seen)
            r = vkMapMemory(device(), b.memory, 0, VK_WHOLE_SIZE, 0, &b.mapped);
        if (r != VK_SUCCESS)
            destroy(b);
        check(r, "memory for " + what);
        return b;
    }

    void destroy(const block& b) const
    {
        vkDestroyBuffer(device(), b.buffer, nullptr);
        vkFreeMemory(device(), b.memory, nullptr);
    }

    void drop_free()
    {
        for (auto& [kind, blocks] : free_) {
            for (auto& [bytes, b] : blocks)
                destroy(b);
            blocks.clear();
        }
        free_bytes_ = 0;
    }

    instance instance_;
    VkPhysicalDevice physical_;
    logical_device device_;
    VkPhysicalDeviceProperties properties_{};
    VkPhysicalDeviceMemoryProperties memory_{};
    bool staging_ = false, unified_ = false;
    std::uint64_t max_buffer_bytes_ = 0;
    std::map<memory_kind, std::multimap<VkDeviceSize, block>> free_;
    VkDeviceSize free_bytes_ = 0;
    std::uint64_t bytes_ = 0, named_ = 0, peak_ = 0;
};

/// A block in use. A buffer owns it, and so does each batch of passes that uses it, until that batch is done.
class allocation {
public:
    /// `format`: that of an element, if the buffer is to be read as texels.
    allocation(std::shared_ptr<context> c, VkDeviceSize bytes, memory_kind kind, VkFormat format = VK_FORMAT_UNDEFINED)
        : context_(std::move(c)), kind_(kind), format_(format), bytes_(bytes), block_(context_->acquire(bytes, kind))
    {
    }
    /// Wraps the first `bytes` bytes of a buffer that the caller continues to own.
    allocation(std::shared_ptr<context> c, VkBuffer callers, VkDeviceSize bytes, VkFormat format)
        : context_(std::move(c)), kind_(memory_kind::device), format_(format), bytes_(bytes), named_(false),
          ours_(false), block_{.buffer = callers, .bytes = bytes}
    {
    }
    allocation(const allocation&) = delete;
    allocation& operator=(const allocation&) = delete;
    ~allocation()
    {
        forget();
        vkDestroyBufferView(context_->device(), view_, nullptr);
        if (ours_)
            context_->release(block_, kind_);
    }

    /// Releases it to the caller, who must destroy it after the device has finished with it.
    block give_up()
    {
        forget();
        if (ours_)
            context_->let_go(block_);
        ours_ = false;
        return block_;
    }
    bool is_of(const context& c) const { return context_.get() == &c; }

    /// The buffer was destroyed; only unfinished passes still use the block.
    void forget()
    {
        if (named_)
            context_->forget(block_);
        named_ = false;
    }

    VkBuffer buffer() const { return block_.buffer; }
    VkDeviceSize bytes() const { return bytes_; }
    void* mapped() const { return block_.mapped; }
    /// The range of a descriptor. For the backend's own buffers it is never empty.
    VkDeviceSize range() const { return ours_ ? std::max<VkDeviceSize>(bytes_, 16) : bytes_; }
    /// A view of it as a texel buffer.
    VkBufferView view()
    {
        if (view_)
            return view_;
        VkBufferViewCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO;
        info.buffer = buffer();
        info.format = format_;
        info.range = range();
        check(vkCreateBufferView(context_->device(), &info, nullptr, &view_), "vkCreateBufferView");
        return view_;
    }

private:
    std::shared_ptr<context> context_;
    memory_kind kind_;
    VkFormat format_;
    VkBufferView view_ = VK_NULL_HANDLE;
    VkDeviceSize bytes_;
    bool named_ = true, ours_ = true;
    block block_;
};

using memory = std::shared_ptr<allocation>;

} // namespace photongrid::vulkan
