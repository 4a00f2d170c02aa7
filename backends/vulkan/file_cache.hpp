// A folder that caches data between runs of a program: compiled kernels.
#pragma once

#include <photongrid/core/file_target.hpp>
#include <photongrid/core/fnv1a.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace photongrid::vulkan {

/// Stores byte strings in files, with texts as keys. Files that are damaged, unreadable or of other origin count as
/// missing, failed writes are ignored, and nothing is reported as an error. Several programs may use a folder at the
/// same time.
class file_cache {
public:
    using bytes = std::vector<char>;

    /// "": stores nothing. The folder is created when the first file is stored.
    explicit file_cache(std::string folder) : folder_(std::move(folder)) {}

    std::optional<bytes> find(std::string_view key) const
    {
        if (folder_.empty())
            return std::nullopt;
        std::ifstream file(path_of(key), std::ios::binary);
        const bytes all{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
        const std::size_t head = sizeof magic + 3 * sizeof(std::uint64_t);
        if (all.size() < head + key.size() || std::memcmp(all.data(), magic, sizeof magic) != 0)
            return std::nullopt;
        std::uint64_t sizes_and_sum[3];
        std::memcpy(sizes_and_sum, all.data() + sizeof magic, sizeof sizes_and_sum);
        const std::string_view contents(all.data() + head, all.size() - head);
        if (sizes_and_sum[0] != key.size() || sizes_and_sum[1] != contents.size() - key.size()
            || contents.substr(0, key.size()) != key || sizes_and_sum[2] != detail::fnv1a(contents))
            return std::nullopt;
        return bytes(contents.begin() + static_cast<std::ptrdiff_t>(key.size()), contents.end());
    }

    void keep(std::string_view key, std::string_view value)
    {
        if (folder_.empty())
            return;
        std::error_code failed;
        std::filesystem::create_directories(folder_, failed);
        remove_oldest();
        const std::string contents = std::string(key) + std::string(value);
        const std::uint64_t sizes_and_sum[3] = {key.size(), value.size(), detail::fnv1a(contents)};
        // Other programs never read an incomplete file. A cache that cannot be written is only slower.
        (void)detail::replace_file(path_of(key), [&](const auto& append) {
            append(magic, sizeof magic);
            append(sizes_and_sum, sizeof sizes_and_sum);
            append(contents.data(), contents.size());
        });
    }

private:
    static constexpr char magic[8] = {'p', 'h', 'g', 'r', 'i', 'd', '0', '1'};
    static constexpr std::size_t most_files = 1000; ///< a scene needs about 40

    std::filesystem::path path_of(std::string_view key) const
    {
        char name[32];
        std::snprintf(name, sizeof name, "%016llx.bin", static_cast<unsigned long long>(detail::fnv1a(key)));
        return std::filesystem::path(folder_) / name;
    }

    /// Removes files of other versions and drivers: half of all files, when there are too many.
    void remove_oldest()
    {
        if (std::exchange(looked_, true))
            return;
        std::error_code failed;
        std::vector<std::pair<std::filesystem::file_time_type, std::filesystem::path>> files;
        for (const auto& entry : std::filesystem::directory_iterator(folder_, failed))
            if (const auto name = entry.path().filename().string(); name.size() >= 20 && name.find(".bin") == 16)
                files.emplace_back(entry.last_write_time(failed), entry.path());
        if (files.size() <= most_files)
            return;
        std::sort(files.begin(), files.end());
        for (std::size_t i = 0; i < files.size() / 2; ++i)
            std::filesystem::remove(files[i].second, failed);
    }

    std::string folder_;
    bool looked_ = false;
};

} // namespace photongrid::vulkan
