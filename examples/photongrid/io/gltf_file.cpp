#include <photongrid/io/gltf/accessors.hpp>
#include <photongrid/io/gltf/lamps.hpp>
#include <photongrid/io/gltf_file.hpp>
#include <photongrid/io/whole_file.hpp>

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace photongrid {

namespace gltf {
    namespace {
        class scene_reader {
        public:
            scene_reader(const std::string& file, std::string_view bytes, const import_settings& settings)
                : builder_(file, settings), all_(file, bytes, builder_)
            {
            }

            imported_scene read()
            {
                place_nodes();
                add_camera();
                if (all_.count("animations") > 0)
                    builder_.note(all_.element("animations", 0).place(),
                        "animations are left out: everything is where the nodes have it");
                for (const auto n : drawn_)
                    if (!nodes_[n].is_hidden)
                        add_node(n);
                return builder_.finish();
            }

        private:
            struct node {
                glm::dmat4 to_parent{1}, to_scene{1};
                std::vector<std::size_t> children;
                bool is_hidden = false; ///< with all that is below it
            };

            // --- nodes ---
            static glm::dmat4 matrix_of(const part& n)
            {
                if (const auto given = n.numbers<16>("matrix")) {
                    glm::dmat4 m;
                    for (int i = 0; i < 16; ++i)
                        m[i / 4][i % 4] = (*given)[static_cast<std::size_t>(i)];
                    return m;
                }
                const auto moved = n.numbers<3>("translation").value_or(std::array{0.0, 0.0, 0.0}),
                           scaled = n.numbers<3>("scale").value_or(std::array{1.0, 1.0, 1.0});
                const auto turned = n.numbers<4>("rotation").value_or(std::array{0.0, 0.0, 0.0, 1.0});
                return placement(n, dvec3(moved[0], moved[1], moved[2]),
                    glm::dquat(turned[3], turned[0], turned[1], turned[2]), dvec3(scaled[0], scaled[1], scaled[2]));
            }

            static glm::dmat4 placement(
                const part& n, const dvec3& moved, const glm::dquat& turned, const dvec3& scaled)
            {
                const double length = glm::length(turned);
                if (!(length > 1e-100))
                    n.fail("the rotation is 0; expected a unit quaternion");
                const auto turn = glm::mat3_cast(turned / length);
                glm::dmat4 m(1);
                for (int c = 0; c < 3; ++c)
                    m[c] = glm::dvec4(turn[c] * scaled[c], 0);
                m[3] = glm::dvec4(moved, 1);
                return m;
            }

            void place_nodes()
            {
                const auto count = all_.count("nodes");
                std::vector<bool> has_parent(count, false);
                for (std::size_t n = 0; n < count; ++n) {
                    const auto p = all_.element("nodes", n);
                    nodes_.push_back({.to_parent = matrix_of(p), .children = {}});
                    if (const auto seen = p.extension("KHR_node_visibility"))
                        nodes_[n].is_hidden = !seen->truth("visible", true);
                    for (const auto& c : p.items("children")) {
                        const auto child = c.as_index("nodes");
                        if (has_parent[child])
                            c.fail("node " + std::to_string(child) + " has two parents");
                        has_parent[child] = true;
                        nodes_[n].children.push_back(child);
                    }
                }
                std::vector<std::size_t> roots;
                for (std::size_t n = 0; n < count; ++n)
                    if (!has_parent[n])
                        roots.push_back(n);
                // Each node has one parent at most, so that those that no root leads to go round.
                std::vector<bool> is_placed(count, false);
                for (const auto n : below(roots))
                    is_placed[n] = true;
                if (const auto n = std::find(is_placed.begin(), is_placed.end(), false); n != is_placed.end())
                    all_.element("nodes", static_cast<std::size_t>(n - is_placed.begin()))
                        .fail("the node is a child of itself, or of one below it");
                drawn_ = below(roots_of_scene(roots, has_parent));
            }

            /// The nodes that the scene of the file has.
            std::vector<std::size_t> roots_of_scene(
                const std::vector<std::size_t>& all_roots, const std::vector<bool>& has_parent)
            {
                const auto count = all_.count("scenes");
                if (count == 0) {
                    if (!all_roots.empty())
                        builder_.log().say(all_.root().place(), "the file has no scene; all its nodes are drawn");
                    return all_roots;
                }
                const auto number = all_.root().index("scene", "scenes").value_or(0);
                std::vector<std::size_t> roots;
                std::vector<bool> is_root(has_parent.size(), false);
                for (const auto& n : all_.element("scenes", number).items("nodes")) {
                    const auto root = n.as_index("nodes");
                    if (has_parent[root] || is_root[root])
                        n.fail("node " + std::to_string(root) + " is below another one, or in the scene twice");
                    is_root[root] = true;
                    roots.push_back(root);
                }
                if (count > 1)
                    builder_.note(all_.root().at("scenes").place(),
                        "of several scenes one is drawn, number " + std::to_string(number));
                return roots;
            }

            /// Roots and what is below them, which is placed.
            std::vector<std::size_t> below(const std::vector<std::size_t>& roots)
            {
                std::vector<std::size_t> made, left(roots.rbegin(), roots.rend());
                for (const auto r : roots)
                    nodes_[r].to_scene = nodes_[r].to_parent;
                while (!left.empty()) {
                    const auto n = left.back();
                    left.pop_back();
                    made.push_back(n);
                    const auto& children = nodes_[n].children;
                    for (auto c = children.rbegin(); c != children.rend(); ++c) {
                        nodes_[*c].is_hidden = nodes_[*c].is_hidden || nodes_[n].is_hidden;
                        nodes_[*c].to_scene = nodes_[n].to_scene * nodes_[*c].to_parent;
                        left.push_back(*c);
                    }
                }
                return made;
            }

            // --- camera ---
            void add_camera()
            {
                for (const auto n : drawn_) {
                    const auto p = all_.element("nodes", n);
                    const auto index = p.index("camera", "cameras");
                    if (!index)
                        continue;
                    const auto c = all_.element("cameras", *index);
                    const auto type = c.text("type").value_or("");
                    const auto lens = c.object("perspective");
                    if (type != "perspective" || !lens) {
                        builder_.note(c.place(),
                            all_.name_of("camera", "cameras", *index) + ": is no perspective one, and is left out");
                        continue;
                    }
                    // Nothing is mirrored or scaled by the camera's node.
                    const auto& m = nodes_[n].to_scene;
                    const dvec3 forward = -dvec3(m[2]), up(m[1]);
                    const auto pixels = default_pixels(lens->number("aspectRatio", 1, 1e-3, 1e3));
                    builder_.set_camera(c.place(),
                        {.position = dvec3(m[3]),
                            .forward = forward,
                            .up = up,
                            .right = glm::cross(forward, up),
                            .fov = glm::degrees(lens->number("yfov", 1, 1e-6, 3.15)),
                            .fov_axis = imported_camera::axis::vertical},
                        pixels.x, pixels.y);
                    return;
                }
            }

            /// The size of a picture with these proportions and about as many pixels as one of default size.
            static glm::uvec2 default_pixels(double aspect)
            {
                const double side = output_settings{}.height, root = std::sqrt(aspect);
                return {static_cast<std::uint32_t>(std::lround(side * root)),
                    static_cast<std::uint32_t>(std::max(std::lround(side / root), 1L))};
            }

            // --- what a node has ---
            void add_node(std::size_t n)
            {
                const auto p = all_.element("nodes", n);
                if (const auto mesh_index = p.index("mesh", "meshes"))
                    add_mesh(p, *mesh_index, nodes_[n].to_scene);
                if (const auto l = p.extension("KHR_lights_punctual"))
                    add_light(*l, nodes_[n].to_scene);
            }

            void add_mesh(const part& p, std::size_t mesh_index, const glm::dmat4& to_scene)
            {
                mesh_pose pose;
                for (const auto& w : p.items("weights"))
                    pose.weights.push_back(w.as_number(-1e6, 1e6));
                auto places = instances_of(p, to_scene);
                if (const auto skin = p.index("skin", "skins")) {
                    pose.joints = joints_of(*skin);
                    places = {glm::dmat4(1)}; // the joints place the vertices
                }
                const auto primitives = all_.element("meshes", mesh_index).items("primitives");
                for (std::size_t i = 0; i < primitives.size(); ++i) {
                    const auto& material
                        = materials_.made(primitives[i].index("material", "materials"), primitives[i].place());
                    const auto surface = meshes_.surface_of(mesh_index, i, material.coordinates, pose);
                    if (surface == nullptr)
                        continue;
                    for (const auto& place : places) {
                        if (++shapes_ > max_shapes)
                            p.fail("more than 2^22 shapes, with all places of meshes");
                        add_surface(primitives[i].place(), surface, place, material);
                    }
                }
            }

            /// EXT_mesh_gpu_instancing.
            std::vector<glm::dmat4> instances_of(const part& p, const glm::dmat4& to_scene)
            {
                const auto e = p.extension("EXT_mesh_gpu_instancing");
                const auto attributes = e ? e->object("attributes") : std::nullopt;
                if (!attributes)
                    return {to_scene};
                const auto of = [&](const char* name) { return attributes->index(name, "accessors"); };
                const auto moved = of("TRANSLATION"), turned = of("ROTATION"), scaled = of("SCALE");
                const auto moves = moved ? triples(all_, *moved) : std::vector<glm::vec3>{},
                           scales = scaled ? triples(all_, *scaled) : std::vector<glm::vec3>{};
                const auto turns = turned ? quadruples(all_, *turned) : std::vector<glm::vec4>{};
                const auto count = std::max({moves.size(), scales.size(), turns.size()});
                for (const auto size : {moves.size(), scales.size(), turns.size()})
                    if (size != 0 && size != count)
                        attributes->fail("the attributes of instances are not as many");
                if (count > max_shapes)
                    attributes->fail("more than 2^22 instances");
                std::vector<glm::dmat4> all;
                for (std::size_t i = 0; i < count; ++i) {
                    const auto q = turns.empty() ? glm::dvec4(0, 0, 0, 1) : glm::dvec4(turns[i]);
                    all.push_back(to_scene
                        * placement(*attributes, moves.empty() ? dvec3(0) : dvec3(moves[i]),
                            glm::dquat(q.w, q.x, q.y, q.z), scales.empty() ? dvec3(1) : dvec3(scales[i])));
                }
                return all;
            }

            std::vector<glm::dmat4> joints_of(std::size_t skin)
            {
                const auto s = all_.element("skins", skin);
                const auto joints = s.items("joints");
                const auto given = s.index("inverseBindMatrices", "accessors");
                const auto inverse
                    = given ? matrices(all_, *given) : std::vector<glm::mat4>(joints.size(), glm::mat4(1));
                if (inverse.size() < joints.size())
                    s.fail("the skin has " + std::to_string(joints.size()) + " joints and "
                        + std::to_string(inverse.size()) + " inverse matrices");
                std::vector<glm::dmat4> made;
                for (std::size_t j = 0; j < joints.size(); ++j)
                    made.push_back(nodes_[joints[j].as_index("nodes")].to_scene * glm::dmat4(inverse[j]));
                return made;
            }

            void add_surface(const source_place& place, const std::shared_ptr<const mesh>& surface,
                const glm::dmat4& to_scene, const surface_material& material)
            {
                auto radiance = material.radiance;
                auto lit = surface, dark = std::shared_ptr<const mesh>();
                if (radiance == dvec3(0)) {
                    std::swap(lit, dark);
                } else if (material.emission) {
                    auto& parts = divided_[surface];
                    if (!parts.lit && !parts.dark)
                        parts = divided(*surface, *material.emission);
                    lit = parts.lit;
                    dark = parts.dark;
                    radiance *= parts.colour;
                    if (lit)
                        builder_.note(place, material.name + ": the colour of its emission is even where it emits");
                }
                if (dark)
                    builder_.add_mesh(place, dark, to_scene, body_or_pane(place, *dark, material));
                if (!lit)
                    return;
                if (!material.is_black)
                    builder_.note(
                        place, material.name + ": the surface of a lamp: black; what it reflects is left out");
                builder_.add_emitter(place, lit, to_scene, {radiance, material.is_double_sided && !is_closed(*lit)});
            }

            /// Exporters, Blender's too, write bodies of glass without the volume that glTF wants of them. What is
            /// closed is one.
            std::uint32_t body_or_pane(const source_place& place, const mesh& m, const surface_material& material)
            {
                if (!material.is_pane || !is_closed(m))
                    return material.index;
                if (noted_bodies_.insert(material.index).second)
                    builder_.note(place,
                        material.name
                            + ": its closed meshes are drawn as bodies of glass, others as panes; KHR_materials_volume "
                              "says "
                              "what is a body");
                return builder_.as_body(place, material.index);
            }

            // --- lights ---
            void add_light(const part& use, const glm::dmat4& to_scene)
            {
                const auto lights = all_.root().extension("KHR_lights_punctual");
                const auto list = lights ? lights->items("lights") : std::vector<part>{};
                const auto index = use.whole("light", std::size_t{1} << 32);
                if (!index || *index >= list.size())
                    use.fail("the light is none of those in KHR_lights_punctual, of which there are "
                        + std::to_string(list.size()));
                const auto& l = list[*index];
                const auto type = l.text("type").value_or("");
                const auto light
                    = l.colour("color", 1).value_or(dvec3(1)) * (l.number("intensity", 1, 0) / luminous_efficacy);
                const dvec3 position(to_scene[3]), direction = -dvec3(to_scene[2]);
                if (l.has("range"))
                    builder_.note(
                        l.at("range").place(), "the range of a light is left out: it shines as far as it does");
                if (type == "point") {
                    builder_.add_point_light(l.place(), position, light);
                } else if (type == "directional") {
                    builder_.add_directional_light(l.place(), direction, light);
                } else if (type == "spot") {
                    const auto cone = l.object("spot");
                    const double right = std::numbers::pi / 2,
                                 outer = cone ? cone->number("outerConeAngle", right / 2, 0, right) : right / 2,
                                 inner = cone ? cone->number("innerConeAngle", 0, 0, right) : 0;
                    if (outer < 1e-4)
                        l.fail("the angle of a spotlight must be above 0.0001 radians");
                    builder_.add_spot_light(l.place(), position, direction, glm::degrees(std::min(inner, outer)),
                        glm::degrees(outer), light);
                } else {
                    builder_.note(l.place(), "light " + shown_word(type) + ": is left out");
                }
            }

            static constexpr std::size_t max_shapes = std::size_t{1} << 22;

            scene_builder builder_;
            document all_;
            mesh_reader meshes_{all_};
            material_reader materials_{all_};
            std::vector<node> nodes_;
            std::vector<std::size_t> drawn_;
            std::map<std::shared_ptr<const mesh>, emitting_parts> divided_;
            std::set<std::uint32_t> noted_bodies_; ///< materials of panes that closed meshes have
            std::size_t shapes_ = 0;
        };
    } // namespace
} // namespace gltf

imported_scene parse_gltf(const std::string& file, std::string_view bytes, const import_settings& settings)
{
    return gltf::scene_reader(file, bytes, settings).read();
}

imported_scene read_gltf(const std::string& path, const import_settings& settings)
{
    return parsed_file(path, [&](const std::string& bytes) { return parse_gltf(path, bytes, settings); });
}

} // namespace photongrid
