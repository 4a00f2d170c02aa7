#include <photongrid/io/scene_keys.hpp>
#include <photongrid/io/scene_writer.hpp>

#include <nlohmann/json.hpp>

#include <charconv>
#include <set>
#include <string_view>

namespace photongrid {

namespace {
    using json = nlohmann::ordered_json;

    /// The double with the same shortest decimal form as the float: 0.3 for 0.3f, not 0.30000001192092896.
    double as_written(float v)
    {
        char text[32];
        const auto* end = std::to_chars(text, text + sizeof text, v).ptr;
        double d = 0;
        std::from_chars(text, end, d);
        return d;
    }

    /// The active policies, as in a scene file.
    json leaks_json(const leak_policy& l)
    {
        json leaks = json::object();
        if (l.side)
            leaks["side"] = true;
        if (l.needs_photon_normals())
            leaks["min_cosine"] = as_written(l.min_cosine);
        if (l.flattening > 1)
            leaks["flattening"] = as_written(l.flattening);
        return leaks;
    }

    json three(const dvec3& v) { return {v.x, v.y, v.z}; }

    json written(double v) { return v; }
    json written(const dvec3& v) { return three(v); }
    json written(const std::vector<dvec3>& points)
    {
        json all = json::array();
        for (const auto& p : points)
            all.push_back(three(p));
        return all;
    }

    /// Adds the surface of a mesh to its object.
    void add_surface(json& all, const placed_mesh& m)
    {
        if (!m.file.empty()) {
            all["file"] = m.file;
        } else {
            json positions = json::array(), triangles = json::array();
            for (const auto& p : m.surface->positions)
                if (m.surface->origin == dvec3(0))
                    positions.push_back({as_written(p.x), as_written(p.y), as_written(p.z)});
                else
                    positions.push_back(three(m.surface->origin + dvec3(p)));
            for (const auto& t : m.surface->triangles)
                triangles.push_back({t.x, t.y, t.z});
            all["positions"] = std::move(positions);
            all["triangles"] = std::move(triangles);
            for (const auto& n : m.surface->normals)
                all["normals"].push_back({as_written(n.x), as_written(n.y), as_written(n.z)});
            for (const auto& t : m.surface->texture_coordinates)
                all["texture_coordinates"].push_back({as_written(t.x), as_written(t.y)});
            for (const auto& c : m.surface->colors)
                all["colors"].push_back({as_written(c.x), as_written(c.y), as_written(c.z)});
        }
        if (m.linear != glm::dmat3(1) || m.offset != dvec3(0)) {
            json rows = json::array();
            for (int row = 0; row < 3; ++row)
                rows.push_back({m.linear[0][row], m.linear[1][row], m.linear[2][row], m.offset[row]});
            all["matrix"] = std::move(rows);
        }
    }

    /// Adds the map of an environment and its rotation to its object.
    void add_map(json& all, const environment_light& l)
    {
        if (l.map && l.file.empty())
            throw std::invalid_argument("scene_text: environment_lights[0].map: was not read from a file; write it to "
                                        "one, and set `file` to its name");
        if (l.map)
            all["file"] = l.file;
        if (l.degrees != 0)
            all["rotate"] = {{"axis", three(l.axis)}, {"degrees", l.degrees}};
    }

    // Settings as in a scene file.
    json written(const setting_table::pixels&, const output_settings& s) { return {s.width, s.height}; }
    json written(const setting_table::whole_range&, std::uint32_t v) { return v; }
    json written(const setting_table::real_or_auto&, const std::optional<double>& v)
    {
        return v ? json(*v) : json("auto");
    }
    json written(const setting_table::whole_or_auto& r, std::uint32_t v)
    {
        return v == r.automatic ? json("auto") : json(v);
    }
    json written(const setting_table::length_or_auto& r, double v) { return v == r.automatic ? json("auto") : json(v); }
    json written(const real_range&, double v) { return v; }
    template <class Value, std::size_t N>
    json written(const setting_table::one_of<Value, N>& choice, Value v)
    {
        return choice.word_for(v);
    }
    json written(const setting_table::cells&, const glm::uvec3& v)
    {
        return v == glm::uvec3(0) ? json("auto") : json{v.x, v.y, v.z};
    }
    json written(const setting_table::policies&, const leak_policy& l) { return leaks_json(l); }

    json settings_json(const render_settings& s)
    {
        json all = json::object();
        for_each_setting([&](const auto& row) { all[row.name] = written(row.values, row.of(s)); });
        return all;
    }

    /// Those that scene files have.
    json settings_of_scene(const render_settings& s)
    {
        auto all = settings_json(s);
        for_each_setting([&](const auto& row) {
            if (row.use == in_scenes::never)
                all.erase(row.name);
        });
        return all;
    }

    /// A unique name for each material.
    std::vector<std::string> names_of(const std::vector<material>& materials)
    {
        std::vector<std::string> names;
        std::set<std::string> taken{"", "comment"};
        for (const auto& m : materials)
            taken.insert(m.name);
        std::set<std::string> used{"", "comment"};
        for (const auto& m : materials) {
            auto name = m.name;
            for (std::size_t n = names.size(); used.count(name) > 0; ++n)
                if (const auto numbered = "material " + std::to_string(n); taken.count(numbered) == 0)
                    name = numbered;
            used.insert(name);
            taken.insert(name);
            names.push_back(name);
        }
        return names;
    }

    /// `channel`: it is a number.
    json texture_json(const material& m, const texture_use& t, bool channel)
    {
        if (t.file.empty())
            throw std::invalid_argument("scene_text: material '" + m.name
                + "': its texture was not read from a file; write it to one, and set `file` to its name");
        json all = {{"file", t.file}};
        if (channel && t.channel != texture_channel::red)
            all["channel"] = texture_channel_names[static_cast<std::size_t>(t.channel)];
        if (t.wrap == texture_wrap::clamp)
            all["wrap"] = "clamp";
        if (t.scale != glm::dvec2(1))
            all["scale"] = {t.scale.x, t.scale.y};
        if (t.offset != glm::dvec2(0))
            all["offset"] = {t.offset.x, t.offset.y};
        return all;
    }

    /// `names`: of all materials.
    json material_json(const material& m, const std::vector<std::string>& names)
    {
        const auto& row = detail::entry_of(m.kind);
        json all = json::object();
        all["type"] = row.name;
        for (const auto& f : row.fields)
            std::visit(
                [&](auto member) {
                    const std::string_view key = f.key;
                    const bool is_rare = key == "opacity" || key == "absorption" || key == "priority";
                    if (!is_rare || m.*member != std::decay_t<decltype(m.*member)>(*f.if_absent))
                        all[f.key] = written(m.*member);
                },
                f.member);
        if (has_energy(row) && m.energy != facet_bounces::multiple)
            all["energy"] = facet_bounces_names[static_cast<std::size_t>(m.energy)];
        if (is_mixture(m))
            all["materials"] = {names.at(m.parts[0]), names.at(m.parts[1])};
        for (const auto& [key, member] : detail::number_textures)
            if ((m.*member).map)
                all[key] = texture_json(m, m.*member, true);
        if (m.texture.map)
            all["texture"] = texture_json(m, m.texture, false);
        return all;
    }
} // namespace

std::string settings_text(const render_settings& s) { return settings_json(s).dump(); }

std::string scene_text(const scene& s, const render_settings& settings)
{
    const auto names = names_of(s.materials);
    json materials = json::object(), shapes = json::array(), lights = json::array();
    for (std::size_t i = 0; i < names.size(); ++i)
        materials[names[i]] = material_json(s.materials[i], names);
    const auto with_fields = [](json object, const auto& part, const auto& fields) {
        for_each_field(fields, [&](const auto& f) { object[f.name] = written(part.*f.member); });
        return object;
    };
    for_each_shape(s, [&](const auto& list, auto kind) {
        for (const auto& x : list) {
            auto shape = with_fields({{"type", kind.name}}, x, kind.fields);
            shape["material"] = names.at(x.material);
            shapes.push_back(std::move(shape));
        }
    });
    for (const auto& m : s.meshes) {
        json shape = {{"type", shape_kind<placed_mesh>::name}};
        add_surface(shape, m);
        shape["material"] = names.at(m.material);
        shapes.push_back(std::move(shape));
    }
    for_each_light(s, [&](const auto& list, auto kind) {
        for (const auto& x : list) {
            lights.push_back(with_fields({{"type", kind.name}, {"name", x.name}}, x, kind.fields));
            if constexpr (requires { x.surface; })
                add_surface(lights.back(), x.surface);
            if constexpr (requires { x.map; })
                add_map(lights.back(), x);
        }
    });
    for (auto& light : lights)
        if (light["name"] == "")
            light.erase("name");
    json all
        = {{"photongrid", 1}, {"name", s.name.empty() ? "scene" : s.name}, {"units", {{"length", "m"}, {"power", "W"}}},
            {"camera",
                {{"position", three(s.camera.position)}, {"look_at", three(s.camera.look_at)},
                    {"up", three(s.camera.up)}, {"vertical_fov", s.camera.vertical_fov}}},
            {"materials", materials}, {"shapes", shapes}, {"lights", lights}, {"render", settings_of_scene(settings)}};
    if (s.paper)
        all["as_paper"] = settings_of_scene(*s.paper);
    return all.dump(2) + "\n";
}

} // namespace photongrid
