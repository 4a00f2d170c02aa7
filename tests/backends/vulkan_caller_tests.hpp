// The backend on the caller's device.
#pragma once

#include "vulkan_caller.hpp"

namespace photongrid::testing {

TEST_F(callers_device, gives_what_serial_gives_and_stays_the_callers)
{
    const auto s = make_photons(distribution::uniform, 1000, glm::uvec3(5), 1);
    const auto points = make_points(s, 100, 1);
    const auto estimates = [&](auto& b) {
        const auto map = sorted_map(b, upload_photons(b, s), s.g);
        return b.download(
            knn_grid_estimate(b, map, b.upload(std::span<const vec4>(points)), {.k = 20, .max_radius = 1.0f})
                .irradiance);
    };
    {
        vulkan_backend mine(app.handles);
        EXPECT_EQ(count_different_bits(estimates(mine), estimates(serial)), 0u);
    }
    app.wait();
}

TEST_F(callers_device, takes_over_a_buffer_and_hands_one_back_without_the_host)
{
    constexpr std::size_t n = 5000;
    constexpr VkDeviceSize bytes = n * sizeof(uvec2);
    const auto pairs = random_pairs(n);
    application::own_buffer source, keys, result;
    app.make(source, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    app.make(keys, bytes, vulkan_backend::adopted_usage);
    app.make(result, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    source.fill(pairs);
    const auto to_keys = app.record_copy(source.buffer, keys.buffer, bytes);
    {
        vulkan_backend b(app.handles);
        const auto held = b.bytes();
        auto buffer = b.adopt<uvec2>(keys.buffer, n);
        EXPECT_EQ(buffer.size(), n);
        EXPECT_EQ(b.bytes(), held);
        app.submit(to_keys); // nobody waits: the sort comes after it on the queue
        bitonic_sort(b, buffer);
        app.submit(app.record_copy(b.handle(buffer), result.buffer, bytes));
        app.wait();
        EXPECT_EQ(result.contents<uvec2>(), in_order(pairs));
        EXPECT_EQ(b.download(buffer), in_order(pairs));
    }
    app.wait();
    EXPECT_EQ(keys.contents<uvec2>().size(), n); // still the application's
}

TEST_F(callers_device, sees_in_its_own_buffer_what_a_pass_wrote_there)
{
    constexpr uint n = 1000;
    application::own_buffer ids, result;
    app.make(ids, n * sizeof(uint), vulkan_backend::adopted_usage);
    app.make(result, n * sizeof(uint), VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    vulkan_backend b(app.handles);
    const auto pairs = random_pairs(n);
    const auto from = b.upload(std::span<const uvec2>(pairs));
    auto adopted = b.adopt<uint>(ids.buffer, n);
    for (uint turn = 0; turn < 3; ++turn) { // their copy reads what ours wrote, ours writes what theirs has read
        b.run<kernels::pair_value>(n, {}, reads(from), writes(adopted));
        ASSERT_EQ(b.handle(adopted), ids.buffer);
        app.submit(app.record_copy(ids.buffer, result.buffer, n * sizeof(uint)));
    }
    app.wait();
    const auto seen = result.contents<uint>();
    for (uint i = 0; i < n; ++i)
        ASSERT_EQ(seen[i], pairs[i].y);
}

TEST_F(callers_device, owns_a_buffer_that_was_released)
{
    vulkan_backend::released_buffer given;
    application::own_buffer result;
    const auto pairs = random_pairs(100);
    app.make(result, 100 * sizeof(uvec2), VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    {
        vulkan_backend b(app.handles);
        const auto held = b.bytes();
        auto buffer = b.upload(std::span<const uvec2>(pairs));
        EXPECT_GT(b.bytes(), held);
        given = b.release(std::move(buffer));
        EXPECT_EQ(b.bytes(), held);
        EXPECT_EQ(buffer.size(), 0u);
    }
    ASSERT_NE(given.buffer, VkBuffer{});
    app.submit(app.record_copy(given.buffer, result.buffer, 100 * sizeof(uvec2)));
    app.wait();
    EXPECT_EQ(result.contents<uvec2>(), pairs);
    vkDestroyBuffer(app.handles.device, given.buffer, nullptr);
    vkFreeMemory(app.handles.device, given.memory, nullptr);
}

TEST_F(callers_device, rejects_wrong_handles_and_buffers)
{
    EXPECT_THROW(vulkan_backend{vulkan_handles{}}, std::invalid_argument);
    vulkan_backend b(app.handles), other(app.handles);
    EXPECT_THROW((void)b.adopt<uint>(VK_NULL_HANDLE, 10), std::invalid_argument);
    application::own_buffer small;
    app.make(small, 64, vulkan_backend::adopted_usage);
    EXPECT_THROW((void)b.adopt<uint>(small.buffer, 0), std::invalid_argument);
    EXPECT_THROW((void)b.adopt<uint>(small.buffer, std::size_t{1} << 40), std::invalid_argument);

    // Another backend's buffers, on the same device even.
    const auto pairs = random_pairs(8);
    auto theirs = other.upload(std::span<const uvec2>(pairs));
    auto ours = b.make<uint>(8);
    auto ids = other.make<uint>(8);
    const auto refusal = [](auto&& f) {
        try {
            f();
        } catch (const std::invalid_argument& e) {
            return std::string(e.what());
        }
        return std::string("none");
    };
    EXPECT_NE(refusal([&] {
        b.run<kernels::pair_value>(8, {}, reads(theirs), writes(ours));
    }).find("buffer 'pairs' belongs to another"),
        std::string::npos);
    EXPECT_NE(refusal([&] {
        other.run<kernels::pair_value>(8, {}, reads(theirs), writes(ours));
    }).find("buffer 'value' belongs to another"),
        std::string::npos);
    EXPECT_NE(refusal([&] { (void)b.download(theirs); }).find("download: b"), std::string::npos);
    EXPECT_NE(refusal([&] { (void)b.handle(theirs); }).find("handle: b"), std::string::npos);
    EXPECT_NE(refusal([&] { (void)b.release(std::move(ids)); }).find("release: b"), std::string::npos);
    EXPECT_EQ(refusal([&] {
        b.run<kernels::pair_value>(8, {}, reads(b.upload(std::span<const uvec2>(pairs))), writes(ours));
    }),
        "none");
}

} // namespace photongrid::testing
