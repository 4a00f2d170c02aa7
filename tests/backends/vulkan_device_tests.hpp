// Devices, validation and the cache of compiled kernels.
#pragma once

#include "vulkan_algorithm_tests.hpp"
#include "vulkan_buffer_tests.hpp"
#include "vulkan_under_test.hpp"

namespace photongrid::testing {

TEST_F(vulkan, devices_are_listed_and_chosen_by_index_or_name)
{
    const auto all = vulkan_devices();
    ASSERT_FALSE(all.empty());
    for (const auto& d : all) {
        if (!d.unusable.empty())
            continue;
        vulkan_options by_index, by_name;
        by_index.device = std::to_string(d.index);
        by_name.device = d.name.substr(0, d.name.find(' '));
        EXPECT_NE(vulkan_backend(by_index).caps().device.find(d.name), std::string::npos);
        EXPECT_FALSE(vulkan_backend(by_name).caps().device.empty());
    }
    const auto message_of = [](const vulkan_options& o) -> std::string {
        try {
            vulkan_backend none(o);
        } catch (const backend_error& e) {
            return e.what();
        }
        return "";
    };
    vulkan_options absent;
    absent.device = "Voodoo 2";
    EXPECT_NE(message_of(absent).find("Voodoo 2"), std::string::npos);
    EXPECT_NE(message_of(absent).find(all[0].name), std::string::npos);
    if (std::all_of(all.begin(), all.end(), [](const auto& d) { return d.software; })) {
        vulkan_options hardware;
        hardware.hardware_only = true;
        EXPECT_NE(message_of(hardware).find("hardware"), std::string::npos);
    }
}

TEST_F(vulkan, works_through_staging_buffers)
{
    vulkan_options o;
    o.validation = true;
    o.staging = true;
    std::unique_ptr<vulkan_backend> staged;
    try {
        staged = std::make_unique<vulkan_backend>(o);
    } catch (const backend_error& e) {
        GTEST_SKIP() << e.what();
    }
    expect_round_trips(*staged);
    const auto s = make_photons(distribution::clustered, 3000, uvec3(5), 1);
    const auto points = make_points(s, 100, 1);
    for (const uint m : {0u, 4u})
        expect_equal(staged->caps(), map_and_estimate(*staged, s, points, m, {.k = 20, .max_radius = 1.0f}),
            map_and_estimate(serial, s, points, m, {.k = 20, .max_radius = 1.0f}), 20);
    EXPECT_EQ(staged->validation_messages(), std::vector<std::string>{});
}

// Without this, silence of the layer would prove nothing.
TEST_F(vulkan, the_validation_layer_is_listening)
{
    vulkan_options o;
    o.validation = true;
    std::shared_ptr<photongrid::vulkan::context> c;
    try {
        c = std::make_shared<photongrid::vulkan::context>(o);
    } catch (const backend_error& e) {
        GTEST_SKIP() << e.what();
    }
    const auto make = [&] {
        return std::make_shared<photongrid::vulkan::allocation>(c, 64, photongrid::vulkan::memory_kind::device);
    };
    // Synchronization: a fill and a copy of the same bytes with no barrier between them.
    const auto from = make(), to = make();
    VkCommandPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool_info.queueFamilyIndex = c->family();
    VkCommandPool pool = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateCommandPool(c->device(), &pool_info, nullptr, &pool), VK_SUCCESS);
    VkCommandBufferAllocateInfo commands_info{};
    commands_info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    commands_info.commandPool = pool;
    commands_info.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    ASSERT_EQ(vkAllocateCommandBuffers(c->device(), &commands_info, &commands), VK_SUCCESS);
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    ASSERT_EQ(vkBeginCommandBuffer(commands, &begin), VK_SUCCESS);
    vkCmdFillBuffer(commands, from->buffer(), 0, 64, 0);
    const VkBufferCopy region{0, 0, 64};
    vkCmdCopyBuffer(commands, from->buffer(), to->buffer(), 1, &region);
    vkEndCommandBuffer(commands);
    vkDestroyCommandPool(c->device(), pool, nullptr);
    const auto messages = c->messages();
    ASSERT_FALSE(messages.empty());
    EXPECT_NE(messages[0].find("SYNC-HAZARD"), std::string::npos) << messages[0];
}

// A kernel that reads past the end of its input, as texels and (staging) as a storage buffer.
TEST_F(vulkan, gpu_assisted_validation_sees_a_read_out_of_bounds)
{
    for (const bool staging : {false, true}) {
        SCOPED_TRACE(staging ? "storage buffers" : "texel buffers");
        std::unique_ptr<vulkan_backend> watched;
        try {
            watched = std::make_unique<vulkan_backend>(
                vulkan_options{.validation = true, .gpu_assisted = true, .staging = staging});
        } catch (const backend_error& e) {
            GTEST_SKIP() << e.what();
        }
        watched->add_texts(test_kernels::texts);
        const std::vector<uint> host(16, 7u);
        const auto input = watched->upload(std::span<const uint>(host));
        auto output = watched->make<uint>(16);
        watched->run<test_kernels::next_frame>(16, {.frame = 0u}, reads(input), writes(output));
        EXPECT_EQ(watched->download(output), std::vector<uint>(16, 15u));
        EXPECT_EQ(watched->validation_messages(), std::vector<std::string>{});
        watched->run<test_kernels::next_frame>(
            16, {.frame = 0u - 1000u}, reads(input), writes(output)); // elements 1000 to 1015
        watched->finish();
        const auto messages = watched->validation_messages();
        ASSERT_FALSE(messages.empty());
        EXPECT_NE(messages[0].find("out of bounds"), std::string::npos) << messages[0];
    }
}

// Instrumenting breaks some loops of optimized kernels: the search's did not compile.
TEST_F(vulkan, gpu_assisted_validation_takes_the_search)
{
    std::unique_ptr<vulkan_backend> watched;
    try {
        watched = std::make_unique<vulkan_backend>(vulkan_options{.validation = true, .gpu_assisted = true});
    } catch (const backend_error& e) {
        GTEST_SKIP() << e.what();
    }
    const auto set = make_photons(distribution::uniform, 200, {3, 3, 3}, 4);
    const auto points = make_points(set, 20, 4);
    const auto radii = [&](auto& device) {
        const auto map = sorted_map(device, upload_photons(device, set), set.g);
        std::vector<float> found;
        for (const auto& e : device.download(knn_grid_estimate(
                 device, map, device.upload(std::span<const vec4>(points)), {.k = 10, .max_radius = 1})
                                                 .irradiance))
            found.push_back(e.w);
        return found;
    };
    serial_backend serial;
    EXPECT_EQ(radii(*watched), radii(serial));
    EXPECT_EQ(watched->validation_messages(), std::vector<std::string>{});
}

// --- the cache of compiled kernels
// --------------------------------------------------------------------------------------

/// A folder of this process's own that goes with it.
struct own_folder {
    std::filesystem::path path
        = std::filesystem::temp_directory_path() / ("photongrid-cache-test-" + std::to_string(std::random_device()()));
    ~own_folder()
    {
        std::error_code failed;
        std::filesystem::remove_all(path, failed);
    }
};

TEST(file_cache, finds_what_it_kept_and_nothing_else)
{
    const own_folder folder;
    photongrid::vulkan::file_cache cache(folder.path.string()), none("");
    EXPECT_FALSE(cache.find("a"));
    const std::string binary("\0\1\xFF\n", 4);
    cache.keep("a", binary);
    cache.keep("b", "");
    cache.keep("b", "newer");
    none.keep("a", "x");
    EXPECT_FALSE(none.find("a"));
    const auto text
        = [](const auto& found) { return found ? std::string(found->begin(), found->end()) : std::string("none"); };
    EXPECT_EQ(text(photongrid::vulkan::file_cache(folder.path.string()).find("a")), binary);
    EXPECT_EQ(text(cache.find("b")), "newer");
    EXPECT_FALSE(cache.find("c"));
    // A folder that cannot be made: nothing kept, no error.
    photongrid::vulkan::file_cache nowhere_to_go((folder.path / "0").string());
    std::ofstream(folder.path / "0") << "a file";
    nowhere_to_go.keep("a", "x");
    EXPECT_FALSE(nowhere_to_go.find("a"));
}

TEST(file_cache, a_damaged_file_counts_as_not_there)
{
    const own_folder folder;
    photongrid::vulkan::file_cache cache(folder.path.string());
    cache.keep("key", "some value");
    const auto file = std::filesystem::directory_iterator(folder.path)->path();
    std::ifstream in(file, std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    const auto found_with = [&](const std::string& contents) {
        std::ofstream(file, std::ios::binary) << contents;
        return cache.find("key").has_value();
    };
    EXPECT_TRUE(found_with(whole));
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_FALSE(found_with(whole.substr(0, size))) << size << " bytes of it";
    EXPECT_FALSE(found_with(whole + "x"));
    for (std::size_t at = 0; at < whole.size(); ++at) {
        auto damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 4);
        EXPECT_FALSE(found_with(damaged)) << "byte " << at;
    }
}

TEST(file_cache, too_many_files_lose_the_oldest)
{
    const own_folder folder;
    std::filesystem::create_directories(folder.path);
    for (int i = 0; i < 1200; ++i) {
        char name[32];
        std::snprintf(name, sizeof name, "%016x.bin", i);
        std::ofstream(folder.path / name) << "old";
    }
    std::ofstream(folder.path / "another's file") << "stays";
    photongrid::vulkan::file_cache cache(folder.path.string());
    cache.keep("key", "value");
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path))
        ++files;
    EXPECT_EQ(files, 600u + 2u);
    EXPECT_TRUE(cache.find("key"));
    EXPECT_TRUE(std::filesystem::exists(folder.path / "another's file"));
}

TEST_F(vulkan, the_second_start_finds_its_kernels_compiled)
{
    const own_folder folder;
    const auto sorted = [&] {
        vulkan_backend b({.validation = true, .cache_folder = folder.path.string()});
        std::vector<uvec2> pairs;
        for (uint i = 0; i < 100; ++i)
            pairs.emplace_back(i * 37 % 101, i);
        auto buffer = b.upload(std::span<const uvec2>(pairs));
        bitonic_sort<vulkan_backend>(b, buffer); // the generic one, whose kernel spirv() is asked for
        const auto result = b.download(buffer);
        const auto messages = b.validation_messages();
        EXPECT_TRUE(messages.empty()) << messages.front();
        return std::tuple(result, b.kernels_found(), b.spirv<kernels::bitonic_step>());
    };
    const auto [first, found_first, words_first] = sorted();
    const auto [second, found_second, words_second] = sorted();
    EXPECT_EQ(found_first, 1u); // spirv() asks for one that bitonic_sort had compiled
    EXPECT_GT(found_second, 2u);
    EXPECT_EQ(first, second);
    EXPECT_EQ(words_first, words_second);
    // All files spoilt: compiled again, with the same result.
    for (const auto& entry : std::filesystem::directory_iterator(folder.path))
        std::filesystem::resize_file(entry.path(), std::filesystem::file_size(entry.path()) / 2);
    const auto [third, found_third, words_third] = sorted();
    EXPECT_EQ(found_third, 1u);
    EXPECT_EQ(first, third);
}

TEST_F(vulkan, knows_what_its_device_is)
{
    const auto& c = b().caps();
    EXPECT_EQ(c.backend, "vulkan");
    EXPECT_GE(c.max_elements, std::uint64_t{1} << 23);
    EXPECT_EQ(c.max_route_slots, 16u);
    if (c.device.find("llvmpipe") != std::string::npos) {
        EXPECT_TRUE(c.software && c.exact_division && c.exact_sqrt);
        EXPECT_EQ(c.loop_limit, 65535u);
    }
}

} // namespace photongrid::testing
