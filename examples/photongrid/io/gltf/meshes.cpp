#include <photongrid/io/gltf/accessors.hpp>
#include <photongrid/io/gltf/meshes.hpp>

#include <glm/common.hpp>

#include <algorithm>
#include <string>

namespace photongrid::gltf {

namespace {
    /// The ways in which vertices make primitives.
    enum mode : std::size_t { triangles = 4, triangle_strip = 5, triangle_fan = 6 };

    void require_as_many(const part& p, const char* attribute, std::size_t found, std::size_t positions)
    {
        if (found != positions)
            p.fail(std::string(attribute) + " has " + std::to_string(found) + " elements and POSITION "
                + std::to_string(positions) + "; expected as many");
    }
} // namespace

std::shared_ptr<const mesh> mesh_reader::surface_of(
    std::size_t mesh_index, std::size_t primitive, const coordinate_use& coordinates, const mesh_pose& pose)
{
    const auto m = all_.element("meshes", mesh_index);
    const auto p = m.items("primitives")[primitive];
    std::vector<double> weights;
    for (const auto& w : m.items("weights"))
        weights.push_back(w.as_number(-1e6, 1e6));
    if (!pose.joints.empty() || (!pose.weights.empty() && pose.weights != weights))
        return made(mesh_index, p, coordinates, pose.weights.empty() ? weights : pose.weights, pose.joints);
    const auto [known, is_new] = made_.try_emplace({mesh_index, primitive});
    if (is_new)
        known->second = made(mesh_index, p, coordinates, weights, {});
    return known->second;
}

std::shared_ptr<const mesh> mesh_reader::made(std::size_t mesh_index, const part& p, const coordinate_use& coordinates,
    const std::vector<double>& weights, const std::vector<glm::dmat4>& joints)
{
    const auto name = all_.name_of("mesh", "meshes", mesh_index);
    const auto kind = p.whole("mode", 6).value_or(triangles);
    if (kind < triangles) {
        all_.builder().note(p.place(), name + ": its points or lines are left out");
        return nullptr;
    }
    const auto attributes = p.object("attributes");
    const auto positions = attributes ? attributes->index("POSITION", "accessors") : std::nullopt;
    if (!positions) {
        all_.builder().note(p.place(), name + ": a primitive without positions is left out");
        return nullptr;
    }
    for (const auto* compressed : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"})
        if (p.extension(compressed) && !all_.element("accessors", *positions).has("bufferView"))
            p.fail(
                name + ": is compressed (" + compressed + "), which photongrid does not read; export it uncompressed");
    mesh m{.positions = triples(all_, *positions), .triangles = {}};
    if (const auto normals = attributes->index("NORMAL", "accessors")) {
        m.normals = triples(all_, *normals);
        require_as_many(p, "NORMAL", m.normals.size(), m.positions.size());
    }
    m.triangles = triangles_of(p, m.positions.size());
    if (m.triangles.empty()) {
        all_.builder().note(p.place(), name + ": a primitive without triangles is left out");
        return nullptr;
    }
    add_colors(*attributes, m);
    add_coordinates(p, *attributes, coordinates, m);
    morph(p, weights, m);
    if (!joints.empty())
        pose_by_skin(*attributes, joints, m);
    return std::make_shared<const mesh>(std::move(m));
}

std::vector<glm::uvec3> mesh_reader::triangles_of(const part& p, std::size_t vertices)
{
    std::vector<std::uint32_t> corners;
    if (const auto given = p.index("indices", "accessors")) {
        corners = indices(all_, *given);
        for (const auto c : corners)
            if (c >= vertices)
                p.at("indices").fail(
                    "found the index " + std::to_string(c) + "; there are " + std::to_string(vertices) + " vertices");
    } else {
        corners.resize(vertices);
        for (std::size_t v = 0; v < vertices; ++v)
            corners[v] = static_cast<std::uint32_t>(v);
    }
    const auto kind = p.whole("mode", 6).value_or(triangles);
    std::vector<glm::uvec3> made;
    if (kind == triangles) {
        if (corners.size() % 3 != 0)
            all_.builder().note(p.place(),
                "the last " + std::to_string(corners.size() % 3) + " of " + std::to_string(corners.size())
                    + " indices make no triangle, and are left out");
        made.reserve(corners.size() / 3);
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
            made.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
        return made;
    }
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) { // glTF 2.0, 3.7.2.1
        if (kind == triangle_fan)
            made.emplace_back(corners[i + 1], corners[i + 2], corners[0]);
        else
            made.emplace_back(corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]);
    }
    return made;
}

void mesh_reader::add_colors(const part& attributes, mesh& m)
{
    const auto given = attributes.index("COLOR_0", "accessors");
    if (!given)
        return;
    const auto colors = quadruples(all_, *given);
    require_as_many(attributes, "COLOR_0", colors.size(), m.positions.size());
    bool is_limited = false, is_clear = false;
    m.colors.reserve(colors.size());
    for (const auto& c : colors) {
        const glm::vec3 rgb(c);
        m.colors.push_back(glm::clamp(rgb, 0.0f, 1.0f)); // NaN is replaced with the vertices' other numbers
        is_limited = is_limited || m.colors.back() != rgb;
        is_clear = is_clear || c.w != 1;
    }
    if (is_limited)
        all_.builder().note(attributes.place(), "colours of vertices are limited to 0 to 1");
    if (is_clear)
        all_.builder().note(attributes.place(), "the opacity of vertices is left out");
}

void mesh_reader::add_coordinates(const part& p, const part& attributes, const coordinate_use& coordinates, mesh& m)
{
    if (!coordinates.is_used)
        return;
    const auto name = "TEXCOORD_" + std::to_string(coordinates.set);
    const auto given = attributes.index(name, "accessors");
    if (!given) {
        all_.builder().note(p.place(), "there is no " + name + " for the material's textures; (0, 0) is used");
        m.texture_coordinates.assign(m.positions.size(), glm::vec2(0, 1));
        return;
    }
    m.texture_coordinates = pairs(all_, *given);
    require_as_many(attributes, name.c_str(), m.texture_coordinates.size(), m.positions.size());
    const bool is_moved = coordinates.transform != glm::dmat3(1);
    for (auto& t : m.texture_coordinates) {
        if (is_moved)
            t = glm::vec2(coordinates.transform * dvec3(t.x, t.y, 1));
        t.y = 1 - t.y; // downwards in the file, upwards here
    }
}

void mesh_reader::morph(const part& p, const std::vector<double>& weights, mesh& m)
{
    const auto targets = p.items("targets");
    for (std::size_t n = 0; n < targets.size() && n < weights.size(); ++n) {
        if (weights[n] == 0)
            continue;
        const auto add = [&](const char* attribute, std::vector<glm::vec3>& to) {
            const auto given = targets[n].index(attribute, "accessors");
            if (!given || to.empty())
                return;
            const auto more = triples(all_, *given);
            require_as_many(targets[n], attribute, more.size(), to.size());
            for (std::size_t v = 0; v < to.size(); ++v)
                to[v] += static_cast<float>(weights[n]) * more[v];
        };
        add("POSITION", m.positions);
        add("NORMAL", m.normals);
    }
}

void mesh_reader::pose_by_skin(const part& attributes, const std::vector<glm::dmat4>& matrices, mesh& m)
{
    const auto count = m.positions.size();
    std::vector<glm::dmat4> sums(count, glm::dmat4(0));
    std::vector<double> totals(count, 0);
    for (std::size_t set = 0; set < 16; ++set) {
        const auto number = std::to_string(set);
        const auto of = attributes.index("JOINTS_" + number, "accessors"),
                   by = attributes.index("WEIGHTS_" + number, "accessors");
        if (!of || !by)
            break;
        const auto which = joints(all_, *of);
        const auto weights = quadruples(all_, *by);
        require_as_many(attributes, ("JOINTS_" + number).c_str(), which.size(), count);
        require_as_many(attributes, ("WEIGHTS_" + number).c_str(), weights.size(), count);
        for (std::size_t v = 0; v < count; ++v)
            for (int c = 0; c < 4; ++c) {
                if (weights[v][c] == 0)
                    continue;
                if (which[v][c] >= matrices.size())
                    attributes.fail("found the joint " + std::to_string(which[v][c]) + "; the skin has "
                        + std::to_string(matrices.size()));
                sums[v] += matrices[which[v][c]] * static_cast<double>(weights[v][c]);
                totals[v] += static_cast<double>(weights[v][c]);
            }
    }
    for (std::size_t v = 0; v < count; ++v) {
        if (!(totals[v] > 0))
            attributes.fail("vertex " + std::to_string(v) + " has no joint with a weight above 0");
        const auto turned = sums[v] / totals[v];
        m.positions[v] = glm::vec3(turned * glm::dvec4(dvec3(m.positions[v]), 1));
        if (!m.normals.empty())
            m.normals[v] = glm::vec3(glm::dmat3(turned) * dvec3(m.normals[v]));
    }
}

} // namespace photongrid::gltf
