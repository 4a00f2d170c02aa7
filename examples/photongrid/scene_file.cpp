#include "scene_file.hpp"

#include "setting_names.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>

namespace photongrid {

namespace {
    // --- what the format knows ---
    constexpr bool must = true, may = false;
    constexpr scene_key scene_keys[] = {{"$schema", may}, {"photongrid", must}, {"name", may}, {"units", must},
        {"camera", must}, {"materials", must}, {"shapes", must}, {"lights", must}, {"render", must}};
    constexpr scene_key units_keys[] = {{"length", must}, {"power", must}};
    constexpr scene_key camera_keys[] = {{"position", must}, {"look_at", must}, {"up", may}, {"vertical_fov", must}};
    constexpr scene_key reflecting_keys[] = {{"type", must}, {"reflectance", must}};
    constexpr scene_key mirror_keys[] = {{"type", must}, {"reflectance", may}};
    constexpr scene_key glass_keys[] = {{"type", must}, {"index_of_refraction", must}, {"transmittance", may}};
    constexpr scene_key render_keys[] = {{"size", must}, {"photons", must}, {"k", must}, {"grid", must},
        {"max_radius", must}, {"light_samples", may}, {"spp", may}, {"passes", may}, {"depth", may},
        {"photon_depth", may}, {"seed", may}, {"map", may}, {"slots", may}, {"exposure", may}, {"search", may},
        {"kernel", may}, {"bias", may}, {"leaks", may}, {"edge_correction", may}};
    constexpr scene_key leaks_keys[] = {{"side", may}, {"normals", may}, {"disc", may}};
    // The keys of shapes and lights are those of the tables in scene/ (shape_kind, light_kind).
    template <class Kind>
    std::vector<scene_key> keys_of(Kind kind, std::vector<scene_key> before, std::vector<scene_key> after)
    {
        for_each_field(kind.fields, [&](const auto& f) { before.push_back({f.name, must}); });
        before.insert(before.end(), after.begin(), after.end());
        return before;
    }

    /// In scene files a polygon of three vertices may be called this.
    constexpr const char* triangle = "triangle";

    /// The keys of each kind of shape, or of light, by the name of the kind.
    struct kind_keys {
        const char* name;
        std::vector<scene_key> keys;
    };
    const std::vector<kind_keys>& shape_keys()
    {
        static const auto all = [] {
            std::vector<kind_keys> kinds;
            const scene none;
            for_each_shape(none, [&](const auto& list, auto kind) {
                const auto keys = keys_of(kind, {{"type", must}}, {{"material", must}});
                if constexpr (std::is_same_v<std::decay_t<decltype(list)>, std::vector<polygon>>)
                    kinds.push_back({triangle, keys});
                kinds.push_back({kind.name, keys});
            });
            return kinds;
        }();
        return all;
    }
    const std::vector<kind_keys>& light_keys()
    {
        static const auto all = [] {
            std::vector<kind_keys> kinds;
            const scene none;
            for_each_light(none, [&](const auto&, auto kind) {
                kinds.push_back({kind.name, keys_of(kind, {{"type", must}, {"name", may}}, {})});
            });
            return kinds;
        }();
        return all;
    }
    std::vector<std::string> names_of(const std::vector<kind_keys>& kinds)
    {
        std::vector<std::string> names;
        for (const auto& k : kinds)
            names.emplace_back(k.name);
        return names;
    }

    // Beyond these, single precision (squares and cubes of lengths, photon power) is no longer safe.
    constexpr double max_length = 1e9, max_power = 1e15;
    // Below this, squares and cubes of lengths leave even double precision, and normals made of them are no unit
    // vectors.
    constexpr double min_length = 1e-9;
    constexpr std::size_t max_shapes = 65'536, max_materials = 4'096, max_lights = 1'024, max_vertices = 1'024;

    std::string joined(const std::vector<std::string>& words)
    {
        std::string all;
        for (std::size_t i = 0; i < words.size(); ++i)
            all += (i == 0 ? "\"" : i + 1 == words.size() ? " or \"" : ", \"") + words[i] + "\"";
        return all;
    }

    /// The length (m) that a part must not lack: its axis, its least edge, a polygon's extent. Radii are read with
    /// limits.
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
            return min_length;
    }

    /// A unit: a value in it is value * multiply / divide in SI. Two whole numbers round better than 0.001 would.
    struct unit {
        double multiply = 1, divide = 1;
    };

    class reader {
    public:
        reader(const std::string& file, std::string text) : tree_(file, std::move(text)) {}

        scene read(const std::string& default_name)
        {
            const auto& root = tree_.root();
            open(root, "scene");
            if (const auto& version = at(root, "photongrid"); version.kind != json_kind::number || version.number != 1)
                wrong(version, "the format's version, 1");
            read_units(at(root, "units"));
            scene_.name = default_name;
            if (const auto* name = root.find("name"))
                scene_.name = read_name(*name);
            read_camera(at(root, "camera"));
            read_materials(at(root, "materials"));
            read_list(at(root, "shapes"), max_shapes, "shapes", [&](const json_value& v) { read_shape(v); });
            read_list(at(root, "lights"), max_lights, "lights", [&](const json_value& v) { read_light(v); });
            if (count_lights(scene_) == 0)
                tree_.fail(at(root, "lights").place, "lights: the scene has none; expected at least one");
            read_render(at(root, "render"));
            return std::move(scene_);
        }

    private:
        [[noreturn]] void wrong(const json_value& v, const std::string& expected) const
        {
            tree_.fail(v.place, "found " + described(v) + "; expected " + expected);
        }

        // --- objects ---
        static const json_value& at(const json_value& object, std::string_view key) { return *object.find(key); }

        static std::vector<std::string> names(std::span<const scene_key> keys)
        {
            std::vector<std::string> all;
            for (const auto& k : keys)
                all.emplace_back(k.name);
            return all;
        }

        /// Holds `v` to the keys of `kind`: all required ones there, no unknown ones.
        void open(const json_value& v, std::string_view kind) const
        {
            if (v.kind != json_kind::object)
                wrong(v, "an object with the keys of \"" + std::string(kind) + "\"");
            const auto objects = known_objects();
            const auto keys = std::find_if(objects.begin(), objects.end(), [&](const object_keys& o) {
                return o.name == kind;
            })->keys;
            for (const auto& m : v.items) {
                if (m.key == "comment"
                    || std::any_of(keys.begin(), keys.end(), [&](const scene_key& k) { return m.key == k.name; }))
                    continue;
                const auto near = nearest(m.key, names(keys));
                tree_.fail(m.key_place,
                    "unknown key " + described({.kind = json_kind::string, .text = m.key}).substr(9) + " in \""
                        + std::string(kind) + "\"; expected "
                        + (near.empty() ? joined(names(keys)) : "\"" + near + "\"?"));
            }
            for (const auto& k : keys)
                if (k.required && !v.find(k.name))
                    tree_.fail(v.place, "\"" + std::string(kind) + "\" lacks the key \"" + k.name + "\"");
        }

        /// The value of "type", one of `types`.
        const std::string& type_of(const json_value& v, const char* what, const std::vector<std::string>& types) const
        {
            if (v.kind != json_kind::object)
                wrong(v, std::string("an object: a ") + what);
            const auto* type = v.find("type");
            if (!type)
                tree_.fail(v.place, std::string("a ") + what + " lacks the key \"type\"; expected " + joined(types));
            return one_of(*type, types);
        }

        const std::string& one_of(const json_value& v, const std::vector<std::string>& words) const
        {
            if (v.kind != json_kind::string || std::find(words.begin(), words.end(), v.text) == words.end())
                wrong(v, joined(words));
            return v.text;
        }

        template <class Read>
        void read_list(const json_value& v, std::size_t limit, const char* what, Read&& read) const
        {
            if (v.kind != json_kind::array)
                wrong(v, std::string("an array of ") + what);
            if (v.items.size() > limit)
                tree_.fail(v.items[limit].place,
                    std::to_string(v.items.size()) + " " + what + "; expected at most " + std::to_string(limit));
            for (const auto& item : v.items)
                read(item);
        }

        /// Runs photongrid::check on a part and puts the place of the member at fault before its words.
        template <class Part>
        void checked(const json_value& v, const Part& part) const
        {
            try {
                check(part);
            } catch (const std::invalid_argument& e) {
                const std::string_view what = e.what();
                const auto* m = v.find(what.substr(0, what.find_first_of(":, ")));
                tree_.fail(m ? m->place : v.place, std::string(what));
            }
            if (least_length(part) < min_length)
                tree_.fail(v.place,
                    "its points or edges are less than 1e-9 m apart; expected a larger one (are the units right?)");
        }

        // --- numbers ---
        double number(const json_value& v, double low, double high, const std::string& expected) const
        {
            if (v.kind != json_kind::number || !(v.number >= low && v.number <= high))
                wrong(v, expected);
            return v.number;
        }

        std::uint32_t whole(const json_value& v, std::uint32_t low, std::uint32_t high) const
        {
            const auto expected = "a whole number from " + std::to_string(low) + " to " + std::to_string(high);
            const double d = number(v, low, high, expected);
            if (d != std::floor(d))
                wrong(v, expected);
            return static_cast<std::uint32_t>(d);
        }

        double in_units(const json_value& v, const unit& u, double low, double high, const std::string& expected) const
        {
            if (v.kind != json_kind::number)
                wrong(v, expected);
            const double d = v.number * u.multiply / u.divide;
            if (!(d >= low && d <= high))
                wrong(v, expected);
            return d;
        }

        double length(const json_value& v) const
        {
            return in_units(v, length_, -max_length, max_length, "a length of at most 1e9 m");
        }
        double radius(const json_value& v) const
        {
            return in_units(v, length_, min_length, max_length, "a length from 1e-9 m to 1e9 m");
        }

        template <class Element>
        dvec3 three(const json_value& v, const char* expected, Element&& element) const
        {
            if (v.kind != json_kind::array || v.items.size() != 3)
                wrong(v, expected);
            return {element(v.items[0]), element(v.items[1]), element(v.items[2])};
        }

        dvec3 point(const json_value& v) const
        {
            return three(v, "a point: [x, y, z]", [&](const json_value& c) { return length(c); });
        }

        dvec3 direction(const json_value& v) const
        {
            const auto d = three(v, "a direction: [x, y, z]",
                [&](const json_value& c) { return number(c, -1e9, 1e9, "a number from -1e9 to 1e9"); });
            if (glm::length(d) < 1e-9)
                tree_.fail(v.place, "found a direction shorter than 1e-9; expected a longer one");
            return d;
        }

        /// Three channels, or one number for all of them.
        template <class Element>
        dvec3 rgb(const json_value& v, const char* expected, Element&& element) const
        {
            return v.kind == json_kind::number ? dvec3(element(v)) : three(v, expected, element);
        }

        dvec3 fraction(const json_value& v) const
        {
            return rgb(v, "[red, green, blue] or one number, each from 0 to 1",
                [&](const json_value& c) { return number(c, 0, 1, "a number from 0 to 1"); });
        }

        dvec3 power(const json_value& v) const
        {
            return rgb(v, "[red, green, blue] or one number: power",
                [&](const json_value& c) { return in_units(c, power_, 0, max_power, "a power from 0 to 1e15 W"); });
        }

        /// Names stand in messages, so a terminal must bear them.
        static bool is_name(const std::string& text)
        {
            return !text.empty() && text.size() <= 100 && std::none_of(text.begin(), text.end(), [](char c) {
                return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
            });
        }

        std::string read_name(const json_value& v) const
        {
            if (v.kind != json_kind::string || !is_name(v.text))
                wrong(v, "a name: text of 1 to 100 bytes without control characters");
            return v.text;
        }

        // --- parts ---
        void read_units(const json_value& v)
        {
            open(v, "units");
            static const std::map<std::string, unit> lengths{{"m", {}}, {"cm", {1, 100}}, {"mm", {1, 1000}}},
                powers{{"W", {}}, {"mW", {1, 1000}}, {"kW", {1000, 1}}};
            length_ = lengths.at(one_of(at(v, "length"), {"m", "cm", "mm"}));
            power_ = powers.at(one_of(at(v, "power"), {"W", "mW", "kW"}));
        }

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
                tree_.fail(v.items[max_materials].key_place,
                    std::to_string(v.items.size()) + " materials; expected at most " + std::to_string(max_materials));
            for (const auto& m : v.items)
                if (m.key != "comment") {
                    if (!is_name(m.key))
                        tree_.fail(m.key_place,
                            "found the key " + described({.kind = json_kind::string, .text = m.key}).substr(9)
                                + "; expected a material's name of 1 to 100 bytes without control characters");
                    material_index_[m.key] = static_cast<std::uint32_t>(scene_.materials.size());
                    material_names_.push_back(m.key);
                    scene_.materials.push_back(read_material(m));
                }
        }

        material read_material(const json_value& v) const
        {
            const auto& type = type_of(v, "material", {"lambertian", "mirror", "metal", "glass"});
            open(v, type);
            material made{.name = v.key};
            made.kind = type == "lambertian" ? material_kind::lambertian
                : type == "mirror"           ? material_kind::mirror
                : type == "metal"            ? material_kind::metal
                                             : material_kind::glass;
            const auto* colour = v.find(type == "glass" ? "transmittance" : "reflectance");
            made.reflectance = colour ? fraction(*colour) : dvec3(1);
            if (const auto* ior = v.find("index_of_refraction"))
                made.index_of_refraction = number(*ior, 1, 10, "an index of refraction from 1 to 10");
            checked(v, made);
            return made;
        }

        std::uint32_t material_of(const json_value& shape) const
        {
            const auto& v = at(shape, "material");
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

        /// Reads the member of `part` that `f` names. `most`: how many points a list may have.
        template <class Part, class Field>
        void read_field(const json_value& v, Part& part, const Field& f, std::size_t most) const
        {
            const auto& value = at(v, f.name);
            if constexpr (requires { (part.*f.member).push_back({}); })
                part.*f.member = points(value, most);
            else if constexpr (std::is_same_v<std::decay_t<decltype(part.*f.member)>, double>)
                part.*f.member = radius(value);
            else
                part.*f.member = f.what_it_says == quantity::direction ? direction(value)
                    : f.what_it_says == quantity::power                ? power(value)
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
            const auto& type = type_of(v, "shape", names_of(shape_keys()));
            open(v, type);
            for_each_shape(scene_, [&](auto& list, auto kind) {
                using shape = typename std::decay_t<decltype(list)>::value_type;
                const bool is_triangle = std::is_same_v<shape, polygon> && type == triangle;
                if (type != kind.name && !is_triangle)
                    return;
                shape x;
                for_each_field(
                    kind.fields, [&](const auto& f) { read_field(v, x, f, is_triangle ? 3 : max_vertices); });
                x.material = material_of(v);
                checked(v, x);
                list.push_back(std::move(x));
            });
        }

        void read_light(const json_value& v)
        {
            const auto& type = type_of(v, "light", names_of(light_keys()));
            open(v, type);
            const auto* given = v.find("name");
            const auto name = given ? read_name(*given) : "lights[" + std::to_string(count_lights(scene_)) + "]";
            for_each_light(scene_, [&](auto& list, auto kind) {
                if (type != kind.name)
                    return;
                typename std::decay_t<decltype(list)>::value_type l;
                l.name = name;
                for_each_field(kind.fields, [&](const auto& f) { read_field(v, l, f, max_vertices); });
                checked(v, l);
                list.push_back(std::move(l));
            });
        }

        /// Policies that are not named are off, those of the default too.
        leak_policy read_leaks(const json_value& v) const
        {
            if (v.kind != json_kind::object)
                wrong(v, "an object with some of the keys " + joined(names(leaks_keys)) + "; {} for no policy");
            open(v, "leaks");
            leak_policy leaks;
            if (const auto* side = v.find("side")) {
                if (side->kind != json_kind::boolean)
                    wrong(*side, "true or false");
                leaks.side = side->truth;
            }
            if (const auto* normals = v.find("normals"))
                leaks.min_cosine = static_cast<float>(number(*normals, -1, 1, "a cosine from -1 to 1"));
            if (const auto* disc = v.find("disc"))
                leaks.compression = static_cast<float>(number(*disc, 1, 1e6, "a compression from 1 to 1e6"));
            return leaks;
        }

        void read_render(const json_value& v)
        {
            open(v, "render");
            auto& r = scene_.render;
            const auto optional = [&](const char* key, std::uint32_t& setting, std::uint32_t low, std::uint32_t high) {
                if (const auto* m = v.find(key))
                    setting = whole(*m, low, high);
            };
            const auto& size = at(v, "size");
            if (size.kind != json_kind::array || size.items.size() != 2)
                wrong(size, "a size: [width, height] in pixels");
            r.width = whole(size.items[0], 1, 16384);
            r.height = whole(size.items[1], 1, 16384);
            if (const auto& grid = at(v, "grid"); grid.kind == json_kind::string && grid.text == "auto") {
                r.grid = glm::uvec3(0);
            } else {
                const auto cells = three(grid, "a grid: [x, y, z] cells, or \"auto\"",
                    [&](const json_value& c) { return static_cast<double>(whole(c, 1, 1u << 20)); });
                if (cells.x * cells.y * cells.z > 0x1p31)
                    wrong(grid, "at most 2^31 cells");
                r.grid = glm::uvec3(cells);
            }
            r.max_radius = radius(at(v, "max_radius"));
            optional("photons", r.photons, 1, 1u << 27);
            optional("k", r.k, 1, 1u << 24);
            optional("light_samples", r.light_samples, 1, 65536);
            optional("spp", r.spp, 1, 65536);
            optional("passes", r.passes, 1, 65536);
            optional("depth", r.depth, 0, 64);
            optional("photon_depth", r.photon_depth, 1, 64);
            optional("seed", r.seed, 0, 0xFFFFFFFFu);
            optional("slots", r.slots, 1, 16);
            const auto choice = [&](const char* key, auto& setting, const auto& names) {
                if (const auto* m = v.find(key))
                    setting = value_of(names, one_of(*m, words(names)));
            };
            choice("map", r.builder, map_names);
            choice("search", r.search, search_names);
            choice("kernel", r.kernel, kernel_names);
            choice("bias", r.bias, bias_names);
            choice("edge_correction", r.edges, edge_names);
            if (const auto* leaks = v.find("leaks"))
                r.leaks = read_leaks(*leaks);
            if (const auto* exposure = v.find("exposure"))
                r.exposure = number(*exposure, -64, 64, "an exposure from -64 to 64 EV");
            checked(v, r);
        }

        json_tree tree_;
        scene scene_;
        unit length_, power_;
        std::map<std::string, std::uint32_t> material_index_;
        std::vector<std::string> material_names_;
    };
} // namespace

std::span<const object_keys> known_objects()
{
    static const auto all = [] {
        std::vector<object_keys> objects{{"scene", scene_keys}, {"units", units_keys}, {"camera", camera_keys},
            {"lambertian", reflecting_keys}, {"mirror", mirror_keys}, {"metal", reflecting_keys}, {"glass", glass_keys},
            {"render", render_keys}, {"leaks", leaks_keys}};
        for (const auto* kinds : {&shape_keys(), &light_keys()})
            for (const auto& k : *kinds)
                objects.push_back({k.name, k.keys});
        return objects;
    }();
    return all;
}

scene parse_scene(const std::string& file, std::string text)
{
    return reader(file, std::move(text)).read(std::filesystem::path(file).stem().string());
}

scene read_scene(const std::string& path) { return parse_scene(path, read_scene_text(path)); }

} // namespace photongrid
