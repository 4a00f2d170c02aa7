#include <photongrid/io/export/equal_area.hpp>
#include <photongrid/io/export/pbrt_materials.hpp>
#include <photongrid/io/export/shape_meshes.hpp>
#include <photongrid/io/pbrt_writer.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace photongrid {

namespace pbrt_export {
    namespace {
        constexpr double pi = std::numbers::pi;
        constexpr std::size_t small_mesh = 64; // triangles; a larger one has a file

        class scene_text_writer {
        public:
            scene_text_writer(const std::string& path, const scene& s, const export_settings& settings)
                : scene_(s), place_(path), log_(settings.strict), files_(path), pictures_(files_, settings.source),
                  materials_(s, pictures_, log_, place_)
            {
            }

            exported_scene write()
            {
                write_options();
                to_.line("WorldBegin").line();
                materials_.write(to_);
                to_.line();
                write_shapes();
                for_each_light(scene_, [&](const auto& list, auto) {
                    for (const auto& l : list)
                        write_light(l);
                });
                auto names = files_.finish(to_.take());
                return {std::move(names), log_.take()};
            }

        private:
            // --- the camera and how pbrt draws ---
            void write_options()
            {
                const auto& c = scene_.camera;
                const auto& r = scene_.render;
                const double aspect = static_cast<double>(r.output.width) / r.output.height;
                // pbrt's is that of the smaller side.
                const double fov = aspect >= 1
                    ? c.vertical_fov
                    : glm::degrees(2 * std::atan(std::tan(glm::radians(c.vertical_fov) / 2) * aspect));
                to_.line("# A scene of photongrid for pbrt-v4.");
                to_.line("Scale -1 1 1 # pbrt's camera is left-handed");
                to_.word("LookAt ").numbers(c.position).word("  ").numbers(c.look_at).word("  ").numbers(c.up).line();
                to_.word("Camera \"perspective\"").parameter("float fov", fov).line();
                to_.word("Film \"rgb\"")
                    .parameter("integer xresolution", std::uint64_t{r.output.width})
                    .parameter("integer yresolution", std::uint64_t{r.output.height})
                    .parameter("string filename", std::filesystem::path(files_.scene()).stem().string() + ".exr")
                    .line();
                to_.line("PixelFilter \"box\" \"float xradius\" 0.5 \"float yradius\" 0.5");
                render_settings usual;
                usual.view.spp = 1;
                usual.output.passes = 64;
                const auto drawn = with_numbers(r, usual);
                to_.word("Sampler \"halton\"")
                    .parameter("integer pixelsamples", std::uint64_t{drawn.view.spp} * drawn.output.passes)
                    .line();
                to_.word("Integrator \"path\"")
                    .parameter("integer maxdepth", std::uint64_t{r.view.depth} + r.map.photon_depth)
                    .line();
            }

            // --- shapes ---
            void begin(std::uint32_t material)
            {
                to_.line("AttributeBegin").word("  NamedMaterial ").quoted(materials_.name(material)).line();
            }
            void end() { to_.line("AttributeEnd"); }

            void write(const sphere& s)
            {
                begin(s.material);
                write_ball(s);
                end();
            }
            void write_ball(const sphere& s)
            {
                to_.word("  Translate ").numbers(s.center).line();
                to_.word("  Shape \"sphere\"").parameter("float radius", s.radius).line();
            }
            void write(const cylinder& x)
            {
                begin(x.material);
                to_.transform(frame_about(x.top - x.base), x.base);
                to_.word("  Shape \"cylinder\"").parameter("float radius", x.radius);
                to_.word(" \"float zmin\" 0").parameter("float zmax", glm::length(x.top - x.base)).line();
                end();
            }
            void write(const disk& d)
            {
                begin(d.material);
                to_.transform(frame_about(d.normal), d.center);
                to_.word("  Shape \"disk\"").parameter("float radius", d.radius).line();
                end();
            }
            template <class Shape>
            void write(const Shape& s)
            {
                const auto m = mesh_of(s);
                if (!m.normals.empty() && noted_.insert(shape_kind<Shape>::list).second)
                    log_.add(place_,
                        std::string(shape_kind<Shape>::list) + ": drawn as " + std::to_string(m.triangles.size())
                            + " triangles each");
                begin(s.material);
                write_surface(std::make_shared<const mesh>(m), s.material);
                end();
            }

            /// `material`: whose opacity it has; none of a lamp.
            void write_surface(const std::shared_ptr<const mesh>& surface, std::optional<std::uint32_t> material,
                bool has_file = false)
            {
                const auto& m = *surface;
                if (has_file || m.triangles.size() >= small_mesh || !m.colors.empty()) {
                    to_.word("  Shape \"plymesh\"").parameter("string filename", files_.add_surface(surface));
                } else {
                    to_.word("  Shape \"trianglemesh\"");
                    if (m.origin == dvec3(0)) {
                        to_.parameter("point3 P", std::span(m.positions));
                    } else {
                        std::vector<dvec3> places;
                        for (const auto& p : m.positions)
                            places.push_back(m.origin + dvec3(p));
                        to_.parameter("point3 P", std::span<const dvec3>(places));
                    }
                    to_.parameter("integer indices", std::span(m.triangles));
                    if (!m.normals.empty())
                        to_.parameter("normal N", std::span(m.normals));
                    if (!m.texture_coordinates.empty())
                        to_.parameter("point2 uv", std::span(m.texture_coordinates));
                }
                if (material)
                    materials_.write_alpha(to_, *material);
                to_.line();
                if (!m.colors.empty() && noted_.insert("colors").second)
                    log_.add(place_, "pbrt does not read the colours of vertices");
            }

            void write_shapes()
            {
                for_each_shape(scene_, [&](const auto& list, auto) {
                    for (const auto& s : list)
                        write(s);
                });
                std::map<std::pair<std::shared_ptr<const mesh>, std::uint32_t>, std::size_t> uses;
                std::map<std::shared_ptr<const mesh>, std::size_t> places;
                for (const auto& m : scene_.meshes) {
                    ++uses[{m.surface, m.material}];
                    ++places[m.surface];
                }
                std::map<std::pair<std::shared_ptr<const mesh>, std::uint32_t>, std::string> objects;
                for (const auto& m : scene_.meshes) {
                    // pbrt keeps an object in memory once.
                    const bool is_object
                        = uses[{m.surface, m.material}] > 1 && m.surface->triangles.size() >= small_mesh;
                    if (is_object && !objects.contains({m.surface, m.material})) {
                        const auto& name = objects[{m.surface, m.material}]
                            = "object " + std::to_string(objects.size());
                        to_.word("ObjectBegin ").quoted(name).line();
                        to_.word("  NamedMaterial ").quoted(materials_.name(m.material)).line();
                        write_surface(m.surface, m.material);
                        to_.line("ObjectEnd");
                    }
                    if (is_object)
                        to_.line("AttributeBegin");
                    else
                        begin(m.material);
                    if (m.linear != glm::dmat3(1) || m.offset != dvec3(0))
                        to_.transform(m.linear, m.offset);
                    if (is_object)
                        to_.word("  ObjectInstance ").quoted(objects[{m.surface, m.material}]).line();
                    else
                        write_surface(m.surface, m.material, places[m.surface] > 1);
                    end();
                }
            }

            // --- lights ---
            /// `area`: m^2.
            void begin_lamp(const dvec3& power, double area)
            {
                to_.word("AttributeBegin\n  AreaLightSource \"diffuse\"")
                    .parameter("rgb L", power / (area * pi))
                    .line();
                to_.line("  Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]");
            }
            void write_light(const rectangle_light& l)
            {
                // A square, placed: numbers of double precision, and a shape from which pbrt samples evenly.
                const dvec3 normal = glm::cross(l.edge_u, l.edge_v);
                begin_lamp(l.power, glm::length(normal));
                to_.transform({l.edge_u, l.edge_v, normal / std::sqrt(glm::length(normal))}, l.corner);
                to_.line("  Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0  1 1 0 ]");
                end();
            }
            void write_light(const sphere_light& l)
            {
                begin_lamp(l.power, 4 * pi * l.radius * l.radius);
                write_ball(surface_of(l));
                end();
            }
            void write_light(const mesh_light& l)
            {
                // Without normals: pbrt's lamps shine to where those point.
                const auto& s = *l.surface.surface;
                begin_lamp(l.power, area_of(l.surface));
                to_.transform(l.surface.linear, l.surface.offset);
                write_surface(std::make_shared<const mesh>(mesh{s.positions, s.triangles}), std::nullopt);
                end();
            }
            void write_light(const point_light& l)
            {
                to_.word("LightSource \"point\"").parameter("rgb I", l.power / (4 * pi));
                to_.parameter("point3 from", l.position).line();
            }
            void write_light(const spot_light& l)
            {
                const double lit
                    = (detail::one_minus_cosine(l.inner_angle) + detail::one_minus_cosine(l.outer_angle)) / 2;
                // So long that adding the position loses no digits of it.
                const double length = glm::length(l.direction), longer = std::max(length, glm::length(l.position));
                to_.word("AttributeBegin\n  Translate ").numbers(l.position).line();
                to_.word("  LightSource \"spot\"").parameter("rgb I", l.power / (2 * pi * lit));
                to_.parameter("point3 from", dvec3(0)).parameter("point3 to", l.direction * (longer / length));
                to_.parameter("float coneangle", l.outer_angle);
                to_.parameter("float conedeltaangle", l.outer_angle - l.inner_angle).line();
                end();
                if (l.outer_angle > 90)
                    log_.add(place_,
                        "spotlight " + shown_word(l.name)
                            + ": pbrt may not have one wider than 90 degrees "
                              "from its axis");
            }
            void write_light(const directional_light& l)
            {
                to_.word("LightSource \"distant\"").parameter("rgb L", l.irradiance);
                to_.parameter("point3 from", dvec3(0)).parameter("point3 to", l.direction).line();
            }
            template <class Light>
            void write_light(const Light& l)
            {
                log_.add(place_, light_kind<Light>::name + (" " + shown_word(l.name)) + " is left out; pbrt has none");
            }
            void write_light(const environment_light& l)
            {
                if (!l.map) {
                    to_.word("LightSource \"infinite\"").parameter("rgb L", l.radiance).line();
                    return;
                }
                const auto side = std::clamp(2 * l.map->height, 64u, 4096u);
                log_.add(place_,
                    "the environment is resampled to a square of " + std::to_string(side) + " x " + std::to_string(side)
                        + " pixels, which pbrt needs");
                const auto file = pictures_.add_exr("sky", side, side, equal_area_texels(l, side));
                to_.line("AttributeBegin");
                if (l.degrees != 0)
                    to_.word("  Rotate ").number(l.degrees).word(" ").numbers(l.axis).line();
                to_.line("  ConcatTransform [ 1 0 0 0  0 0 -1 0  0 1 0 0  0 0 0 1 ] # its z is up");
                to_.word("  LightSource \"infinite\"").parameter("string filename", file).line();
                end();
            }

            const scene& scene_;
            source_place place_;
            import_log log_;
            side_files files_;
            picture_files pictures_;
            material_writer materials_;
            text_writer to_;
            std::set<std::string> noted_; ///< what is noted once
        };
    } // namespace
} // namespace pbrt_export

exported_scene write_pbrt(const std::string& path, const scene& s, const export_settings& settings)
{
    try {
        check(s);
    } catch (const std::invalid_argument& e) {
        throw scene_error(path, 0, 0, std::string("this scene cannot be written: ") + e.what());
    }
    return pbrt_export::scene_text_writer(path, s, settings).write();
}

} // namespace photongrid
