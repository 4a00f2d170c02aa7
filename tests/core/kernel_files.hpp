// The kernel files of include/, read when a test runs.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace photongrid::testing {

struct kernel_file {
    std::string name, text;
    /// Defines `kernel` or `holds`; others are shared by kernels.
    bool is_kernel() const
    {
        return text.find("void kernel(uint i)") != text.npos || text.find("bool holds(uint i)") != text.npos;
    }
};

/// Every .glsl file under include/.
inline std::vector<kernel_file> kernel_files()
{
    std::vector<kernel_file> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(PHOTONGRID_INCLUDE)) {
        if (entry.path().extension() != ".glsl")
            continue;
        std::ostringstream text;
        text << std::ifstream(entry.path()).rdbuf();
        files.push_back({entry.path().string(), text.str()});
    }
    return files;
}

} // namespace photongrid::testing
