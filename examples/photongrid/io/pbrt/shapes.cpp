#include <photongrid/io/import/tessellation.hpp>
#include <photongrid/io/pbrt/shapes.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace photongrid::pbrt {

namespace {
    constexpr double full_turn = 2 * std::numbers::pi;

    /// Turns triangles so that they face as the normals of their corners do, or all around if `reversed` and there are
    /// none. Returns whether that changed anything.
    bool orient(mesh& m, bool reversed)
    {
        bool changed = reversed;
        if (reversed)
            for (auto& n : m.normals)
                n = -n;
        for (auto& t : m.triangles) {
            bool turn = reversed;
            if (!m.normals.empty()) {
                const glm::dvec3 a(m.positions[t.x]), b(m.positions[t.y]), c(m.positions[t.z]);
                const auto mean = glm::dvec3(m.normals[t.x]) + glm::dvec3(m.normals[t.y]) + glm::dvec3(m.normals[t.z]);
                turn = glm::dot(glm::cross(b - a, c - a), mean) < 0;
            }
            if (turn)
                std::swap(t.y, t.z);
            changed = changed || turn;
        }
        return changed;
    }

    template <class Vector>
    std::vector<Vector> vectors_of(const std::vector<double>& numbers)
    {
        constexpr auto n = static_cast<std::size_t>(Vector::length());
        std::vector<Vector> all(numbers.size() / n);
        for (std::size_t i = 0; i < all.size(); ++i)
            for (std::size_t c = 0; c < n; ++c)
                all[i][static_cast<int>(c)] = static_cast<typename Vector::value_type>(numbers[i * n + c]);
        return all;
    }

    std::vector<std::uint32_t> indices_of(const shape_entity& s, std::size_t together, std::size_t vertices)
    {
        const auto numbers = s.parameters.numbers("indices", {"integer"}, together);
        std::vector<std::uint32_t> all;
        all.reserve(numbers.size());
        for (const double d : numbers) {
            if (!(d >= 0 && d < static_cast<double>(vertices) && d == std::floor(d)))
                fail_at(s.parameters.find("indices")->place,
                    "found the index " + std::to_string(static_cast<long long>(d)) + "; there are "
                        + std::to_string(vertices) + " vertices");
            all.push_back(static_cast<std::uint32_t>(d));
        }
        return all;
    }

    /// Positions, normals and texture coordinates.
    mesh vertices_of(const shape_entity& s)
    {
        const auto& p = s.parameters;
        mesh m;
        set_positions(m, vectors_of<glm::dvec3>(p.numbers("P", {"point3", "point"}, 3)));
        m.normals = vectors_of<glm::vec3>(p.numbers("N", {"normal", "normal3"}, 3));
        const char* coordinates = p.find("st") != nullptr ? "st" : "uv";
        m.texture_coordinates = vectors_of<glm::vec2>(p.numbers(coordinates, {"point2", "float", "vector2"}, 2));
        p.find("S"); // tangents and faces' numbers matter to what is not drawn here
        p.find("faceIndices");
        if (m.positions.empty())
            fail_at(s.place, "the shape lacks \"point3 P\", its vertices");
        const auto require_as_many = [&](const char* name, std::size_t size) {
            if (size != 0 && size != m.positions.size())
                fail_at(s.place,
                    std::string(name) + ": there are " + std::to_string(size) + " of them and "
                        + std::to_string(m.positions.size()) + " positions; expected one for each, or none");
        };
        require_as_many("N", m.normals.size());
        require_as_many(coordinates, m.texture_coordinates.size());
        return m;
    }
} // namespace

mesh shape_reader::triangle_mesh(const shape_entity& s) const
{
    auto m = vertices_of(s);
    auto indices = indices_of(s, 3, m.positions.size());
    if (s.parameters.find("indices") == nullptr) {
        if (m.positions.size() != 3)
            fail_at(s.place, "the shape lacks \"integer indices\", which only a single triangle may");
        indices = {0, 1, 2};
    }
    for (std::size_t i = 0; i < indices.size(); i += 3)
        m.triangles.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
    return m;
}

mesh shape_reader::bilinear_mesh(const shape_entity& s)
{
    const auto corners = vertices_of(s);
    auto indices = indices_of(s, 4, corners.positions.size());
    if (s.parameters.find("indices") == nullptr) {
        if (corners.positions.size() != 4)
            fail_at(s.place, "the shape lacks \"integer indices\", which only a single patch may");
        indices = {0, 1, 2, 3};
    }
    mesh made;
    made.origin = corners.origin;
    for (std::size_t i = 0; i < indices.size(); i += 4) {
        const auto corner = [&](const auto& all, std::size_t n) { return all[indices[i + n]]; };
        const std::array<glm::dvec3, 4> p{corner(corners.positions, 0), corner(corners.positions, 1),
            corner(corners.positions, 2), corner(corners.positions, 3)};
        const double twist = glm::length(p[0] + p[3] - p[1] - p[2]),
                     size = std::max(glm::length(p[3] - p[0]), glm::length(p[2] - p[1]));
        const unsigned parts = twist <= 1e-6 * size ? 1 : 16;
        const auto blend = [](const auto& a, const auto& b, const auto& c, const auto& d, double u, double v) {
            return (1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * c + u * d);
        };
        auto patch = tessellated(
            parts, parts, [&](double u, double v) { return blend(p[0], p[1], p[2], p[3], u, v); }, nullptr);
        const auto each = [&](const auto& of, auto& to) {
            if (of.empty())
                return;
            using vector = std::decay_t<decltype(of[0])>;
            to.clear();
            for (const auto& at : patch.texture_coordinates) {
                const auto wide = [&](std::size_t n) { return glm::vec<vector::length(), double>(of[indices[i + n]]); };
                to.push_back(vector(blend(wide(0), wide(1), wide(2), wide(3), double(at.x), double(at.y))));
            }
        };
        each(corners.normals, patch.normals);
        if (!corners.texture_coordinates.empty()) {
            std::vector<glm::vec2> coordinates;
            each(corners.texture_coordinates, coordinates);
            patch.texture_coordinates = std::move(coordinates);
        }
        count(s, patch);
        const auto first = static_cast<std::uint32_t>(made.positions.size());
        made.positions.insert(made.positions.end(), patch.positions.begin(), patch.positions.end());
        made.normals.insert(made.normals.end(), patch.normals.begin(), patch.normals.end());
        made.texture_coordinates.insert(
            made.texture_coordinates.end(), patch.texture_coordinates.begin(), patch.texture_coordinates.end());
        for (const auto& t : patch.triangles)
            made.triangles.push_back(t + first);
    }
    return made;
}

shape_surface shape_reader::file_mesh(const shape_entity& s)
{
    const auto* file = s.parameters.find("filename");
    const auto name = s.parameters.text("filename", "");
    if (file == nullptr)
        fail_at(s.place, "the shape lacks \"string filename\"");
    auto& known = files_[{name, s.reverse_orientation}];
    if (!known.surface) {
        try {
            known.surface = builder_.files().surface(name);
            known.file = name;
        } catch (const file_error& e) {
            fail_at(file->place, e.what());
        } catch (const scene_error& e) {
            fail_at(file->place, e.what());
        }
        auto turned = *known.surface;
        if (orient(turned, s.reverse_orientation))
            known = {std::make_shared<const mesh>(std::move(turned))};
    }
    return known;
}

void shape_reader::count(const shape_entity& s, const mesh& m)
{
    triangles_ += m.triangles.size();
    if (triangles_ > std::size_t{1} << 25)
        fail_at(s.place, "round shapes and patches take more than 2^25 triangles so far");
}

shape_surface shape_reader::round(const shape_entity& s)
{
    const auto& p = s.parameters;
    const double angle = std::clamp(p.number("phimax", 360), 0.0, 360.0);
    const double turn = angle == 360 ? full_turn : glm::radians(angle), radius = p.number("radius", 1);
    if (!(radius > 0) || turn == 0)
        fail_at(s.place, "the shape has no extent: a radius or an angle that is not above 0");
    const auto cut = [&](mesh m, const char* what) -> shape_surface {
        builder_.note(s.place, std::string(what) + ": drawn as " + std::to_string(m.triangles.size()) + " triangles");
        count(s, m);
        orient(m, s.reverse_orientation);
        return {std::make_shared<const mesh>(std::move(m))};
    };
    if (s.type == "disk") {
        const double height = p.number("height", 0), inner = p.number("innerradius", 0);
        if (inner > 0 || turn != full_turn)
            return cut(disk_mesh(height, radius, inner, turn), "a part of a disk");
        return {nullptr, "", {round_shape::kind::disk, radius, height, height}};
    }
    const bool is_sphere = s.type == "sphere";
    double low = p.number("zmin", is_sphere ? -radius : -1), high = p.number("zmax", is_sphere ? radius : 1);
    if (low > high)
        std::swap(low, high);
    if (!(high > low))
        fail_at(s.place, "the shape has no extent: zmin is zmax");
    if (is_sphere && (low > -radius || high < radius || turn != full_turn))
        return cut(sphere_mesh(radius, low, high, turn), "a part of a sphere");
    if (!is_sphere && turn != full_turn)
        return cut(cylinder_mesh(radius, low, high, turn), "a part of a cylinder");
    return {nullptr, "", {is_sphere ? round_shape::kind::sphere : round_shape::kind::cylinder, radius, low, high}};
}

std::shared_ptr<const mesh> shape_reader::triangles_of(const shape_entity& s, const round_shape& r)
{
    auto m = r.is == round_shape::kind::sphere ? sphere_mesh(r.radius, -r.radius, r.radius, full_turn)
        : r.is == round_shape::kind::cylinder  ? cylinder_mesh(r.radius, r.low, r.high, full_turn)
                                               : disk_mesh(r.low, r.radius, 0, full_turn);
    count(s, m);
    orient(m, s.reverse_orientation);
    return std::make_shared<const mesh>(std::move(m));
}

std::shared_ptr<const mesh> shape_reader::with_coordinates(const mesh& m)
{
    return std::make_shared<const mesh>(
        with_corner_coordinates(m, {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1)}));
}

shape_surface shape_reader::surface_of(const shape_entity& s)
{
    if (s.type == "plymesh")
        return file_mesh(s);
    if (s.type == "sphere" || s.type == "disk" || s.type == "cylinder")
        return round(s);
    mesh m;
    if (s.type == "trianglemesh" || s.type == "loopsubdiv")
        m = triangle_mesh(s);
    else if (s.type == "bilinearmesh")
        m = bilinear_mesh(s);
    else {
        builder_.note(s.place, "shape " + shown_word(s.type) + ": is left out");
        return {};
    }
    if (s.type == "loopsubdiv") {
        s.parameters.find("levels");
        builder_.note(s.place, "a subdivision surface: its control mesh is drawn, as it is");
    }
    if (m.triangles.empty()) {
        builder_.note(s.place, "a shape without triangles is left out");
        return {};
    }
    orient(m, s.reverse_orientation);
    return {std::make_shared<const mesh>(std::move(m))};
}

} // namespace photongrid::pbrt
