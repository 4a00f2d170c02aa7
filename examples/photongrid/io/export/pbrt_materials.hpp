// Materials and textures in pbrt-v4's language.
#pragma once

#include <photongrid/io/export/pbrt_text.hpp>
#include <photongrid/io/export/picture_files.hpp>
#include <photongrid/io/import/import_log.hpp>
#include <photongrid/scene/scene.hpp>

#include <functional>
#include <string>
#include <vector>

namespace photongrid::pbrt_export {

/// Writes the materials of a scene, and knows their names.
class material_writer {
public:
    material_writer(const scene& s, picture_files& pictures, import_log& log, const source_place& place);

    /// All materials, with their textures.
    void write(text_writer& to);

    const std::string& name(std::uint32_t m) const { return names_[m]; }

    /// The parameter of shapes of this material that lets light pass them.
    void write_alpha(text_writer& to, std::uint32_t m) const;

private:
    void write_mixture(text_writer& to, const material& m, std::size_t index);
    void write_reflectance(text_writer& to, const material& m, const std::string& color);
    void write_roughness(text_writer& to, const material& m, const std::string& texture);
    std::string color_texture(text_writer& to, const material& m);
    std::string number_texture(text_writer& to, const texture_use& t, const std::function<double(double)>& change);
    std::string texture(text_writer& to, const char* type, const texture_use& t, const std::string& file, double scale);
    void note(const material& m, const std::string& what);

    const scene& scene_;
    picture_files& pictures_;
    import_log& log_;
    source_place place_;
    std::vector<std::string> names_;
    std::vector<std::string> alphas_; ///< the texture of each material's opacity, or ""
    std::size_t textures_ = 0;
};

} // namespace photongrid::pbrt_export
