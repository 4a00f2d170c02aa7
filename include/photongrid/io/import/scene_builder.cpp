#include <photongrid/io/import/scene_builder.hpp>
#include <photongrid/io/whole_file.hpp>

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace photongrid {

namespace {
    constexpr double pi = std::numbers::pi;
    constexpr double max_length = 1e9, max_emission = 1e15; // as in scene files: squares must be finite

    bool is_finite(const glm::dmat4& m)
    {
        return detail::finite(dvec3(m[0])) && detail::finite(dvec3(m[1])) && detail::finite(dvec3(m[2]))
            && detail::finite(dvec3(m[3]));
    }

    /// The factor by which a matrix scales all lengths alike, or 0.
    double even_scale(const glm::dmat3& m)
    {
        const double x = glm::length(m[0]), y = glm::length(m[1]), z = glm::length(m[2]);
        constexpr double most = 1e-6;
        const bool even = std::abs(x - y) <= most * x && std::abs(x - z) <= most * x
            && std::abs(glm::dot(m[0], m[1])) <= most * x * y && std::abs(glm::dot(m[0], m[2])) <= most * x * z
            && std::abs(glm::dot(m[1], m[2])) <= most * y * z;
        return even ? x : 0;
    }

    /// The rectangle of two triangles, counterclockwise as seen from outside, if they are one.
    std::optional<rectangle_light> as_rectangle(const placed_mesh& m)
    {
        if (m.surface->triangles.size() != 2)
            return std::nullopt;
        const auto first = corners_of(m, 0), second = corners_of(m, 1);
        // The corner of the second that the first does not have. It is opposite to one of the first.
        for (const auto& fourth : second) {
            if (std::find(first.begin(), first.end(), fourth) != first.end())
                continue;
            for (std::size_t i = 0; i < 3; ++i) {
                const dvec3 corner = first[i], u = first[(i + 1) % 3] - corner, v = first[(i + 2) % 3] - corner;
                const double least = std::min(glm::length(u), glm::length(v));
                if (!(least > 0) || std::abs(glm::dot(u, v)) > 1e-6 * glm::length(u) * glm::length(v)
                    || glm::length(corner + u + v - fourth) > 1e-6 * least)
                    continue;
                // Both face the same way.
                if (glm::dot(glm::cross(u, v), glm::cross(second[1] - second[0], second[2] - second[0])) <= 0)
                    return std::nullopt;
                // It begins at the first vertex of the surface, where its file begins, too.
                const std::array<dvec3, 4> around{corner, corner + u, fourth, corner + v};
                const auto begin = static_cast<std::size_t>(
                    std::find(around.begin(), around.end(), place_of(m, m.surface->positions[0])) - around.begin());
                if (begin == around.size())
                    return rectangle_light{.name = "", .corner = corner, .edge_u = u, .edge_v = v};
                return rectangle_light{.name = "",
                    .corner = around[begin],
                    .edge_u = around[(begin + 1) % 4] - around[begin],
                    .edge_v = around[(begin + 3) % 4] - around[begin]};
            }
        }
        return std::nullopt;
    }

    /// The surface twice, back to back, with the given distance between both.
    std::shared_ptr<const mesh> both_sides(const mesh& m, double apart)
    {
        mesh made;
        for (const auto& t : m.triangles) {
            const auto c
                = std::array{glm::dvec3(m.positions[t.x]), glm::dvec3(m.positions[t.y]), glm::dvec3(m.positions[t.z])};
            const auto normal = glm::cross(c[1] - c[0], c[2] - c[0]);
            const double length = glm::length(normal);
            const auto offset = length > 0 ? normal * (apart / 2 / length) : glm::dvec3(0);
            const auto first = static_cast<std::uint32_t>(made.positions.size());
            for (const double sign : {1.0, -1.0})
                for (const auto& corner : c)
                    made.positions.emplace_back(corner + sign * offset);
            made.triangles.emplace_back(first, first + 1, first + 2);
            made.triangles.emplace_back(first + 3, first + 5, first + 4);
        }
        return std::make_shared<const mesh>(std::move(made));
    }

    /// Runs photongrid::check. Its message gets the place and begins with `of`.
    template <class Part>
    void check_at(const source_place& place, const Part& part, const std::string& of = "")
    {
        try {
            check(part);
        } catch (const std::invalid_argument& e) {
            fail_at(place, of + e.what());
        }
    }
} // namespace

scene_builder::scene_builder(const std::string& path, const import_settings& settings)
    : file_(path), settings_(settings), log_(settings.strict),
      files_(std::filesystem::path(path).parent_path(), settings.allow_outside)
{
    if (settings.unit && !(*settings.unit >= 1e-9 && *settings.unit <= 1e9))
        throw std::invalid_argument("import_settings: unit: must be from 1e-9 to 1e9 m");
    made_.name = printable(std::filesystem::path(path).stem().string(), 100);
    made_.render.map.grid = glm::uvec3(0);
    made_.render.map.builder = map_builder::automatic;
    set_unit(1);
}

void scene_builder::set_unit(double metres)
{
    unit_ = settings_.unit.value_or(metres);
    world_ = glm::dmat4(unit_);
    world_[3][3] = 1;
}

void scene_builder::set_camera(
    const source_place& place, const imported_camera& c, std::uint32_t width, std::uint32_t height)
{
    if (width < 1 || height < 1 || width > 16384 || height > 16384)
        fail_at(place,
            "the picture has " + std::to_string(width) + " x " + std::to_string(height)
                + " pixels; expected 1 to 16384 on each side");
    made_.render.output.width = width;
    made_.render.output.height = height;
    if (glm::dot(glm::cross(c.forward, c.up), c.right) < 0)
        world_[2][2] = -world_[2][2];
    auto& to = made_.camera;
    to.position = point(c.position);
    const double length = glm::length(direction(c.forward));
    if (!(length > 0) || !std::isfinite(length))
        fail_at(place, "the camera has no direction of view");
    to.look_at = to.position + direction(c.forward) / length * std::max(1.0, glm::length(to.position) * 1e-6);
    to.up = direction(c.up) / unit_;
    const double aspect = static_cast<double>(width) / height;
    const bool is_vertical = c.fov_axis == imported_camera::axis::vertical
        || (c.fov_axis == imported_camera::axis::smaller && height <= width)
        || (c.fov_axis == imported_camera::axis::larger && height > width);
    to.vertical_fov = is_vertical ? c.fov : glm::degrees(2 * std::atan(std::tan(glm::radians(c.fov) / 2) / aspect));
    check_at(place, to, "camera: ");
    has_camera_ = true;
}

// --- materials ---

std::uint32_t scene_builder::add_material(const source_place& place, material m)
{
    m.name = printable(m.name, 100);
    check_at(place, m, "material " + shown_word(m.name) + ": ");
    made_.materials.push_back(std::move(m));
    return static_cast<std::uint32_t>(made_.materials.size() - 1);
}

std::uint32_t scene_builder::add_mixture(
    const source_place& place, material m, std::uint32_t first, std::uint32_t second)
{
    m.kind = material_kind::mixture;
    m.parts = {first, second};
    try {
        check_parts(made_.materials, m);
    } catch (const std::invalid_argument& e) {
        const auto kept = m.share > 0.5 ? second : first;
        note(place,
            "material " + shown_word(m.name) + ": drawn as " + shown_word(made_.materials[kept].name)
                + " alone, since its materials do not mix (" + e.what() + ")");
        return kept;
    }
    return add_material(place, std::move(m));
}

std::uint32_t scene_builder::with_opacity(
    const source_place& place, std::uint32_t m, double opacity, const texture_use& texture)
{
    auto changed = made_.materials[m];
    changed.opacity *= opacity;
    if (texture.map)
        changed.opacity_texture = texture;
    const auto same = std::find(made_.materials.begin(), made_.materials.end(), changed);
    return same != made_.materials.end() ? static_cast<std::uint32_t>(same - made_.materials.begin())
                                         : add_material(place, std::move(changed));
}

std::optional<texture_use> scene_builder::texture(
    const source_place& place, const std::string& name, texture_holds holds)
{
    std::string path;
    try {
        path = files_.path_of(name);
    } catch (const file_error& e) {
        fail_at(place, e.what());
    }
    try {
        texture_use t;
        t.map = files_.texture(name, holds);
        t.file = name;
        return t;
    } catch (const file_error& e) {
        note(place, std::string("0.5 in the place of a texture: ") + e.what());
        return std::nullopt;
    }
}

template <class List, class Part>
void scene_builder::add_checked(const source_place& place, List& list, Part part)
{
    check_at(place, part);
    list.push_back(std::move(part));
}

template <class List, class Light>
void scene_builder::add_light(const source_place& place, List& list, Light light)
{
    dvec3 emission;
    if constexpr (requires { light.power; })
        emission = light.power;
    else if constexpr (requires { light.irradiance; })
        emission = light.irradiance;
    else
        emission = light.radiance;
    if (emission == dvec3(0)) {
        note(place, "a light that emits nothing is left out");
        return;
    }
    if (std::max({emission.x, emission.y, emission.z}) > max_emission)
        fail_at(place, "the light emits more than 1e15 W, W/m^2 or W/(m^2 sr)");
    add_checked(place, list, std::move(light));
}

// --- shapes ---

scene_builder::placing scene_builder::place_in_scene(const source_place& place, const glm::dmat4& to_scene) const
{
    const auto m = world_ * to_scene;
    if (!is_finite(m))
        fail_at(place, "the transformation of this shape is not finite");
    const bool is_affine = m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1;
    if (!is_affine)
        fail_at(place, "the transformation of this shape is no affine one: its last row is not 0 0 0 1");
    if (!(glm::length(dvec3(m[3])) <= max_length))
        fail_at(place, "this shape is moved by more than 1e9 m");
    return {glm::dmat3(m), dvec3(m[3])};
}

placed_mesh scene_builder::placed(const source_place& place, std::shared_ptr<const mesh> surface,
    const glm::dmat4& to_scene, const std::string& file) const
{
    const auto at = place_in_scene(place, to_scene);
    placed_mesh m{.file = file, .surface = std::move(surface), .linear = at.linear, .offset = at.offset};
    check_at(place, m);
    return m;
}

void scene_builder::add_mesh(const source_place& place, std::shared_ptr<const mesh> surface, const glm::dmat4& to_scene,
    std::uint32_t material, const std::string& file)
{
    auto m = placed(place, std::move(surface), to_scene, file);
    m.material = material;
    try {
        detail::check_material_of(m, made_.materials);
    } catch (const std::invalid_argument& e) {
        fail_at(place, e.what());
    }
    made_.meshes.push_back(std::move(m));
}

double scene_builder::round_scale(const placing& at, std::uint32_t material) const
{
    return is_clear(made_.materials[material]) || has_texture(material) ? 0 : even_scale(at.linear);
}

bool scene_builder::add_sphere(
    const source_place& place, double radius, const glm::dmat4& to_scene, std::uint32_t material)
{
    const auto at = place_in_scene(place, to_scene);
    const double scale = round_scale(at, material);
    if (scale == 0)
        return false;
    add_checked(place, made_.spheres, sphere{at.offset, radius * scale, material});
    sphere_places_.push_back(place);
    return true;
}

bool scene_builder::add_cylinder(const source_place& place, double radius, double low, double high,
    const glm::dmat4& to_scene, std::uint32_t material)
{
    const auto at = place_in_scene(place, to_scene);
    const double scale = round_scale(at, material);
    if (scale == 0)
        return false;
    add_checked(place, made_.cylinders,
        cylinder{at.offset + at.linear * dvec3(0, 0, low), at.offset + at.linear * dvec3(0, 0, high), radius * scale,
            material});
    return true;
}

bool scene_builder::add_disk(
    const source_place& place, double height, double radius, const glm::dmat4& to_scene, std::uint32_t material)
{
    const auto at = place_in_scene(place, to_scene);
    const double scale = round_scale(at, material);
    if (scale == 0)
        return false;
    add_checked(place, made_.disks,
        disk{at.offset + at.linear * dvec3(0, 0, height), at.linear[2] / scale, radius * scale, material});
    return true;
}

// --- lights ---

std::string scene_builder::next_light_name() { return "lamp " + std::to_string(++lights_); }

double scene_builder::area(const mesh& surface, const glm::dmat4& to_scene) const
{
    placed_mesh m{.file = "",
        .surface = std::shared_ptr<const mesh>(std::shared_ptr<void>(), &surface),
        .linear = glm::dmat3(to_scene),
        .offset = dvec3(to_scene[3])};
    return area_of(m);
}

void scene_builder::add_emitter(const source_place& place, std::shared_ptr<const mesh> surface,
    const glm::dmat4& to_scene, const imported_emission& e, const std::string& file)
{
    if (e.two_sided) {
        bounds box;
        for (const auto& p : surface->positions)
            box.add(dvec3(p));
        // So far apart that rays from one side do not start behind the other.
        surface = both_sides(*surface, 0x1p-12 * glm::length(box.high - box.low));
    }
    const auto m = placed(place, std::move(surface), to_scene, e.two_sided ? "" : file);
    const double size = area_of(m);
    if (!(size > 0)) {
        note(place, "a lamp without area is left out");
        return;
    }
    const dvec3 power = e.radiance * (size * pi);
    if (auto rectangle = as_rectangle(m)) {
        rectangle->name = next_light_name();
        rectangle->power = power;
        add_light(place, made_.rectangle_lights, std::move(*rectangle));
    } else {
        add_light(place, made_.mesh_lights, mesh_light{next_light_name(), m, power});
    }
}

bool scene_builder::add_sphere_light(
    const source_place& place, double radius, const glm::dmat4& to_scene, const imported_emission& e)
{
    const auto at = place_in_scene(place, to_scene);
    const double r = radius * even_scale(at.linear);
    if (r == 0 || e.two_sided)
        return false;
    add_light(
        place, made_.sphere_lights, sphere_light{next_light_name(), at.offset, r, e.radiance * (4 * pi * r * r * pi)});
    return true;
}

void scene_builder::add_point_light(const source_place& place, const dvec3& position, const dvec3& intensity)
{
    add_light(place, made_.point_lights,
        point_light{next_light_name(), point(position), intensity * (4 * pi * unit_ * unit_)});
}

void scene_builder::add_spot_light(const source_place& place, const dvec3& position, const dvec3& toward,
    double inner_angle, double outer_angle, const dvec3& intensity)
{
    const double even = detail::one_minus_cosine(inner_angle), lit = (even + detail::one_minus_cosine(outer_angle)) / 2;
    add_light(place, made_.spot_lights,
        spot_light{next_light_name(), point(position), direction(toward) / unit_, inner_angle, outer_angle,
            intensity * (2 * pi * lit * unit_ * unit_)});
}

void scene_builder::add_directional_light(const source_place& place, const dvec3& toward, const dvec3& irradiance)
{
    add_light(
        place, made_.directional_lights, directional_light{next_light_name(), direction(toward) / unit_, irradiance});
}

void scene_builder::add_sky(const source_place& place, const dvec3& radiance)
{
    if (!detail::finite(radiance) || radiance.x < 0 || radiance.y < 0 || radiance.z < 0)
        fail_at(place, "the radiance of the environment must be finite and not negative");
    sky_ += radiance;
    if (!sky_place_)
        sky_place_ = place;
}

void scene_builder::add_environment(const source_place& place, std::shared_ptr<const environment_map> map,
    const dvec3& radiance, const glm::dmat4& to_scene, const std::string& file)
{
    if (environment_) {
        note(place, "a second environment with a picture is left out; photongrid has one");
        return;
    }
    const auto at = place_in_scene(place, to_scene);
    glm::dmat3 turn = at.linear;
    for (int c = 0; c < 3; ++c)
        turn[c] = glm::normalize(turn[c]);
    if (even_scale(turn) == 0)
        fail_at(place, "the environment is skewed; it can only be turned and mirrored");
    environment_light l{.name = next_light_name(), .file = file, .map = std::move(map), .radiance = radiance};
    if (glm::determinant(turn) < 0) {
        auto mirrored = *l.map;
        for (std::uint32_t row = 0; row < mirrored.height; ++row) {
            const auto begin = mirrored.radiance.begin() + static_cast<std::ptrdiff_t>(row) * mirrored.width;
            std::reverse(begin, begin + mirrored.width);
        }
        l.map = std::make_shared<const environment_map>(std::move(mirrored));
        l.file.clear();
        turn[0] = -turn[0]; // x is the axis that the reversal of rows changes
    }
    const auto q = glm::quat_cast(turn);
    const dvec3 axis(q.x, q.y, q.z);
    if (glm::length(axis) > 1e-12) {
        l.axis = glm::normalize(axis);
        l.degrees = glm::degrees(2 * std::atan2(glm::length(axis), q.w));
    }
    check_at(place, l, "environment: ");
    environment_ = std::move(l);
    if (!sky_place_)
        sky_place_ = place;
}

void scene_builder::add_environment_light()
{
    if (environment_ && sky_ != dvec3(0)) { // one light has the sum of both
        auto sum = *environment_->map;
        for (auto& r : sum.radiance)
            r = glm::vec3(dvec3(r) * environment_->radiance + sky_);
        environment_->map = std::make_shared<const environment_map>(std::move(sum));
        environment_->file.clear();
        environment_->radiance = dvec3(1);
    }
    if (environment_)
        made_.environment_lights.push_back(*environment_);
    else if (sky_ != dvec3(0))
        add_light(*sky_place_, made_.environment_lights,
            environment_light{.name = next_light_name(), .file = "", .map = nullptr, .radiance = sky_});
}

// --- the whole ---

void scene_builder::add_default_camera()
{
    const auto b = bounds_of(made_);
    const dvec3 middle = 0.5 * (b.low + b.high);
    const double radius = std::max(0.5 * glm::length(b.high - b.low), 1e-6);
    auto& c = made_.camera;
    c.vertical_fov = 40;
    // All of a ball about the scene is in the picture.
    const double distance = radius / std::sin(glm::radians(c.vertical_fov) / 2);
    c.look_at = middle;
    c.position = middle + distance * glm::normalize(dvec3(0.4, 0.35, 1));
    log_.say(file_, "the file has no camera; one that sees the whole scene is added");
}

void scene_builder::choose_settings()
{
    const auto b = bounds_of(made_);
    auto& r = made_.render;
    r.map.photons = 100'000; // few of an open scene's paths end in one that is stored
    r.estimate.k = 100;
    r.estimate.max_radius = std::clamp(0.1 * glm::length(b.high - b.low), 1e-6, max_length);
    r.view.spp = 16;
    r.view.light_samples = 4;
}

imported_scene scene_builder::finish()
{
    if (count_shapes(made_) == 0)
        fail_at(file_, "the scene has no shape that can be drawn");
    add_environment_light();
    if (count_lights(made_) == 0) {
        made_.environment_lights.push_back({.name = "sky", .file = "", .map = nullptr, .radiance = dvec3(1)});
        log_.say(file_, "the file has no light; a white environment of radiance 1 is added");
    }
    if (!has_camera_)
        add_default_camera();
    choose_settings();
    if (!detail::has_matte_shape(made_))
        fail_at(file_, "nothing in the scene is diffuse, so that no photon can be stored and nothing can be lit");
    if (const auto pair = detail::overlapping_glass(made_)) {
        const auto& second = (*pair)[1];
        fail_at(second.list == shape_kind<sphere>::list ? sphere_places_[second.index] : file_,
            "this glass overlaps other glass; the outside of glass must be air");
    }
    check_at(file_, made_.camera);
    check_at(file_, made_.render);
    return {std::move(made_), log_.take()};
}

} // namespace photongrid
