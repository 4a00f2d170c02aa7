#include <photongrid/io/import/coat.hpp>
#include <photongrid/io/obj/materials.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <cmath>

namespace photongrid::obj {

namespace {
    double largest(const dvec3& v) { return std::max({v.x, v.y, v.z}); }
    bool is_black(const dvec3& v) { return largest(v) <= 0; }

    /// Blinn's exponent as photongrid's roughness, the square root of GGX's alpha: both distributions of facets are as
    /// wide where alpha^2 = 2 / (Ns + 2) (Walter et al. 2007). From 1000 on, where programs end their range, smooth.
    double roughness_of_exponent(double ns) { return ns >= 1000 ? 0 : std::pow(2 / (std::max(ns, 0.0) + 2), 0.25); }

    /// The mean of a texture.
    dvec3 mean_of(const texture_use& t)
    {
        dvec3 sum(0);
        for (const auto& texel : t.map->texels)
            sum += dvec3(texel.x, texel.y, texel.z);
        return sum / (65535.0 * static_cast<double>(t.map->texels.size()));
    }

    class material_maker {
    public:
        material_maker(scene_builder& builder, const mtl_material& from, bool has_coordinates)
            : builder_(builder), from_(from), has_coordinates_(has_coordinates)
        {
        }

        std::uint32_t made()
        {
            for (const auto& n : from_.notes)
                builder_.note(n.place, n.what);
            read_diffuse();
            if (from_.map_ke)
                builder_.note(from_.map_ke->place, "the picture of what a surface emits is left out: Ke is 0");
            if (is_glass())
                return glass();
            if (from_.tf && *from_.tf != dvec3(1) && *from_.tf != dvec3(0))
                said("Tf is left out: it colours glass alone");
            read_opacity();
            const bool is_physical = from_.pr || from_.pm || from_.map_pr || from_.map_pm;
            return is_physical ? physical() : phong();
        }

        std::optional<texture_use> texture(const mtl_map& map, texture_holds holds, bool needs_coordinates = true)
        {
            if (needs_coordinates && !has_coordinates_) {
                builder_.note(map.place, "a picture is left out: the surface has no texture coordinates");
                return std::nullopt;
            }
            try {
                builder_.files().path_of(map.file);
            } catch (const file_error& e) {
                fail_at(map.place, e.what());
            }
            try {
                texture_use t;
                t.map = builder_.files().texture(map.file, holds);
                t.file = map.file;
                t.wrap = map.clamp ? texture_wrap::clamp : texture_wrap::repeat;
                t.scale = map.scale;
                t.offset = map.offset;
                t.channel = map.channel.value_or(texture_channel::red);
                return t;
            } catch (const file_error& e) {
                builder_.note(map.place, std::string("a picture is left out: ") + e.what());
                return std::nullopt;
            }
        }

    private:
        void said(const std::string& what)
        {
            builder_.note(from_.place, "material " + shown_word(from_.name) + ": " + what);
        }
        dvec3 limited(const dvec3& c, const char* name)
        {
            const auto within = glm::clamp(c, dvec3(0), dvec3(1));
            if (within != c)
                said(std::string(name) + " is limited to 0 to 1");
            return within;
        }
        double limited(double v, const char* name) { return limited(dvec3(v), name).x; }

        void read_diffuse()
        {
            base_.name = from_.name;
            base_.reflectance = limited(from_.kd.value_or(dvec3(from_.map_kd ? 1 : 0.5)), "Kd");
            if (!from_.map_kd)
                return;
            if (const auto t = texture(*from_.map_kd, texture_holds::colour)) {
                base_.texture = *t;
                if (is_black(base_.reflectance)) {
                    said("Kd is black, and its picture would be; 1 is used");
                    base_.reflectance = dvec3(1);
                }
            }
        }

        void read_opacity()
        {
            if (from_.d) {
                base_.opacity = limited(*from_.d, "d");
                if (from_.tr && std::abs(*from_.d + *from_.tr - 1) > 0.01)
                    said("d and Tr differ; d is used");
            } else if (from_.tr && *from_.tr == 1) {
                said("Tr 1 is taken for opaque, since programs that write it without d mean that");
            } else if (from_.tr) {
                base_.opacity = 1 - limited(*from_.tr, "Tr");
            }
            if (!from_.map_d)
                return;
            if (auto t = texture(*from_.map_d, texture_holds::numbers)) {
                const auto& texels = t->map->texels;
                const bool has_alpha = std::any_of(
                    texels.begin(), texels.end(), [](const glm::u16vec4& texel) { return texel.w != 65535; });
                if (has_alpha && !from_.map_d->channel)
                    t->channel = texture_channel::alpha;
                base_.opacity_texture = *t;
            }
        }

        double index_of_coat()
        {
            const double ni = from_.ni.value_or(1.5);
            if (ni > 10)
                said("Ni is limited to 10");
            return ni > 1 ? std::min(ni, 10.0) : 1.5; // programs write 0 and 1 where they have none
        }

        // Programs write 4 and 9 for what is not transparent, too, or what is as leaves are.
        bool is_glass() const
        {
            const int illum = from_.illum.value_or(2);
            const bool is_dark = !from_.map_kd && from_.kd && largest(*from_.kd) <= 0.05;
            return illum == 6 || illum == 7 || ((illum == 4 || illum == 9) && is_dark && from_.ni.value_or(1) > 1);
        }
        std::uint32_t glass()
        {
            if (base_.texture.map || largest(base_.reflectance) > 0.05)
                said("glass, without its diffuse colour");
            if (from_.map_d)
                builder_.note(from_.map_d->place, "the opacity of glass is left out");
            base_.kind = material_kind::glass;
            base_.texture = {};
            base_.reflectance = dvec3(1);
            if (from_.tf && !is_black(*from_.tf))
                base_.reflectance = limited(*from_.tf, "Tf");
            else if (from_.tf)
                said("Tf is black, and the glass would be; 1 is used");
            base_.index_of_refraction = index_of_coat();
            if (from_.pr)
                base_.roughness = limited(*from_.pr, "Pr");
            return builder_.add_material(from_.place, base_);
        }

        /// A part of a mixture, which has its opacity.
        std::uint32_t add_part(material m, const char* name)
        {
            m.name = from_.name + " (" + name + ")";
            m.opacity = 1;
            m.opacity_texture = {};
            return builder_.add_material(from_.place, std::move(m));
        }
        std::uint32_t add_mixture(material first, material second, double share, const texture_use& texture)
        {
            material both{.name = from_.name};
            both.opacity = base_.opacity;
            both.opacity_texture = base_.opacity_texture;
            both.share = share;
            both.share_texture = texture;
            const auto a = add_part(std::move(first), "below"), b = add_part(std::move(second), "metal");
            return builder_.add_mixture(from_.place, both, a, b);
        }

        /// The metallic-roughness model: plastic, metal, or a mixture of both.
        std::uint32_t physical()
        {
            const double given = from_.ns ? roughness_of_exponent(*from_.ns) : 0.5;
            std::optional<texture_use> rough;
            if (from_.map_pr)
                rough = texture(*from_.map_pr, texture_holds::numbers);
            const double roughness = limited(from_.pr.value_or(rough ? 1 : given), "Pr");
            auto metal = base_, plastic = base_;
            metal.kind = material_kind::metal;
            plastic.kind = material_kind::plastic;
            metal.roughness = plastic.roughness = roughness;
            plastic.index_of_refraction = index_of_coat();
            if (rough)
                metal.roughness_texture = *rough;

            std::optional<texture_use> metallic;
            if (from_.map_pm)
                metallic = texture(*from_.map_pm, texture_holds::numbers);
            const double share = limited(from_.pm.value_or(metallic ? 1 : 0), "Pm");
            if (share == 1 && !metallic)
                return builder_.add_material(from_.place, std::move(metal));
            if (rough) {
                builder_.note(from_.map_pr->place, "a picture of the roughness of a coat: its mean is used");
                plastic.roughness = roughness * mean_of(*rough)[std::min(static_cast<int>(rough->channel), 2)];
            }
            set_reflectance_below_coat(plastic);
            if (share == 0)
                return builder_.add_material(from_.place, std::move(plastic));
            return add_mixture(std::move(plastic), std::move(metal), share, metallic.value_or(texture_use{}));
        }

        /// The illumination models of MTL files.
        std::uint32_t phong()
        {
            const int illum = from_.illum.value_or(2);
            const auto ks = from_.ks.value_or(dvec3(0));
            if (illum < 2 || is_black(ks))
                return builder_.add_material(from_.place, base_);
            if (illum == 3 || illum == 5)
                return mirror(limited(ks, "Ks"));
            if (from_.ns.value_or(0) < 1) // as wide as the hemisphere: no highlight
                return builder_.add_material(from_.place, base_);
            if (ks.x != ks.y || ks.x != ks.z)
                said("its highlight has no colour: a clear coat is drawn");
            base_.kind = material_kind::plastic;
            base_.index_of_refraction = index_of_coat();
            base_.roughness = roughness_of_exponent(*from_.ns);
            set_reflectance_below_coat(base_);
            return builder_.add_material(from_.place, base_);
        }
        std::uint32_t mirror(const dvec3& ks)
        {
            auto metal = base_;
            metal.kind = material_kind::metal;
            metal.texture = {};
            metal.roughness = from_.ns ? roughness_of_exponent(*from_.ns) : 0;
            const double share = largest(ks);
            if (is_black(base_.reflectance) || share == 1) {
                if (!is_black(base_.reflectance))
                    said("a mirror, without its diffuse colour, since Ks is 1");
                metal.reflectance = ks;
                return builder_.add_material(from_.place, std::move(metal));
            }
            metal.reflectance = ks / share;
            base_.reflectance /= 1 - share;
            if (largest(base_.reflectance) > 1 + 1e-9)
                said("Kd and Ks are more than 1 together; Kd is limited");
            base_.reflectance = glm::min(base_.reflectance, dvec3(1));
            return add_mixture(base_, std::move(metal), share, {});
        }

        scene_builder& builder_;
        const mtl_material& from_;
        bool has_coordinates_;
        material base_;
    };
} // namespace

std::optional<imported_emission> emission_of(scene_builder& builder, const mtl_material& m)
{
    dvec3 radiance = m.ke.value_or(dvec3(m.map_ke ? 1 : 0));
    if (radiance.x < 0 || radiance.y < 0 || radiance.z < 0)
        fail_at(m.place, "material " + shown_word(m.name) + ": Ke must not be below 0");
    if (is_black(radiance))
        return std::nullopt;
    for (const auto& n : m.notes)
        builder.note(n.place, n.what);
    if (m.map_ke) {
        material_maker maker(builder, m, false);
        if (const auto t = maker.texture(*m.map_ke, texture_holds::colour, false)) {
            builder.note(m.map_ke->place, "the picture of what a surface emits: its mean is used");
            radiance *= mean_of(*t);
        }
    }
    const bool is_coloured = m.map_kd || !is_black(m.kd.value_or(dvec3(0)));
    if (is_coloured)
        builder.note(m.place, "the surface of a lamp: black; its material is left out");
    return imported_emission{.radiance = radiance, .two_sided = false};
}

std::uint32_t add_material(scene_builder& builder, const mtl_material& m, bool has_coordinates)
{
    return material_maker(builder, m, has_coordinates).made();
}

} // namespace photongrid::obj
