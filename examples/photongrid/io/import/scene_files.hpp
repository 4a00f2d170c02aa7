// The files that a scene's file names: meshes, textures and environments, each read once.
#pragma once

#include <photongrid/io/image_file.hpp>
#include <photongrid/io/scene_error.hpp>
#include <photongrid/scene/environment_map.hpp>
#include <photongrid/scene/mesh.hpp>
#include <photongrid/scene/texture.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace photongrid {

/// What the pixels of a texture are: colours, which are decoded from sRGB where their file is encoded, or numbers as
/// the file has them.
enum class texture_holds { colour, numbers };

/// The ending of a file's name in small letters, as ".ply", without that of compressed files (.gz).
std::string ending_of(const std::string& name);

/// Reads files by their names in a scene's file.
class scene_files {
public:
    /// `folder`: that of the scene's file. `allow_outside`: files may lie outside of it.
    scene_files(std::filesystem::path folder, bool allow_outside, file_reading how = {})
        : folder_(std::move(folder)), allow_outside_(allow_outside), how_(std::move(how)), pixels_(how_.max_pixels)
    {
    }

    /// Whether a file lies in the folder or below it, with symbolic links followed and backslashes taken as path_of()
    /// takes them.
    bool lies_inside(const std::string& name) const;

    /// The path of a file. Where there is no such file, a name with backslashes is taken with slashes.
    /// \throws file_error for a file that lies outside of the folder and must not.
    std::string path_of(const std::string& name) const;

    /// The bytes of a file, unpacked if it is compressed (gzip).
    /// \throws file_error for a file that cannot be read, that is no regular file, or that has more than 2^32 bytes.
    std::string bytes_of(const std::string& name) const;

    /// The surface in a PLY or OBJ file (.obj), which may be compressed.
    /// \throws file_error; scene_error for a file that does not hold one.
    std::shared_ptr<const mesh> surface(const std::string& name);

    /// A texture: values are from 0 to 1, others are the nearest of these, and NaN is 0.
    /// \throws file_error.
    std::shared_ptr<const photongrid::texture> texture(const std::string& name, texture_holds holds);

    /// The same of a picture file's bytes, made once for each `name`.
    /// \throws file_error.
    std::shared_ptr<const photongrid::texture> texture_of(
        const std::string& name, std::string_view bytes, texture_holds holds);

    /// An environment, as its file has it. Values below 0 and NaN are 0, infinite ones the largest of the others.
    /// \throws file_error.
    std::shared_ptr<const environment_map> environment(const std::string& name);

private:
    std::filesystem::path found_path(const std::string& name) const;
    std::string path_of_regular(const std::string& name) const;
    std::shared_ptr<const photongrid::texture> decoded_texture(
        const std::string& path, std::string_view bytes, texture_holds holds);
    void note(const std::string& path, const std::string& what) const;

    std::filesystem::path folder_;
    bool allow_outside_;
    file_reading how_;
    pixel_budget pixels_; ///< for pictures that are still to come
    std::map<std::string, std::shared_ptr<const mesh>> surfaces_;
    std::map<std::pair<std::string, texture_holds>, std::shared_ptr<const photongrid::texture>> textures_;
    std::map<std::string, std::shared_ptr<const environment_map>> environments_;
};

/// What `parse(bytes)` makes of a scene's file.
/// \throws as `parse` does; scene_error for a file that cannot be read.
template <class Parse>
auto parsed_file(const std::string& path, Parse parse)
{
    const std::filesystem::path p(path);
    try {
        return parse(scene_files(p.parent_path(), true).bytes_of(p.filename().string()));
    } catch (const file_error& e) {
        throw scene_error(path, 0, 0, e.what());
    }
}

} // namespace photongrid
