#include <photongrid/io/import/tessellation.hpp>
#include <photongrid/io/mitsuba/serialized.hpp>
#include <photongrid/io/mitsuba/shapes.hpp>
#include <photongrid/io/mitsuba/xml_values.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace photongrid::mitsuba {

namespace {
    constexpr double full_turn = 2 * std::numbers::pi;

    /// Turns triangles so that they face as the normals of their corners do, which is what decides in Mitsuba; then
    /// all, if `is_reversed`. Returns whether that changed anything.
    bool face_outwards(mesh& m, bool is_reversed)
    {
        bool is_changed = is_reversed;
        for (auto& t : m.triangles) {
            if (m.normals.empty())
                break;
            const glm::dvec3 a(m.positions[t.x]), b(m.positions[t.y]), c(m.positions[t.z]);
            const auto sum = glm::dvec3(m.normals[t.x]) + glm::dvec3(m.normals[t.y]) + glm::dvec3(m.normals[t.z]);
            if (glm::dot(glm::cross(b - a, c - a), sum) < 0) {
                std::swap(t.y, t.z);
                is_changed = true;
            }
        }
        if (is_reversed) {
            for (auto& t : m.triangles)
                std::swap(t.y, t.z);
            for (auto& n : m.normals)
                n = -n;
        }
        return is_changed;
    }

    /// Normals of vertices as Mitsuba gives meshes that have none: those of triangles, weighted by their angles there
    /// (Thürmer and Wüthrich 1998, Computing Vertex Normals from Polygonal Facets).
    void add_smooth_normals(mesh& m)
    {
        std::vector<glm::dvec3> sums(m.positions.size(), glm::dvec3(0));
        for (const auto& t : m.triangles) {
            const std::array<glm::dvec3, 3> p{
                glm::dvec3(m.positions[t.x]), glm::dvec3(m.positions[t.y]), glm::dvec3(m.positions[t.z])};
            const auto n = glm::cross(p[1] - p[0], p[2] - p[0]);
            const double length = glm::length(n);
            if (!(length > 0) || !std::isfinite(length))
                continue;
            for (std::size_t k = 0; k < 3; ++k) {
                const auto a = p[(k + 1) % 3] - p[k], b = p[(k + 2) % 3] - p[k];
                const double angle = std::atan2(length, glm::dot(a, b));
                sums[t[static_cast<int>(k)]] += n / length * angle;
            }
        }
        m.normals.reserve(sums.size());
        for (const auto& s : sums) {
            const double length = glm::length(s);
            m.normals.emplace_back(length > 0 ? s / length : glm::dvec3(1, 0, 0));
        }
    }

    /// Texture coordinates of Mitsuba's meshes without any, (0, 0), (1, 0) and (0, 1) in each triangle; v reversed.
    constexpr std::array corner_coordinates{glm::vec2(0, 1), glm::vec2(1, 1), glm::vec2(0, 0)};

    std::shared_ptr<const mesh> shared(mesh m) { return std::make_shared<const mesh>(std::move(m)); }
} // namespace

mesh shape_reader::rectangle() const
{
    return {.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
        .triangles = {{0, 1, 2}, {0, 2, 3}},
        .texture_coordinates = {{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
}

mesh shape_reader::cube() const
{
    struct side {
        glm::vec3 normal, u, v; ///< u and v: the ways in which the texture coordinates grow
    };
    // Mitsuba's sides.
    constexpr std::array<side, 6> sides{side{{0, -1, 0}, {0, 0, 1}, {1, 0, 0}}, side{{0, 1, 0}, {-1, 0, 0}, {0, 0, -1}},
        side{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}, side{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}},
        side{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, side{{0, 0, -1}, {0, -1, 0}, {1, 0, 0}}};
    mesh made;
    for (const auto& s : sides) {
        const auto first = static_cast<std::uint32_t>(made.positions.size());
        for (const glm::vec2 at : {glm::vec2(0, 1), glm::vec2(1, 1), glm::vec2(1, 0), glm::vec2(0, 0)}) {
            made.positions.push_back(s.normal + (2 * at.x - 1) * s.u + (2 * at.y - 1) * s.v);
            made.normals.push_back(s.normal);
            made.texture_coordinates.emplace_back(at.x, 1 - at.y);
        }
        made.triangles.emplace_back(first, first + 1, first + 2);
        made.triangles.emplace_back(first + 3, first, first + 2);
    }
    return made;
}

mesh shape_reader::read_file(const object& o, const std::string& name, int index, bool* is_flat)
{
    if (o.type != "serialized")
        return *builder_.files().surface(name);
    if (serialized_name_ != name) {
        serialized_bytes_ = builder_.files().bytes_of(name);
        serialized_name_ = name;
    }
    auto made = parse_serialized(builder_.files().path_of(name), serialized_bytes_, static_cast<std::size_t>(index));
    *is_flat = *is_flat || made.has_face_normals;
    return std::move(made.surface);
}

shape_surface shape_reader::file_surface(const object& o, const surface_needs& needs)
{
    const auto* file = o.find("filename");
    const auto name = o.text("filename", "");
    if (file == nullptr)
        fail_at(o.place, o.said() + " lacks \"filename\"");
    const int index = o.type == "serialized" ? o.whole("shape_index", 0) : 0;
    if (index < 0)
        fail_at(o.place, o.said() + ": \"shape_index\" counts from 0");
    bool is_flat = o.truth("face_normals", false);
    const bool is_reversed = o.truth("flip_normals", false);
    // Mitsuba reverses v of OBJ files, but of no others unless it is told to, and has v = 0 at the top of a picture.
    const bool is_reversed_there = o.type != "serialized" && o.truth("flip_tex_coords", o.type == "obj");
    const bool reverse_v = needs.coordinates && !is_reversed_there;
    auto& known = files_[{name, index, is_flat, is_reversed, reverse_v, needs.colors, needs.coordinates}];
    if (known.surface)
        return known;
    try {
        auto m = read_file(o, name, index, &is_flat);
        known.file = o.type == "serialized" ? "" : name;
        if (!m.colors.empty() && !needs.colors) {
            m.colors.clear();
            known.file.clear();
        }
        const bool had_normals = !m.normals.empty();
        if (is_flat && had_normals) {
            m.normals.clear();
            known.file.clear();
        }
        if (face_outwards(m, is_reversed))
            known.file.clear();
        if (!is_flat && !had_normals) {
            add_smooth_normals(m);
            known.file.clear();
        }
        if (needs.coordinates && m.texture_coordinates.empty()) {
            m = with_corner_coordinates(m, corner_coordinates);
            known.file.clear();
        } else if (reverse_v) {
            for (auto& at : m.texture_coordinates)
                at.y = 1 - at.y;
            known.file.clear();
        }
        known.surface = known.file.empty() ? shared(std::move(m)) : builder_.files().surface(name);
    } catch (const file_error& e) {
        fail_at(file->place, e.what());
    } catch (const scene_error& e) {
        fail_at(file->place, e.what());
    }
    return known;
}

shape_surface shape_reader::round(const object& o) const
{
    round_shape r;
    r.radius = o.number("radius", 1);
    if (o.type == "disk") {
        r.is = round_shape::kind::disk;
        r.radius = 1;
    } else if (!(r.radius > 0)) {
        fail_at(o.place, o.said() + " has no extent: its radius is not above 0");
    } else if (o.type == "sphere") {
        r.is = round_shape::kind::sphere;
        r.to_shape[3] = glm::dvec4(o.vector("center").value_or(dvec3(0)), 1);
    } else {
        r.is = round_shape::kind::cylinder;
        const auto from = o.vector("p0").value_or(dvec3(0)), axis = o.vector("p1").value_or(dvec3(0, 0, 1)) - from;
        r.height = glm::length(axis);
        if (!(r.height > 0) || !std::isfinite(r.height))
            fail_at(o.place, o.said() + " has no extent: p0 is p1");
        const dvec3 z = axis / r.height, x = beside(z);
        r.to_shape
            = glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), glm::dvec4(from, 1));
    }
    return {nullptr, "", r};
}

std::shared_ptr<const mesh> shape_reader::triangles_of(const object& o, const round_shape& r)
{
    auto m = r.is == round_shape::kind::sphere ? sphere_mesh(r.radius, -r.radius, r.radius, full_turn)
        : r.is == round_shape::kind::cylinder  ? cylinder_mesh(r.radius, 0, r.height, full_turn)
                                               : disk_mesh(0, r.radius, 0, full_turn);
    triangles_ += m.triangles.size();
    if (triangles_ > std::size_t{1} << 25)
        fail_at(o.place, "round shapes take more than 2^25 triangles so far");
    // Of spheres v goes upwards here, downwards in Mitsuba; of disks Mitsuba's u goes outwards and v around.
    for (auto& at : m.texture_coordinates)
        if (r.is == round_shape::kind::cylinder)
            at.y = 1 - at.y;
        else if (r.is == round_shape::kind::disk)
            at = {1 - at.y, 1 - at.x};
    face_outwards(m, o.truth("flip_normals", false));
    return shared(std::move(m));
}

shape_surface shape_reader::surface_of(const object& o, const surface_needs& needs)
{
    o.find("silhouette_sampling_weight"); // how Mitsuba draws
    if (o.type == "obj" || o.type == "ply" || o.type == "serialized")
        return file_surface(o, needs);
    if (o.type == "sphere" || o.type == "disk" || o.type == "cylinder")
        return round(o);
    if (o.type == "rectangle" || o.type == "cube") {
        auto m = o.type == "cube" ? cube() : rectangle();
        face_outwards(m, o.truth("flip_normals", false));
        o.find("face_normals"); // they are anyway
        return {shared(std::move(m))};
    }
    builder_.note(o.place, o.said() + ": is left out");
    return {};
}

} // namespace photongrid::mitsuba
