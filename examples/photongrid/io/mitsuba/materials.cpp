#include <photongrid/io/import/coat.hpp>
#include <photongrid/io/mitsuba/materials.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace photongrid::mitsuba {

namespace {
    /// photongrid's roughness of GGX's alpha.
    double rough(double alpha) { return std::sqrt(std::clamp(alpha, 0.0, 1.0)); }

    /// Whether it changes nothing as a factor.
    bool is_one(const varying& v) { return !v.texture.map && v.factor == dvec3(1); }
} // namespace

std::optional<std::uint32_t> material_reader::index_of(const child* bsdf)
{
    const auto* o = bsdf != nullptr ? bsdf->target : nullptr;
    if (const auto before = made_.find(o); before != made_.end()) {
        is_colored_ = is_colored_ || (before->second && colored_.contains(*before->second));
        return before->second;
    }
    if (o == nullptr) {
        const auto index = builder_.add_material(source_place(""), {.name = "default"});
        made_.emplace(o, index);
        return index;
    }
    if (o->tag != "bsdf")
        fail_at(bsdf->place, "found the " + o->said() + "; expected a bsdf");
    if (within_.size() > 16 || !within_.insert(o).second)
        fail_at(o->place, o->said() + " is made of itself, or of more than 16 within each other");
    const bool outer_is_colored = std::exchange(is_colored_, false);
    const auto index = made(*o);
    if (index && is_colored_)
        colored_.insert(*index);
    is_colored_ = is_colored_ || outer_is_colored;
    within_.erase(o);
    o->note_unused(builder_.log());
    made_.emplace(o, index);
    return index;
}

std::optional<std::uint32_t> material_reader::with_absorption(
    const source_place& place, std::optional<std::uint32_t> m, const dvec3& absorbed)
{
    if (absorbed == dvec3(0))
        return m;
    if (!m) {
        m = builder_.add_medium(place, "medium", absorbed);
        glass_.insert(*m);
        return m;
    }
    const auto made = builder_.with_absorption(place, *m, absorbed);
    if (refracts(*m))
        glass_.insert(made);
    return made;
}

bool material_reader::is_black(const child* bsdf)
{
    const auto* o = bsdf != nullptr ? bsdf->target : nullptr;
    for (int depth = 0; o != nullptr && o->type == "twosided" && depth < 16; ++depth) {
        const auto inside = o->all_of("bsdf");
        o = inside.empty() ? nullptr : inside[0]->target;
    }
    if (o == nullptr || o->type == "null")
        return true; // so is Mitsuba's own
    const auto* p = o->type == "diffuse" ? o->find("reflectance") : nullptr;
    return p != nullptr && (p->is == property_kind::color || p->is == property_kind::number)
        && std::all_of(p->numbers.begin(), p->numbers.end(), [](double d) { return d == 0; });
}

void material_reader::reflect(material& m, const varying& v)
{
    m.reflectance = glm::clamp(v.factor, dvec3(0), dvec3(1));
    m.texture = v.texture;
    is_colored_ = is_colored_ || v.has_vertex_colors;
}

double material_reader::roughness(const object& o, texture_use* texture)
{
    const auto distribution = o.text("distribution", "beckmann");
    if (distribution != "ggx")
        builder_.note(o.place, o.said() + ": facets by " + shown_word(distribution) + ": drawn as \"ggx\"");
    o.find("sample_visible"); // how Mitsuba draws
    const auto both = values_.number(o, "alpha", 0.1), u = values_.number(o, "alpha_u", both.factor.x),
               v = values_.number(o, "alpha_v", both.factor.x);
    if (both.texture.map && texture != nullptr) {
        auto baked = changed(both, [](const dvec3& alpha) { return dvec3(rough(alpha.x)); });
        *texture = baked.texture;
        return 1;
    }
    if (both.texture.map || u.texture.map || v.texture.map)
        builder_.note(o.place, o.said() + ": a texture of its roughness: the mean is used");
    const double alpha_u = both.texture.map ? mean_of(both).x : mean_of(u).x,
                 alpha_v = both.texture.map ? alpha_u : mean_of(v).x;
    if (alpha_u != alpha_v)
        builder_.note(o.place, o.said() + ": a roughness that differs along u and v: the geometric mean is used");
    return std::sqrt(rough(alpha_u) * rough(alpha_v));
}

double material_reader::relative_index(const object& o, const char* if_absent, double least)
{
    const double inside = values_.index_of_refraction(o, "int_ior", if_absent),
                 outside = values_.index_of_refraction(o, "ext_ior", "air");
    if (!(inside > 0) || !(outside > 0))
        fail_at(o.place, o.said() + ": an index of refraction must be above 0");
    if (std::abs(outside - 1) > 0.001)
        builder_.note(o.place, o.said() + ": the outside has no air: the index is that of both sides' ratio");
    if (inside < least * outside)
        builder_.note(
            o.place, o.said() + ": its index of refraction is too small; " + detail::text_of(least) + " is used");
    return std::clamp(inside / outside, least, 10.0);
}

void material_reader::note_unless_one(const object& o, const char* name)
{
    if (!is_one(values_.reflectance(o, name, dvec3(1))))
        builder_.note(o.place, o.said() + ": " + shown_word(name) + " is left out");
}

/// The first bsdf within a bsdf.
std::optional<std::uint32_t> material_reader::inner(const object& o)
{
    const auto inside = o.all_of("bsdf");
    if (inside.empty())
        fail_at(o.place, o.said() + " has no bsdf inside");
    if (inside.size() > 1)
        builder_.note(o.place, o.said() + " with several bsdfs: the first one is drawn on both sides");
    return index_of(inside[0]);
}

std::optional<std::uint32_t> material_reader::with_opacity(
    const object& o, std::optional<std::uint32_t> m, const varying& opacity)
{
    if (!m)
        return std::nullopt;
    if (opacity.texture.map && cut_out_.contains(*m))
        builder_.note(o.place, o.said() + ": its texture of the opacity is drawn without that of the bsdf inside");
    const auto made = builder_.with_opacity(o.place, *m, std::clamp(opacity.factor.x, 0.0, 1.0), opacity.texture);
    if (glass_.contains(*m))
        glass_.insert(made);
    if (colored_.contains(*m))
        colored_.insert(made);
    if (opacity.texture.map || cut_out_.contains(*m))
        cut_out_.insert(made);
    return made;
}

std::optional<std::uint32_t> material_reader::mask(const object& o)
{
    return with_opacity(o, inner(o), values_.number(o, "opacity", 0.5));
}

std::optional<std::uint32_t> material_reader::blend(const object& o)
{
    const auto inside = o.all_of("bsdf");
    if (inside.size() != 2)
        fail_at(o.place, o.said() + " has " + std::to_string(inside.size()) + " bsdfs inside; expected two");
    const auto weight = values_.number(o, "weight", 0.5);
    const auto first = index_of(inside[0]), second = index_of(inside[1]);
    if (!first) // the rest passes
        return with_opacity(o, second, weight);
    if (!second)
        return with_opacity(o, first, changed(weight, [](const dvec3& w) { return 1.0 - w; }));
    material m{.name = o.id.empty() ? "bsdf " + std::to_string(++count_) : o.id};
    m.share = std::clamp(weight.factor.x, 0.0, 1.0);
    m.share_texture = weight.texture;
    const auto made = builder_.add_mixture(o.place, m, *first, *second);
    if (glass_.contains(*first) || glass_.contains(*second))
        glass_.insert(made);
    return made;
}

/// Mitsuba's plastic keeps the colour of its base unless it is "nonlinear": light that the coat throws back is not
/// coloured again. A base of another reflectance does the same here, where it is.
void material_reader::make_plastic(const object& o, material& m)
{
    m.kind = material_kind::plastic;
    m.index_of_refraction = relative_index(o, "polypropylene");
    m.roughness = o.type == "roughplastic" ? roughness(o, nullptr) : 0;
    note_unless_one(o, "specular_reflectance");
    reflect(m, values_.reflectance(o, "diffuse_reflectance", dvec3(0.5)));
    if (!o.truth("nonlinear", false))
        set_reflectance_below_coat(m);
}

void material_reader::make_principled(const object& o, material& m)
{
    builder_.note(o.place, o.said() + ": approximated by metal, glass or plastic, whichever is most of it");
    const double metallic = mean_of(values_.number(o, "metallic", 0)).x,
                 passing = mean_of(values_.number(o, "spec_trans", 0)).x * (1 - metallic);
    const auto base = values_.reflectance(o, "base_color", dvec3(0.5));
    const auto rough_as_here = values_.number(o, "roughness", 0.5); // the square root of alpha, too
    // F0 = 0.08 specular, of Fresnel's reflectance head-on.
    const double head_on = std::sqrt(0.08 * std::clamp(o.number("specular", 0.5), 0.0, 1.0));
    const double index = std::clamp(o.number("eta", 2 / (1 - head_on) - 1), 1.0, 10.0);
    m.kind = metallic > 0.5 ? material_kind::metal : passing > 0.5 ? material_kind::glass : material_kind::plastic;
    if (m.kind != material_kind::metal)
        m.index_of_refraction = index;
    m.roughness = std::clamp(mean_of(rough_as_here).x, 0.0, 1.0);
    if (rough_as_here.texture.map && m.kind != material_kind::plastic) {
        m.roughness = std::clamp(rough_as_here.factor.x, 0.0, 1.0);
        m.roughness_texture = rough_as_here.texture;
    }
    reflect(m, base);
}

std::optional<std::uint32_t> material_reader::made(const object& o)
{
    if (o.type == "null") {
        builder_.note(o.place, o.said() + ": its surfaces are left out");
        return std::nullopt;
    }
    if (o.type == "twosided")
        return inner(o);
    if (o.type == "mask")
        return mask(o);
    if (o.type == "blendbsdf")
        return blend(o);
    for (const auto* outer : {"bumpmap", "normalmap", "coating", "roughcoating"})
        if (o.type == outer) {
            builder_.note(o.place, o.said() + ": the bsdf inside is drawn without it");
            return inner(o);
        }
    material m{.name = o.id.empty() ? "bsdf " + std::to_string(++count_) : o.id};
    if (o.type == "diffuse") {
        const bool old_name = o.find("diffuse_reflectance") || o.find_child("diffuse_reflectance");
        reflect(m, values_.reflectance(o, old_name ? "diffuse_reflectance" : "reflectance", dvec3(0.5)));
    } else if (o.type == "dielectric" || o.type == "roughdielectric") {
        m.kind = material_kind::glass;
        m.priority = 0; // its index is relative to what it says is outside
        m.index_of_refraction = relative_index(o, "bk7", 0.1);
        reflect(m, values_.reflectance(o, "specular_transmittance", dvec3(1)));
        note_unless_one(o, "specular_reflectance");
        if (o.type == "roughdielectric")
            m.roughness = roughness(o, &m.roughness_texture);
    } else if (o.type == "thindielectric") {
        m.kind = material_kind::thin_glass;
        m.index_of_refraction = relative_index(o, "bk7");
        reflect(m, values_.reflectance(o, "specular_transmittance", dvec3(1)));
        note_unless_one(o, "specular_reflectance");
    } else if (o.type == "conductor" || o.type == "roughconductor") {
        m.kind = material_kind::metal;
        reflect(m, values_.conductor(o));
        if (o.type == "roughconductor")
            m.roughness = roughness(o, &m.roughness_texture);
    } else if (o.type == "plastic" || o.type == "roughplastic") {
        make_plastic(o, m);
    } else if (o.type == "principled") {
        make_principled(o, m);
    } else {
        builder_.note(o.place, o.said() + ": drawn as diffuse 0.5");
    }
    const bool is_glass = m.kind == material_kind::glass;
    const auto index = builder_.add_material(o.place, std::move(m));
    if (is_glass)
        glass_.insert(index);
    return index;
}

} // namespace photongrid::mitsuba
