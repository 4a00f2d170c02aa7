// Reads the surfaces of meshes in a scene file: from PLY and OBJ files beside it or listed there, and where they are
// placed.
#pragma once

#include <photongrid/io/import/scene_files.hpp>
#include <photongrid/io/json_tree.hpp>
#include <photongrid/io/scene_values.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <type_traits>
#include <vector>

namespace photongrid {

/// A scene file's values, and those that make a mesh. Files of meshes are sought in the scene file's folder.
class surface_reader : public scene_values {
public:
    /// `how`: those files.
    surface_reader(const std::string& file, std::string text, file_reading how)
        : scene_values(file, std::move(text)), files_(std::filesystem::path(file).parent_path(), true, std::move(how))
    {
    }

    /// The surface that an object describes, without a material.
    placed_mesh surface_in(const json_value& v)
    {
        placed_mesh m;
        const auto *file = v.find("file"), *positions = v.find("positions"), *triangles = v.find("triangles"),
                   *normals = v.find("normals"), *coordinates = v.find("texture_coordinates"),
                   *colors = v.find("colors");
        if (file != nullptr ? positions != nullptr || triangles != nullptr || normals != nullptr
                    || coordinates != nullptr || colors != nullptr
                            : positions == nullptr || triangles == nullptr)
            fail(v.place, "a mesh has either a \"file\" or \"positions\" and \"triangles\"");
        if (file != nullptr) {
            m.file = file_name(*file);
            m.surface = from_file(*file, [&] { return files_.surface(m.file); });
        } else {
            auto listed = inline_mesh(*positions, *triangles, normals);
            if (coordinates != nullptr)
                read_for_each_position(*coordinates, "texture coordinates", listed, listed.texture_coordinates,
                    [&](const json_value& c) { return glm::vec2(two(c)); });
            if (colors != nullptr)
                read_for_each_position(*colors, "colors", listed, listed.colors, [&](const json_value& c) {
                    return glm::vec3(rgb_in_range(c, {0, 1, ""}));
                });
            m.surface = std::make_shared<const mesh>(std::move(listed));
        }
        read_placement(v, m);
        return m;
    }

protected:
    /// The name of a file in the scene's folder or below it.
    std::string file_name(const json_value& v) const
    {
        if (v.kind != json_kind::string || !is_name(v.text) || !files_.lies_inside(v.text))
            wrong(v, "the name of a file in the scene's folder or below it, of 1 to 100 bytes");
        return v.text;
    }

    /// What `read` returns. Its errors get the place of `v`, the file's name.
    template <class Read>
    std::invoke_result_t<Read> from_file(const json_value& v, Read&& read) const
    {
        try {
            return read();
        } catch (const file_error& e) {
            fail(v.place, e.what());
        } catch (const scene_error& e) {
            fail(v.place, e.what());
        }
    }

    /// A scale or a place of a texture.
    glm::dvec2 two(const json_value& v) const
    {
        const auto number_in = [&](const json_value& n) { return number(n, -1e6, 1e6, "a number from -10^6 to 10^6"); };
        if (v.kind != json_kind::array || v.items.size() != 2)
            wrong(v, "two numbers: [u, v]");
        return {number_in(v.items[0]), number_in(v.items[1])};
    }

    struct turn {
        dvec3 axis;
        double degrees;
    };
    turn turn_in(const json_value& v) const
    {
        if (v.kind != json_kind::object)
            wrong(v, "an object with the keys \"axis\" and \"degrees\"");
        open(v, "rotate");
        return {direction(at(v, "axis")), number(at(v, "degrees"), -360, 360, "an angle from -360 to 360 degrees")};
    }

    scene_files files_; ///< file_name() has seen to it that they lie in the scene's folder

private:
    mesh inline_mesh(const json_value& positions, const json_value& triangles, const json_value* normals) const
    {
        mesh m;
        std::vector<dvec3> places;
        read_list(positions, json_limits{}.values, "positions", [&](const json_value& p) {
            places.push_back(three(p, "a position: [x, y, z]",
                [&](const json_value& c) { return number(c, -1e9, 1e9, "a coordinate from -1e9 to 1e9"); }));
        });
        if (places.empty())
            wrong(positions, "at least one position");
        set_positions(m, places);
        read_list(triangles, json_limits{}.values, "triangles", [&](const json_value& t) {
            m.triangles.emplace_back(
                three(t, "a triangle: the numbers of 3 positions, counted from 0", [&](const json_value& c) {
                    return static_cast<double>(whole(c, 0, static_cast<std::uint32_t>(m.positions.size() - 1)));
                }));
        });
        if (m.triangles.empty())
            wrong(triangles, "at least one triangle");
        if (normals != nullptr)
            read_for_each_position(
                *normals, "normals", m, m.normals, [&](const json_value& n) { return glm::vec3(direction(n)); });
        return m;
    }
    /// Reads a list that must have an element for each position of a mesh.
    template <class Element, class Read>
    void read_for_each_position(
        const json_value& v, const char* what, const mesh& m, std::vector<Element>& to, Read&& read) const
    {
        read_list(v, json_limits{}.values, what, [&](const json_value& e) { to.push_back(read(e)); });
        if (to.size() != m.positions.size())
            wrong(v, std::string(what) + " for each of the " + std::to_string(m.positions.size()) + " positions");
    }

    /// Positions are in the file's unit of length.
    void read_placement(const json_value& v, placed_mesh& m) const
    {
        const auto *matrix = v.find("matrix"), *scale = v.find("scale"), *rotate = v.find("rotate"),
                   *translate = v.find("translate");
        if (matrix != nullptr && (scale != nullptr || rotate != nullptr || translate != nullptr))
            fail(matrix->place, "a mesh has either a \"matrix\" or \"scale\", \"rotate\" and \"translate\"");
        if (matrix != nullptr) {
            read_matrix(*matrix, m);
        } else {
            if (scale != nullptr) {
                const auto s = rgb(*scale, "[x, y, z] or one number: scale",
                    [&](const json_value& c) { return number(c, -1e9, 1e9, "a factor from -1e9 to 1e9"); });
                m.linear = glm::dmat3(s.x, 0, 0, 0, s.y, 0, 0, 0, s.z);
            }
            if (rotate != nullptr) {
                const auto turned = turn_in(*rotate);
                m.linear = rotation_about(turned.axis, turned.degrees) * m.linear;
            }
            if (translate != nullptr)
                m.offset = point(*translate);
        }
        m.linear = m.linear * length_.multiply / length_.divide;
    }
    void read_matrix(const json_value& v, placed_mesh& m) const
    {
        if (v.kind != json_kind::array || v.items.size() != 3)
            wrong(v, "3 rows of 4 numbers");
        for (int row = 0; row < 3; ++row) {
            const auto& r = v.items[static_cast<std::size_t>(row)];
            if (r.kind != json_kind::array || r.items.size() != 4)
                wrong(r, "a row of 4 numbers");
            for (int column = 0; column < 3; ++column)
                m.linear[column][row]
                    = number(r.items[static_cast<std::size_t>(column)], -1e9, 1e9, "a number from -1e9 to 1e9");
            m.offset[row] = length(r.items[3]);
        }
    }
};

} // namespace photongrid
