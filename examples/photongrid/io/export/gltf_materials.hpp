// Materials and textures as glTF has them.
#pragma once

#include <photongrid/io/export/gltf_buffer.hpp>
#include <photongrid/io/export/picture_files.hpp>
#include <photongrid/io/import/import_log.hpp>
#include <photongrid/scene/scene.hpp>

#include <nlohmann/json.hpp>

#include <map>
#include <set>
#include <string>

namespace photongrid::gltf_export {

/// Where the bytes of pictures go. `embedded`: into the buffer, not into files.
struct picture_bytes {
    side_files& files;
    picture_files& pictures;
    buffer_writer& buffer;
    bool embedded;
};

/// Collects the materials, textures and images of a file.
class material_writer {
public:
    material_writer(const scene& s, const picture_bytes& to, import_log& log, const source_place& place)
        : scene_(s), files_(to.files), pictures_(to.pictures), buffer_(to.buffer), log_(log), place_(place),
          embedded_(to.embedded)
    {
    }

    /// Adds a material of the scene.
    void add(const material& m);

    /// Adds a black material that emits, W/(m^2 sr), and returns its index.
    std::size_t add_lamp(const std::string& name, const dvec3& radiance);

    /// Adds materials, textures, images and samplers to the file.
    void write(nlohmann::ordered_json& to) const;
    const std::set<std::string>& extensions() const { return extensions_; }

private:
    using json = nlohmann::ordered_json;
    void note(const material& m, const std::string& what);
    void add_base_color(json& to, const material& m, const material& owner);
    void add_roughness(json& to, const material& m);
    json texture(const texture_use& t, const std::string& ending, const std::string& bytes);
    std::size_t image(const std::string& ending, const std::string& bytes);
    void extend(json& to, const char* name, json content);

    const scene& scene_;
    side_files& files_;
    picture_files& pictures_;
    buffer_writer& buffer_;
    import_log& log_;
    source_place place_;
    bool embedded_;
    json materials_ = json::array(), textures_ = json::array(), images_ = json::array(), samplers_ = json::array();
    std::map<std::string, std::size_t> images_by_bytes_;
    std::set<std::string> extensions_;
};

/// A file's name as a URI: all but plain characters as %xx.
std::string uri_of(const std::string& name);

} // namespace photongrid::gltf_export
