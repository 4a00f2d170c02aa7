// Where a file is written that replaces another: photon maps, pictures, scenes.
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

namespace photongrid::detail {

/// The file that a link refers to, so that the link is kept; any other file itself.
inline std::filesystem::path file_target(const std::filesystem::path& file)
{
    std::error_code none;
    auto real = std::filesystem::canonical(file, none);
    return none ? file : real;
}

/// Why no file can be renamed onto `file`, or "". Renaming one onto /dev/null would replace the device.
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

} // namespace photongrid::detail
