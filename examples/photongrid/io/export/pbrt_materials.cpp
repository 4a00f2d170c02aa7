#include <photongrid/io/export/pbrt_materials.hpp>
#include <photongrid/io/whole_file.hpp>

#include <set>

namespace photongrid::pbrt_export {

namespace {
    /// A name of its own for each material.
    std::vector<std::string> own_names(const std::vector<material>& materials)
    {
        std::set<std::string> taken{""}, used{""};
        for (const auto& m : materials)
            taken.insert(m.name);
        std::vector<std::string> names;
        for (const auto& m : materials) {
            auto name = m.name;
            for (std::size_t n = names.size() + 1; used.contains(name); ++n)
                if (const auto numbered = "material " + std::to_string(n); !taken.contains(numbered))
                    name = numbered;
            used.insert(name);
            taken.insert(name);
            names.push_back(name);
        }
        return names;
    }

    bool is_grey(const dvec3& v) { return v.x == v.y && v.y == v.z; }
} // namespace

material_writer::material_writer(const scene& s, picture_files& pictures, import_log& log, const source_place& place)
    : scene_(s), pictures_(pictures), log_(log), place_(place), names_(own_names(s.materials)),
      alphas_(s.materials.size())
{
}

void material_writer::note(const material& m, const std::string& what)
{
    log_.add(place_, "material " + shown_word(m.name) + ": " + what);
}

std::string material_writer::texture(
    text_writer& to, const char* type, const texture_use& t, const std::string& file, double scale)
{
    auto name = "texture " + std::to_string(++textures_);
    to.word("Texture ").quoted(name).word(" ").quoted(type).word(" \"imagemap\"").parameter("string filename", file);
    if (scale != 1)
        to.parameter("float scale", scale);
    const auto coordinate = [&](const char* declaration, double v, double absent) {
        if (v != absent)
            to.parameter(declaration, v);
    };
    coordinate("float uscale", t.scale.x, 1);
    coordinate("float vscale", t.scale.y, 1);
    coordinate("float udelta", t.offset.x, 0);
    coordinate("float vdelta", t.offset.y, 0);
    if (t.wrap == texture_wrap::clamp)
        to.parameter("string wrap", "clamp");
    to.line();
    return name;
}

/// The texture of a reflectance, or "". A factor other than grey is in its picture: pbrt has only numbers as factors.
std::string material_writer::color_texture(text_writer& to, const material& m)
{
    if (!m.texture.map)
        return "";
    auto use = m.texture;
    if (is_grey(m.reflectance))
        return texture(to, "spectrum", use, pictures_.texture(use, texture_holds::colour), m.reflectance.x);
    std::vector<glm::vec3> texels;
    texels.reserve(use.map->texels.size());
    for (const auto& t : use.map->texels)
        texels.emplace_back(m.reflectance * dvec3(t) / 65535.0);
    return texture(to, "spectrum", use, pictures_.add_exr("texture", use.map->width, use.map->height, texels), 1);
}

/// The texture of a number, or "". pbrt takes the mean of all channels, so that they all have the one that is used.
std::string material_writer::number_texture(
    text_writer& to, const texture_use& t, const std::function<double(double)>& change)
{
    if (!t.map)
        return "";
    std::vector<glm::vec3> texels;
    texels.reserve(t.map->texels.size());
    for (const auto& texel : t.map->texels)
        texels.emplace_back(change(texel[static_cast<int>(t.channel)] / 65535.0));
    return texture(to, "float", t, pictures_.add_exr("texture", t.map->width, t.map->height, texels), 1);
}

void material_writer::write_reflectance(text_writer& to, const material& m, const std::string& color)
{
    if (color.empty())
        to.parameter("rgb reflectance", m.reflectance);
    else
        to.parameter("texture reflectance", color);
}

void material_writer::write_roughness(text_writer& to, const material& m, const std::string& texture)
{
    to.word(" \"bool remaproughness\" false");
    if (texture.empty())
        to.parameter("float roughness", alpha_of(m));
    else
        to.parameter("texture roughness", texture);
    if (is_rough(m) && alpha_of(m) < 1e-3)
        note(m, "pbrt takes a roughness below 0.032 for 0");
}

void material_writer::write_mixture(text_writer& to, const material& m, std::size_t index)
{
    const auto share = number_texture(to, m.share_texture, [&](double v) { return m.share * v; });
    to.word("MakeNamedMaterial ").quoted(names_[index]).parameter("string type", "mix");
    to.word(" \"string materials\" [ ").quoted(names_[m.parts[0]]).word(" ").quoted(names_[m.parts[1]]).word(" ]");
    if (share.empty())
        to.parameter("float amount", m.share);
    else
        to.parameter("texture amount", share);
    to.line();
}

void material_writer::write(text_writer& to)
{
    const auto& all = scene_.materials;
    for (const bool mixtures : {false, true}) // pbrt wants the parts first
        for (std::size_t i = 0; i < all.size(); ++i) {
            const auto& m = all[i];
            if (is_mixture(m) != mixtures)
                continue;
            alphas_[i] = number_texture(to, m.opacity_texture, [&](double v) { return m.opacity * v; });
            if (mixtures) {
                write_mixture(to, m, i);
                continue;
            }
            const auto color = color_texture(to, m);
            const auto rough
                = number_texture(to, m.roughness_texture, [&](double v) { return m.roughness * v * m.roughness * v; });
            to.word("MakeNamedMaterial ").quoted(names_[i]).word(" \"string type\" ");
            switch (m.kind) {
            case material_kind::lambertian: write_reflectance(to.quoted("diffuse"), m, color); break;
            case material_kind::mirror: write_reflectance(to.quoted("conductor"), m, color); break;
            case material_kind::metal:
                write_reflectance(to.quoted("conductor"), m, color);
                write_roughness(to, m, rough);
                break;
            case material_kind::glass:
                to.quoted("dielectric").parameter("float eta", m.index_of_refraction);
                write_roughness(to, m, rough);
                if (m.reflectance != dvec3(1) || m.texture.map)
                    note(m, "pbrt's glass lets all light pass; its transmittance is left out");
                if (m.absorption != dvec3(0))
                    note(m, "its absorption is left out");
                break;
            case material_kind::plastic:
                write_reflectance(to.quoted("coateddiffuse"), m, color);
                to.parameter("float eta", m.index_of_refraction);
                write_roughness(to, m, rough);
                break;
            case material_kind::thin_glass:
                to.quoted("thindielectric").parameter("float eta", m.index_of_refraction);
                if (is_rough(m) || m.reflectance != dvec3(1) || m.texture.map)
                    note(m,
                        "pbrt's thin glass is smooth and lets all light pass; its roughness and its transmittance "
                        "are left out");
                break;
            case material_kind::mixture: break;
            default:
                write_reflectance(to.quoted("diffuse"), m, color);
                note(m,
                    std::string("is matte here; pbrt has no ") + material_kinds[static_cast<std::size_t>(m.kind)].name);
                break;
            }
            to.line();
        }
}

void material_writer::write_alpha(text_writer& to, std::uint32_t m) const
{
    if (!alphas_[m].empty())
        to.parameter("texture alpha", alphas_[m]);
    else if (scene_.materials[m].opacity < 1)
        to.parameter("float alpha", scene_.materials[m].opacity);
}

} // namespace photongrid::pbrt_export
