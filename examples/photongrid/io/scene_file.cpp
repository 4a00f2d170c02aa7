// The reader of scene files.
#include <photongrid/io/picture_reader.hpp>
#include <photongrid/io/scene_file.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>

namespace photongrid {

namespace {
    constexpr std::size_t max_shapes = 65'536, max_materials = 4'096, max_lights = 1'024, max_vertices = 1'024;

    /// The length, m, that must not be too small: of the axis, of the shortest edge, or a polygon's extent. Radii are
    /// limited when they are read.
    template <class Part>
    double least_length(const Part& p)
    {
        if constexpr (requires { shape_kind<Part>::extent(p); })
            return shape_kind<Part>::extent(p);
        else if constexpr (requires { light_kind<Part>::extent(p); })
            return light_kind<Part>::extent(p);
        else if constexpr (std::is_same_v<Part, camera>)
            return glm::length(p.look_at - p.position);
        else
            return scene_values::min_length;
    }

    class reader : picture_reader {
    public:
        using picture_reader::picture_reader;

        scene read(const std::string& default_name)
        {
            open(root(), "scene");
            if (const auto& version = at(root(), "photongrid");
                version.kind != json_kind::number || version.number != 1)
                wrong(version, "the format's version, 1");
            read_units(at(root(), "units"));
            scene_.name = default_name;
            if (const auto* name = root().find("name"))
                scene_.name = read_name(*name);
            read_camera(at(root(), "camera"));
            read_materials(at(root(), "materials"));
            read_list(at(root(), "shapes"), max_shapes, "shapes", [&](const json_value& v) { read_shape(v); });
            read_list(at(root(), "lights"), max_lights, "lights", [&](const json_value& v) { read_light(v); });
            if (count_lights(scene_) == 0)
                fail(at(root(), "lights").place, "lights: the scene has none; expected at least one");
            check_shapes();
            scene_.render = settings_unless_named(false, false);
            if (const auto* render = root().find("render"))
                read_render(*render);
            if (const auto* paper = root().find("as_paper"))
                read_settings(*paper, "as_paper", scene_.paper.emplace(as_paper(scene_.render)));
            return std::move(scene_);
        }

    private:
        /// Runs photongrid::check on a part, and adds the position of the invalid member to the message.
        template <class Part>
        void checked(const json_value& v, const Part& part) const
        {
            try {
                check(part);
            } catch (const std::invalid_argument& e) {
                const std::string_view what = e.what();
                const auto* m = v.find(what.substr(0, what.find_first_of(":, ")));
                fail(m ? m->place : v.place, std::string(what));
            }
            if (least_length(part) < min_length)
                fail(v.place,
                    std::is_same_v<Part, camera> ? "position and look_at are less than 1e-9 m apart; check \"units\""
                                                 : "is smaller than 1e-9 m; check \"units\"");
        }

        /// What all shapes together must be, with the position of the one at fault.
        void check_shapes() const
        {
            const auto& shapes = at(root(), "shapes");
            if (!has_surfaces(scene_))
                fail(shapes.place, detail::no_shape);
            const auto number = [&](const detail::shape_place& p) {
                return std::distance(shape_places_.begin(), std::find(shape_places_.begin(), shape_places_.end(), p));
            };
            if (const auto bad = detail::unresolved_in(detail::extent_of(scene_))) {
                const auto n = static_cast<std::size_t>(number(bad->place));
                if (n == shape_places_.size()) // a lamp
                    fail(at(root(), "lights").place, bad->place.text() + ": " + bad->what);
                fail(shapes.items[n].place, bad->what);
            }
            if (const auto pair = detail::overlapping_glass(scene_)) {
                const auto [first, second] = std::minmax({number((*pair)[0]), number((*pair)[1])});
                fail(shapes.items[static_cast<std::size_t>(second)].place,
                    "is glass and overlaps shapes[" + std::to_string(first)
                        + "], which is of the same glass; move them apart, or give them different materials");
            }
        }

        // --- parts ---
        void read_camera(const json_value& v)
        {
            open(v, "camera");
            auto& c = scene_.camera;
            c.position = point(at(v, "position"));
            c.look_at = point(at(v, "look_at"));
            if (const auto* up = v.find("up"))
                c.up = direction(*up);
            c.vertical_fov = number(at(v, "vertical_fov"), 1e-3, 178.9, "an angle of 0.001 to 178.9 degrees");
            checked(v, c);
        }

        void read_materials(const json_value& v)
        {
            if (v.kind != json_kind::object)
                wrong(v, "an object: materials by name");
            if (v.items.size() > max_materials)
                fail(v.items[max_materials].key_place,
                    std::to_string(v.items.size()) + " materials; expected at most " + std::to_string(max_materials));
            for (const auto& m : v.items)
                if (m.key != "comment") {
                    if (!is_name(m.key))
                        fail(m.key_place,
                            "found the key " + described({.kind = json_kind::string, .text = m.key}).substr(9)
                                + "; expected a material's name of 1 to 100 bytes without control characters");
                    material_index_[m.key] = static_cast<std::uint32_t>(scene_.materials.size());
                    material_names_.push_back(m.key);
                    scene_.materials.push_back(read_material(m));
                }
            for (const auto& m : v.items)
                if (const auto* parts = m.key == "comment" ? nullptr : m.find("materials"))
                    read_parts(m, *parts, scene_.materials[material_index_[m.key]]);
        }

        void read_parts(const json_value& mixture, const json_value& v, material& to) const
        {
            if (v.kind != json_kind::array || v.items.size() != to.parts.size())
                wrong(v, "the names of two materials");
            for (std::size_t i = 0; i < to.parts.size(); ++i)
                to.parts[i] = index_of_material(v.items[i]);
            try {
                check_parts(scene_.materials, to);
            } catch (const std::invalid_argument& e) {
                fail(at(mixture, "materials").place, e.what());
            }
        }

        material read_material(const json_value& v)
        {
            const auto& type = type_of(v, "material", material_names());
            open(v, type);
            const auto& row = *std::find_if(
                material_kinds.begin(), material_kinds.end(), [&](const material_entry& m) { return type == m.name; });
            material made{.name = v.key, .kind = row.kind};
            for (const auto& f : row.fields)
                std::visit([&](auto member) { read_field(v.find(f.key), f, made.*member); }, f.member);
            for (const auto& [key, member] : detail::number_textures)
                if (const auto* texture = v.find(key))
                    made.*member = number_texture_in(*texture);
            if (const auto* texture = v.find("texture"))
                made.texture = texture_in(*texture);
            if (const auto* energy = v.find("energy")) {
                const auto& names = facet_bounces_names;
                const auto& word = one_of(*energy, {names.begin(), names.end()});
                made.energy = static_cast<facet_bounces>(std::find(names.begin(), names.end(), word) - names.begin());
            }
            checked(v, made);
            return made;
        }

        void read_field(const json_value* given, const material_field& f, dvec3& to) const
        {
            to = given ? rgb_in_range(*given, f.range) : dvec3(f.if_absent.value());
        }
        void read_field(const json_value* given, const material_field& f, double& to) const
        {
            to = given ? in_range(*given, f.range, f.what) : f.if_absent.value();
        }

        std::uint32_t material_of(const json_value& shape) const { return index_of_material(at(shape, "material")); }

        std::uint32_t index_of_material(const json_value& v) const
        {
            if (v.kind != json_kind::string)
                wrong(v, "the name of a material");
            const auto found = material_index_.find(v.text);
            if (found == material_index_.end()) {
                const auto near = nearest(v.text, material_names_);
                wrong(
                    v, "the name of a material in \"materials\"" + (near.empty() ? "" : ", perhaps \"" + near + "\""));
            }
            return found->second;
        }

        /// Reads the member `f` of `part`. `most`: the largest number of points in a list.
        template <class Part, class Field>
        void read_field(const json_value& v, Part& part, const Field& f, std::size_t most) const
        {
            const auto& value = at(v, f.name);
            if constexpr (requires { (part.*f.member).push_back({}); })
                part.*f.member = points(value, most);
            else if constexpr (std::is_same_v<std::decay_t<decltype(part.*f.member)>, double>)
                part.*f.member = f.of == quantity::angle ? angle(value) : radius(value);
            else
                part.*f.member = f.of == quantity::direction ? direction(value)
                    : f.of == quantity::power                ? power(value)
                    : f.of == quantity::emission             ? emission(value)
                                                             : point(value);
        }

        std::vector<dvec3> points(const json_value& list, std::size_t most) const
        {
            if (list.kind != json_kind::array || list.items.size() < 3 || list.items.size() > most)
                wrong(
                    list, most == 3 ? "an array of 3 points" : "an array of 3 to " + std::to_string(most) + " points");
            std::vector<dvec3> all;
            for (const auto& p : list.items)
                all.push_back(point(p));
            return all;
        }

        void read_shape(const json_value& v)
        {
            const auto& type = type_of(v, "shape", shape_names());
            open(v, type);
            if (type == shape_kind<placed_mesh>::name)
                read_mesh(v);
            for_each_shape(scene_, [&](auto& list, auto kind) {
                using shape = typename std::decay_t<decltype(list)>::value_type;
                const bool is_triangle = std::is_same_v<shape, polygon> && type == triangle_name;
                if (type != kind.name && !is_triangle)
                    return;
                shape x;
                for_each_field(
                    kind.fields, [&](const auto& f) { read_field(v, x, f, is_triangle ? 3 : max_vertices); });
                x.material = material_of(v);
                checked(v, x);
                check_suits_material(v, x);
                shape_places_.push_back({kind.list, list.size()});
                list.push_back(std::move(x));
            });
        }

        template <class Shape>
        void check_suits_material(const json_value& v, const Shape& shape) const
        {
            try {
                detail::check_material_of(shape, scene_.materials);
            } catch (const std::invalid_argument& e) {
                fail(at(v, "material").place, e.what());
            }
        }

        // --- meshes ---
        void read_mesh(const json_value& v)
        {
            placed_mesh m = surface_in(v);
            m.material = material_of(v);
            checked(v, m);
            check_suits_material(v, m);
            shape_places_.push_back({"meshes", scene_.meshes.size()});
            scene_.meshes.push_back(std::move(m));
        }

        void read_light(const json_value& v)
        {
            const auto& type = type_of(v, "light", light_names());
            open(v, type);
            const auto* given = v.find("name");
            const auto name = given ? read_name(*given) : "lights[" + std::to_string(count_lights(scene_)) + "]";
            for_each_light(scene_, [&](auto& list, auto kind) {
                if (type != kind.name)
                    return;
                typename std::decay_t<decltype(list)>::value_type l;
                l.name = name;
                if constexpr (requires { l.surface; })
                    l.surface = surface_in(v);
                if constexpr (requires { l.map; })
                    read_environment(v, l);
                for_each_field(kind.fields, [&](const auto& f) {
                    if (v.find(f.name) != nullptr) // open() has seen to those that must be there
                        read_field(v, l, f, max_vertices);
                });
                checked(v, l);
                if constexpr (requires { l.map; })
                    if (!list.empty())
                        fail(v.place, "is the second environment; a scene has at most one");
                list.push_back(std::move(l));
            });
        }

        // --- settings ---
        static bool is_auto(const json_value& v) { return v.kind == json_kind::string && v.text == "auto"; }
        void set(const json_value& v, const setting_table::whole_range& r, std::uint32_t& to) const
        {
            to = whole(v, r.least, r.most);
        }
        void set(const json_value& v, const setting_table::real_or_auto& r, std::optional<double>& to) const
        {
            if (is_auto(v))
                to = std::nullopt;
            else
                to = in_range(v, r.range);
        }
        void set(const json_value& v, const real_range& r, double& to) const { to = in_range(v, r); }
        void set(const json_value& v, const setting_table::whole_or_auto& r, std::uint32_t& to) const
        {
            to = is_auto(v) ? r.automatic : whole(v, r.range.least, r.range.most, ", or \"auto\"");
        }
        void set(const json_value& v, const setting_table::length_or_auto& r, double& to) const
        {
            to = is_auto(v) ? r.automatic : radius(v, ", or \"auto\"");
        }
        template <class Value, std::size_t N>
        void set(const json_value& v, const setting_table::one_of<Value, N>& choice, Value& to) const
        {
            std::vector<std::string> words;
            for (const auto& n : choice.values)
                words.emplace_back(n.name);
            to = *choice.find(one_of(v, words));
        }
        void set(const json_value& v, const setting_table::pixels& p, output_settings& to) const
        {
            if (v.kind != json_kind::array || v.items.size() != 2)
                wrong(v, "a size: [width, height] in pixels");
            to.width = whole(v.items[0], 1, p.most);
            to.height = whole(v.items[1], 1, p.most);
        }
        void set(const json_value& v, const setting_table::cells& c, glm::uvec3& to) const
        {
            if (is_auto(v)) {
                to = glm::uvec3(0);
                return;
            }
            const auto along = three(v, "a grid: [x, y, z] cells, or \"auto\"",
                [&](const json_value& n) { return static_cast<double>(whole(n, 1, c.most_per_axis)); });
            if (along.x * along.y * along.z > c.most)
                wrong(v, "at most 2^31 cells");
            to = glm::uvec3(along);
        }
        /// Policies that are not in the file are off, even if the default has them on.
        void set(const json_value& v, const setting_table::policies& p, leak_policy& to) const
        {
            if (v.kind != json_kind::object)
                wrong(
                    v, "an object with some of the keys \"side\", \"min_cosine\" or \"flattening\"; {} for no policy");
            open(v, "leaks");
            to = {};
            if (const auto* side = v.find("side")) {
                if (side->kind != json_kind::boolean)
                    wrong(*side, "true or false");
                to.side = side->truth;
            }
            if (const auto* cosine = v.find("min_cosine"))
                to.min_cosine = static_cast<float>(in_range(*cosine, p.min_cosine));
            if (const auto* flattening = v.find("flattening"))
                to.flattening = static_cast<float>(in_range(*flattening, p.flattening));
        }

        void read_render(const json_value& v)
        {
            const auto* photons = v.find(setting_table::photons.name);
            scene_.render = settings_unless_named(
                photons != nullptr && !is_auto(*photons), v.find(setting_table::grid.name) != nullptr);
            read_settings(v, "render", scene_.render);
        }

        void read_settings(const json_value& v, const char* kind, render_settings& to)
        {
            open(v, kind);
            for_each_setting([&](const auto& row) {
                if (const auto* given = row.use == in_scenes::never ? nullptr : v.find(row.name))
                    set(*given, row.values, row.of(to));
            });
            checked(v, to);
        }

        scene scene_;
        std::vector<detail::shape_place> shape_places_; ///< in the file's order
        std::map<std::string, std::uint32_t> material_index_;
        std::vector<std::string> material_names_;
    };
} // namespace

render_settings settings_unless_named(bool photons, bool grid)
{
    auto s = automatic_settings();
    if (photons) {
        s = with_numbers(s, {});
        s.estimate.k = automatic_number;
    }
    if (grid)
        s.map.builder = map_settings{}.builder;
    return s;
}

scene parse_scene(const std::string& file, std::string text, file_reading how)
{
    return reader(file, std::move(text), std::move(how)).read(std::filesystem::path(file).stem().string());
}

scene read_scene(const std::string& path, file_reading how)
{
    return parse_scene(path, read_scene_text(path), std::move(how));
}

} // namespace photongrid
