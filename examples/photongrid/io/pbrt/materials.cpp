#include <photongrid/io/pbrt/materials.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <cmath>

namespace photongrid::pbrt {

std::size_t material_reader::entity_of(const material_reference& m, const source_place& place) const
{
    if (!m.name)
        return m.index;
    const auto found = all_.named_materials.find(*m.name);
    if (found == all_.named_materials.end())
        fail_at(place, "the material " + shown_word(*m.name) + " of this shape is not defined");
    return found->second;
}

std::optional<std::uint32_t> material_reader::index_of(const material_reference& m, const source_place& place)
{
    const auto number = entity_of(m, place);
    if (const auto before = made_.find(number); before != made_.end())
        return before->second;
    const auto& e = all_.materials[number];
    if (within_.size() > 16 || !within_.insert(number).second)
        fail_at(e.place, "the material is a mixture of itself, or of more than 16 within each other");
    const auto index = made(e, m.name.value_or("material " + std::to_string(number)));
    within_.erase(number);
    e.parameters.find("type"); // of MakeNamedMaterial
    e.parameters.note_unused(builder_.log(), "material " + shown_word(m.name.value_or(e.type)));
    made_.emplace(number, index);
    return index;
}

material_reader::medium material_reader::medium_of(const std::string& name, const source_place& place)
{
    if (const auto before = media_.find(name); before != media_.end())
        return before->second;
    const auto found = all_.media.find(name);
    if (found == all_.media.end())
        fail_at(place, "the medium " + shown_word(name) + " of this shape is not defined");
    const auto& e = found->second;
    const auto& p = e.parameters;
    const auto said = [&](const char* what) { builder_.note(e.place, "medium " + shown_word(name) + what); };
    medium m;
    if (e.type != "homogeneous" || (p.find("sigma_a") == nullptr && p.find("sigma_s") == nullptr)) {
        said(": is left out; light crosses it unchanged");
    } else {
        const double scale = p.number("scale", 1);
        m.absorbed = glm::max(values_.coefficient(e, "sigma_a") * scale, dvec3(0));
        m.scatters = p.find("sigma_s") == nullptr || values_.coefficient(e, "sigma_s") * scale != dvec3(0);
        if (m.scatters)
            said(": absorbs light, but does not scatter it");
        p.find("g");
        if (p.find("Le") != nullptr)
            said(": its light is left out");
        p.note_unused(builder_.log(), "medium " + shown_word(name));
    }
    return media_.emplace(name, m).first->second;
}

std::optional<std::uint32_t> material_reader::index_of(const shape_entity& s)
{
    if (!s.outside.empty() && s.outside != s.inside && !noted_outside_) {
        builder_.note(s.place, "the media outside of shapes are left out");
        noted_outside_ = true;
    }
    const auto inside = s.inside.empty() || s.inside == s.outside ? medium{} : medium_of(s.inside, s.place);
    const auto& e = all_.materials[entity_of(s.material, s.place)];
    const bool is_interface = e.type.empty() || e.type == "none" || e.type == "interface";
    if (is_interface && inside.absorbed != dvec3(0) && !inside.scatters)
        return builder_.add_medium(e.place, s.inside, inside.absorbed);
    const auto index = index_of(s.material, s.place);
    return index && inside.absorbed != dvec3(0) ? builder_.with_absorption(s.place, *index, inside.absorbed) : index;
}

bool material_reader::is_black(const material_reference& m, const source_place& place)
{
    const auto& e = all_.materials[entity_of(m, place)];
    const auto* p = e.parameters.find("reflectance");
    return e.type == "diffuse" && p != nullptr && p->type == "rgb"
        && std::all_of(p->numbers.begin(), p->numbers.end(), [](double d) { return d == 0; });
}

/// photongrid's roughness: the square root of GGX's alpha.
double material_reader::roughness(const entity& e, const std::string& prefix, texture_use* texture)
{
    const auto& p = e.parameters;
    const bool remap = p.truth("remaproughness", true);
    const auto both = values_.number(e, prefix + "roughness", 0);
    const bool is_uneven = p.find(prefix + "uroughness") != nullptr || p.find(prefix + "vroughness") != nullptr;
    const auto u = is_uneven ? values_.number(e, prefix + "uroughness", both.factor.x) : both,
               v = is_uneven ? values_.number(e, prefix + "vroughness", both.factor.x) : both;
    const auto alpha = [&](double r) { return remap ? std::sqrt(std::max(r, 0.0)) : std::max(r, 0.0); };
    const auto rough = [&](double r) { return std::sqrt(std::min(alpha(r), 1.0)); };
    if (u.texture.map || v.texture.map) {
        if (texture != nullptr && u.texture.map == v.texture.map && u.factor == v.factor) {
            // Its texels become what the material's roughness is multiplied with.
            auto map = *u.texture.map;
            for (auto& t : map.texels) {
                const double r = rough(u.factor.x * t.x / 65535.0) * 65535 + 0.5;
                t = glm::u16vec4(r, r, r, 65535);
            }
            *texture = u.texture;
            texture->map = std::make_shared<const photongrid::texture>(std::move(map));
            texture->file.clear();
            return 1;
        }
        builder_.note(e.place, "a texture of the roughness: its mean is used");
    }
    const double ru = value_reader::mean(u).x, rv = value_reader::mean(v).x;
    if (ru != rv)
        builder_.note(e.place, "a roughness that differs along u and v: the geometric mean of both is used");
    const double mean = std::sqrt(rough(ru) * rough(rv));
    return mean * mean < 1e-3 ? 0 : mean; // pbrt takes such a surface for smooth
}

std::optional<std::uint32_t> material_reader::mixture(const entity& e, const std::string& name)
{
    const auto* p = e.parameters.find("materials");
    if (p == nullptr || p->texts.size() != 2)
        fail_at(e.place, "a mixture has the parameter \"string materials\" with two names");
    material m{.name = name};
    const auto amount = values_.number(e, "amount", 0.5);
    m.share = std::clamp(amount.factor.x, 0.0, 1.0);
    m.share_texture = amount.texture;
    const auto first = index_of({.name = p->texts[0]}, p->place), second = index_of({.name = p->texts[1]}, p->place);
    if (!first || !second) {
        builder_.note(e.place, "a mixture with an interface: only its other material is drawn");
        return first ? first : second;
    }
    return builder_.add_mixture(e.place, m, *first, *second);
}

std::optional<std::uint32_t> material_reader::made(const entity& e, const std::string& name)
{
    const auto& p = e.parameters;
    const auto said
        = [&](const std::string& what) { builder_.note(e.place, "material " + shown_word(name) + ": " + what); };
    if (e.type.empty() || e.type == "none" || e.type == "interface") {
        builder_.note(e.place, "material \"interface\": its surfaces are left out");
        return std::nullopt;
    }
    if (p.find("normalmap") != nullptr || p.find("displacement") != nullptr)
        said("its displacement or map of normals is left out");
    if (e.type == "mix")
        return mixture(e, name);
    material m{.name = name};
    const auto reflect = [&](const varying& v) {
        m.reflectance = v.factor;
        m.texture = v.texture;
    };
    if (e.type == "diffuse") {
        reflect(values_.reflectance(e, "reflectance", dvec3(0.5)));
    } else if (e.type == "coateddiffuse") {
        m.kind = material_kind::plastic;
        reflect(values_.reflectance(e, "reflectance", dvec3(0.5)));
        m.index_of_refraction = values_.index_of_refraction(e, "eta", 1.5);
        m.roughness = roughness(e, "", nullptr);
        p.find("thickness"); // without matter in the coat it changes nothing
        p.find("maxdepth");
        p.find("nsamples");
    } else if (e.type == "conductor") {
        m.kind = material_kind::metal;
        reflect(values_.conductor(e, ""));
        m.roughness = roughness(e, "", &m.roughness_texture);
    } else if (e.type == "coatedconductor") {
        said("drawn without its coat");
        m.kind = material_kind::metal;
        reflect(values_.conductor(e, "conductor."));
        m.roughness = roughness(e, "conductor.", &m.roughness_texture);
        for (const auto* coat : {"interface.roughness", "interface.uroughness", "interface.vroughness", "interface.eta",
                 "thickness", "maxdepth", "nsamples", "g", "albedo"})
            p.find(coat);
    } else if (e.type == "dielectric") {
        m.kind = material_kind::glass;
        m.reflectance = dvec3(1);
        m.priority = 0; // eta is relative to whatever is outside
        m.index_of_refraction = values_.index_of_refraction(e, "eta", 1.5);
        m.roughness = roughness(e, "", &m.roughness_texture);
    } else if (e.type == "thindielectric") {
        m.kind = material_kind::thin_glass;
        m.reflectance = dvec3(1);
        m.index_of_refraction = values_.index_of_refraction(e, "eta", 1.5);
    } else if (e.type == "diffusetransmission") {
        said("drawn without the light that passes it");
        reflect(values_.reflectance(e, "reflectance", dvec3(0.25)));
        p.find("transmittance");
    } else if (e.type == "subsurface" && p.find("reflectance") != nullptr) {
        said("drawn as diffuse, without light below its surface");
        reflect(values_.reflectance(e, "reflectance", dvec3(0.5)));
    } else {
        builder_.note(e.place, "material " + shown_word(e.type) + ": drawn as diffuse 0.5");
    }
    if (m.index_of_refraction < (m.kind == material_kind::glass ? 0.1 : 1.0)) {
        said("its index of refraction is too small; 1 is used");
        m.index_of_refraction = 1;
    }
    if (has_rebounds(m))
        m.energy = facet_bounces::single; // as pbrt has it
    return builder_.add_material(e.place, std::move(m));
}

} // namespace photongrid::pbrt
