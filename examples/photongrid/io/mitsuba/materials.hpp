// Materials of Mitsuba (bsdfs) as photongrid's.
#pragma once

#include <photongrid/io/mitsuba/values.hpp>

#include <map>
#include <optional>
#include <set>
#include <string>

namespace photongrid::mitsuba {

/// Makes each material where a shape first uses it.
class material_reader {
public:
    material_reader(scene_builder& builder, value_reader& values) : builder_(builder), values_(values) {}

    /// Its index in the scene; none for `null`, whose surfaces are not drawn. `bsdf`: null for that of shapes without
    /// one.
    std::optional<std::uint32_t> index_of(const child* bsdf);
    /// The same, if it is glass, with what its inside absorbs of light by the unit of length; without a surface, if it
    /// absorbs any, glass of the index of refraction 1.
    std::optional<std::uint32_t> with_absorption(
        const source_place& place, std::optional<std::uint32_t> m, const dvec3& absorbed);
    /// Whether it is black, as the surfaces of lamps are here.
    static bool is_black(const child* bsdf);
    /// Whether light enters bodies of it, so that it matters which side is outside.
    bool refracts(std::uint32_t m) const { return glass_.contains(m); }
    /// Whether it has the colours of vertices.
    bool has_vertex_colors(std::uint32_t m) const { return colored_.contains(m); }

private:
    std::optional<std::uint32_t> made(const object& o);
    std::optional<std::uint32_t> inner(const object& o);
    std::optional<std::uint32_t> mask(const object& o);
    std::optional<std::uint32_t> blend(const object& o);
    std::optional<std::uint32_t> with_opacity(const object& o, std::optional<std::uint32_t> m, const varying& opacity);
    void make_plastic(const object& o, material& m);
    void make_principled(const object& o, material& m);
    void reflect(material& m, const varying& v);
    double roughness(const object& o, texture_use* texture);
    double relative_index(const object& o, const char* if_absent, double least = 1);
    void note_unless_one(const object& o, const char* name);

    scene_builder& builder_;
    value_reader& values_;
    std::map<const object*, std::optional<std::uint32_t>> made_; ///< null: that of shapes without one
    std::set<const object*> within_;                             ///< those that are being made
    std::set<std::uint32_t> glass_, colored_, cut_out_;          ///< cut_out_: those with a texture of their opacity
    bool is_colored_ = false;                                    ///< the one that is being made
    std::size_t count_ = 0;
};

} // namespace photongrid::mitsuba
