#include <photongrid/io/import/checked_parts.hpp>
#include <photongrid/io/import/default_view.hpp>
#include <photongrid/io/import/mended_mesh.hpp>
#include <photongrid/io/import/scene_builder.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace photongrid {

namespace {
    constexpr double max_length = 1e9; // as in scene files: squares must be finite

    bool is_finite(const glm::dmat4& m)
    {
        return detail::finite(dvec3(m[0])) && detail::finite(dvec3(m[1])) && detail::finite(dvec3(m[2]))
            && detail::finite(dvec3(m[3]));
    }
} // namespace

scene_builder::scene_builder(const std::string& path, const import_settings& settings)
    : file_(path), settings_(settings), log_(settings.strict),
      files_(std::filesystem::path(path).parent_path(), settings.allow_outside, file_reading_of(settings, log_))
{
    if (settings.unit && !(*settings.unit >= 1e-9 && *settings.unit <= 1e9))
        throw std::invalid_argument("import_settings: unit: must be from 1e-9 to 1e9 m");
    made_.name = printable(std::filesystem::path(path).stem().string(), 100);
    made_.render = automatic_settings();
    set_unit(1);
}

void scene_builder::set_unit(double metres)
{
    unit_ = settings_.unit.value_or(metres);
    world_ = glm::dmat4(unit_);
    if (settings_.z_up) {
        world_[1] = {0, 0, -unit_, 0};
        world_[2] = {0, unit_, 0, 0};
    }
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
        for (int column = 0; column < 3; ++column)
            world_[column][2] = -world_[column][2];
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
    detail::check_at(place, to, "camera: ");
    has_camera_ = true;
}

// --- materials ---

std::uint32_t scene_builder::add_material(const source_place& place, material m)
{
    m.name = printable(m.name, 100);
    detail::check_at(place, m, "material " + shown_word(m.name) + ": ");
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
    return add_once(place, std::move(changed));
}

std::uint32_t scene_builder::as_body(const source_place& place, std::uint32_t m)
{
    auto changed = made_.materials[m];
    if (changed.kind == material_kind::thin_glass)
        changed.kind = material_kind::glass;
    else if (is_mixture(changed))
        for (auto& part : changed.parts)
            part = as_body(place, part);
    if (changed == made_.materials[m])
        return m;
    changed.name = (changed.name + " (body)").substr(0, 100);
    return add_once(place, std::move(changed));
}

std::uint32_t scene_builder::add_medium(const source_place& place, const std::string& name, const dvec3& absorbed)
{
    material m{.name = name};
    m.kind = material_kind::glass;
    m.reflectance = dvec3(1);
    m.priority = 0;
    m.index_of_refraction = 1;
    m.absorption = absorbed / unit_;
    return add_once(place, std::move(m));
}

std::uint32_t scene_builder::with_absorption(const source_place& place, std::uint32_t m, const dvec3& absorbed)
{
    if (made_.materials[m].kind != material_kind::glass)
        return m;
    auto changed = made_.materials[m];
    changed.absorption = absorbed / unit_;
    return add_once(place, std::move(changed));
}

std::uint32_t scene_builder::add_once(const source_place& place, material m)
{
    const auto same = std::find(made_.materials.begin(), made_.materials.end(), m);
    return same != made_.materials.end() ? static_cast<std::uint32_t>(same - made_.materials.begin())
                                         : add_material(place, std::move(m));
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

placed_mesh scene_builder::placed(
    const source_place& place, std::shared_ptr<const mesh> surface, const glm::dmat4& to_scene, const std::string& file)
{
    const auto at = place_in_scene(place, to_scene);
    placed_mesh m{.file = file, .surface = std::move(surface), .linear = at.linear, .offset = at.offset};
    detail::check_at(place, m);
    // Vertices that a file has in single precision.
    const auto& s = *m.surface;
    glm::vec3 low = s.positions[0], high = low;
    for (const auto& p : s.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const auto largest = [](const glm::vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
    const double far = static_cast<double>(std::max(largest(low), largest(high))),
                 extent = static_cast<double>(largest(high - low));
    if (far > 0 && 256 * detail::single_step(far) > extent)
        log_.add(place,
            "vertices " + detail::text_of(far) + " from 0 are in single precision, in steps of "
                + detail::text_of(detail::single_step(far)) + ": write them in double, or closer to 0");
    return m;
}

std::shared_ptr<const mesh> scene_builder::flattened(
    const source_place& place, const mesh& surface, const glm::dmat4& to_scene)
{
    const auto at = place_in_scene(place, to_scene);
    const auto& l = at.linear;
    if (std::abs(glm::determinant(l)) > 1e-12 * glm::length(l[0]) * glm::length(l[1]) * glm::length(l[2]))
        return nullptr;
    auto made = surface;
    std::vector<dvec3> places;
    for (const auto& p : surface.positions)
        places.push_back(at.offset + l * (surface.origin + dvec3(p)));
    set_positions(made, places);
    made.normals.clear();
    double size = 0;
    for (const auto& p : places)
        size = std::max(size, glm::length(p - places[0]));
    std::erase_if(made.triangles, [&](const glm::uvec3& t) {
        const auto a = places[t.y] - places[t.x], b = places[t.z] - places[t.x];
        return !(glm::length(glm::cross(a, b)) > 1e-12 * size * size);
    });
    note(place,
        made.triangles.empty() ? "a scale of 0 leaves nothing of this shape: it is not drawn"
                               : "a scale of 0 makes this shape flat: drawn without its normals");
    return std::make_shared<const mesh>(std::move(made));
}

std::shared_ptr<const mesh> scene_builder::drawable(const source_place& place, std::shared_ptr<const mesh> surface)
{
    if (const auto known = mended_.find(surface); known != mended_.end())
        return known->second;
    std::string said;
    auto made = mended(surface, said);
    if (!said.empty())
        note(place, said);
    if (made->triangles.empty())
        made = nullptr;
    mended_.emplace(std::move(surface), made); // sound ones, too: many places may have the same
    return made;
}

void scene_builder::add_mesh(const source_place& place, std::shared_ptr<const mesh> surface, const glm::dmat4& to_scene,
    std::uint32_t material, const std::string& file)
{
    surface = drawable(place, std::move(surface));
    if (surface == nullptr)
        return;
    if (auto flat = flattened(place, *surface, to_scene)) {
        if (!flat->triangles.empty())
            add_mesh(place, std::move(flat), glm::dmat4(glm::inverse(glm::dmat3(world_))), material);
        return;
    }
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
    const bool only_meshes = is_clear(made_.materials[material]) || has_texture(material)
        || detail::any_part(
            made_.materials, made_.materials[material], [](const auto& m) { return is_smooth_pane(m); });
    return only_meshes ? 0 : detail::even_scale(at.linear);
}

bool scene_builder::add_sphere(
    const source_place& place, double radius, const glm::dmat4& to_scene, std::uint32_t material)
{
    const auto at = place_in_scene(place, to_scene);
    const double scale = round_scale(at, material);
    if (scale == 0)
        return false;
    detail::add_checked(place, made_.spheres, sphere{at.offset, radius * scale, material});
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
    detail::add_checked(place, made_.cylinders,
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
    detail::add_checked(place, made_.disks,
        disk{at.offset + at.linear * dvec3(0, 0, height), at.linear[2] / scale, radius * scale, material});
    return true;
}

// --- the whole ---

void scene_builder::add_default_camera()
{
    const auto chosen = default_camera(made_);
    made_.camera = chosen.view;
    log_.say(file_,
        chosen.is_inside ? "the file has no camera, and no light gets out of the scene; one in its corner is added"
                         : "the file has no camera; one that sees the whole scene is added");
}

void scene_builder::note_flat_along_z()
{
    const auto ending = ending_of(*file_.file);
    const auto b = bounds_of(made_);
    const dvec3 size = b.high - b.low;
    if (!settings_.z_up && (ending == ".obj" || ending == ".ply") && size.z > 0
        && 2 * size.z < std::min(size.x, size.y))
        log_.say(file_, "the scene is flat along z; if z is up in it, --z-up turns it");
}

imported_scene scene_builder::finish()
{
    if (!has_surfaces(made_))
        fail_at(file_, "the scene has no shape that can be drawn");
    add_environment_light();
    if (count_lights(made_) == 0 && settings_.environment.empty()) {
        made_.environment_lights.push_back({.name = "sky",
            .file = "",
            .map = std::make_shared<const environment_map>(default_sky()),
            .radiance = dvec3(1)});
        log_.say(file_, "the file has no light; a sky with a soft bright patch is added");
    }
    if (!has_camera_ && settings_.camera_from.empty()) {
        add_default_camera();
        note_flat_along_z();
    }
    if (depth_) // of eye rays and of photons: together they may have more
        made_.render.view.depth = made_.render.map.photon_depth = *depth_;
    if (const auto bad = detail::unresolved_in(detail::extent_of(made_)))
        fail_at(bad->place.list == shape_kind<sphere>::list ? sphere_places_[bad->place.index] : file_,
            bad->place.text() + ": " + bad->what);
    if (const auto pair = detail::overlapping_glass(made_)) {
        const auto& second = (*pair)[1];
        fail_at(second.list == shape_kind<sphere>::list ? sphere_places_[second.index] : file_,
            "this body overlaps another one of the same glass");
    }
    if (settings_.camera_from.empty())
        detail::check_at(file_, made_.camera);
    detail::check_at(file_, made_.render);
    return {std::move(made_), log_.take()};
}

} // namespace photongrid
