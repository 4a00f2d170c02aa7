#include <photongrid/io/scene_edit.hpp>
#include <photongrid/io/scene_file.hpp>
#include <photongrid/io/scene_values.hpp>
#include <photongrid/io/scene_writer.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace photongrid {

namespace {
    /// The shortest decimal number that reads as `v`.
    std::string shortest(double v)
    {
        char text[32];
        return {text, std::to_chars(text, text + sizeof text, v).ptr};
    }

    /// A number in the unit `u` that reads as `v`, in SI units, if there is one; else the nearest.
    double in_unit(double v, const unit& u)
    {
        const double x = v * u.divide / u.multiply;
        for (const double end : {x, -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()})
            if (const double near = std::nextafter(x, end); near * u.multiply / u.divide == v)
                return near;
        return x;
    }

    class editor : scene_values {
    public:
        editor(const std::string& file, const std::string& text)
            : scene_values(file, text), text_(text), before_(parse_scene(file, text))
        {
            read_units(at(root(), "units"));
        }

        std::string edited(const scene& s, const render_settings& settings)
        {
            if (s.name != before_.name || s.materials != before_.materials)
                throw_other("name or materials");
            edit_camera(s.camera);
            edit_parts(at(root(), "shapes"), s, [](auto& of, const auto& f) { for_each_shape(of, f); });
            edit_parts(at(root(), "lights"), s, [](auto& of, const auto& f) { for_each_light(of, f); });
            edit_meshes(s.meshes);
            edit_settings(settings);
            return replaced();
        }

    private:
        /// Text in place of the bytes begin to end - 1 of the file.
        struct replacement {
            std::size_t begin, end;
            std::string text;
        };

        [[noreturn]] static void throw_other(const std::string& what)
        {
            throw std::invalid_argument(
                "edited_scene_text: the scene has another " + what + " than the text; use scene_text()");
        }

        // --- values: as they were and as they are, in SI units ---
        void edit(const json_value& v, const unit& u, double was, double is)
        {
            if (was != is)
                replacements_.push_back({v.place, v.end, shortest(in_unit(is, u))});
        }
        void edit(const json_value& v, const unit& u, const dvec3& was, const dvec3& is)
        {
            if (v.kind == json_kind::array) {
                for (int c = 0; c < 3; ++c)
                    edit(v.items[static_cast<std::size_t>(c)], u, was[c], is[c]);
            } else if (is == dvec3(is.x)) { // one number for three channels
                edit(v, u, was.x, is.x);
            } else {
                replacements_.push_back({v.place, v.end, three_text(is, u)});
            }
        }
        void edit(const json_value& v, const unit& u, const std::vector<dvec3>& was, const std::vector<dvec3>& is)
        {
            if (was.size() != is.size())
                throw_other("number of corners");
            for (std::size_t i = 0; i < is.size(); ++i)
                edit(v.items[i], u, was[i], is[i]);
        }
        static std::string three_text(const dvec3& v, const unit& u)
        {
            return "[" + shortest(in_unit(v.x, u)) + ", " + shortest(in_unit(v.y, u)) + ", " + shortest(in_unit(v.z, u))
                + "]";
        }
        /// Adds a member to an object that has some, laid out as its last one.
        void add_member(const json_value& object, const std::string& key, const std::string& value)
        {
            const auto& last = object.items.back();
            const auto line = text_.find_last_not_of(" \t\r\n", last.key_place - 1) + 1;
            auto blanks = text_.substr(line, last.key_place - line);
            if (object.items.size() == 1 && blanks.empty())
                blanks = " ";
            replacements_.push_back({last.end, last.end, "," + blanks + "\"" + key + "\": " + value});
        }

        // --- parts ---
        void edit_camera(const camera& c)
        {
            const auto& v = at(root(), "camera");
            const auto& was = before_.camera;
            edit(at(v, "position"), length_, was.position, c.position);
            edit(at(v, "look_at"), length_, was.look_at, c.look_at);
            edit(at(v, "vertical_fov"), {}, was.vertical_fov, c.vertical_fov);
            if (const auto* up = v.find("up"))
                edit(*up, {}, was.up, c.up);
            else if (was.up != c.up)
                add_member(v, "up", three_text(c.up, {}));
        }

        /// Shapes or lights; for_each(scene, f) calls f(list, kind) for each list of them.
        template <class ForEach>
        void edit_parts(const json_value& all, const scene& s, const ForEach& for_each)
        {
            for_each(s, [&](const auto& list, auto kind) {
                using part = typename std::decay_t<decltype(list)>::value_type;
                for_each(before_, [&](const auto& were, auto) {
                    if constexpr (std::is_same_v<std::decay_t<decltype(were)>, std::decay_t<decltype(list)>>)
                        edit_list<part>(items_of(all, kind.name, std::is_same_v<part, polygon>), kind, were, list);
                });
            });
        }
        template <class Part, class Kind>
        void edit_list(const std::vector<const json_value*>& items, Kind kind, const std::vector<Part>& were,
            const std::vector<Part>& are)
        {
            if (were.size() != are.size())
                throw_other(std::string("number of parts of the kind ") + kind.name);
            for (std::size_t i = 0; i < are.size(); ++i) {
                auto was = were[i];
                if constexpr (requires { was.surface.offset; }) {
                    edit_place(*items[i], was.surface, are[i].surface);
                    was.surface.offset = are[i].surface.offset;
                }
                if (!same_but_for_fields(was, are[i], kind))
                    throw_other(std::string("name, surface or material of a ") + kind.name);
                for_each_field(kind.fields, [&](const auto& f) {
                    const unit& u = unit_of(f.of);
                    const auto &before = were[i].*f.member, &after = are[i].*f.member;
                    if (const auto* given = items[i]->find(f.name))
                        edit(*given, u, before, after);
                    else if constexpr (std::is_same_v<std::decay_t<decltype(after)>, dvec3>)
                        if (before != after)
                            add_member(*items[i], f.name, three_text(after, u));
                });
            }
        }
        const unit& unit_of(quantity q) const
        {
            switch (q) {
            case quantity::direction:
            case quantity::angle:
            case quantity::emission: return none_;
            case quantity::power: return power_;
            default: return length_;
            }
        }
        template <class Part, class Kind>
        static bool same_but_for_fields(Part was, const Part& is, Kind kind)
        {
            for_each_field(kind.fields, [&](const auto& f) { was.*f.member = is.*f.member; });
            return was == is;
        }
        /// The parts of a kind, in the order of its list.
        static std::vector<const json_value*> items_of(const json_value& all, std::string_view kind, bool triangles_too)
        {
            std::vector<const json_value*> items;
            for (const auto& v : all.items)
                if (const auto& type = at(v, "type").text; type == kind || (triangles_too && type == triangle_name))
                    items.push_back(&v);
            return items;
        }

        /// Meshes may have moved.
        void edit_meshes(const std::vector<placed_mesh>& meshes)
        {
            using kind = shape_kind<placed_mesh>;
            const auto items = items_of(at(root(), "shapes"), kind::name, false);
            if (meshes.size() != before_.meshes.size())
                throw_other("number of meshes");
            for (std::size_t i = 0; i < meshes.size(); ++i) {
                if (!same_but_for_fields(before_.meshes[i], meshes[i], kind{}))
                    throw_other("mesh, or scale, rotation or material of one");
                edit_place(*items[i], before_.meshes[i], meshes[i]);
            }
        }
        void edit_place(const json_value& of, const placed_mesh& before, const placed_mesh& after)
        {
            const auto &was = before.offset, &is = after.offset;
            if (const auto* matrix = of.find("matrix"))
                for (int row = 0; row < 3; ++row)
                    edit(matrix->items[static_cast<std::size_t>(row)].items[3], length_, was[row], is[row]);
            else if (const auto* translate = of.find("translate"))
                edit(*translate, length_, was, is);
            else if (was != is)
                add_member(of, "translate", three_text(is, length_));
        }

        // --- settings ---
        void edit_settings(const render_settings& settings)
        {
            const auto json_of = [](const render_settings& r) { return nlohmann::json::parse(settings_text(r)); };
            const auto were = json_of(before_.render), are = json_of(settings);
            const auto* v = root().find("render");
            const auto named = [&](const char* name) { return v == nullptr ? nullptr : v->find(name); };
            // What the reader takes for settings that are not named changes with those that are.
            const auto unnamed = json_of(settings_unless_named(settings.map.photons != automatic_number,
                named(setting_table::grid.name) != nullptr || settings.map.grid != glm::uvec3(0)));
            std::string added; // to an object that has no members yet
            for_each_setting([&](const auto& row) {
                const auto* given = named(row.name);
                if (row.use == in_scenes::never || are[row.name] == (given ? were : unnamed)[row.name])
                    return;
                auto value = are[row.name].dump();
                if constexpr (std::is_same_v<std::decay_t<decltype(row.values)>, setting_table::length_or_auto>)
                    if (row.of(settings) != row.values.automatic)
                        value = shortest(in_unit(row.of(settings), length_));
                if (given)
                    replacements_.push_back({given->place, given->end, value});
                else if (v != nullptr && !v->items.empty())
                    add_member(*v, row.name, value);
                else
                    added += (added.empty() ? "\"" : ", \"") + std::string(row.name) + "\": " + value;
            });
            if (added.empty())
                return;
            if (v != nullptr)
                replacements_.push_back({v->place, v->end, "{" + added + "}"});
            else
                add_member(root(), "render", "{" + added + "}");
        }

        std::string replaced()
        {
            std::stable_sort(replacements_.begin(), replacements_.end(),
                [](const replacement& a, const replacement& b) { return a.begin < b.begin; });
            std::string all;
            std::size_t at = 0;
            for (const auto& r : replacements_) {
                all.append(text_, at, r.begin - at).append(r.text);
                at = r.end;
            }
            return all.append(text_, at);
        }

        const std::string text_;
        const scene before_;
        const unit none_{};
        std::vector<replacement> replacements_;
    };
} // namespace

std::string edited_scene_text(
    const std::string& file, const std::string& text, const scene& s, const render_settings& settings)
{
    return editor(file, text).edited(s, settings);
}

} // namespace photongrid
