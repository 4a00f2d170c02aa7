#include <photongrid/io/import/checked_parts.hpp>
#include <photongrid/io/import/scene_builder.hpp>

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace photongrid {

namespace {
    constexpr double pi = std::numbers::pi;
    constexpr double max_emission = 1e15; // as in scene files: squares must be finite

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
        made.origin = m.origin;
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
} // namespace

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
    detail::add_checked(place, list, std::move(light));
}

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
    surface = drawable(place, std::move(surface));
    if (surface == nullptr)
        return;
    if (e.two_sided) {
        bounds box;
        for (const auto& p : surface->positions)
            box.add(dvec3(p));
        // So far apart that rays from one side do not start behind the other.
        surface = both_sides(*surface, 0x1p-12 * glm::length(box.high - box.low));
    }
    if (auto flat = flattened(place, *surface, to_scene)) {
        if (!flat->triangles.empty())
            add_emitter(place, std::move(flat), glm::dmat4(glm::inverse(glm::dmat3(world_))), {e.radiance, false});
        return;
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
    const double r = radius * detail::even_scale(at.linear);
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
    if (detail::even_scale(turn) == 0)
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
    detail::check_at(place, l, "environment: ");
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

} // namespace photongrid
