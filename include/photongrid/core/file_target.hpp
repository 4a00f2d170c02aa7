// Helpers for writing a file beside the old one and renaming it over it.
#pragma once

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace photongrid::detail {

/// The file that a link refers to, so that the link is kept; any other file itself.
inline std::filesystem::path file_target(const std::filesystem::path& file)
{
    std::error_code none;
    auto real = std::filesystem::canonical(file, none);
    return none ? file : real;
}

/// The reason why `file` cannot be replaced, or "". Renaming a file onto /dev/null would replace the device.
inline std::string unwritable_reason(const std::filesystem::path& file)
{
    namespace fs = std::filesystem;
    std::error_code none;
    const auto status = fs::status(file, none);
    if (fs::exists(status) && !fs::is_regular_file(status))
        return fs::is_directory(status) ? "is a folder; expected a file's name" : "is not a regular file";
    const auto folder = file_target(file).parent_path();
    const auto shown = folder.empty() ? fs::path(".") : folder;
    return fs::is_directory(shown, none) ? "" : "there is no folder " + shown.string();
}

/// A new file beside `target`, which publish() renames over it. Without publish(), or on an error, it is removed. Its
/// name is its own, so that threads and processes may replace the same target at the same time: the last one to publish
/// wins.
class replacement_file {
public:
    explicit replacement_file(std::filesystem::path target) : target_(std::move(target))
    {
        static std::atomic<unsigned> number{0}; // tells the files of this process's threads apart
        do {
            path_ = target_.string() + "." + std::to_string(::getpid()) + "-" + std::to_string(number++) + ".part";
            descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
        } while (descriptor_ < 0 && errno == EEXIST); // left by a process that died and had the same id
        if (descriptor_ < 0)
            error_ = errno;
        is_left_ = error_ == 0;
    }
    replacement_file(const replacement_file&) = delete;
    replacement_file& operator=(const replacement_file&) = delete;
    ~replacement_file()
    {
        close();
        if (is_left_)
            ::unlink(path_.c_str());
    }

    /// Appends bytes; does nothing after an error.
    void append(const void* data, std::size_t bytes)
    {
        const auto* const from = static_cast<const char*>(data);
        for (std::size_t at = 0; at < bytes && error_ == 0;) {
            const auto n = ::write(descriptor_, from + at, std::min(bytes - at, std::size_t{1} << 30));
            if (n >= 0)
                at += static_cast<std::size_t>(n);
            else if (errno != EINTR)
                error_ = errno;
        }
    }

    /// Renames the file over the target. Returns the first error, or "".
    std::string publish()
    {
        close();
        if (error_ == 0 && ::rename(path_.c_str(), target_.c_str()) != 0)
            error_ = errno;
        if (error_ != 0)
            return std::generic_category().message(error_);
        is_left_ = false;
        return "";
    }

private:
    void close()
    {
        if (descriptor_ >= 0 && ::close(descriptor_) != 0 && error_ == 0)
            error_ = errno;
        descriptor_ = -1;
    }

    std::filesystem::path target_;
    std::string path_;
    int descriptor_ = -1;
    int error_ = 0;
    bool is_left_ = false; ///< the file exists under its own name
};

/// Writes `file` by write(append), where append(data, bytes) adds bytes, and replaces the old one by it. Returns the
/// reason why that failed, or "". On an error, or if the program dies, the old file remains.
template <class Write>
std::string replace_file(const std::filesystem::path& file, const Write& write)
{
    if (auto reason = unwritable_reason(file); !reason.empty())
        return reason;
    replacement_file part(file_target(file));
    write([&](const void* data, std::size_t bytes) { part.append(data, bytes); });
    return part.publish();
}

} // namespace photongrid::detail
