#include <photongrid/io/export/gltf_materials.hpp>
#include <photongrid/io/export/shape_meshes.hpp>
#include <photongrid/io/gltf_writer.hpp>
#include <photongrid/io/import/photometry.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>

namespace photongrid {

namespace gltf_export {
    namespace {
        using json = nlohmann::ordered_json;
        constexpr double pi = std::numbers::pi;

        /// A node at a place; `linear`: its axes, as columns.
        json node_at(const glm::dmat3& linear, const dvec3& offset)
        {
            if (linear == glm::dmat3(1) && offset == dvec3(0))
                return json::object();
            json matrix = json::array();
            for (int column = 0; column < 3; ++column)
                matrix.insert(matrix.end(), {linear[column].x, linear[column].y, linear[column].z, 0});
            matrix.insert(matrix.end(), {offset.x, offset.y, offset.z, 1});
            return {{"matrix", matrix}};
        }

        /// Whether a matrix is scale and rotation alone, as those of glTF's nodes must be.
        bool is_scaled_rotation(const glm::dmat3& m)
        {
            for (int i = 0; i < 3; ++i) {
                const auto &a = m[i], &b = m[(i + 1) % 3];
                if (std::abs(glm::dot(a, b)) > 1e-6 * glm::length(a) * glm::length(b))
                    return false;
            }
            return true;
        }

        /// A shape of size 1 about the z axis, whose nodes scale it.
        template <class Shape>
        Shape unit();
        template <>
        sphere unit<sphere>()
        {
            return {};
        }
        template <>
        cylinder unit<cylinder>()
        {
            return {dvec3(0), dvec3(0, 0, 1), 1, 0};
        }
        template <>
        cone unit<cone>()
        {
            return {dvec3(0), dvec3(0, 0, 1), 1, 0};
        }
        template <>
        paraboloid unit<paraboloid>()
        {
            return {dvec3(0), dvec3(0, 0, 1), 1, 0};
        }
        template <>
        disk unit<disk>()
        {
            return {dvec3(0), dvec3(0, 0, 1), 1, 0};
        }

        glm::dmat3 scaled(glm::dmat3 m, double across, double along)
        {
            m[0] *= across;
            m[1] *= across;
            m[2] *= along;
            return m;
        }
        json node_of(const sphere& s) { return node_at(glm::dmat3(s.radius), s.center); }
        json node_along(const dvec3& from, const dvec3& to, double radius)
        {
            return node_at(scaled(frame_about(to - from), radius, glm::length(to - from)), from);
        }
        json node_of(const cylinder& x) { return node_along(x.base, x.top, x.radius); }
        json node_of(const cone& x) { return node_along(x.base, x.apex, x.radius); }
        json node_of(const paraboloid& x) { return node_along(x.vertex, x.rim, x.radius); }
        json node_of(const disk& d) { return node_at(scaled(frame_about(d.normal), d.radius, d.radius), d.center); }

        class scene_writer {
        public:
            scene_writer(const std::string& path, const scene& s, const export_settings& settings)
                : scene_(s), place_(path), log_(settings.strict), files_(path), pictures_(files_, settings.source),
                  is_binary_(ending_of(path) == ".glb"),
                  materials_(s, {files_, pictures_, buffer_, is_binary_}, log_, place_)
            {
            }

            exported_scene write()
            {
                for (const auto& m : scene_.materials)
                    materials_.add(m);
                add_camera();
                for_each_shape(scene_, [&](const auto& list, auto kind) {
                    for (std::size_t i = 0; i < list.size(); ++i)
                        add_shape(list[i], std::string(kind.name) + " " + std::to_string(i));
                });
                for (std::size_t i = 0; i < scene_.meshes.size(); ++i)
                    add_placed(scene_.meshes[i], "mesh " + std::to_string(i), scene_.meshes[i].material);
                for_each_light(scene_, [&](const auto& list, auto) {
                    for (const auto& l : list)
                        add_light(l);
                });
                auto names = files_.finish(is_binary_ ? binary() : text());
                return {std::move(names), log_.take()};
            }

        private:
            void add_node(json node, const std::string& name)
            {
                if (!name.empty())
                    node["name"] = name;
                nodes_.push_back(std::move(node));
            }

            void add_camera()
            {
                const auto& c = scene_.camera;
                const auto& o = scene_.render.output;
                const detail::camera_axes axes(c);
                const auto b = bounds_of(scene_);
                cameras_ = json::array({{{"type", "perspective"},
                    {"perspective",
                        {{"aspectRatio", static_cast<double>(o.width) / o.height},
                            {"yfov", glm::radians(c.vertical_fov)},
                            {"znear", std::max(1e-4 * glm::length(b.high - b.low), 1e-6)}}}}});
                auto node = node_at({axes.right, axes.up, -axes.forward}, c.position);
                node["camera"] = 0;
                add_node(std::move(node), "camera");
            }

            // --- surfaces ---
            /// The mesh of a surface with a material. `geometry`: its primitive without one.
            std::size_t mesh_with(const json& geometry, std::size_t material)
            {
                const auto [at, is_new] = meshes_by_use_.try_emplace({geometry["indices"], material}, meshes_.size());
                if (is_new) {
                    auto primitive = geometry;
                    primitive["material"] = material;
                    meshes_.push_back({{"primitives", json::array({primitive})}});
                }
                return at->second;
            }

            /// The primitive of a round shape of size 1, or of a lamp's square, which is made once.
            const json& unit_geometry(const std::string& name, const mesh& m)
            {
                auto& known = units_[name];
                if (known.is_null())
                    known = buffer_.add(m);
                return known;
            }

            template <class Shape>
            void add_shape(const Shape& s, const std::string& name)
            {
                if constexpr (requires { node_of(s); }) {
                    add_round(s, name, s.material);
                } else {
                    auto node = json::object();
                    node["mesh"] = mesh_with(buffer_.add(mesh_of(s)), s.material);
                    add_node(std::move(node), name);
                }
            }
            template <class Shape>
            void add_round(const Shape& s, const std::string& name, std::size_t material)
            {
                const std::string list = shape_kind<Shape>::list;
                if (!units_.contains(list)) {
                    const auto m = mesh_of(unit<Shape>());
                    unit_geometry(list, m);
                    log_.add(place_, list + ": drawn as " + std::to_string(m.triangles.size()) + " triangles each");
                }
                auto node = node_of(s);
                node["mesh"] = mesh_with(units_[list], material);
                add_node(std::move(node), name);
            }

            void add_placed(const placed_mesh& m, const std::string& name, std::size_t material)
            {
                const bool as_node = is_scaled_rotation(m.linear);
                auto node
                    = as_node ? node_at(m.linear, place_of(m, glm::vec3(0))) : node_at(glm::dmat3(1), apart_of(m));
                json placed;
                if (!as_node)
                    placed = buffer_.add(placed_surface(m));
                else if (surfaces_[m.surface].is_null())
                    surfaces_[m.surface] = buffer_.add(*m.surface);
                node["mesh"] = mesh_with(as_node ? surfaces_[m.surface] : placed, material);
                add_node(std::move(node), name);
            }
            /// The place from which placed_surface() measures: 0, unless the surface is far from it.
            static dvec3 apart_of(const placed_mesh& m)
            {
                return m.surface->origin == dvec3(0) ? dvec3(0) : place_of(m, glm::vec3(0));
            }
            /// The surface with its vertices where they are in the scene.
            static mesh placed_surface(const placed_mesh& m)
            {
                auto made = *m.surface;
                for (auto& p : made.positions)
                    p = place_of(m, p) - apart_of(m);
                for (auto& n : made.normals)
                    n = normal_of(m, n);
                if (is_mirrored(m))
                    for (auto& t : made.triangles)
                        std::swap(t.y, t.z);
                return made;
            }

            // --- lights ---
            void add_light(const rectangle_light& l)
            {
                const dvec3 normal = glm::cross(l.edge_u, l.edge_v);
                auto node = node_at({l.edge_u, l.edge_v, normal / std::sqrt(glm::length(normal))}, l.corner);
                const mesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
                node["mesh"] = mesh_with(
                    unit_geometry("square", square), materials_.add_lamp(l.name, l.power / (pi * glm::length(normal))));
                add_node(std::move(node), l.name);
            }
            void add_light(const sphere_light& l)
            {
                add_round(
                    surface_of(l), l.name, materials_.add_lamp(l.name, l.power / (4 * pi * pi * l.radius * l.radius)));
            }
            void add_light(const mesh_light& l)
            {
                add_placed(l.surface, l.name, materials_.add_lamp(l.name, l.power / (pi * area_of(l.surface))));
            }
            void add_light(const point_light& l)
            {
                add_punctual({{"type", "point"}}, l.name, l.power / (4 * pi), node_at(glm::dmat3(1), l.position));
            }
            void add_light(const spot_light& l)
            {
                const double lit
                    = (detail::one_minus_cosine(l.inner_angle) + detail::one_minus_cosine(l.outer_angle)) / 2;
                const double outer = std::min(l.outer_angle, 90.0), inner = std::min(l.inner_angle, outer * (1 - 1e-6));
                log_.add(place_,
                    "spotlight " + shown_word(l.name)
                        + (l.outer_angle > 90 ? ": 90 degrees from its axis are the most that glTF has"
                                              : ": its light falls off at the edge as each program likes"));
                add_punctual(
                    {{"type", "spot"},
                        {"spot", {{"innerConeAngle", glm::radians(inner)}, {"outerConeAngle", glm::radians(outer)}}}},
                    l.name, l.power / (2 * pi * lit), node_at(frame_about(-l.direction), l.position));
            }
            void add_light(const directional_light& l)
            {
                add_punctual(
                    {{"type", "directional"}}, l.name, l.irradiance, node_at(frame_about(-l.direction), dvec3(0)));
            }
            void add_light(const environment_light&) { log_.add(place_, "the environment is left out; glTF has none"); }
            template <class Light>
            void add_light(const Light& l)
            {
                log_.add(place_, light_kind<Light>::name + (" " + shown_word(l.name)) + " is left out; glTF has none");
            }

            /// `emission`: W/sr or W/m^2. Such a light shines along its node's -z.
            void add_punctual(json light, const std::string& name, const dvec3& emission, json node)
            {
                const double most = std::max({emission.x, emission.y, emission.z});
                if (!name.empty())
                    light["name"] = name;
                const dvec3 color = emission / most;
                light["color"] = {color.x, color.y, color.z};
                light["intensity"] = most * luminous_efficacy;
                node["extensions"]["KHR_lights_punctual"]["light"] = lights_.size();
                lights_.push_back(std::move(light));
                add_node(std::move(node), name);
            }

            // --- the file ---
            /// `buffer`: what the file says of its buffer.
            std::string document(json buffer)
            {
                json roots = json::array();
                for (std::size_t i = 0; i < nodes_.size(); ++i)
                    roots.push_back(i);
                json all = {{"asset", {{"version", "2.0"}, {"generator", "photongrid"}}}};
                auto extensions = materials_.extensions();
                if (!lights_.empty())
                    extensions.insert("KHR_lights_punctual");
                if (!extensions.empty())
                    all["extensionsUsed"] = extensions;
                if (!lights_.empty())
                    all["extensions"]["KHR_lights_punctual"]["lights"] = lights_;
                json shown = {{"nodes", roots}};
                if (!scene_.name.empty())
                    shown["name"] = scene_.name;
                all["scene"] = 0;
                all["scenes"] = json::array({shown});
                all["nodes"] = nodes_;
                all["cameras"] = cameras_;
                all["meshes"] = meshes_;
                materials_.write(all);
                all["accessors"] = buffer_.accessors();
                all["bufferViews"] = buffer_.views();
                buffer["byteLength"] = buffer_.bytes().size();
                all["buffers"] = json::array({buffer});
                // A name that is no UTF-8 keeps what is.
                return all.dump(is_binary_ ? -1 : 1, ' ', false, json::error_handler_t::replace);
            }

            std::string text()
            {
                const auto name = files_.add("geometry", ".bin", buffer_.bytes());
                return document({{"uri", uri_of(name)}}) + "\n";
            }

            /// Header, a chunk of JSON and one of bytes, each filled to a multiple of 4.
            std::string binary()
            {
                auto described = document(json::object());
                described.resize((described.size() + 3) / 4 * 4, ' ');
                auto bytes = buffer_.bytes();
                bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
                const std::size_t size = 12 + 8 + described.size() + 8 + bytes.size();
                if (size > 0xFFFFFFFFu)
                    fail_file(files_.scene(), "has more than 2^32 bytes, the most that a .glb has; write a .gltf");
                std::string all = "glTF";
                const auto number = [&](std::size_t n) {
                    const auto four = static_cast<std::uint32_t>(n);
                    all.append(reinterpret_cast<const char*>(&four), sizeof four);
                };
                number(2);
                number(size);
                number(described.size());
                all += "JSON" + described;
                number(bytes.size());
                all += std::string("BIN\0", 4) + bytes;
                return all;
            }

            const scene& scene_;
            source_place place_;
            import_log log_;
            side_files files_;
            picture_files pictures_;
            bool is_binary_;
            buffer_writer buffer_;
            material_writer materials_;
            json nodes_ = json::array(), meshes_ = json::array(), cameras_, lights_ = json::array();
            std::map<std::string, json> units_;
            std::map<std::shared_ptr<const mesh>, json> surfaces_;
            std::map<std::pair<std::size_t, std::size_t>, std::size_t> meshes_by_use_; ///< by indices and material
        };
    } // namespace
} // namespace gltf_export

exported_scene write_gltf(const std::string& path, const scene& s, const export_settings& settings)
{
    try {
        check(s);
    } catch (const std::invalid_argument& e) {
        throw scene_error(path, 0, 0, std::string("this scene cannot be written: ") + e.what());
    }
    return gltf_export::scene_writer(path, s, settings).write();
}

} // namespace photongrid
