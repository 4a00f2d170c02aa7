// Whether files have changed: by the time of their last change and by their size, on any file system.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace photongrid::viewer {

/// What tells one content of a file from another.
struct file_stamp {
    bool exists = false;
    std::filesystem::file_time_type changed{};
    std::uintmax_t size = 0; ///< bytes

    bool operator==(const file_stamp&) const = default;
};

file_stamp stamp_of(const std::string& path);

/// By path.
using file_stamps = std::map<std::string, file_stamp>;

/// Files that were read. Programs write files in steps, so a change counts when two looks find the same.
class file_watch {
public:
    /// `read`: the files as they were just before they were read.
    explicit file_watch(file_stamps read = {}) : read_(std::move(read)), seen_(read_) {}

    /// Looks at the files. Returns whether they are not what was read, but what the last look found.
    bool look();
    /// They were read again after the last look, in vain, and with them `tried`: true is returned only after another
    /// change.
    void failed(const file_stamps& tried);

private:
    file_stamps read_, seen_;
};

} // namespace photongrid::viewer
