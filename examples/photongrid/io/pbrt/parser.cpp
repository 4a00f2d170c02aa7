// The directives of pbrt-v4 files, as its users' guide lists them.
#include <photongrid/io/pbrt/description.hpp>
#include <photongrid/io/pbrt/parameter_reader.hpp>
#include <photongrid/io/pbrt/transformations.hpp>
#include <photongrid/io/pbrt/version_3.hpp>

#include <photongrid/io/import/included_files.hpp>
#include <photongrid/io/json_tree.hpp>

#include <algorithm>
#include <span>
#include <utility>

namespace photongrid::pbrt {

namespace {
    constexpr std::size_t max_blocks = 100'000; // against files whose every line begins one

    /// What AttributeBegin saves.
    struct graphics_state {
        glm::dmat4 to_world{1};
        bool moves_start = true; ///< whether transformations change what is drawn: the state at the start time
        bool reverse_orientation = false;
        std::string inside{}, outside{}; ///< names of media
        material_reference material{};
        std::optional<std::size_t> area_light{};
        std::map<std::string, parameter_list> defaults{}; ///< of Attribute
        const rgb_primaries* colors = color_space("srgb");
    };

    class parser {
    public:
        parser(const scene_files& files, import_log& log, const std::string& name) : files_(files), log_(log)
        {
            made_.materials.push_back({.type = "diffuse", .place = source_place(name), .colors = state_.colors});
        }

        void read(const std::string& name, std::string_view text, std::size_t depth)
        {
            token_reader t(std::make_shared<const std::string>(name), text);
            while (t.peek())
                read_directive(t, depth);
        }

        description take(const source_place& end)
        {
            if (!in_world_)
                fail_at(end, "there is no WorldBegin, so that the file describes no scene");
            if (!blocks_.empty())
                fail_at(blocks_.back().place, std::string(names[blocks_.back().kind]) + "Begin has no end");
            return std::move(made_);
        }

    private:
        enum block_kind : std::size_t { attribute, transform, object };
        static constexpr std::array names{"Attribute", "Transform", "Object"};
        struct block {
            block_kind kind;
            source_place place;
            graphics_state saved;
        };

        using action = void (parser::*)(token_reader&, const source_place&);
        struct directive {
            std::string_view name;
            action read;
            enum { anywhere, before_world, in_world } where;
        };
        static std::span<const directive> directives()
        {
            static constexpr directive all[] = {
                {"Identity", &parser::read_identity, directive::anywhere},
                {"Translate", &parser::read_translate, directive::anywhere},
                {"Scale", &parser::read_scale, directive::anywhere},
                {"Rotate", &parser::read_rotate, directive::anywhere},
                {"LookAt", &parser::read_look_at, directive::anywhere},
                {"CoordinateSystem", &parser::read_coordinate_system, directive::anywhere},
                {"CoordSysTransform", &parser::read_coord_sys_transform, directive::anywhere},
                {"Transform", &parser::read_transform, directive::anywhere},
                {"ConcatTransform", &parser::read_concat_transform, directive::anywhere},
                {"ActiveTransform", &parser::read_active_transform, directive::anywhere},
                {"TransformTimes", &parser::read_transform_times, directive::anywhere},
                {"ColorSpace", &parser::read_color_space, directive::anywhere},
                {"Option", &parser::read_option, directive::anywhere},
                {"Attribute", &parser::read_attribute, directive::anywhere},
                {"Camera", &parser::read_camera, directive::before_world},
                {"Film", &parser::read_film, directive::before_world},
                {"PixelFilter", &parser::read_filter, directive::before_world},
                {"Sampler", &parser::read_method, directive::before_world},
                {"Integrator", &parser::read_integrator, directive::before_world},
                {"Accelerator", &parser::read_method, directive::before_world},
                {"WorldBegin", &parser::begin_world, directive::before_world},
                {"WorldEnd", &parser::end_world, directive::in_world}, // of older versions
                {"AttributeBegin", &parser::begin<attribute>, directive::in_world},
                {"AttributeEnd", &parser::end<attribute>, directive::in_world},
                {"TransformBegin", &parser::begin<transform>, directive::in_world},
                {"TransformEnd", &parser::end<transform>, directive::in_world},
                {"ObjectBegin", &parser::begin_object, directive::in_world},
                {"ObjectEnd", &parser::end<object>, directive::in_world},
                {"ObjectInstance", &parser::read_instance, directive::in_world},
                {"ReverseOrientation", &parser::reverse_orientation, directive::in_world},
                {"Shape", &parser::read_shape, directive::in_world},
                {"Material", &parser::read_material, directive::in_world},
                {"MakeNamedMaterial", &parser::read_named_material, directive::in_world},
                {"NamedMaterial", &parser::use_named_material, directive::in_world},
                {"Texture", &parser::read_texture, directive::in_world},
                {"AreaLightSource", &parser::read_area_light, directive::in_world},
                {"LightSource", &parser::read_light, directive::in_world},
                {"MakeNamedMedium", &parser::read_medium, directive::anywhere},
                {"MediumInterface", &parser::read_medium_interface, directive::anywhere},
            };
            return all;
        }

        void read_directive(token_reader& t, std::size_t depth)
        {
            const auto place = t.place();
            if (t.peek()->is != token::kind::word)
                t.fail_at_next("a directive such as Shape");
            const auto name = t.next()->text;
            if (name == "Include" || name == "Import") {
                include(t, place, depth, name == "Import");
                return;
            }
            const auto d = std::find_if(
                directives().begin(), directives().end(), [&](const directive& x) { return x.name == name; });
            if (d == directives().end()) {
                std::vector<std::string> known;
                for (const auto& x : directives())
                    known.emplace_back(x.name);
                const auto near = nearest(name, known);
                fail_at(place,
                    "found " + shown_word(name) + "; expected a directive of pbrt-v4"
                        + (near.empty() ? "" : ", perhaps " + near));
            }
            if (d->where == directive::in_world && !in_world_)
                fail_at(place, std::string(name) + " stands before WorldBegin");
            if (d->where == directive::before_world && in_world_)
                fail_at(place, std::string(name) + " stands behind WorldBegin");
            (this->*d->read)(t, place);
        }

        // --- values ---
        /// A directive's type and parameters. `defaults`: the name of those in Attribute, or "".
        entity read_entity(token_reader& t, const source_place& place, const char* what, const char* defaults = "")
        {
            entity e{.type = t.quoted(what), .place = place, .colors = state_.colors, .to_world = state_.to_world};
            e.parameters = read_parameters(t);
            if (const auto found = state_.defaults.find(defaults); found != state_.defaults.end())
                e.parameters.add_absent(found->second);
            return e;
        }

        // --- transformations ---
        void apply(const glm::dmat4& m)
        {
            if (state_.moves_start)
                state_.to_world = state_.to_world * m;
        }

        void read_identity(token_reader&, const source_place&)
        {
            if (state_.moves_start)
                state_.to_world = glm::dmat4(1);
        }
        void read_translate(token_reader& t, const source_place&) { apply(read_translation(t)); }
        void read_scale(token_reader& t, const source_place&) { apply(read_scaling(t)); }
        void read_rotate(token_reader& t, const source_place& place) { apply(read_rotation(t, place)); }
        void read_look_at(token_reader& t, const source_place& place) { apply(read_view(t, place)); }
        void read_coordinate_system(token_reader& t, const source_place&)
        {
            systems_[t.quoted("the name of a coordinate system")] = state_.to_world;
        }
        void read_coord_sys_transform(token_reader& t, const source_place& place)
        {
            const auto name = t.quoted("the name of a coordinate system");
            const auto found = systems_.find(name);
            if (found == systems_.end())
                fail_at(place, "the coordinate system " + shown_word(name) + " is not known here");
            if (state_.moves_start)
                state_.to_world = found->second;
        }
        void read_transform(token_reader& t, const source_place&)
        {
            const auto m = read_matrix(t);
            if (state_.moves_start)
                state_.to_world = m;
        }
        void read_concat_transform(token_reader& t, const source_place&) { apply(read_matrix(t)); }
        void read_active_transform(token_reader& t, const source_place& place)
        {
            const auto name = t.peek() ? t.next()->text : "";
            if (!is_one_of(name, {"StartTime", "EndTime", "All"}))
                fail_at(place, "found ActiveTransform " + shown_word(name) + "; expected StartTime, EndTime or All");
            state_.moves_start = name != "EndTime";
            if (name == "EndTime")
                log_.add(place, "motion is left out: the scene is drawn as it is at the start time");
        }
        void read_transform_times(token_reader& t, const source_place&) { read_numbers<2>(t); }

        // --- the picture ---
        void read_camera(token_reader& t, const source_place& place)
        {
            made_.camera = read_entity(t, place, "a camera's type");
            if (!(std::abs(glm::determinant(state_.to_world)) > 0))
                fail_at(place, "Camera: its transformation cannot be inverted");
            made_.camera_to_world = glm::inverse(state_.to_world);
            systems_["camera"] = made_.camera_to_world;
        }
        void read_film(token_reader& t, const source_place& place)
        {
            made_.film = read_entity(t, place, "a film's type");
        }
        void read_filter(token_reader& t, const source_place& place)
        {
            made_.filter = read_entity(t, place, "a filter's type");
        }
        void read_integrator(token_reader& t, const source_place& place)
        {
            made_.integrator = read_entity(t, place, "an integrator's type");
        }
        /// How pbrt draws the scene is no part of it.
        void read_method(token_reader& t, const source_place& place) { read_entity(t, place, "a type"); }
        void read_option(token_reader& t, const source_place&) { read_parameter(t); }
        void read_color_space(token_reader& t, const source_place& place)
        {
            const auto name = t.quoted("the name of a colour space");
            state_.colors = color_space(name);
            if (state_.colors == nullptr)
                fail_at(place,
                    "found the colour space " + shown_word(name) + "; expected srgb, dci-p3, rec2020 or aces2065-1");
        }

        // --- blocks ---
        void begin_world(token_reader&, const source_place&)
        {
            in_world_ = true;
            state_.to_world = glm::dmat4(1);
            state_.moves_start = true;
            systems_["world"] = glm::dmat4(1);
        }
        void end_world(token_reader&, const source_place&) {}
        template <block_kind Kind>
        void begin(token_reader&, const source_place& place)
        {
            if (blocks_.size() == max_blocks)
                fail_at(place, "more than 100,000 blocks within each other");
            blocks_.push_back({Kind, place, state_});
        }
        template <block_kind Kind>
        void end(token_reader&, const source_place& place)
        {
            if (blocks_.size() <= outer_blocks_ || blocks_.back().kind != Kind)
                fail_at(place,
                    std::string(names[Kind]) + "End without its beginning"
                        + (blocks_.size() <= outer_blocks_
                                ? ""
                                : std::string("; here ends what ") + names[blocks_.back().kind] + "Begin began"));
            if (Kind == transform) {
                state_.to_world = blocks_.back().saved.to_world;
                state_.moves_start = blocks_.back().saved.moves_start;
            } else {
                state_ = std::move(blocks_.back().saved);
            }
            if (Kind == object)
                object_.reset();
            blocks_.pop_back();
        }
        void begin_object(token_reader& t, const source_place& place)
        {
            if (object_)
                fail_at(place, "ObjectBegin within an object");
            object_ = t.quoted("an object's name");
            begin<object>(t, place);
            if (!made_.objects.try_emplace(*object_).second)
                fail_at(place, "the object " + shown_word(*object_) + " is defined twice");
        }
        void read_instance(token_reader& t, const source_place& place)
        {
            if (object_)
                fail_at(place, "ObjectInstance within an object; pbrt allows none there");
            made_.instances.push_back({t.quoted("an object's name"), place, state_.to_world});
        }
        void include(token_reader& t, const source_place& place, std::size_t depth, bool apart)
        {
            const auto [path, text] = files_.read(t.quoted("a file's name"), place, depth);
            const auto state = state_;
            const auto outer = std::exchange(outer_blocks_, blocks_.size());
            read(path, text, depth + 1);
            if (blocks_.size() != outer_blocks_)
                fail_at(
                    blocks_.back().place, std::string(names[blocks_.back().kind]) + "Begin has no end in this file");
            outer_blocks_ = outer;
            if (apart)
                state_ = state;
        }

        // --- what the scene consists of ---
        void read_attribute(token_reader& t, const source_place& place)
        {
            const auto target = t.quoted("what it is of: shape, light, material, medium or texture");
            if (!is_one_of(target, {"shape", "light", "material", "medium", "texture"}))
                fail_at(place, "found " + shown_word(target) + "; expected shape, light, material, medium or texture");
            auto given = read_parameters(t);
            auto& defaults = state_.defaults[target];
            given.add_absent(defaults);
            defaults = std::move(given);
        }
        void reverse_orientation(token_reader&, const source_place&)
        {
            state_.reverse_orientation = !state_.reverse_orientation;
        }
        void read_shape(token_reader& t, const source_place& place)
        {
            shape_entity s{read_entity(t, place, "a shape's type", "shape"), state_.material, state_.area_light,
                state_.reverse_orientation, state_.inside, state_.outside};
            (object_ ? made_.objects[*object_] : made_.shapes).push_back(std::move(s));
        }
        void read_material(token_reader& t, const source_place& place)
        {
            state_.material = {.name = {}, .index = made_.materials.size()};
            made_.materials.push_back(of_version_4(read_entity(t, place, "a material's type", "material"), "material"));
        }
        /// As pbrt-v4 says it, with a note if it is pbrt-v3's.
        entity of_version_4(entity e, std::string_view kind)
        {
            if (to_version_4(e, kind) && !std::exchange(is_old_, true))
                log_.say(e.place, "written for pbrt-v3: its materials and lights are read as the nearest of pbrt-v4");
            return e;
        }
        /// What follows a name: its type is a parameter.
        entity read_named_entity(token_reader& t, const source_place& place, const char* kind)
        {
            entity e{.type = "", .place = place, .colors = state_.colors, .to_world = state_.to_world};
            e.parameters = read_parameters(t);
            if (const auto found = state_.defaults.find(kind); found != state_.defaults.end())
                e.parameters.add_absent(found->second);
            e.type = e.parameters.text("type", "");
            return e;
        }
        void read_named_material(token_reader& t, const source_place& place)
        {
            const auto name = t.quoted("a material's name");
            auto e = read_named_entity(t, place, "material");
            if (e.type.empty())
                fail_at(place, "MakeNamedMaterial " + shown_word(name) + " lacks the parameter \"string type\"");
            if (!made_.named_materials.emplace(name, made_.materials.size()).second)
                fail_at(place, "the material " + shown_word(name) + " is defined twice");
            made_.materials.push_back(of_version_4(std::move(e), "material"));
        }
        void use_named_material(token_reader& t, const source_place&)
        {
            state_.material = {.name = t.quoted("a material's name"), .index = 0};
        }
        void read_texture(token_reader& t, const source_place& place)
        {
            const auto name = t.quoted("a texture's name");
            auto value = t.quoted("float or spectrum");
            if (value == "color") // as in pbrt-v3
                value = "spectrum";
            if (!is_one_of(value, {"float", "spectrum"}))
                fail_at(place, "found a texture of " + shown_word(value) + "; expected float or spectrum");
            auto e = read_entity(t, place, "a texture's type", "texture");
            if (!made_.textures.emplace(name + (value == "float" ? "/float" : "/spectrum"), std::move(e)).second)
                fail_at(place, "the texture " + shown_word(name) + " is defined twice");
        }
        void read_area_light(token_reader& t, const source_place& place)
        {
            state_.area_light = made_.area_lights.size();
            made_.area_lights.push_back(of_version_4(read_entity(t, place, "a light's type", "light"), "light"));
        }
        void read_light(token_reader& t, const source_place& place)
        {
            made_.lights.push_back(of_version_4(read_entity(t, place, "a light's type", "light"), "light"));
        }
        void read_medium(token_reader& t, const source_place& place)
        {
            const auto name = t.quoted("a medium's name");
            auto e = read_named_entity(t, place, "medium");
            if (!made_.media.emplace(name, std::move(e)).second)
                fail_at(place, "the medium " + shown_word(name) + " is defined twice");
        }
        void read_medium_interface(token_reader& t, const source_place&)
        {
            const auto inside = t.quoted("a medium's name or \"\"");
            auto outside = inside;
            if (t.peek() && t.peek()->is == token::kind::quoted)
                outside = t.quoted("");
            state_.inside = inside;
            state_.outside = outside;
        }

        included_files files_;
        import_log& log_;
        description made_;
        graphics_state state_;
        std::vector<block> blocks_;
        std::size_t outer_blocks_ = 0; ///< blocks that a file which includes this one has begun
        std::map<std::string, glm::dmat4> systems_;
        std::optional<std::string> object_; ///< the one that is being defined
        bool in_world_ = false;
        bool is_old_ = false; ///< something is pbrt-v3's
    };
} // namespace

description parse(const std::string& file, std::string_view text, const scene_files& files, import_log& log)
{
    parser p(files, log, file);
    p.read(file, text, 0);
    return p.take(source_place(file));
}

} // namespace photongrid::pbrt
