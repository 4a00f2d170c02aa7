// The pictures of a scene as files.
#pragma once

#include <photongrid/io/export/side_files.hpp>
#include <photongrid/io/import/scene_files.hpp>
#include <photongrid/scene/distant_lights.hpp>
#include <photongrid/scene/texture.hpp>

#include <map>
#include <memory>
#include <string>
#include <utility>

namespace photongrid {

/// Finds or writes files that read as the pictures of a scene.
class picture_files {
public:
    /// `source`: the file that the scene was read from.
    picture_files(side_files& to, const std::string& source);

    /// The name of a file that reads as the texture, texel by texel. One that it was read from and that lies beside the
    /// scene's file keeps its name; one that lies elsewhere is copied. Else it is written as an EXR file, or as PNG if
    /// it has an alpha; one with an alpha that 8 bits do not hold has in all its channels what `t` uses, and `t` its
    /// first one.
    /// \throws file_error.
    std::string texture(texture_use& t, texture_holds holds);

    /// The name of a file that reads as the map of an environment. Likewise.
    /// \throws file_error.
    std::string environment(const environment_light& l);

    /// The name of an EXR file with these texels, numbers from 0 to 1 or colours.
    std::string add_exr(
        const std::string& kind, std::uint32_t width, std::uint32_t height, const std::vector<glm::vec3>& texels);

    /// The bytes of the file that a texture was read from; none if it does not read as the texture any more.
    std::string bytes_of_source(const texture_use& t, texture_holds holds);

private:
    template <class IsSame>
    static bool holds(scene_files& in, const std::string& file, const IsSame& is_same);
    template <class IsSame>
    std::string existing(const std::string& file, const IsSame& is_same);
    std::string made(texture_use& t, texture_holds holds);

    side_files& to_;
    scene_files beside_, source_; ///< files of the scene that is written, and of the one that was read
    std::map<std::pair<std::shared_ptr<const photongrid::texture>, texture_holds>, std::string> textures_;
};

/// The texels as 8 bits, if they are: of colours encoded as sRGB, else of numbers with their alpha. Empty otherwise.
std::vector<unsigned char> exact_bytes(const texture& map, texture_holds holds);

/// The nearest 8-bit texels: red, green, blue, alpha; colours encoded as sRGB.
std::vector<unsigned char> nearest_bytes(const texture& map, texture_holds holds);

/// A texel as numbers from 0 to 1.
inline glm::vec4 numbers_of(const glm::u16vec4& texel) { return glm::vec4(texel) / 65535.0f; }

} // namespace photongrid
