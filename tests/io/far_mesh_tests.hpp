// Meshes that are far from 0, as surveys have them: every format keeps their shape, and so do files that are written.
#pragma once

#include "import_tests.hpp"

#include <photongrid/io/mitsuba_file.hpp>
#include <photongrid/io/obj_scene.hpp>
#include <photongrid/io/pbrt_file.hpp>
#include <photongrid/io/ply_file.hpp>
#include <photongrid/io/ply_writer.hpp>
#include <photongrid/io/scene_export.hpp>

#include <algorithm>
#include <sstream>

namespace photongrid {
namespace {

    /// A square of 0.1 m whose first corner is at `at`; `before`, `between`, `after` its numbers.
    std::string square_at(const dvec3& at, const char* before, const char* between, const char* after)
    {
        std::ostringstream all;
        all.precision(17);
        for (const auto& p : {dvec3(0, 0, 0), dvec3(0.1, 0, 0), dvec3(0.1, 0.1, 0), dvec3(0, 0.1, 0)}) {
            const dvec3 v = at + p;
            all << before << v.x << between << v.y << between << v.z << after;
        }
        return all.str();
    }

    scene scene_with(const std::string& mesh, const std::string& file)
    {
        auto lines = good;
        lines[8] = ""; // a ball, which would be too small so far away
        lines[9] = R"(  {"type": "mesh", )" + mesh + R"(, "material": "white"}],)";
        return parse_scene(file, text(lines));
    }

    class far_meshes : public import_folder {
    protected:
        /// The square as each format has it.
        std::vector<std::pair<const char*, scene>> squares(const dvec3& at)
        {
            const auto ply
                = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
                  "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                + square_at(at, "", " ", "\n") + "4 0 1 2 3\n";
            write("square.ply", ply_bytes(parse_ply("m.ply", ply)));
            write("square.obj", square_at(at, "v ", " ", "\n") + "f 1 2 3 4\n");
            const auto list = square_at(at, "[", ", ", "], ");
            const auto json = (folder / "s.json").string(), xml = (folder / "s.xml").string();
            return {{"json",
                        scene_with(R"("positions": [)" + list.substr(0, list.size() - 2)
                                + R"(], "triangles": [[0, 1, 2], [0, 2, 3]])",
                            json)},
                {"json, obj", scene_with(R"("file": "square.obj")", json)},
                {"json, ply in double", scene_with(R"("file": "square.ply")", json)},
                {"obj", read_obj_scene((folder / "square.obj").string()).scene},
                {"ply", parse_ply_scene("square.ply", ply).scene},
                {"pbrt",
                    parse_pbrt("s.pbrt",
                        "WorldBegin\nShape \"trianglemesh\" \"point3 P\" [" + square_at(at, " ", " ", " ")
                            + "] \"integer indices\" [0 1 2 0 2 3]\n")
                        .scene},
                {"mitsuba",
                    parse_mitsuba(xml,
                        "<scene version=\"3.0.0\"><shape type=\"obj\"><string name=\"filename\" value=\"square.obj\"/>"
                        "</shape></scene>")
                        .scene}};
        }
        static std::vector<dvec3> corners(const scene& s)
        {
            std::vector<dvec3> all;
            for (std::size_t t = 0; t < s.meshes.at(0).surface->triangles.size(); ++t)
                for (const auto& c : corners_of(s.meshes[0], t))
                    all.push_back(c);
            return all;
        }
    };

    TEST_F(far_meshes, have_the_shape_of_near_ones)
    {
        const dvec3 at(500000.1, 5400000.1, 100);
        const auto near = squares(dvec3(0)), far = squares(at);
        for (std::size_t i = 0; i < near.size(); ++i) {
            const auto a = corners(near[i].second), b = corners(far[i].second);
            ASSERT_EQ(a.size(), 6u) << near[i].first;
            ASSERT_EQ(b.size(), 6u) << near[i].first;
            EXPECT_EQ(near[i].second.meshes[0].surface->origin, dvec3(0)) << near[i].first;
            for (std::size_t c = 0; c < a.size(); ++c)
                EXPECT_LT(glm::length(b[c] - at - a[c]), 2e-8) << near[i].first << ", corner " << c;
        }
    }

    TEST_F(far_meshes, are_written_as_they_were_read)
    {
        const auto s = squares(dvec3(500000.1, 5400000.1, 100))[0].second;
        const auto json = (folder / "s.json").string();
        EXPECT_TRUE(parse_scene(json, scene_text(s, s.render)) == s);
        const auto& m = *s.meshes[0].surface;
        EXPECT_NE(m.origin, dvec3(0));
        EXPECT_EQ(parse_ply("m.ply", ply_bytes(m)), m);
        for (const auto* name : {"s.pbrt", "s.gltf"}) {
            const auto path = (folder / name).string();
            export_scene(path, s);
            const auto read = import_scene(path).scene;
            const auto a = corners(s), b = corners(read);
            ASSERT_EQ(a.size(), b.size()) << name;
            for (std::size_t c = 0; c < a.size(); ++c)
                EXPECT_LT(glm::length(a[c] - b[c]), 1e-6) << name << ", corner " << c;
        }
    }

    TEST_F(far_meshes, that_files_have_in_single_precision_are_noted)
    {
        const auto bytes = [](float at) {
            std::string b = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float "
                            "y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
            const float v[9] = {at, 0, 0, at + 1, 0, 0, at, 1, 0};
            const std::int32_t corners[3] = {0, 1, 2};
            b.append(reinterpret_cast<const char*>(v), sizeof v);
            b += '\3';
            b.append(reinterpret_cast<const char*>(corners), sizeof corners);
            return b;
        };
        const auto count = [&](float at, const char* text) {
            const auto notes = notes_of(parse_ply_scene("m.ply", bytes(at)));
            return std::count_if(
                notes.begin(), notes.end(), [&](const std::string& n) { return n.find(text) != std::string::npos; });
        };
        EXPECT_EQ(count(1000, "single precision"), 0);
        EXPECT_EQ(count(5400000, "single precision, in steps of 0.5"), 1);
    }

} // namespace
} // namespace photongrid
