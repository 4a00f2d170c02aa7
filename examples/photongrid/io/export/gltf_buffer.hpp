// The numbers of glTF meshes in one run of bytes.
#pragma once

#include <photongrid/scene/mesh.hpp>

#include <nlohmann/json.hpp>

#include <string>

namespace photongrid::gltf_export {

/// A buffer with its views and accessors.
class buffer_writer {
public:
    /// Adds a mesh and returns its attributes and indices as a glTF primitive. Normals become unit vectors; v of
    /// texture coordinates counts from the top.
    nlohmann::ordered_json add(const mesh& m);

    /// Adds bytes, and returns the index of their view.
    std::size_t add_bytes(const std::string& bytes);

    const std::string& bytes() const { return bytes_; }
    const nlohmann::ordered_json& views() const { return views_; }
    const nlohmann::ordered_json& accessors() const { return accessors_; }

private:
    template <class Element>
    std::size_t add_accessor(const std::vector<Element>& all, const char* type, unsigned component, unsigned target);

    std::string bytes_;
    nlohmann::ordered_json views_ = nlohmann::ordered_json::array(), accessors_ = nlohmann::ordered_json::array();
};

} // namespace photongrid::gltf_export
