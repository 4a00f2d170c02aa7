#include <photongrid/io/import/scene_builder.hpp>
#include <photongrid/io/obj/materials.hpp>
#include <photongrid/io/obj/surface.hpp>
#include <photongrid/io/obj_scene.hpp>
#include <photongrid/io/ply_file.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

namespace photongrid {

namespace obj {
    namespace {
        class scene_maker {
        public:
            scene_maker(const std::string& file, surface s, const import_settings& settings)
                : file_(file), builder_(file, settings), surface_(std::move(s))
            {
            }

            imported_scene made()
            {
                if (surface_.face_starts.empty())
                    fail_at(
                        file_, "the file has no face; points, lines and curves have no surface that could be drawn");
                for (const auto& l : surface_.libraries)
                    read_library(l);
                note_what_is_left_out();
                resolve_names();
                for (const auto& [material, faces] : faces_by_material())
                    add_faces(material, faces);
                if (cutter_.not_cut() > 0)
                    builder_.note(file_, text_of_crossed_faces(cutter_.not_cut()));
                return builder_.finish();
            }

        private:
            static constexpr std::uint32_t undefined = absent; ///< the number of no material

            /// A file whose name may have blanks, or several.
            void read_library(const placed_name& names)
            {
                std::error_code none;
                const auto exists = [&](const std::string& name) {
                    return name.size() <= 1000 && std::filesystem::is_regular_file(path_of(names.place, name), none);
                };
                if (names.name.empty())
                    fail_at(names.place, "found mtllib without a file's name");
                if (exists(names.name)) {
                    read_materials(names.place, names.name);
                    return;
                }
                for (std::size_t at = 0; at < names.name.size();) {
                    const auto past = std::min(names.name.find_first_of(" \t", at), names.name.size());
                    if (past > at)
                        read_materials(names.place, names.name.substr(at, past - at));
                    at = past + 1;
                }
            }
            std::string path_of(const source_place& place, const std::string& name)
            {
                try {
                    return builder_.files().path_of(name);
                } catch (const file_error& e) {
                    fail_at(place, e.what());
                }
            }
            void read_materials(const source_place& place, const std::string& name)
            {
                const auto path = path_of(place, name);
                if (!read_libraries_.insert(path).second)
                    return;
                std::string text;
                try {
                    text = builder_.files().bytes_of(name);
                } catch (const file_error& e) {
                    builder_.note(place, std::string("a file of materials is left out: ") + e.what());
                    return;
                }
                for (auto& m : parse_mtl(path, text)) {
                    const auto [before, is_new]
                        = numbers_.try_emplace(m.name, static_cast<std::uint32_t>(defined_.size()));
                    if (is_new)
                        defined_.push_back(std::move(m));
                    else
                        builder_.note(
                            m.place, "material " + shown_word(m.name) + " is defined before; this one is left out");
                }
            }

            void note_what_is_left_out()
            {
                for (const auto& s : surface_.skipped)
                    builder_.note(s.place,
                        shown_word(s.statement) + " is left out"
                            + (s.count > 1 ? ", here and " + std::to_string(s.count - 1) + " times more" : ""));
                if (surface_.flat.count > 0)
                    builder_.note(surface_.flat.place, text_of_flat_faces(surface_.flat.count));
                if (surface_.smooth_without_normals)
                    builder_.note(
                        *surface_.smooth_without_normals, "smoothing is left out: faces without normals look flat");
            }

            /// The material of each name.
            void resolve_names()
            {
                for (const auto& m : surface_.materials) {
                    auto found = numbers_.find(m.name);
                    if (const auto comment = m.name.find('#'); found == numbers_.end() && comment != std::string::npos)
                        found = numbers_.find(m.name.substr(0, m.name.find_last_not_of(" \t", comment - 1) + 1));
                    resolved_.push_back(found == numbers_.end() ? undefined : found->second);
                    if (found == numbers_.end() && !defined_.empty())
                        builder_.note(m.place,
                            "the material " + shown_word(m.name) + " is not defined: drawn as diffuse "
                                + default_reflectance());
                }
                if (!surface_.materials.empty() && defined_.empty())
                    builder_.note(surface_.materials[0].place,
                        "no material is defined: all are drawn as diffuse " + default_reflectance());
            }
            std::string default_reflectance() const { return surface_.colors.empty() ? "0.5" : "1"; }

            std::map<std::uint32_t, std::vector<face_range>> faces_by_material() const
            {
                std::map<std::uint32_t, std::vector<face_range>> faces;
                const auto add = [&](std::uint32_t material, std::uint32_t first, std::uint32_t past) {
                    if (past > first)
                        faces[material].push_back({first, past});
                };
                std::uint32_t first = 0, material = undefined;
                for (const auto& c : surface_.changes) {
                    add(material, first, c.face);
                    first = c.face;
                    material = resolved_[c.name];
                }
                add(material, first, static_cast<std::uint32_t>(surface_.face_starts.size()));
                return faces;
            }

            void add_faces(std::uint32_t number, const std::vector<face_range>& faces)
            {
                const auto surface = std::make_shared<const mesh>(mesh_of(surface_, faces, cutter_));
                if (number == undefined) {
                    const material grey{
                        .name = "without material", .reflectance = dvec3(surface_.colors.empty() ? 0.5 : 1.0)};
                    builder_.add_mesh(file_, surface, glm::dmat4(1), builder_.add_material(file_, grey));
                    return;
                }
                const auto& m = defined_[number];
                if (const auto emission = emission_of(builder_, m))
                    builder_.add_emitter(m.place, surface, glm::dmat4(1), *emission);
                else
                    builder_.add_mesh(m.place, surface, glm::dmat4(1),
                        add_material(builder_, m, !surface->texture_coordinates.empty()));
            }

            source_place file_;
            scene_builder builder_;
            surface surface_;
            polygon_cutter cutter_;
            std::set<std::string> read_libraries_;
            std::vector<mtl_material> defined_;
            std::map<std::string, std::uint32_t> numbers_; ///< of materials by their names
            std::vector<std::uint32_t> resolved_;          ///< numbers of the names in surface_
        };
    } // namespace
} // namespace obj

imported_scene parse_obj_scene(const std::string& file, std::string_view text, const import_settings& settings)
{
    return obj::scene_maker(file, obj::parse(file, text), settings).made();
}

imported_scene read_obj_scene(const std::string& path, const import_settings& settings)
{
    // The text is gone before the scene is made.
    auto parsed = parsed_file(path, [&](const std::string& text) { return obj::parse(path, text); });
    return obj::scene_maker(path, std::move(parsed), settings).made();
}

namespace {
    imported_scene scene_of_ply(
        const std::string& path, std::string_view bytes, const std::string& file, const import_settings& settings)
    {
        const source_place place(path);
        const auto name = std::make_shared<const std::string>(path);
        scene_builder builder(path, settings);
        ply_rest rest;
        const auto surface = std::make_shared<const mesh>(parse_ply(path, bytes, &rest));
        if (surface->triangles.empty())
            fail_at(place, "the file has no face, so that there is no surface to be drawn");
        for (const auto& r : rest.left_out)
            builder.note({name, r.line, 1}, r.what);
        material m{.name = "surface", .reflectance = dvec3(surface->colors.empty() ? 0.5 : 1.0)};
        if (const source_place at(name, rest.texture_line, 1); !rest.texture.empty()) {
            if (surface->texture_coordinates.empty()) {
                builder.note(at, "a picture is left out: the vertices have no texture coordinates");
            } else if (const auto t = builder.texture(at, rest.texture, texture_holds::colour)) {
                m.texture = *t;
                m.reflectance = dvec3(1);
            }
        }
        builder.add_mesh(place, surface, glm::dmat4(1), builder.add_material(place, std::move(m)), file);
        return builder.finish();
    }
} // namespace

imported_scene parse_ply_scene(const std::string& file, std::string_view bytes, const import_settings& settings)
{
    return scene_of_ply(file, bytes, "", settings);
}

imported_scene read_ply_scene(const std::string& path, const import_settings& settings)
{
    const auto name = std::filesystem::path(path).filename().string();
    return parsed_file(path, [&](const std::string& bytes) { return scene_of_ply(path, bytes, name, settings); });
}

} // namespace photongrid
