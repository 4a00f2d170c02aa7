#include <photongrid/io/import/checked_parts.hpp>
#include <photongrid/io/import/token_reader.hpp>
#include <photongrid/io/mitsuba/materials.hpp>
#include <photongrid/io/mitsuba/shapes.hpp>
#include <photongrid/io/mitsuba_file.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

namespace photongrid {

namespace mitsuba {
    namespace {
        constexpr std::size_t max_shapes = std::size_t{1} << 22; // with all places of groups

        class scene_reader {
        public:
            scene_reader(const std::string& file, std::string_view text, const import_settings& settings)
                : builder_(file, settings), all_(parse(file, text, builder_.files(), builder_.log()))
            {
            }

            imported_scene read()
            {
                const auto& scene = all_.scene();
                for (const auto* i : scene.all_of("integrator"))
                    if (const int depth = i->target->whole("max_depth", -1); depth > 0)
                        builder_.set_depth(depth - 1); // without the camera's end
                // What only others name, and how Mitsuba draws.
                for (const auto* tag : {"bsdf", "texture", "spectrum", "medium", "phase", "volume", "subsurface",
                         "sampler", "film", "rfilter"})
                    scene.all_of(tag);
                read_camera(scene.all_of("sensor"));
                for (const auto* s : scene.all_of("shape"))
                    add_shape(*s, glm::dmat4(1));
                for (const auto* e : scene.all_of("emitter"))
                    add_light(*e->target);
                scene.note_unused(builder_.log());
                for (const auto& o : all_.objects)
                    if (drawn_.contains(o.get()))
                        o->note_unused(builder_.log());
                return builder_.finish();
            }

        private:
            // --- the camera ---
            void read_camera(const std::vector<const child*>& sensors)
            {
                if (sensors.empty())
                    return;
                for (std::size_t i = 1; i < sensors.size(); ++i)
                    builder_.note(sensors[i]->place, "a second sensor is left out");
                const auto& o = *sensors[0]->target;
                if (o.type != "perspective")
                    builder_.note(o.place, o.said() + ": drawn as a perspective one");
                std::uint32_t width = 768, height = 576; // Mitsuba's own
                for (const auto* f : o.all_of("film"))
                    read_film(*f->target, width, height);
                for (const auto* not_read : {"sampler", "rfilter"})
                    o.all_of(not_read);
                for (const auto* not_read :
                    {"near_clip", "far_clip", "focus_distance", "shutter_open", "shutter_close"})
                    o.find(not_read);
                if (o.number("aperture_radius", 0) > 0)
                    builder_.note(o.place, o.said() + ": its lens: everything is in focus");
                const auto m = o.transform("to_world");
                if (!is_rigid(glm::dmat3(m)))
                    builder_.note(o.place, o.said() + ": its transformation stretches or skews: drawn without that");
                imported_camera c{.position = dvec3(m[3]),
                    .forward = dvec3(m[2]),
                    .up = dvec3(m[1]),
                    .right = -dvec3(m[0])}; // Mitsuba's camera has x on the left of its picture
                read_field_of_view(o, static_cast<double>(width) / std::max(height, 1u), c);
                drawn_.insert(&o);
                builder_.set_camera(o.place, c, width, height);
            }

            /// Whether a matrix turns, mirrors and scales evenly. Files have six digits.
            static bool is_rigid(const glm::dmat3& m)
            {
                const double x = glm::length(m[0]), y = glm::length(m[1]), z = glm::length(m[2]), most = 1e-3;
                return std::abs(x - y) <= most * x && std::abs(x - z) <= most * x
                    && std::abs(glm::dot(m[0], m[1])) <= most * x * y && std::abs(glm::dot(m[0], m[2])) <= most * x * z
                    && std::abs(glm::dot(m[1], m[2])) <= most * y * z;
            }

            void read_film(const object& f, std::uint32_t& width, std::uint32_t& height)
            {
                const auto side = [&](const char* name, std::uint32_t absent) {
                    return static_cast<std::uint32_t>(std::clamp(f.whole(name, static_cast<int>(absent)), 0, 1 << 20));
                };
                width = side("width", width);
                height = side("height", height);
                for (const auto* name : {"crop_width", "crop_height", "crop_offset_x", "crop_offset_y"})
                    if (const auto* p = f.find(name))
                        builder_.note(p->place, std::string(name) + ": the whole picture is drawn");
                // The rest says how a picture is stored.
            }

            static double full_angle(double tangent_of_half) { return glm::degrees(2 * std::atan(tangent_of_half)); }

            void read_field_of_view(const object& o, double aspect, imported_camera& c)
            {
                const auto given = o.number("fov");
                auto axis = o.text("fov_axis", "x");
                double fov = given.value_or(0);
                if (const auto length = focal_length(o); length && given)
                    fail_at(o.place, o.said() + " has both \"fov\" and \"focal_length\"");
                else if (!given) { // of a picture of 36 x 24 mm
                    fov = full_angle(std::hypot(36, 24) / 2 / length.value_or(50));
                    axis = "diagonal";
                }
                if (!(fov > 0 && fov < 180))
                    fail_at(o.place, o.said() + ": the field of view must be above 0 and below 180 degrees");
                c.fov = fov;
                if (axis == "x") {
                    c.fov_axis = imported_camera::axis::horizontal;
                } else if (axis == "y") {
                    c.fov_axis = imported_camera::axis::vertical;
                } else if (axis == "smaller") {
                    c.fov_axis = imported_camera::axis::smaller;
                } else if (axis == "larger") {
                    c.fov_axis = imported_camera::axis::larger;
                } else if (axis == "diagonal") {
                    c.fov_axis = imported_camera::axis::vertical;
                    c.fov = full_angle(std::tan(glm::radians(fov) / 2) / std::hypot(aspect, 1));
                } else {
                    fail_at(o.place,
                        "found the fov_axis " + shown_word(axis) + "; expected x, y, diagonal, smaller or larger");
                }
            }

            /// mm, as "50mm".
            static std::optional<double> focal_length(const object& o)
            {
                const auto* p = o.find("focal_length");
                if (p == nullptr)
                    return std::nullopt;
                if (p->is == property_kind::number || p->is == property_kind::whole)
                    return p->numbers[0];
                std::string_view text = p->is == property_kind::text ? std::string_view(p->text) : "";
                if (text.ends_with("mm"))
                    text.remove_suffix(2);
                while (text.ends_with(" "))
                    text.remove_suffix(1);
                const auto length = token_reader::number_of(text);
                if (!length || !(*length > 0))
                    fail_at(p->place, "found a focal_length that is not one number of mm above 0, as 50mm");
                return length;
            }

            // --- shapes ---
            void add_shape(const child& c, const glm::dmat4& outer)
            {
                const auto& o = *c.target;
                if (o.tag != "shape")
                    fail_at(c.place, "found the " + o.said() + "; expected a shape");
                if (o.type == "shapegroup")
                    return; // instances draw it
                if (++shapes_ > max_shapes)
                    fail_at(o.place, "more than 2^22 shapes, with all places of groups");
                drawn_.insert(&o);
                const auto to_world = outer * o.transform("to_world");
                if (o.type == "instance" || o.type == "merge")
                    return add_instance(o, to_world);
                const auto absorbed = absorbed_inside(o);
                const auto bsdfs = o.all_of("bsdf");
                if (bsdfs.size() > 1)
                    builder_.note(o.place, o.said() + " with several bsdfs: the first one is drawn");
                const auto* bsdf = bsdfs.empty() ? nullptr : bsdfs[0];
                for (const auto* e : o.all_of("emitter"))
                    if (add_emitter(o, *e->target, bsdf, to_world))
                        return;
                const auto index = materials_.with_absorption(o.place, materials_.index_of(bsdf), absorbed);
                if (index)
                    add_surface(o, to_world, *index);
            }

            /// What the medium inside a shape absorbs of light by the unit of length. Notes what is left out.
            dvec3 absorbed_inside(const object& o)
            {
                dvec3 absorbed(0);
                bool left_out = !o.all_of("subsurface").empty();
                for (const auto* c : o.all_of("medium"))
                    if (c->name == "interior" && c->target->type == "homogeneous")
                        absorbed = absorbed_by(*c->target);
                    else
                        left_out = true;
                if (left_out && !noted_medium_)
                    builder_.note(
                        o.place, "the media of shapes are left out but for those inside that are homogeneous");
                noted_medium_ = noted_medium_ || left_out;
                return absorbed;
            }

            dvec3 absorbed_by(const object& medium)
            {
                if (const auto before = media_.find(&medium); before != media_.end())
                    return before->second;
                const auto albedo = medium.find("albedo") != nullptr ? values_.emission(medium, "albedo") : dvec3(0.75);
                const double scale = values_.number(medium, "scale", 1).factor.x;
                const auto absorbed
                    = glm::max(values_.emission(medium, "sigma_t") * scale * (dvec3(1) - albedo), dvec3(0));
                if (albedo != dvec3(0))
                    builder_.note(medium.place, medium.said() + ": absorbs light, but does not scatter it");
                medium.all_of("phase");
                medium.find("has_spectral_extinction");
                medium.find("sample_emitters");
                medium.note_unused(builder_.log());
                return media_.emplace(&medium, absorbed).first->second;
            }

            /// The shapes of the groups that an instance places.
            void add_instance(const object& o, const glm::dmat4& to_world)
            {
                const auto inside = o.all_of("shape");
                if (inside.empty())
                    fail_at(o.place, o.said() + " has no " + (o.type == "merge" ? "shape" : "shapegroup") + " inside");
                if (is_in_group_)
                    fail_at(o.place, "found the " + o.said() + " within another one; Mitsuba has none there");
                is_in_group_ = true;
                for (const auto* i : inside) {
                    if (i->target->type != "shapegroup") {
                        add_shape(*i, to_world);
                        continue;
                    }
                    drawn_.insert(i->target);
                    for (const auto* s : i->target->all_of("shape"))
                        add_shape(*s, to_world);
                }
                is_in_group_ = false;
            }

            void add_surface(const object& o, const glm::dmat4& to_world, std::uint32_t material)
            {
                const surface_needs needs{builder_.has_texture(material), materials_.has_vertex_colors(material)};
                auto made = shapes_reader_.surface_of(o, needs);
                const bool is_reversed_glass = materials_.refracts(material) && o.truth("flip_normals", false);
                if (made.round.is != round_shape::kind::none) {
                    if (!is_reversed_glass && add_round(o, made.round, to_world, material))
                        return;
                    made.surface = shapes_reader_.triangles_of(o, made.round);
                    builder_.note(o.place,
                        o.said() + ": drawn as " + std::to_string(made.surface->triangles.size())
                            + " triangles, since it is stretched, or has a texture or an opacity, or is glass turned "
                              "inside out");
                }
                if (made.surface)
                    builder_.add_mesh(o.place, made.surface, to_world * made.round.to_shape, material, made.file);
            }

            bool add_round(const object& o, const round_shape& r, const glm::dmat4& to_world, std::uint32_t material)
            {
                o.find("flip_normals"); // surfaces are the same on both sides
                const auto m = to_world * r.to_shape;
                switch (r.is) {
                case round_shape::kind::sphere: return builder_.add_sphere(o.place, r.radius, m, material);
                case round_shape::kind::cylinder:
                    return builder_.add_cylinder(o.place, r.radius, 0, r.height, m, material);
                case round_shape::kind::disk: return builder_.add_disk(o.place, 0, r.radius, m, material);
                case round_shape::kind::none: break;
                }
                return false;
            }

            /// \return whether the shape is a lamp and nothing else is to be drawn.
            bool add_emitter(const object& o, const object& e, const child* bsdf, const glm::dmat4& to_world)
            {
                drawn_.insert(&e);
                if (e.type != "area")
                    builder_.note(e.place, e.said() + " of a shape: drawn as \"area\"");
                e.find("sampling_weight"); // how Mitsuba draws
                const imported_emission emission{values_.emission(e, "radiance")};
                if (emission.radiance == dvec3(0))
                    return false;
                auto made = shapes_reader_.surface_of(o, {});
                if (!made.surface && made.round.is == round_shape::kind::none)
                    return true;
                if (!material_reader::is_black(bsdf))
                    builder_.note(o.place, "the surface of a lamp: black; its bsdf is left out");
                if (made.round.is == round_shape::kind::sphere && !o.truth("flip_normals", false)
                    && builder_.add_sphere_light(o.place, made.round.radius, to_world * made.round.to_shape, emission))
                    return true;
                if (!made.surface) {
                    made.surface = shapes_reader_.triangles_of(o, made.round);
                    builder_.note(o.place,
                        "a round lamp: drawn as " + std::to_string(made.surface->triangles.size()) + " triangles");
                }
                builder_.add_emitter(o.place, made.surface, to_world * made.round.to_shape, emission, made.file);
                return true;
            }

            // --- lights ---
            void add_light(const object& o)
            {
                if (o.type == "area")
                    return; // of the shapes that name it
                drawn_.insert(&o);
                o.find("sampling_weight");
                const auto m = o.transform("to_world");
                if (o.type == "point") {
                    builder_.add_point_light(
                        o.place, o.vector("position").value_or(dvec3(m[3])), values_.emission(o, "intensity"));
                } else if (o.type == "spot") {
                    add_spot(o, m);
                } else if (o.type == "directional") {
                    builder_.add_directional_light(
                        o.place, o.vector("direction").value_or(dvec3(m[2])), values_.emission(o, "irradiance"));
                } else if (o.type == "constant") {
                    builder_.add_sky(o.place, values_.emission(o, "radiance"));
                } else if (o.type == "envmap") {
                    add_environment(o, m);
                } else {
                    drawn_.erase(&o); // one note is enough
                    builder_.note(o.place, o.said() + ": is left out");
                }
            }

            void add_spot(const object& o, const glm::dmat4& m)
            {
                const double outer = o.number("cutoff_angle", 20), inner = o.number("beam_width", outer * 3 / 4);
                if (!(outer >= 0.01 && outer <= 180))
                    fail_at(o.place, "the angle of a spotlight must be from 0.01 to 180 degrees");
                if (inner < outer)
                    builder_.note(
                        o.place, o.said() + ": its edge falls off smoothly in the cosine, not evenly in the angle");
                builder_.add_spot_light(o.place, dvec3(m[3]), dvec3(m[2]), std::clamp(inner, 0.0, outer), outer,
                    values_.emission(o, "intensity"));
            }

            void add_environment(const object& o, const glm::dmat4& m)
            {
                const auto* file = o.find("filename");
                if (file == nullptr)
                    fail_at(o.place, o.said() + " lacks \"filename\"");
                const auto name = o.text("filename", "");
                for (const auto* not_read : {"mis_compensation", "cache"})
                    o.find(not_read);
                std::shared_ptr<const environment_map> map;
                try {
                    map = builder_.files().environment(name);
                } catch (const file_error& wrong) {
                    fail_at(file->place, wrong.what());
                }
                // Mitsuba's picture has the directions of photongrid's.
                builder_.add_environment(o.place, map, dvec3(o.number("scale", 1)), m, name);
            }

            scene_builder builder_;
            description all_;
            value_reader values_{builder_};
            material_reader materials_{builder_, values_};
            shape_reader shapes_reader_{builder_};
            std::set<const object*> drawn_; ///< that something is made of
            std::size_t shapes_ = 0;
            std::map<const object*, dvec3> media_; ///< what they absorb
            bool noted_medium_ = false, is_in_group_ = false;
        };
    } // namespace
} // namespace mitsuba

imported_scene parse_mitsuba(const std::string& file, std::string_view text, const import_settings& settings)
{
    return mitsuba::scene_reader(file, text, settings).read();
}

imported_scene read_mitsuba(const std::string& path, const import_settings& settings)
{
    return parsed_file(path, [&](const std::string& bytes) { return parse_mitsuba(path, bytes, settings); });
}

} // namespace photongrid
