// The files that a scene's file names: they are written into a folder beside it.
#pragma once

#include <photongrid/scene/mesh.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace photongrid {

/// Writes a scene's file and those that it names. The folder has the name of the scene's file without its ending. A
/// file in it has a hash of its content in its name, so that none with other content is replaced: the scene that was
/// there before stays whole until its own file is replaced, last of all. What was made is removed if that does not
/// happen.
class side_files {
public:
    /// `scene`: the path of the scene's file.
    /// \throws file_error for one that cannot be written.
    explicit side_files(const std::string& scene);
    side_files(const side_files&) = delete;
    side_files& operator=(const side_files&) = delete;
    ~side_files();

    /// Writes a file and returns its name in the scene's folder. `kind`: what the name begins with; `ending`: ".ply".
    /// \throws file_error.
    std::string add(const std::string& kind, const std::string& ending, const std::string& bytes);

    /// The name of the PLY file with this surface, which is written once.
    /// \throws file_error.
    std::string add_surface(const std::shared_ptr<const mesh>& surface);

    /// Writes the scene's file. Returns the paths of all files, that of the scene last.
    /// \throws file_error.
    std::vector<std::string> finish(const std::string& bytes);

    const std::string& scene() const { return scene_; }
    /// That of the scene's file.
    std::filesystem::path folder() const { return std::filesystem::path(scene_).parent_path(); }

private:
    std::string scene_, name_; ///< of the folder, in that of the scene
    std::map<std::shared_ptr<const mesh>, std::string> surfaces_;
    std::set<std::string> paths_;             ///< of all files but the scene's
    std::vector<std::filesystem::path> made_; ///< what was not there before
};

} // namespace photongrid
