#include <photongrid/io/pbrt/materials.hpp>
#include <photongrid/io/pbrt/shapes.hpp>
#include <photongrid/io/pbrt_file.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>

namespace photongrid {

namespace pbrt {
    namespace {
        constexpr std::size_t max_shapes = std::size_t{1} << 22; // with all places of objects

        class scene_reader {
        public:
            scene_reader(const std::string& file, std::string_view text, const import_settings& settings)
                : builder_(file, settings), all_(parse(file, text, builder_.files(), builder_.log()))
            {
            }

            imported_scene read()
            {
                read_camera();
                for (const auto& s : all_.shapes)
                    add_shape(s, s.to_world);
                for (const auto& i : all_.instances)
                    add_instance(i);
                for (const auto& l : all_.lights)
                    add_light(l);
                note_unused();
                return builder_.finish();
            }

        private:
            void note_unused()
            {
                const auto note = [&](const entity& e, const char* what) {
                    e.parameters.note_unused(builder_.log(), std::string(what) + " " + shown_word(e.type));
                };
                for (const auto& s : all_.shapes)
                    note(s, "shape");
                for (const auto& [name, shapes] : all_.objects)
                    for (const auto& s : shapes)
                        if (drawn_objects_.contains(name))
                            note(s, "shape");
                for (const auto& l : all_.lights)
                    note(l, "light");
                for (const auto& l : all_.area_lights)
                    note(l, "light");
                // Textures and materials that nothing uses are not read; the others were noted where they were made.
            }

            void read_camera()
            {
                std::uint32_t width = 1280, height = 720; // pbrt's own
                if (all_.film) {
                    const auto side = [&](const char* name, std::uint32_t absent) {
                        return static_cast<std::uint32_t>(
                            std::clamp(all_.film->parameters.whole(name, static_cast<int>(absent)), 0, 1 << 20));
                    };
                    width = side("xresolution", width);
                    height = side("yresolution", height);
                    for (const auto* name : {"cropwindow", "pixelbounds"})
                        if (all_.film->parameters.find(name) != nullptr)
                            builder_.note(all_.film->place, std::string(name) + ": the whole picture is drawn");
                }
                if (all_.integrator && all_.integrator->parameters.find("maxdepth") != nullptr)
                    builder_.set_depth(all_.integrator->parameters.whole("maxdepth", 5));
                if (!all_.camera)
                    return;
                const auto& e = *all_.camera;
                const auto& p = e.parameters;
                if (e.type != "perspective")
                    builder_.note(e.place, "camera " + shown_word(e.type) + ": drawn as a perspective one");
                if (p.number("lensradius", 0) > 0)
                    builder_.note(e.place, "the camera's lens: everything is in focus");
                p.find("focaldistance");
                p.find("shutteropen");
                p.find("shutterclose");
                for (const auto* name : {"screenwindow", "frameaspectratio"})
                    if (p.find(name) != nullptr)
                        builder_.note(e.place, std::string("camera: \"") + name + "\" is left out");
                const double fov = p.number("fov", 90);
                p.note_unused(builder_.log(), "camera " + shown_word(e.type));
                const auto& m = all_.camera_to_world;
                builder_.set_camera(e.place,
                    {.position = dvec3(m[3]) / m[3][3],
                        .forward = dvec3(m[2]),
                        .up = dvec3(m[1]),
                        .right = dvec3(m[0]),
                        .fov = fov,
                        .fov_axis = imported_camera::axis::smaller},
                    width, height);
            }

            void add_instance(const object_instance& i)
            {
                const auto found = all_.objects.find(i.name);
                if (found == all_.objects.end())
                    fail_at(i.place, "the object " + shown_word(i.name) + " is not defined");
                drawn_objects_.insert(i.name);
                for (const auto& s : found->second)
                    add_shape(s, i.to_world * s.to_world);
            }

            /// What a shape's alpha makes of its material.
            std::uint32_t with_alpha(const shape_entity& s, std::uint32_t material)
            {
                if (s.parameters.find("alpha") == nullptr)
                    return material;
                const auto alpha = values_.number(s, "alpha", 1);
                return builder_.with_opacity(s.place, material, std::clamp(alpha.factor.x, 0.0, 1.0), alpha.texture);
            }

            void add_shape(const shape_entity& s, const glm::dmat4& to_world)
            {
                if (++shapes_ > max_shapes)
                    fail_at(s.place, "more than 2^22 shapes, with all places of objects");
                if (s.area_light && add_emitter(s, to_world))
                    return;
                const auto index = materials_.index_of(s);
                if (!index)
                    return;
                const auto material = with_alpha(s, *index);
                auto made = shapes_reader_.surface_of(s);
                if (made.round.is != round_shape::kind::none) {
                    if (add_round(s, made.round, to_world, material))
                        return;
                    made.surface = shapes_reader_.triangles_of(s, made.round);
                    builder_.note(s.place,
                        "shape " + shown_word(s.type) + ": drawn as " + std::to_string(made.surface->triangles.size())
                            + " triangles, since it is stretched, or has a texture or an alpha");
                }
                if (!made.surface)
                    return;
                if (builder_.has_texture(material) && made.surface->texture_coordinates.empty()) {
                    made.surface = shape_reader::with_coordinates(*made.surface);
                    made.file.clear();
                }
                builder_.add_mesh(s.place, made.surface, to_world, material, made.file);
            }

            bool add_round(
                const shape_entity& s, const round_shape& r, const glm::dmat4& to_world, std::uint32_t material)
            {
                switch (r.is) {
                case round_shape::kind::sphere: return builder_.add_sphere(s.place, r.radius, to_world, material);
                case round_shape::kind::cylinder:
                    return builder_.add_cylinder(s.place, r.radius, r.low, r.high, to_world, material);
                case round_shape::kind::disk: return builder_.add_disk(s.place, r.low, r.radius, to_world, material);
                case round_shape::kind::none: break;
                }
                return false;
            }

            /// \return whether the shape is a lamp and nothing else is to be drawn.
            bool add_emitter(const shape_entity& s, const glm::dmat4& to_world)
            {
                const auto& e = all_.area_lights[*s.area_light];
                const auto& p = e.parameters;
                if (e.type != "diffuse") {
                    builder_.note(e.place, "area light " + shown_word(e.type) + ": drawn as \"diffuse\"");
                }
                auto made = shapes_reader_.surface_of(s);
                if (!made.surface && made.round.is == round_shape::kind::none)
                    return true;
                const auto triangles = made.surface ? made.surface : shapes_reader_.triangles_of(s, made.round);
                imported_emission emission{values_.emission(e, "L") * p.number("scale", 1), p.truth("twosided", false)};
                if (p.find("filename") != nullptr)
                    builder_.note(e.place, "the picture of an area light: its colour is even");
                if (const auto power = p.number("power"); power && *power > 0) {
                    const double area = builder_.area(*triangles, to_world) * (emission.two_sided ? 2 : 1);
                    if (area > 0)
                        emission.radiance *= *power / (area * std::numbers::pi);
                }
                if (emission.radiance == dvec3(0))
                    return false;
                if (s.parameters.find("alpha") != nullptr)
                    builder_.note(s.place, "the alpha of a lamp is left out");
                if (!materials_.is_black(s.material, s.place))
                    builder_.note(s.place, "the surface of a lamp: black; its material is left out");
                if (made.round.is == round_shape::kind::sphere && !s.reverse_orientation
                    && builder_.add_sphere_light(s.place, made.round.radius, to_world, emission))
                    return true;
                if (!made.surface)
                    builder_.note(s.place,
                        "a round lamp: drawn as " + std::to_string(triangles->triangles.size()) + " triangles");
                builder_.add_emitter(s.place, triangles, to_world, emission, made.file);
                return true;
            }

            // --- lights ---
            static dvec3 placed(const glm::dmat4& m, const dvec3& p) { return dvec3(m * glm::dvec4(p, 1)); }

            void add_light(const entity& e)
            {
                const auto& p = e.parameters;
                const auto place_of = [&](const char* name, const dvec3& absent) {
                    return placed(e.to_world, p.point(name).value_or(absent));
                };
                const double scale = p.number("scale", 1);
                if (e.type == "point" || e.type == "goniometric") {
                    if (e.type == "goniometric") {
                        builder_.note(e.place, "light \"goniometric\": shines evenly in all directions");
                        p.find("filename");
                    }
                    auto intensity = values_.emission(e, "I") * scale;
                    if (const auto power = p.number("power"); power && *power > 0)
                        intensity *= *power / (4 * std::numbers::pi);
                    builder_.add_point_light(e.place, place_of("from", dvec3(0)), intensity);
                } else if (e.type == "spot" || e.type == "projection") {
                    add_spot(e, scale);
                } else if (e.type == "distant") {
                    auto irradiance = values_.emission(e, "L") * scale;
                    if (const auto given = p.number("illuminance"); given && *given > 0)
                        irradiance *= *given;
                    builder_.add_directional_light(
                        e.place, place_of("to", dvec3(0, 0, 1)) - place_of("from", dvec3(0)), irradiance);
                } else if (e.type == "infinite") {
                    add_infinite(e, scale);
                } else {
                    builder_.note(e.place, "light " + shown_word(e.type) + ": is left out");
                }
            }

            void add_spot(const entity& e, double scale)
            {
                const auto& p = e.parameters;
                double outer = p.number("coneangle", 30), fading = p.number("conedeltaangle", 5);
                dvec3 from = p.point("from").value_or(dvec3(0)), to = p.point("to").value_or(dvec3(0, 0, 1));
                if (e.type == "projection") {
                    builder_.note(e.place, "light \"projection\": an even spotlight of the same angle");
                    p.find("filename");
                    outer = p.number("fov", 90) / 2;
                    fading = 0;
                }
                if (!(outer >= 0.01 && outer <= 180))
                    fail_at(e.place, "the angle of a spotlight must be from 0.01 to 180 degrees");
                const double inner = std::clamp(outer - fading, 0.0, outer);
                auto intensity = values_.emission(e, "I") * scale;
                if (const auto power = p.number("power"); power && *power > 0)
                    intensity *= *power
                        / (std::numbers::pi * (detail::one_minus_cosine(inner) + detail::one_minus_cosine(outer)));
                builder_.add_spot_light(e.place, placed(e.to_world, from),
                    placed(e.to_world, to) - placed(e.to_world, from), inner, outer, intensity);
            }

            void add_infinite(const entity& e, double scale)
            {
                const auto& p = e.parameters;
                const auto illuminance = p.number("illuminance");
                if (p.find("portal") != nullptr)
                    builder_.note(e.place, "the portal of an environment: light comes from everywhere");
                const auto* old = p.find("mapname"); // pbrt-v3's
                const auto* file = old != nullptr ? old : p.find("filename");
                if (file == nullptr) {
                    auto radiance = values_.emission(e, "L") * scale;
                    if (illuminance && *illuminance > 0)
                        radiance *= *illuminance / std::numbers::pi;
                    builder_.add_sky(e.place, radiance);
                    return;
                }
                if (illuminance)
                    builder_.note(e.place, "the illuminance of an environment with a picture is left out");
                std::shared_ptr<const environment_map> map;
                try {
                    map = builder_.files().environment(p.text(file->name, ""));
                } catch (const file_error& wrong) {
                    fail_at(file->place, wrong.what());
                }
                if (old != nullptr) {
                    // By longitude and latitude: the map's left edge is at x, its middle at -x; z is up.
                    const glm::dmat4 upright(0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 0, 0, 0, 1);
                    const auto radiance = p.find("L") != nullptr ? values_.emission(e, "L") : dvec3(1);
                    builder_.add_environment(
                        e.place, map, radiance * scale, e.to_world * upright, p.text(old->name, ""));
                    return;
                }
                if (map->width != map->height)
                    fail_at(file->place,
                        "the picture of the environment is " + std::to_string(map->width) + " x "
                            + std::to_string(map->height)
                            + " pixels; pbrt-v4 has square ones, of the equal-area map (imgtool makeequiarea)");
                // The map's middle is up: pbrt's z, which is y in photongrid's.
                const glm::dmat4 upright(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);
                builder_.add_environment(e.place, latitudes_of(*map), dvec3(scale), e.to_world * upright);
            }

            /// The place in the equal-area map of a direction (Clarberg 2008, Fast Equal-Area Mapping of the
            /// (Hemi)Sphere using SIMD).
            static glm::dvec2 equal_area_square(const dvec3& d)
            {
                const double x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
                const double r = std::sqrt(std::max(0.0, 1 - z));
                double v = x == 0 && y == 0 ? 0 : r * std::atan2(y, x) * 2 / std::numbers::pi, u = r - v;
                if (d.z < 0) {
                    std::swap(u, v);
                    u = 1 - u;
                    v = 1 - v;
                }
                return {0.5 * (std::copysign(u, d.x) + 1), 0.5 * (std::copysign(v, d.y) + 1)};
            }

            /// The same picture by longitude and latitude. Each texel is the mean of 4 x 4 places in it.
            static std::shared_ptr<const environment_map> latitudes_of(const environment_map& square)
            {
                environment_map made{std::min(2 * square.width, 8192u), std::min(square.width, 4096u), {}};
                made.radiance.reserve(std::size_t{made.width} * made.height);
                const auto at = [&](const glm::dvec2& place) {
                    const auto cell = [&](double c) {
                        return std::min(static_cast<std::uint32_t>(c * square.width), square.width - 1);
                    };
                    return dvec3(square.radiance[std::size_t{cell(place.y)} * square.width + cell(place.x)]);
                };
                constexpr std::uint32_t parts = 4;
                for (std::uint32_t row = 0; row < made.height; ++row)
                    for (std::uint32_t column = 0; column < made.width; ++column) {
                        dvec3 sum(0);
                        for (std::uint32_t part = 0; part < parts * parts; ++part) {
                            const auto middle = [](std::uint32_t n) { return (n + 0.5) / parts; };
                            const auto d = environment_direction((column + middle(part % parts)) / made.width,
                                (row + middle(part / parts)) / made.height);
                            sum += at(equal_area_square(dvec3(d.x, -d.z, d.y))); // z is up in the square
                        }
                        made.radiance.emplace_back(sum / double{parts * parts});
                    }
                return std::make_shared<const environment_map>(std::move(made));
            }

            scene_builder builder_;
            description all_;
            value_reader values_{all_, builder_};
            material_reader materials_{all_, builder_, values_};
            shape_reader shapes_reader_{builder_};
            std::set<std::string> drawn_objects_;
            std::size_t shapes_ = 0;
        };
    } // namespace
} // namespace pbrt

imported_scene parse_pbrt(const std::string& file, std::string_view text, const import_settings& settings)
{
    return pbrt::scene_reader(file, text, settings).read();
}

imported_scene read_pbrt(const std::string& path, const import_settings& settings)
{
    return parsed_file(path, [&](const std::string& bytes) { return parse_pbrt(path, bytes, settings); });
}

} // namespace photongrid
