// Files that a scene's files include.
#pragma once

#include <photongrid/io/import/import_log.hpp>
#include <photongrid/io/import/scene_files.hpp>

#include <cstddef>
#include <string>

namespace photongrid {

struct included_file {
    std::string path, text;
};

/// Reads them, and ends files that include themselves.
class included_files {
public:
    explicit included_files(const scene_files& files) : files_(files) {}

    /// The file that one includes at `from`. `depth`: how many files have included that one, each the next; 0 for the
    /// scene's own. \throws scene_error for a file that cannot be read, and for too many.
    included_file read(const std::string& name, const source_place& from, std::size_t depth)
    {
        if (depth == 16 || ++count_ > 10'000)
            fail_at(from, "files include each other more than 16 deep, or 10,000 times; does one include itself?");
        try {
            return {files_.path_of(name), files_.bytes_of(name)};
        } catch (const file_error& e) {
            fail_at(from, e.what());
        }
    }

private:
    const scene_files& files_;
    std::size_t count_ = 0;
};

} // namespace photongrid
