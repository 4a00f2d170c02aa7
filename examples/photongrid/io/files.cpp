#include <photongrid/io/files.hpp>

#include <photongrid/core/file_target.hpp>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <unistd.h>

namespace photongrid {

namespace fs = std::filesystem;

void fail_file(const std::string& path, const std::string& reason) { throw file_error(path + ": " + reason); }

void check_file_path(const std::string& path)
{
    if (const auto reason = detail::unwritable_reason(path); !reason.empty())
        fail_file(path, reason);
    const auto folder = detail::file_target(path).parent_path();
    const auto shown = folder.empty() ? fs::path(".") : folder;
    if (::access(shown.c_str(), W_OK | X_OK) != 0)
        fail_file(path, "the folder " + shown.string() + " cannot be written to: " + std::strerror(errno));
}

void write_file(const std::string& path, const std::string& bytes)
{
    check_file_path(path);
    const auto reason = detail::replace_file(path, [&](const auto& append) { append(bytes.data(), bytes.size()); });
    if (!reason.empty())
        fail_file(path, "cannot be written: " + reason);
}

} // namespace photongrid
