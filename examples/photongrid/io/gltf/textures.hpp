// Textures of glTF.
#pragma once

#include <photongrid/io/gltf/meshes.hpp>

#include <optional>
#include <string>
#include <string_view>

namespace photongrid::gltf {

/// Makes the textures of one material. photongrid's surfaces have one set of texture coordinates, which is that of the
/// first texture.
class texture_reader {
public:
    /// `owner`: the name of the material for notes.
    texture_reader(document& all, std::string owner) : all_(all), owner_(std::move(owner)) {}

    /// The texture that a property of `of` names; none if it is absent, or if its picture cannot be read, with a note.
    std::optional<texture_use> texture(const part& of, std::string_view key, texture_holds holds);

    const coordinate_use& coordinates() const { return coordinates_; }

private:
    std::optional<texture_use> picture(const part& info, std::size_t index, texture_holds holds);
    void use_coordinates(const part& info, texture_use& t);

    document& all_;
    std::string owner_;
    coordinate_use coordinates_{};
};

/// The least and the largest value of a channel, 0 to 1.
struct channel_range {
    double low = 1, high = 0;
};
channel_range channel_range_of(const texture& t, texture_channel channel);

/// The mean of a texture's channels, 0 to 1.
glm::dvec4 mean_of(const texture& t);

} // namespace photongrid::gltf
