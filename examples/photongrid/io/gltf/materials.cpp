#include <photongrid/io/gltf/materials.hpp>
#include <photongrid/io/import/coat.hpp>

#include <algorithm>
#include <cmath>

namespace photongrid::gltf {

namespace {
    /// The index of refraction of a body that reflects this share head-on.
    double index_of(double reflectance)
    {
        const double root = std::sqrt(std::clamp(reflectance, 0.0, 0.66)); // an index of 10 reflects 0.669
        return (1 + root) / (1 - root);
    }
    double reflectance_of(double index) { return (index - 1) * (index - 1) / ((index + 1) * (index + 1)); }

    /// Reads one material.
    class one_material {
    public:
        one_material(document& all, const part& m, const std::string& name)
            : all_(all), m_(m), name_(name), textures_(all, name)
        {
        }

        surface_material read()
        {
            surface_material made{.name = name_};
            if (const auto glossy = m_.extension("KHR_materials_pbrSpecularGlossiness"))
                read_glossy(*glossy);
            else
                read_base(m_.object("pbrMetallicRoughness"));
            read_opacity();
            note_left_out();
            made.is_black = base_ == dvec3(0);
            made.is_double_sided = m_.truth("doubleSided", false);
            const auto strong = m_.extension("KHR_materials_emissive_strength");
            made.radiance = m_.colour("emissiveFactor", 1).value_or(dvec3(0))
                * ((strong ? strong->number("emissiveStrength", 1, 0, 1e15) : 1.0) / units_of_emission());
            if (made.radiance != dvec3(0))
                made.emission = textures_.texture(m_, "emissiveTexture", texture_holds::colour);
            if (made.radiance == dvec3(0) || made.emission) // else all of its surfaces are lamps
                made.index = surface();
            made.is_pane = is_pane_;
            made.coordinates = textures_.coordinates();
            return made;
        }

    private:
        /// So many of the file's make 1 W/(m^2 sr). Blender writes watts, though glTF has nits.
        double units_of_emission() const
        {
            using unit = import_settings::emission;
            const auto asked = all_.builder().settings().emission_unit;
            return asked.value_or(all_.is_by_blender() ? unit::watts : unit::nits) == unit::watts ? 1
                                                                                                  : luminous_efficacy;
        }
        void note(const std::string& what) { all_.builder().note(m_.place(), name_ + ": " + what); }

        void read_base(const std::optional<part>& pbr)
        {
            if (!pbr) {
                metallic_ = roughness_ = 1;
                return;
            }
            const auto factor = pbr->numbers<4>("baseColorFactor", 0, 1).value_or(std::array{1.0, 1.0, 1.0, 1.0});
            base_ = dvec3(factor[0], factor[1], factor[2]);
            alpha_ = factor[3];
            read_base_texture(*pbr, "baseColorTexture");
            metallic_ = pbr->number("metallicFactor", 1, 0, 1);
            roughness_ = pbr->number("roughnessFactor", 1, 0, 1);
            if (auto t = textures_.texture(*pbr, "metallicRoughnessTexture", texture_holds::numbers)) {
                const auto metal = channel_range_of(*t->map, texture_channel::blue),
                           rough = channel_range_of(*t->map, texture_channel::green);
                if (metal.low < metal.high && metallic_ > 0) {
                    metallic_texture_ = *t;
                    metallic_texture_.channel = texture_channel::blue;
                } else {
                    metallic_ *= metal.high;
                }
                if (rough.low < rough.high && roughness_ > 0) {
                    roughness_texture_ = *t;
                    roughness_texture_.channel = texture_channel::green;
                } else {
                    roughness_ *= rough.high;
                }
            }
        }

        /// Its colour and its opacity.
        void read_base_texture(const part& of, const char* key)
        {
            if (auto colour = textures_.texture(of, key, texture_holds::colour))
                texture_ = *colour;
            else if (of.has(key))
                base_ *= 0.5;
            if (texture_.map && m_.text("alphaMode").value_or("OPAQUE") != "OPAQUE")
                if (auto numbers = textures_.texture(of, key, texture_holds::numbers);
                    numbers && channel_range_of(*numbers->map, texture_channel::alpha).low < 1) {
                    alpha_texture_ = *numbers;
                    alpha_texture_.channel = texture_channel::alpha;
                }
        }

        void read_glossy(const part& g)
        {
            const auto diffuse = g.numbers<4>("diffuseFactor", 0, 1).value_or(std::array{1.0, 1.0, 1.0, 1.0});
            base_ = dvec3(diffuse[0], diffuse[1], diffuse[2]);
            alpha_ = diffuse[3];
            read_base_texture(g, "diffuseTexture");
            const auto specular = g.colour("specularFactor", 1).value_or(dvec3(1));
            roughness_ = 1 - g.number("glossinessFactor", 1, 0, 1);
            dvec3 head_on = specular;
            if (const auto t = textures_.texture(g, "specularGlossinessTexture", texture_holds::colour)) {
                head_on *= dvec3(mean_of(*t->map));
                note("the texture of its specular colour and glossiness: its mean is used");
            }
            if (base_ == dvec3(0)) {
                metallic_ = 1;
                base_ = head_on;
                texture_ = {};
            } else {
                index_ = index_of(std::max({head_on.x, head_on.y, head_on.z}));
                if (head_on.x != head_on.y || head_on.x != head_on.z)
                    note("the colour of its reflection is left out");
            }
            is_glossy_ = true;
        }

        void note_left_out()
        {
            struct unread {
                const char *extension, *key, *what;
            };
            static constexpr unread all[]
                = {{"KHR_materials_clearcoat", "clearcoatFactor", "drawn without its clear coat"},
                    {"KHR_materials_anisotropy", "anisotropyStrength", "its roughness is the same in all directions"},
                    {"KHR_materials_iridescence", "iridescenceFactor", "drawn without iridescence"},
                    {"KHR_materials_dispersion", "dispersion", "drawn without dispersion"},
                    {"KHR_materials_diffuse_transmission", "diffuseTransmissionFactor",
                        "drawn without the light that passes it"}};
            for (const auto& u : all)
                if (const auto e = m_.extension(u.extension); e && e->number(u.key, 0, 0, 1e6) > 0)
                    note(u.what);
            if (const auto sheen = m_.extension("KHR_materials_sheen");
                sheen && sheen->colour("sheenColorFactor", 1).value_or(dvec3(0)) != dvec3(0))
                note("drawn without sheen");
            if (m_.has("normalTexture"))
                note("its map of normals is left out");
            if (m_.extension("KHR_materials_unlit")) {
                note("is unlit: drawn as diffuse, in the scene's light");
                is_matte_ = true;
            }
        }

        /// The share that the surface reflects head-on, by KHR_materials_ior and KHR_materials_specular.
        void read_index()
        {
            if (is_glossy_)
                return;
            if (const auto e = m_.extension("KHR_materials_ior"))
                index_ = e->number("ior", 1.5, 0, 1e6);
            if (index_ < 1 || index_ > 10) {
                note("its index of refraction is not from 1 to 10; 1.5 is used");
                index_ = 1.5;
            }
            body_index_ = index_;
            const auto e = m_.extension("KHR_materials_specular");
            if (!e)
                return;
            const auto colour = e->colour("specularColorFactor", 1e6).value_or(dvec3(1));
            if (colour != dvec3(1) && colour != dvec3(0))
                note("the colour of its reflection is left out");
            double strength = e->number("specularFactor", 1, 0, 1);
            if (colour == dvec3(0))
                strength = 0;
            for (const auto* key : {"specularTexture", "specularColorTexture"})
                if (e->has(key))
                    note("a texture of its reflection is left out");
            if (strength == 0)
                is_matte_ = true;
            index_ = index_of(reflectance_of(index_) * strength);
        }

        std::string plain_name() const
        {
            const auto name = m_.text("name");
            return name && !name->empty() ? *name : name_;
        }

        /// The material without its opacity.
        std::uint32_t surface()
        {
            read_index();
            if (metallic_ <= 0)
                return insulator("");
            if (metallic_ >= 1 && !metallic_texture_.map)
                return metal("");
            const auto first = insulator(" (insulator)"), second = metal(" (metal)");
            return add_mixture("", metallic_, metallic_texture_, first, second);
        }

        std::uint32_t metal(const std::string& suffix)
        {
            return add(suffix,
                {.name = "",
                    .kind = material_kind::metal,
                    .reflectance = base_,
                    .roughness = roughness_,
                    .texture = texture_,
                    .roughness_texture = roughness_texture_});
        }

        std::uint32_t insulator(const std::string& suffix)
        {
            const auto e = m_.extension("KHR_materials_transmission");
            const double passes = e ? e->number("transmissionFactor", 0, 0, 1) : 0;
            if (passes <= 0)
                return opaque(suffix);
            auto share = textures_.texture(*e, "transmissionTexture", texture_holds::numbers);
            if (passes == 1 && !share)
                return clear(suffix);
            const auto first = opaque(" (opaque)"), second = clear(" (clear)");
            return add_mixture(suffix, passes, share.value_or(texture_use{}), first, second);
        }

        std::uint32_t opaque(const std::string& suffix)
        {
            if (is_matte_ || index_ == 1)
                return add(suffix, {.name = "", .reflectance = base_, .texture = texture_});
            double roughness = roughness_;
            if (roughness_texture_.map) {
                note("a texture of the roughness: its mean is used where the surface is no metal");
                roughness *= mean_of(*roughness_texture_.map)[1];
            }
            material m{.name = "",
                .kind = material_kind::plastic,
                .reflectance = base_,
                .index_of_refraction = index_,
                .roughness = roughness,
                .texture = texture_};
            set_reflectance_below_coat(m);
            return add(suffix, std::move(m));
        }

        std::uint32_t clear(const std::string& suffix)
        {
            const auto volume = m_.extension("KHR_materials_volume");
            const double thickness = volume ? volume->number("thicknessFactor", 0, 0) : 0;
            material m{.name = "",
                .kind = thickness > 0 ? material_kind::glass : material_kind::thin_glass,
                .reflectance = base_,
                .index_of_refraction = body_index_,
                .roughness = roughness_,
                .texture = texture_,
                .roughness_texture = roughness_texture_};
            if (!(thickness > 0)) {
                is_pane_ = true;
                m.index_of_refraction = index_;
                return add(suffix, std::move(m));
            }
            const auto colour = volume->colour("attenuationColor", 1).value_or(dvec3(1));
            if (volume->has("attenuationDistance") && colour != dvec3(1)) {
                const double distance = volume->number("attenuationDistance", 1, 1e-9);
                for (int c = 0; c < 3; ++c)
                    m.absorption[c] = -std::log(std::max(colour[c], 1e-9)) / distance;
            }
            return add(suffix, std::move(m));
        }

        /// Reads what `alphaMode` makes of the opacity.
        void read_opacity()
        {
            const auto mode = m_.text("alphaMode").value_or("OPAQUE");
            if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND")
                m_.at("alphaMode").fail("found " + m_.at("alphaMode").described() + "; expected OPAQUE, MASK or BLEND");
            const double cutoff = m_.number("alphaCutoff", 0.5, 0);
            if (mode == "OPAQUE") {
                alpha_ = 1;
                alpha_texture_ = {};
            } else if (mode == "MASK" && alpha_texture_.map) {
                auto map = *alpha_texture_.map;
                for (auto& t : map.texels)
                    t = glm::u16vec4(t.w / 65535.0 * alpha_ >= cutoff ? 65535 : 0);
                alpha_texture_.map = std::make_shared<const texture>(std::move(map));
                alpha_texture_.file.clear();
                alpha_ = 1;
            } else if (mode == "MASK") {
                alpha_ = alpha_ >= cutoff ? 1 : 0;
            }
        }

        void set_opacity(material& m) const
        {
            m.opacity *= alpha_;
            if (alpha_texture_.map)
                m.opacity_texture = alpha_texture_;
        }

        /// Adds a material, or a part of a mixture, which has a suffix to its name.
        std::uint32_t add(const std::string& suffix, material m)
        {
            m.name = plain_name() + suffix;
            if (suffix.empty())
                set_opacity(m);
            return all_.builder().add_material(m_.place(), std::move(m));
        }

        std::uint32_t add_mixture(const std::string& suffix, double share, const texture_use& share_texture,
            std::uint32_t first, std::uint32_t second)
        {
            material m{.name = plain_name() + suffix};
            m.share = share;
            m.share_texture = share_texture;
            if (suffix.empty())
                set_opacity(m);
            const auto made = all_.builder().add_mixture(m_.place(), m, first, second);
            if (suffix.empty() && (made == first || made == second)) // it stands alone, without the opacity
                return all_.builder().with_opacity(m_.place(), made, alpha_, alpha_texture_);
            return made;
        }

        document& all_;
        part m_;
        std::string name_;
        texture_reader textures_;
        dvec3 base_{1};
        double alpha_ = 1, metallic_ = 0, roughness_ = 1, index_ = 1.5, body_index_ = 1.5;
        texture_use texture_{}, alpha_texture_{}, metallic_texture_{}, roughness_texture_{};
        bool is_matte_ = false; ///< without reflection
        bool is_pane_ = false;
        bool is_glossy_ = false; ///< by KHR_materials_pbrSpecularGlossiness
    };
} // namespace

const surface_material& material_reader::made(std::optional<std::size_t> index, const source_place& place)
{
    if (const auto known = made_.find(index); known != made_.end())
        return known->second;
    auto& to = made_[index];
    if (index) {
        to = one_material(all_, all_.element("materials", *index), all_.name_of("material", "materials", *index))
                 .read();
    } else {
        all_.builder().note(place, "surfaces without a material: drawn as diffuse 0.5");
        to.index = all_.builder().add_material(place, {.name = "none"});
        to.name = "none";
    }
    return to;
}

} // namespace photongrid::gltf
