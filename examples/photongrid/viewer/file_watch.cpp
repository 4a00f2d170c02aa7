#include "file_watch.hpp"

#include <utility>

namespace photongrid::viewer {

file_stamp stamp_of(const std::string& path)
{
    std::error_code wrong_time, wrong_size;
    const file_stamp found{.exists = true,
        .changed = std::filesystem::last_write_time(path, wrong_time),
        .size = std::filesystem::file_size(path, wrong_size)};
    return wrong_time || wrong_size ? file_stamp{} : found;
}

bool file_watch::look()
{
    auto before = std::exchange(seen_, {});
    for (const auto& [path, stamp] : read_)
        seen_[path] = stamp_of(path);
    return seen_ != read_ && seen_ == before;
}

void file_watch::failed(const file_stamps& tried)
{
    read_ = seen_;
    for (const auto& [path, stamp] : tried)
        read_[path] = stamp;
}

} // namespace photongrid::viewer
