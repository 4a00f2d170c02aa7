#include <photongrid/io/files.hpp>

#include <photongrid/backend/file_target.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
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
    const auto real = detail::file_target(path);
    const auto temporary = real.string() + "." + std::to_string(::getpid()) + ".tmp";
    const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file < 0)
        fail_file(path, "cannot write " + temporary + ": " + std::strerror(errno));
    int error = 0;
    for (std::size_t at = 0; at < bytes.size() && error == 0;) {
        const auto n = ::write(file, bytes.data() + at, std::min<std::size_t>(bytes.size() - at, std::size_t{1} << 30));
        if (n >= 0)
            at += static_cast<std::size_t>(n);
        else if (errno != EINTR)
            error = errno;
    }
    if (::close(file) != 0 && error == 0)
        error = errno;
    if (error == 0 && ::rename(temporary.c_str(), real.c_str()) != 0)
        error = errno;
    if (error != 0) {
        ::unlink(temporary.c_str());
        fail_file(path, std::string("cannot be written: ") + std::strerror(error));
    }
}

} // namespace photongrid
