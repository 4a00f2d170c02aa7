#include <photongrid/io/export/gltf_materials.hpp>
#include <photongrid/io/image_formats.hpp>
#include <photongrid/io/import/coat.hpp>
#include <photongrid/io/import/photometry.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <cmath>

namespace photongrid::gltf_export {

namespace {
    using json = nlohmann::ordered_json;
    constexpr int repeat = 10497, clamp_to_edge = 33071, interpolated = 9729; // of the specification

    json rgb(const dvec3& v) { return {v.x, v.y, v.z}; }

    /// The mean of what a texture's channel has, 0 to 1.
    double mean_of(const texture_use& t)
    {
        double sum = 0;
        for (const auto& texel : t.map->texels)
            sum += texel[static_cast<int>(t.channel)] / 65535.0;
        return sum / static_cast<double>(t.map->texels.size());
    }

    bool lie_alike(const texture_use& a, const texture_use& b)
    {
        return a.map->width == b.map->width && a.map->height == b.map->height && a.wrap == b.wrap && a.scale == b.scale
            && a.offset == b.offset;
    }

    std::string png(const texture& of, const std::vector<unsigned char>& rgba)
    {
        return image_formats::png_bytes(of.width, of.height, rgba);
    }
} // namespace

std::string uri_of(const std::string& name)
{
    std::string uri;
    for (const char c : name)
        if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9')
            || std::string_view("-._~/").find(c) != std::string_view::npos) {
            uri += c;
        } else {
            const auto byte = static_cast<unsigned char>(c);
            uri += {'%', "0123456789ABCDEF"[byte >> 4], "0123456789ABCDEF"[byte & 15]};
        }
    return uri;
}

void material_writer::note(const material& m, const std::string& what)
{
    log_.add(place_, "material " + shown_word(m.name) + ": " + what);
}

void material_writer::extend(json& to, const char* name, json content)
{
    to["extensions"][name] = std::move(content);
    extensions_.insert(name);
}

std::size_t material_writer::image(const std::string& ending, const std::string& bytes)
{
    const auto known = images_by_bytes_.find(bytes);
    if (known != images_by_bytes_.end())
        return known->second;
    if (embedded_)
        images_.push_back(
            {{"bufferView", buffer_.add_bytes(bytes)}, {"mimeType", ending == ".png" ? "image/png" : "image/jpeg"}});
    else
        images_.push_back({{"uri", uri_of(files_.add("texture", ending, bytes))}});
    images_by_bytes_.emplace(bytes, images_.size() - 1);
    return images_.size() - 1;
}

/// What a material has of a texture. glTF's v counts from the top.
json material_writer::texture(const texture_use& t, const std::string& ending, const std::string& bytes)
{
    const int wrap = t.wrap == texture_wrap::clamp ? clamp_to_edge : repeat;
    const json sampler = {{"magFilter", interpolated}, {"minFilter", interpolated}, {"wrapS", wrap}, {"wrapT", wrap}};
    const auto at
        = static_cast<std::size_t>(std::find(samplers_.begin(), samplers_.end(), sampler) - samplers_.begin());
    if (at == samplers_.size())
        samplers_.push_back(sampler);
    textures_.push_back({{"sampler", at}, {"source", image(ending, bytes)}});
    json made = {{"index", textures_.size() - 1}};
    if (t.scale != glm::dvec2(1) || t.offset != glm::dvec2(0))
        extend(made, "KHR_texture_transform",
            {{"offset", {t.offset.x, 1 - t.scale.y - t.offset.y}}, {"scale", {t.scale.x, t.scale.y}}});
    return made;
}

/// The reflectance of `m`, or what its glass lets pass, with the opacity of `owner`: a mixture, or the same material.
void material_writer::add_base_color(json& to, const material& m, const material& owner)
{
    const auto& color = m.texture;
    const auto& alpha = owner.opacity_texture;
    double opacity = owner.opacity;
    const bool has_alpha = alpha.map && (!color.map || lie_alike(color, alpha));
    if (alpha.map && !has_alpha) {
        note(m, "its opacity has another texture than its reflectance: the mean of the opacity is used");
        opacity *= mean_of(alpha);
    }
    to["baseColorFactor"] = {m.reflectance.x, m.reflectance.y, m.reflectance.z, opacity};
    if (!color.map && !has_alpha)
        return;
    const auto& of = color.map ? color : alpha;
    const auto source = has_alpha ? "" : pictures_.bytes_of_source(color, texture_holds::colour);
    const auto ending = ending_of(color.file);
    if (!source.empty() && (ending == ".png" || ending == ".jpg" || ending == ".jpeg")) {
        to["baseColorTexture"] = texture(of, ending, source);
        return;
    }
    bool is_exact = true;
    std::vector<unsigned char> rgba(4 * of.map->texels.size(), 255);
    if (color.map) {
        rgba = nearest_bytes(*color.map, texture_holds::colour);
        is_exact = !exact_bytes(*color.map, texture_holds::colour).empty();
    }
    if (has_alpha) {
        const auto numbers = nearest_bytes(*alpha.map, texture_holds::numbers);
        for (std::size_t i = 0; i < of.map->texels.size(); ++i) {
            rgba[4 * i + 3] = numbers[4 * i + static_cast<std::size_t>(alpha.channel)];
            is_exact = is_exact && alpha.map->texels[i][static_cast<int>(alpha.channel)] == rgba[4 * i + 3] * 257;
        }
    }
    if (!is_exact)
        note(m, "its texture is rounded to 8 bits, since glTF has PNG and JPEG files");
    to["baseColorTexture"] = texture(of, ".png", png(*of.map, rgba));
}

void material_writer::add_roughness(json& to, const material& m)
{
    to["roughnessFactor"] = is_rough(m) ? m.roughness : 0;
    const auto& t = m.roughness_texture;
    if (!t.map)
        return;
    const auto numbers = nearest_bytes(*t.map, texture_holds::numbers);
    std::vector<unsigned char> rgba(numbers.size(), 255); // blue: it is as metallic as it was
    bool is_exact = true;
    for (std::size_t i = 0; i < t.map->texels.size(); ++i) {
        rgba[4 * i + 1] = numbers[4 * i + static_cast<std::size_t>(t.channel)];
        is_exact = is_exact && t.map->texels[i][static_cast<int>(t.channel)] == rgba[4 * i + 1] * 257;
    }
    if (!is_exact)
        note(m, "the texture of its roughness is rounded to 8 bits");
    to["metallicRoughnessTexture"] = texture(t, ".png", png(*t.map, rgba));
}

namespace {
    /// KHR_materials_volume: a body; without it, it would be a film.
    json volume_of(const material& m)
    {
        json volume = {{"thicknessFactor", 1}};
        const auto& a = m.absorption;
        if (const double most = std::max({a.x, a.y, a.z}); most > 0) {
            volume["attenuationDistance"] = 1 / most;
            volume["attenuationColor"] = {std::exp(-a.x / most), std::exp(-a.y / most), std::exp(-a.z / most)};
        }
        return volume;
    }
} // namespace

void material_writer::add(const material& owner)
{
    const auto* m = &owner;
    if (is_mixture(owner)) {
        m = &scene_.materials[owner.parts[owner.share > 0.5 ? 1 : 0]];
        note(owner, "glTF has no mixtures; drawn as " + shown_word(m->name) + " alone");
    }
    json surface = json::object(), made = json::object();
    if (!owner.name.empty())
        made["name"] = owner.name;
    const auto kind = detail::entry_of(m->kind).surface;
    auto plain = *m;
    if (kind == surface_kind::coated) // glTF has no light that goes back and forth below the coat
        set_reflectance_above_coat(plain);
    add_base_color(surface, plain, owner);
    surface["metallicFactor"] = kind == surface_kind::reflecting ? 1 : 0;
    if (kind == surface_kind::diffuse)
        surface["roughnessFactor"] = 1;
    else
        add_roughness(surface, *m);
    made["pbrMetallicRoughness"] = std::move(surface);
    if (is_clear(owner))
        made["alphaMode"] = "BLEND";
    if (kind == surface_kind::diffuse)
        extend(made, "KHR_materials_specular", {{"specularFactor", 0}}); // glTF's surfaces shine unless told otherwise
    const bool is_glass = kind == surface_kind::refracting || kind == surface_kind::thin;
    if (is_glass || (kind == surface_kind::coated && m->index_of_refraction != 1.5))
        extend(made, "KHR_materials_ior", {{"ior", m->index_of_refraction}});
    if (is_glass)
        extend(made, "KHR_materials_transmission", {{"transmissionFactor", 1}});
    if (kind == surface_kind::refracting)
        extend(made, "KHR_materials_volume", volume_of(*m));
    else
        made["doubleSided"] = true;
    materials_.push_back(std::move(made));
}

std::size_t material_writer::add_lamp(const std::string& name, const dvec3& radiance)
{
    const double most = std::max({radiance.x, radiance.y, radiance.z});
    json made = json::object();
    if (!name.empty())
        made["name"] = name;
    made["pbrMetallicRoughness"] = {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}};
    made["emissiveFactor"] = rgb(radiance / most);
    extend(made, "KHR_materials_emissive_strength", {{"emissiveStrength", most * luminous_efficacy}});
    extend(made, "KHR_materials_specular", {{"specularFactor", 0}});
    materials_.push_back(std::move(made));
    return materials_.size() - 1;
}

void material_writer::write(json& to) const
{
    to["materials"] = materials_;
    if (textures_.empty())
        return;
    to["textures"] = textures_;
    to["images"] = images_;
    to["samplers"] = samplers_;
}

} // namespace photongrid::gltf_export
