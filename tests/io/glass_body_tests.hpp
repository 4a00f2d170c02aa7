// Meshes of glass that are open or inside out: what the reader of scenes makes of them.
#pragma once

#include <photongrid/io/import/glass_bodies.hpp>

#include <gtest/gtest.h>

namespace photongrid::testing {
namespace {

    /// A box from -size to size, of six quads that share no vertex, without those faces that are left out.
    mesh box_mesh(float size, bool inside_out = false, unsigned left_out = 0)
    {
        mesh m;
        for (int axis = 0; axis < 3; ++axis)
            for (const float side : {-size, size}) {
                if ((left_out >> (2 * axis + (side > 0 ? 1 : 0)) & 1u) != 0)
                    continue;
                const auto first = static_cast<unsigned>(m.positions.size());
                for (const auto& [u, v] : {std::pair{-size, -size}, {size, -size}, {size, size}, {-size, size}}) {
                    glm::vec3 p;
                    p[axis] = side;
                    p[(axis + 1) % 3] = u;
                    p[(axis + 2) % 3] = v;
                    m.positions.push_back(p);
                    m.normals.emplace_back(p);
                }
                const bool turned = (side < 0) != inside_out;
                for (const glm::uvec3 t : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)})
                    m.triangles.push_back(first + (turned ? glm::uvec3(t.x, t.z, t.y) : t));
            }
        return m;
    }
    constexpr unsigned all_but_top = 0x3Fu & ~(1u << 3);

    struct mended {
        imported_scene made;

        explicit mended(std::initializer_list<mesh> meshes, double pool = 0, bool as_it_is = false)
        {
            auto& s = made.scene;
            s.materials = {{"clear", material_kind::glass, dvec3(1), 1.5}, {"tile", material_kind::lambertian}};
            for (const auto& m : meshes)
                s.meshes.push_back({"", std::make_shared<const mesh>(m)});
            for (const double x : {-pool, pool})
                if (pool > 0) {
                    s.polygons.push_back({{{x, -2, -2}, {x, 2, -2}, {x, 2, 2}, {x, -2, 2}}, 1});
                    s.polygons.push_back({{{-2, -2, x}, {2, -2, x}, {2, 2, x}, {-2, 2, x}}, 1});
                }
            s.point_lights = {{"bulb", {0, 3, 0}, dvec3(1)}};
            mend_glass(made, "s.json", as_it_is);
        }
        const material& material_of(std::size_t i) const
        {
            return made.scene.materials.at(made.scene.meshes.at(i).material);
        }
        std::string notes() const
        {
            std::string all;
            for (const auto& n : made.notes)
                all += text_of(n) + '\n';
            return all;
        }
    };

    TEST(glass_bodies, the_volume_of_a_mesh_has_the_sign_of_its_winding)
    {
        EXPECT_NEAR(closure_of(box_mesh(0.5f)).volume, 1, 1e-12);
        EXPECT_NEAR(closure_of(box_mesh(0.5f, true)).volume, -1, 1e-12);
        EXPECT_EQ(closure_of(box_mesh(0.5f)).open_edges, 0u);
        const auto open = closure_of(box_mesh(0.5f, false, 1));
        EXPECT_EQ(open.open_edges, 4u);
        EXPECT_NEAR(open.open_share, 1.0 / 5, 1e-12);
        auto mixed = box_mesh(0.5f);
        std::swap(mixed.triangles[3].x, mixed.triangles[3].y);
        EXPECT_EQ(closure_of(mixed).open_edges, 6u); // its own, and those of its neighbours
    }

    TEST(glass_bodies, closed_ones_stay_as_they_are)
    {
        const mended m({box_mesh(1), box_mesh(0.5f, true)}); // hollow
        EXPECT_EQ(m.notes(), "");
        EXPECT_EQ(*m.made.scene.meshes[0].surface, box_mesh(1));
        EXPECT_EQ(*m.made.scene.meshes[1].surface, box_mesh(0.5f, true));
    }

    TEST(glass_bodies, those_that_are_inside_out_are_turned)
    {
        const mended m({box_mesh(1, true)});
        EXPECT_NE(m.notes().find("s.json: note: meshes[0] of glass \"clear\" is inside out; its triangles are turned"),
            std::string::npos)
            << m.notes();
        const auto& turned = *m.made.scene.meshes[0].surface;
        EXPECT_NEAR(closure_of(turned).volume, 8, 1e-12);
        EXPECT_EQ(turned.normals[0], -box_mesh(1).normals[0]);
        EXPECT_EQ(m.material_of(0).kind, material_kind::glass);
        const mended meant({box_mesh(1, true)}, 0, true);
        EXPECT_NE(meant.notes().find("inside out"), std::string::npos);
        EXPECT_EQ(*meant.made.scene.meshes[0].surface, box_mesh(1, true));
    }

    TEST(glass_bodies, sheets_become_panes_unless_shapes_hold_them)
    {
        const auto sheet = box_mesh(1, false, all_but_top);
        const mended pane({sheet, sheet});
        EXPECT_EQ(pane.material_of(0).kind, material_kind::thin_glass);
        EXPECT_EQ(pane.material_of(0).name, "clear (pane)");
        EXPECT_EQ(pane.made.scene.meshes[1].material, pane.made.scene.meshes[0].material);
        EXPECT_NE(pane.notes().find("is open; it is drawn as a pane"), std::string::npos) << pane.notes();
        EXPECT_NO_THROW(check(pane.made.scene));
        for (const double wall : {1.0, 0.999, 1.005}) {
            const mended water({sheet}, wall);
            EXPECT_EQ(water.material_of(0).kind, material_kind::glass) << wall;
            EXPECT_NE(water.notes().find("as water in a pool"), std::string::npos) << water.notes();
        }
        EXPECT_EQ(mended({sheet}, 1.2).material_of(0).kind, material_kind::thin_glass);
        EXPECT_EQ(mended({sheet}, 0, true).material_of(0).kind, material_kind::glass);
        const mended tumbler({box_mesh(1, false, 1u << 3)});
        EXPECT_EQ(tumbler.material_of(0).kind, material_kind::thin_glass);
    }

} // namespace
} // namespace photongrid::testing
