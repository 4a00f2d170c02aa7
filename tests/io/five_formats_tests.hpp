// One scene in five formats: the same records for the device, byte for byte. The texts are put together here, each as
// its format's specification has it.
#pragma once

#include "import_tests.hpp"

#include <photongrid/trace/device_scene.hpp>

#include <cstring>
#include <numbers>
#include <sstream>
#include <type_traits>

namespace photongrid {
namespace {

    /// A Cornell box of rectangles: one surface for each of three colours, and a lamp.
    class cornell_box_files {
    public:
        struct surface {
            const char* name;
            dvec3 colour;
            std::vector<glm::vec3> positions; ///< four for each rectangle, counterclockwise as seen from the room
        };
        std::vector<surface> surfaces{{"white", dvec3(0.725, 0.71, 0.68), {}}, {"red", dvec3(0.63, 0.065, 0.05), {}},
            {"green", dvec3(0.14, 0.45, 0.091), {}}};
        std::vector<glm::vec3> lamp{
            {2.13f, 5.487f, -2.27f}, {3.43f, 5.487f, -2.27f}, {3.43f, 5.487f, -3.32f}, {2.13f, 5.487f, -3.32f}};
        static constexpr double radiance = 15;
        const dvec3 eye{2.78, 2.73, 8}, target{2.78, 2.73, 0};
        static constexpr double fov = 39.5; ///< vertical

        cornell_box_files()
        {
            std::swap(lamp[1], lamp[3]); // it faces down
            const float w = 5.528f, h = 5.488f, d = -5.592f;
            auto& white = surfaces[0].positions;
            add(white, {0, 0, 0}, {w, 0, 0}, {0, 0, d}); // floor
            add(white, {0, h, 0}, {0, 0, d}, {w, 0, 0}); // ceiling
            add(white, {0, 0, d}, {w, 0, 0}, {0, h, 0}); // back
            add_block(white, {1.3f, 0, -0.65f}, {1.58f, 0, -0.49f}, 1.65f);
            add_block(white, {2.65f, 0, -2.96f}, {1.58f, 0, 0.49f}, 3.3f);
            add(surfaces[1].positions, {0, 0, 0}, {0, 0, d}, {0, h, 0}); // left
            add(surfaces[2].positions, {w, 0, 0}, {0, h, 0}, {0, 0, d}); // right
        }

        std::string json() const
        {
            std::string shapes, materials;
            for (const auto& s : surfaces) {
                shapes += comma(shapes) + R"({"type": "mesh", "material": ")" + s.name + R"(", "positions": )"
                    + list(s.positions, "[", ", ", "]") + R"(, "triangles": )" + triangles(s, "[", ", ", "]") + "}";
                materials += comma(materials) + '"' + s.name + R"(": {"type": "lambertian", "reflectance": )" + "["
                    + text(s.colour, ", ") + "]}";
            }
            const dvec3 corner(lamp[0]), u = dvec3(lamp[1]) - corner, v = dvec3(lamp[3]) - corner;
            const double power = radiance * (glm::length(glm::cross(u, v)) * std::numbers::pi);
            return R"({"photongrid": 1, "units": {"length": "m", "power": "W"}, "camera": {"position": [)"
                + text(eye, ", ") + R"(], "look_at": [)" + text(target, ", ") + R"(], "vertical_fov": )" + text(fov)
                + R"(}, "materials": {)" + materials + R"(}, "shapes": [)" + shapes
                + R"(], "lights": [{"type": "rectangle", "corner": [)" + text(corner, ", ") + R"(], "edge_u": [)"
                + text(u, ", ") + R"(], "edge_v": [)" + text(v, ", ") + R"(], "power": )" + text(power)
                + R"(}], "render": {"size": [8, 8], "photons": 10, "k": 2, "max_radius": 1}})";
        }

        std::string pbrt() const
        {
            std::string all = "Scale -1 1 1\nLookAt " + text(eye, " ") + " " + text(target, " ")
                + " 0 1 0\nCamera \"perspective\" \"float fov\" " + text(fov) + "\nWorldBegin\n";
            const auto shape = [](const surface& s) {
                return "Shape \"trianglemesh\" \"point3 P\" [" + list(s.positions, "", " ", "")
                    + "] \"integer indices\" [" + triangles(s, "", " ", "") + "]\n";
            };
            for (const auto& s : surfaces)
                all += "Material \"diffuse\" \"rgb reflectance\" [" + text(s.colour, " ") + "]\n" + shape(s);
            return all + "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\nAreaLightSource \"diffuse\" \"rgb L\" ["
                + text(dvec3(radiance), " ") + "]\n" + shape({"lamp", dvec3(0), lamp});
        }

        /// It names OBJ files of the surfaces.
        std::string mitsuba() const
        {
            std::string all = R"(<scene version="3.0.0"><sensor type="perspective"><string name="fov_axis" value="y"/>)"
                              R"(<float name="fov" value=")"
                + text(fov) + R"("/><transform name="to_world"><lookat origin=")" + text(eye, ", ") + R"(" target=")"
                + text(target, ", ") + R"(" up="0, 1, 0"/></transform></sensor>)";
            for (const auto& s : surfaces)
                all += R"(<shape type="obj"><string name="filename" value=")" + std::string(s.name)
                    + R"(.obj"/><boolean name="face_normals" value="true"/><bsdf type="diffuse">)"
                    + R"(<rgb name="reflectance" value=")" + text(s.colour, ", ") + R"("/></bsdf></shape>)";
            return all + R"(<shape type="obj"><string name="filename" value="lamp.obj"/><bsdf type="diffuse">)"
                + R"(<rgb name="reflectance" value="0"/></bsdf><emitter type="area"><rgb name="radiance" value=")"
                + text(radiance) + R"("/></emitter></shape></scene>)";
        }

        std::string gltf(std::string& buffer) const
        {
            std::string views, accessors, meshes, nodes, materials;
            const auto add_view = [&](const auto& data) {
                views += comma(views) + R"({"buffer": 0, "byteOffset": )" + std::to_string(buffer.size())
                    + R"(, "byteLength": )" + std::to_string(data.size() * sizeof data[0]) + "}";
                buffer.append(reinterpret_cast<const char*>(data.data()), data.size() * sizeof data[0]);
            };
            std::size_t n = 0;
            const auto add_surface = [&](const surface& s, const std::string& material) {
                add_view(s.positions);
                const auto corners = triangles_of(s);
                add_view(corners);
                accessors += comma(accessors) + R"({"componentType": 5126, "type": "VEC3", "count": )"
                    + std::to_string(s.positions.size()) + R"(, "bufferView": )" + std::to_string(2 * n)
                    + R"(}, {"componentType": 5125, "type": "SCALAR", "count": )" + std::to_string(3 * corners.size())
                    + R"(, "bufferView": )" + std::to_string(2 * n + 1) + "}";
                const auto number = std::to_string(n);
                meshes += comma(meshes) + R"({"primitives": [{"attributes": {"POSITION": )" + std::to_string(2 * n)
                    + R"(}, "indices": )" + std::to_string(2 * n + 1) + R"(, "material": )" + number + "}]}";
                nodes += comma(nodes) + R"({"mesh": )" + number + "}";
                materials += comma(materials) + material;
                ++n;
            };
            const auto matte = [](const std::string& name, const dvec3& colour, const std::string& more) {
                return R"({"name": ")" + name
                    + R"(", "pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [)" + text(colour, ", ")
                    + R"(, 1]}, "extensions": {"KHR_materials_specular": {"specularFactor": 0})" + more + "}";
            };
            for (const auto& s : surfaces)
                add_surface(s, matte(s.name, s.colour, "}"));
            add_surface({"lamp", dvec3(0), lamp},
                matte("lamp", dvec3(0),
                    R"(, "KHR_materials_emissive_strength": {"emissiveStrength": )" + text(radiance * 683)
                        + R"(}}, "emissiveFactor": [1, 1, 1])"));
            const dvec3 away = eye - target; // the camera looks along -z
            EXPECT_EQ(away, dvec3(0, 0, away.z));
            return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3, 4]}], "nodes": [)"
                + nodes + R"(, {"camera": 0, "translation": [)" + text(eye, ", ")
                + R"(]}], "cameras": [{"type": "perspective", "perspective": {"znear": 0.1, "yfov": )"
                + text(glm::radians(fov)) + R"(}}], "meshes": [)" + meshes + R"(], "materials": [)" + materials
                + R"(], "accessors": [)" + accessors + R"(], "bufferViews": [)" + views
                + R"(], "buffers": [{"uri": "box.bin", "byteLength": )" + std::to_string(buffer.size()) + "}]}";
        }

        std::string obj(std::string& mtl) const
        {
            std::string all = "mtllib box.mtl\n";
            std::size_t before = 0;
            const auto add_surface = [&](const surface& s) {
                all += "usemtl " + std::string(s.name) + "\n" + obj_of(s, before);
                before += s.positions.size();
            };
            for (const auto& s : surfaces) {
                mtl += "newmtl " + std::string(s.name) + "\nKd " + text(s.colour, " ") + "\n";
                add_surface(s);
            }
            mtl += "newmtl lamp\nKd 0 0 0\nKe " + text(dvec3(radiance), " ") + "\n";
            add_surface({"lamp", dvec3(0), lamp});
            return all;
        }

        static std::string obj_of(const surface& s, std::size_t before = 0)
        {
            std::string all;
            for (const auto& p : s.positions)
                all += "v " + text(dvec3(p), " ") + "\n";
            for (const auto& t : triangles_of(s))
                all += "f " + std::to_string(before + t.x + 1) + " " + std::to_string(before + t.y + 1) + " "
                    + std::to_string(before + t.z + 1) + "\n";
            return all;
        }

    private:
        static void add(std::vector<glm::vec3>& to, glm::vec3 corner, glm::vec3 u, glm::vec3 v)
        {
            to.insert(to.end(), {corner, corner + u, corner + u + v, corner + v});
        }
        static void add_block(std::vector<glm::vec3>& to, glm::vec3 corner, glm::vec3 u, float height)
        {
            const glm::vec3 v(u.z, 0, -u.x), up(0, height, 0);
            add(to, corner + up, u, v);
            add(to, corner, u, up);
            add(to, corner + u, v, up);
            add(to, corner + u + v, -u, up);
            add(to, corner + v, -v, up);
        }
        static std::vector<glm::uvec3> triangles_of(const surface& s)
        {
            std::vector<glm::uvec3> all;
            for (std::uint32_t i = 0; i < s.positions.size(); i += 4)
                all.insert(all.end(), {{i, i + 1, i + 2}, {i, i + 2, i + 3}});
            return all;
        }

        static std::string comma(const std::string& before) { return before.empty() ? "" : ", "; }
        static std::string text(double v)
        {
            std::ostringstream all;
            all.precision(17);
            all << v;
            return all.str();
        }
        static std::string text(const dvec3& v, const char* between)
        {
            return text(v.x) + between + text(v.y) + between + text(v.z);
        }
        static std::string list(
            const std::vector<glm::vec3>& all, const char* open, const char* between, const char* close)
        {
            std::string made;
            for (const auto& p : all)
                made += (made.empty() ? "" : between) + (open + text(dvec3(p), between)) + close;
            return *open == '\0' ? made : "[" + made + "]";
        }
        static std::string triangles(const surface& s, const char* open, const char* between, const char* close)
        {
            std::vector<glm::vec3> corners;
            for (const auto& t : triangles_of(s))
                corners.emplace_back(t);
            return list(corners, open, between, close);
        }
    };

    /// What a device gets of a scene, as bytes.
    std::string device_bytes(const scene_layout& r)
    {
        std::string all;
        const auto add = [&](const auto& list) {
            all.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof list[0]);
        };
        add(r.records);
        add(r.meshes.triangles.positions);
        add(r.meshes.triangles.triangles);
        add(r.meshes.faces);
        add(r.meshes.planes);
        add(r.meshes.shares);
        add(r.meshes.normals);
        add(r.meshes.attributes);
        add(r.meshes.texels);
        return all;
    }

    TEST_F(import_folder, a_cornell_box_has_the_same_records_from_five_formats)
    {
        const cornell_box_files box;
        std::string buffer, mtl;
        write("box.json", box.json());
        write("box.pbrt", box.pbrt());
        write("box.xml", box.mitsuba());
        for (const auto& s : box.surfaces)
            write(s.name + std::string(".obj"), box.obj_of(s));
        write("lamp.obj", box.obj_of({"lamp", dvec3(0), box.lamp}));
        write("box.gltf", box.gltf(buffer));
        write("box.bin", buffer);
        write("box.obj", box.obj(mtl));
        write("box.mtl", mtl);
        const auto expected = import_scene((folder / "box.json").string()).scene;
        ASSERT_EQ(expected.meshes.size(), 3u);
        ASSERT_EQ(expected.rectangle_lights.size(), 1u);
        const auto bytes = device_bytes(lay_out(expected));
        for (const auto* name : {"box.pbrt", "box.xml", "box.gltf", "box.obj"}) {
            const auto made = import_scene((folder / name).string());
            EXPECT_EQ(made.scene.meshes.size(), 3u) << name;
            EXPECT_EQ(device_bytes(lay_out(made.scene)), bytes) << name;
            if (name == std::string("box.obj"))
                continue; // it has no camera
            for (const auto& n : made.notes)
                ADD_FAILURE() << name << ": " << text_of(n);
            expect_near(made.scene.camera.position, expected.camera.position);
            for (const double x : {-1.0, 1.0})
                for (const double y : {-1.0, 1.0}) {
                    auto square = made.scene; // pictures of all formats are not as large
                    square.render.output = expected.render.output;
                    expect_near(view_direction(square, x, y), view_direction(expected, x, y), 1e-9);
                }
        }
    }

    // The repository's own scenes of these formats (examples/scenes/make_table.py).
    TEST(formats, examples_are_the_same_scene_in_each)
    {
        for (const std::string name : {"table", "room"}) {
            const auto read = [&](const char* ending) {
                auto made = import_scene(scenes + "/" + name + ending).scene;
                EXPECT_EQ(made.environment_lights.size(),
                    name == "room" && ending != std::string(".gltf") && ending != std::string(".obj") ? 1u : 0u);
                made.environment_lights.clear(); // which glTF and OBJ do not have
                return made;
            };
            const auto expected = read(".pbrt");
            EXPECT_GE(expected.meshes.size(), 4u);
            for (const auto* ending : {".xml", ".gltf", ".obj"}) {
                auto made = read(ending);
                for (auto& m : made.materials)
                    if (has_energy(detail::entry_of(m.kind)) && is_rough(m))
                        m.energy = facet_bounces::single; // as pbrt's is
                ASSERT_EQ(made.meshes.size(), expected.meshes.size()) << name << ending;
                for (std::size_t i = 0; i < made.meshes.size(); ++i) {
                    const auto &a = *made.meshes[i].surface, &b = *expected.meshes[i].surface;
                    ASSERT_EQ(a.triangles.size(), b.triangles.size()) << name << ending << i;
                    const auto at_corners = [](const mesh& m, const auto& list) { // OBJ files number vertices anew
                        std::vector<typename std::decay_t<decltype(list)>::value_type> all;
                        if (!list.empty())
                            for (const auto& t : m.triangles)
                                all.insert(all.end(), {list[t.x], list[t.y], list[t.z]});
                        return all;
                    };
                    EXPECT_EQ(at_corners(a, a.positions), at_corners(b, b.positions)) << name << ending << i;
                    EXPECT_EQ(at_corners(a, a.normals), at_corners(b, b.normals)) << name << ending << i;
                    const auto place = at_corners(a, a.texture_coordinates),
                               wanted = at_corners(b, b.texture_coordinates);
                    ASSERT_EQ(place.size(), wanted.size()) << name << ending << i;
                    for (std::size_t v = 0; v < place.size(); ++v)
                        EXPECT_LT(glm::length(place[v] - wanted[v]), 1e-6f) << name << ending << i;
                }
                EXPECT_EQ(lay_out(made).records, lay_out(expected).records) << name << ending;
            }
        }
    }

} // namespace
} // namespace photongrid
