// Surfaces that stand in several places and are stored once, on any backend: bit for bit the hits of a loop over all
// triangles of all places, about those of double precision, and the pictures of surfaces that are stored once for each
// place. Included by each on_<backend>.cpp.
#pragma once

#include "mesh_ray_tests.hpp"
#include "mesh_scene_tests.hpp"
#include "texture_scenes.hpp"

#include <photongrid/trace/instance_tree.hpp>

namespace photongrid::testing {

struct instance_set {
    std::vector<mesh> surfaces;
    std::vector<placement> placements;
};

/// The triangles of all places, in the places' order.
inline mesh flattened(const instance_set& s)
{
    mesh flat;
    for (const auto& p : s.placements) {
        const auto first = static_cast<uint>(flat.positions.size());
        for (const auto& v : s.surfaces[p.surface].positions)
            flat.positions.emplace_back(p.linear * dvec3(v) + p.offset);
        for (const auto& t : s.surfaces[p.surface].triangles)
            flat.triangles.push_back(t + first);
    }
    return flat;
}

/// A turn about a random axis, and scales from 1 to `most` along random others; mirrored where it says so.
inline glm::dmat3 random_linear(std::mt19937& bits, double most, bool mirrored)
{
    const auto u = [&] { return static_cast<double>(bits()) * 0x1p-32; };
    const auto turn = [&] {
        const dvec3 x = glm::normalize(dvec3(u() - 0.5, u() - 0.5, u() - 0.5)),
                    y = glm::normalize(glm::cross(x, dvec3(u() - 0.5, u() + 1, u() - 0.5)));
        return glm::dmat3(x, y, glm::cross(x, y));
    };
    glm::dmat3 scale(1);
    for (int axis = 0; axis < 3; ++axis)
        scale[axis][axis] = 1 + (most - 1) * u();
    if (mirrored)
        scale[0][0] = -scale[0][0];
    return turn() * scale * turn();
}

/// Two surfaces in `places` places about 0, the first of the second one as it is.
inline instance_set instances_about(const mesh& a, const mesh& b, std::size_t places, std::uint32_t seed)
{
    std::mt19937 bits(seed);
    const auto u = [&] { return static_cast<double>(bits()) * 0x1p-32; };
    instance_set s{{a, b}, {{.surface = 1, .is_in_place = true}}};
    while (s.placements.size() < places)
        s.placements.push_back({.surface = s.placements.size() % 2,
            .linear = random_linear(bits, 4, s.placements.size() % 3 == 2),
            .offset = 3.0 * dvec3(2 * u() - 1, 2 * u() - 1, 2 * u() - 1)});
    return s;
}

/// The closest hit by a test of each triangle in the space of its surface.
inline ray_hit hit_by_all(const instance_set& s, const glm::vec4& o, const glm::vec4& d)
{
    ray_hit hit{o.w, no_id};
    uint id = 0;
    for (const auto& p : s.placements) {
        const glm::dmat3 inverse = glm::inverse(p.linear);
        const glm::vec3 from = glm::vec3(o) - glm::vec3(p.offset);
        glm::vec4 local_o(0, 0, 0, o.w), local_d(0);
        for (int row = 0; row < 3; ++row) {
            const glm::vec3 r(inverse[0][row], inverse[1][row], inverse[2][row]);
            local_o[row] = kernels::dot3(r, from);
            local_d[row] = kernels::dot3(r, glm::vec3(d));
        }
        const auto& m = s.surfaces[p.surface];
        const auto found = hit_by_all(m, local_o, local_d);
        if (found.triangle != no_id && found.distance < hit.distance)
            hit = {found.distance, id + found.triangle};
        id += static_cast<uint>(m.triangles.size());
    }
    return hit;
}

template <class Tag>
class instances : public mesh_scenes<Tag> {
protected:
    using mesh_scenes<Tag>::traced;

    std::vector<ray_hit> traced(const instance_set& s, const ray_set& rays, const ray_search_settings& settings = {})
    {
        auto& b = this->b();
        const auto tree = upload_triangles(b, build_instance_tree(b, s.surfaces, s.placements));
        return trace_rays(b, tree, upload(b, rays.origins), upload(b, rays.directions), settings);
    }

    /// Of n rays inside of a closed surface, for each of eight placements; they are aimed at its edges and corners as
    /// these are in the scene.
    void expect_no_escape(std::size_t n)
    {
        std::mt19937 bits(3);
        for (int i = 0; i < 8; ++i) {
            instance_set s{{bumpy_ball(20, 1, 0.2f), bumpy_ball(5, 1, 0)}, {}};
            // The second one is too far away to be met.
            s.placements
                = {{.surface = 0, .linear = random_linear(bits, 1 + i, i % 2 == 1), .offset = dvec3(0, 0.001 * i, 0)},
                    {.surface = 1, .offset = {1000, 0, 0}}};
            const auto rays
                = rays_at(flattened({s.surfaces, {s.placements[0]}}), n, 0.5f, static_cast<std::uint32_t>(i));
            std::size_t escaped = 0;
            for (const auto& h : traced(s, rays))
                escaped += h.triangle >= s.surfaces[0].triangles.size() ? 1 : 0;
            EXPECT_EQ(escaped, 0u) << i << ", of " << n;
        }
    }
};
TYPED_TEST_SUITE_P(instances);

TYPED_TEST_P(instances, are_hit_as_a_loop_over_all_triangles_hits)
{
    if (!this->divides_exactly())
        GTEST_SKIP() << "this device's division rounds loosely";
    const auto ball = bumpy_ball(7, 1, 0.2f);
    for (const auto& [name, m, closed] : ray_meshes(200)) {
        if (name == "sizes that double" || m.triangles.empty())
            continue; // larger than rays go, or refused
        for (const std::size_t places : {1u, 2u, 3u, 20u}) {
            const auto s = instances_about(ball, m, places, static_cast<std::uint32_t>(places));
            const auto rays = rays_at(flattened(s), places < 20 ? 300 : 100, 4, 1, 3);
            const auto hits = this->traced(s, rays);
            for (std::size_t i = 0; i < hits.size(); ++i) {
                const auto expected = hit_by_all(s, rays.origins[i], rays.directions[i]);
                ASSERT_EQ(hits[i].triangle, expected.triangle) << name << ", " << places << " places, ray " << i;
                ASSERT_EQ(hits[i].distance, expected.distance) << name << ", " << places << " places, ray " << i;
            }
        }
    }
}

TYPED_TEST_P(instances, are_hit_where_double_precision_says)
{
    const auto s = instances_about(bumpy_ball(6, 1, 0.2f), bumpy_ball(4, 0.5f, 0), 8, 9);
    const auto flat = flattened(s);
    const auto rays = rays_at(flat, 2000, 5, 5);
    const auto hits = this->traced(s, rays);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < hits.size(); ++i)
        if (const auto expected = distance_in_double(flat, rays.origins[i], rays.directions[i])) {
            ++compared;
            ASSERT_EQ(std::isinf(hits[i].distance), std::isinf(*expected)) << "ray " << i;
            if (std::isfinite(*expected)) {
                ASSERT_NEAR(static_cast<double>(hits[i].distance) / *expected, 1, 1e-4) << "ray " << i;
            }
        }
    EXPECT_GT(compared, hits.size() / 4);
}

TYPED_TEST_P(instances, never_leave_a_closed_surface) { this->expect_no_escape(20000); }
TYPED_TEST_P(instances, long_never_leave_a_closed_surface) { this->expect_no_escape(1250000); }

/// Faces that lie in the sides of an instance's box, as far as rounding in the surface's space lets them.
TYPED_TEST_P(instances, flat_faces_are_hit_from_afar)
{
    std::mt19937 bits(8);
    const auto u = [&] { return static_cast<float>(bits() >> 8) * 0x1p-24f; };
    for (const double stretch : {1.0, 4.0, 30.0, 1e3, 1e4}) {
        const auto turn = random_linear(bits, 1, false);
        glm::dmat3 scale(1);
        scale[1][1] = stretch;
        const glm::dmat3 linear = turn * scale * glm::transpose(turn), back = glm::inverse(linear);
        mesh square; // of the face x = 1 of the scene, in the surface's space
        for (const float y : {-1.0f, 1.0f})
            for (const float z : {-1.0f, 1.0f})
                square.positions.emplace_back(back * dvec3(1, static_cast<double>(y), static_cast<double>(z)));
        square.triangles = {{0, 1, 2}, {1, 3, 2}};
        const instance_set s{{square}, {{.linear = linear, .offset = {0.3, -0.2, 0.7}}}};
        ray_set rays;
        for (int i = 0; i < 20000; ++i) {
            const glm::vec3 at(1.3f, -0.2f + 1.98f * u() - 0.99f, 0.7f + 1.98f * u() - 0.99f);
            const float far = i % 2 == 0 ? 3.0f : 15.0f;
            const glm::vec3 o = at + far * glm::normalize(glm::vec3(1, i % 3 == 0 ? 0 : u() - 0.5f, 0));
            rays.origins.emplace_back(o, std::numeric_limits<float>::infinity());
            rays.directions.emplace_back(at - o, 0.0f);
        }
        std::size_t missed = 0;
        for (const auto& h : this->traced(s, rays))
            missed += h.triangle == no_id ? 1 : 0;
        EXPECT_EQ(missed, 0u) << stretch;
    }
}

TYPED_TEST_P(instances, go_on_from_pass_to_pass_and_hit_anything)
{
    const auto s = instances_about(bumpy_ball(12, 1, 0.2f), bumpy_ball(8, 1, 0.1f), 30, 4);
    auto rays = rays_at(flattened(s), 300, 5, 2);
    for (std::size_t i = 0; i < rays.origins.size(); i += 2)
        rays.origins[i].w = 0.5f; // some end before
    const auto whole = this->traced(s, rays);
    EXPECT_EQ(this->traced(s, rays, {.steps_per_pass = 1}), whole);
    EXPECT_EQ(this->traced(s, rays, {.steps_per_pass = 7}), whole);
    std::size_t hits = 0;
    for (const uint steps : {1024u, 3u}) {
        const auto any = this->traced(s, rays, {.kind = hit_kind::any, .steps_per_pass = steps});
        for (std::size_t i = 0; i < any.size(); ++i) {
            ASSERT_EQ(any[i].triangle == no_id, whole[i].triangle == no_id) << "ray " << i;
            ASSERT_GE(any[i].distance, whole[i].distance) << "ray " << i;
            hits += any[i].triangle == no_id ? 0 : 1;
        }
    }
    EXPECT_GT(hits, 100u);
}

TYPED_TEST_P(instances, are_refused_where_they_have_no_place)
{
    const std::vector<mesh> surfaces{bumpy_ball(4, 1, 0)}, empty{mesh{}};
    const auto refused = [&](const std::vector<mesh>& of, const placement& p, const char* part) {
        try {
            (void)build_instance_tree(this->b(), of, std::vector{p});
            ADD_FAILURE() << "expected: " << part;
        } catch (const std::invalid_argument& e) {
            EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
        }
    };
    refused(surfaces, {.surface = 1}, "surface 1 is placed; there are 1");
    refused(surfaces, {.linear = glm::dmat3(0)}, "flat");
    refused(surfaces, {.linear = glm::dmat3(std::numeric_limits<double>::quiet_NaN())}, "not finite");
    refused(surfaces, {.offset = {1e19, 0, 0}}, "10^18");
    refused(surfaces, {.offset = {1, 0, 0}, .is_in_place = true}, "in place");
    refused(empty, {}, "no triangles");
}

/// A room with a glass ball, mirrored ones of glass and of textured plastic, a flat metal one and a matte one with
/// colours, all of one surface with normals, and a lamp.
inline scene room_of_instances()
{
    auto s = small_cornell();
    s.name = "room_of_instances";
    s.spheres.clear();
    auto ball = smooth_ball(18);
    for (const auto& p : ball.positions) {
        ball.texture_coordinates.emplace_back(3 * p.x + p.y, 2 * p.z);
        ball.colors.emplace_back(0.6f + 0.39f * p.x, 0.6f + 0.39f * p.y, 0.6f + 0.39f * p.z);
    }
    for (auto& n : ball.normals)
        n *= 3.0f;
    const auto surface = std::make_shared<const mesh>(ball);
    s.materials.push_back({"painted", material_kind::plastic, dvec3(0.9), 1.5, 0.4,
        {"", std::make_shared<const texture>(random_texture(4, 4, 2))}});
    s.materials.push_back({"brushed", material_kind::metal, {0.9, 0.7, 0.5}, 1.5, 0.3});
    const auto middle = 0.5 * (bounds_of(s).low + bounds_of(s).high);
    const auto at = [&](double x, double y, double z) { return middle + dvec3(x, y, z); };
    s.meshes.push_back({"", surface, glm::dmat3(0.17), at(0.2, -0.3, -0.1), 4});
    s.meshes.push_back({"", surface, glm::dmat3(-0.12, 0.03, 0, 0, 0.2, 0.02, 0.05, 0, 0.15), at(-0.2, -0.25, 0.1), 5});
    s.meshes.push_back({"", surface, glm::dmat3(0.1, 0, 0, 0, -0.1, 0, 0, 0, 0.1), at(-0.2, 0.2, -0.2), 4});
    s.meshes.push_back({"", surface, glm::dmat3(0.2, 0, 0, 0, 0.05, 0.02, 0, 0, 0.1), at(0, 0.1, 0), 6});
    s.meshes.push_back({"", surface, glm::dmat3(0.1, 0.1, 0, -0.1, 0.1, 0, 0, 0, 0.1), at(0.25, 0.2, 0.2), 0});
    return s;
}

/// The scene with a surface of its own for each mesh.
inline scene without_instances(scene s)
{
    for (auto& m : s.meshes)
        m.surface = std::make_shared<const mesh>(*m.surface);
    return s;
}

TYPED_TEST_P(instances, make_the_picture_of_surfaces_that_are_stored_for_each_place)
{
    const auto s = room_of_instances();
    const auto shared = lay_out(s), apart = lay_out(without_instances(s));
    EXPECT_NE(shared.features & has_instances, 0u);
    EXPECT_EQ(apart.features & has_instances, 0u);
    EXPECT_LT(shared.meshes.faces.size() * 3, apart.meshes.faces.size());
    const double error = relative_mse(this->picture(s), this->picture(without_instances(s)));
    std::printf("instances against surfaces stored apart: relMSE %.3g\n", error);
    EXPECT_LE(error, 2e-3); // photons that rounding sends elsewhere
}

/// Inside of a turned, stretched and sometimes mirrored instance, whatever the walls are of.
TYPED_TEST_P(instances, no_photon_leaves_a_closed_room)
{
    std::mt19937 bits(6);
    for (int i = 0; i < 6; ++i) {
        auto s = bumpy_room(3000, 1, dvec3(0));
        s.materials.push_back({"glossy", material_kind::plastic, dvec3(0.95), 1.5, i < 3 ? 0.0 : 0.4});
        s.materials.push_back({"steel", material_kind::metal, dvec3(0.95), 1.5, i < 3 ? 0.0 : 0.3});
        material both{"both", material_kind::mixture};
        both.parts = {0, 2};
        s.materials.push_back(both);
        s.meshes[0].linear = random_linear(bits, 3, i % 2 == 1);
        s.meshes[0].material = std::array{0u, 1u, 3u}[static_cast<std::size_t>(i) % 3];
        s.meshes.push_back(s.meshes[0]); // another place, so that the surface is stored for both
        s.meshes[1].offset = {20, 3, 1};
        ASSERT_NE(lay_out(s).features & has_instances, 0u);
        const auto p = this->traced(s);
        EXPECT_EQ(p.escaped, 0u) << i << ", of " << p.emitted << " paths";
        EXPECT_GT(p.diffuse_hits, 5 * p.emitted) << i;
        expect_an_exact_account(p, s.render.map.photons);
    }
}

TYPED_TEST_P(instances, equal_the_serial_backends)
{
    const auto s = room_of_instances();
    this->expect_serial(s, s.render);
}

REGISTER_TYPED_TEST_SUITE_P(instances, are_hit_as_a_loop_over_all_triangles_hits, are_hit_where_double_precision_says,
    never_leave_a_closed_surface, long_never_leave_a_closed_surface, flat_faces_are_hit_from_afar,
    go_on_from_pass_to_pass_and_hit_anything, are_refused_where_they_have_no_place,
    make_the_picture_of_surfaces_that_are_stored_for_each_place, no_photon_leaves_a_closed_room,
    equal_the_serial_backends);

} // namespace photongrid::testing
