// Memory for the elements of a buffer.
#pragma once

#include <photongrid/backends/vulkan/memory.hpp>

namespace photongrid::vulkan {

/// The format of elements that are read as texels.
template <element T>
inline constexpr VkFormat format_of = std::same_as<T, float> ? VK_FORMAT_R32_SFLOAT
    : std::same_as<T, uint>                                  ? VK_FORMAT_R32_UINT
    : std::same_as<T, glm::vec2>                             ? VK_FORMAT_R32G32_SFLOAT
    : std::same_as<T, glm::uvec2>                            ? VK_FORMAT_R32G32_UINT
    : std::same_as<T, glm::vec4>                             ? VK_FORMAT_R32G32B32A32_SFLOAT
                                                             : VK_FORMAT_R32G32B32A32_UINT;

/// Memory for n elements, which may be 0.
/// \throws backend_error with the numbers if the device does not bind so many, or has no room.
template <element T>
memory make_memory(const std::shared_ptr<context>& c, std::size_t n)
{
    const auto limit = c->max_buffer_bytes() / sizeof(T);
    if (n > limit)
        throw backend_error("vulkan: a buffer of " + std::to_string(n) + " elements of " + std::to_string(sizeof(T))
            + " bytes was requested; " + c->title() + " binds at most " + std::to_string(c->max_buffer_bytes())
            + " bytes (maxStorageBufferRange), " + std::to_string(limit) + " elements");
    return std::make_shared<allocation>(c, n * sizeof(T), memory_kind::device, format_of<T>);
}

} // namespace photongrid::vulkan
