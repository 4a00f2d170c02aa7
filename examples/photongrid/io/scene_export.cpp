#include <photongrid/io/export/picture_files.hpp>
#include <photongrid/io/gltf_writer.hpp>
#include <photongrid/io/pbrt_writer.hpp>
#include <photongrid/io/scene_export.hpp>
#include <photongrid/io/scene_file.hpp>
#include <photongrid/io/scene_values.hpp>
#include <photongrid/io/scene_writer.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace photongrid {

namespace {
    constexpr std::size_t small_mesh = 64;       // triangles; a larger one has a file
    constexpr std::size_t most_listed = 200'000; // numbers of all small meshes, of the 10^6 that a scene file may have

    /// What a scene is when it comes from a scene file: with the names, files and materials' members that those have.
    class scene_as_written {
    public:
        scene_as_written(const scene& s, side_files& files, const std::string& source)
            : made_(s), files_(files), pictures_(files, source)
        {
            made_.name = name_from(s.name);
            for (auto& m : made_.materials)
                write(m);
            const auto for_each_mesh = [&](const auto& visit) {
                for (auto& m : made_.meshes)
                    visit(m);
                for (auto& l : made_.mesh_lights)
                    visit(l.surface);
            };
            for_each_mesh([&](const placed_mesh& m) { ++uses_[m.surface]; });
            for_each_mesh([&](placed_mesh& m) { write(m); });
            for (auto& l : made_.environment_lights)
                l.file = l.map ? pictures_.environment(l) : "";
            for_each_light(made_, [&](auto& list, auto) {
                for (auto& l : list)
                    l.name = l.name.empty() ? "" : name_from(l.name);
            });
        }

        scene& made() { return made_; }

    private:
        static std::string name_from(const std::string& name)
        {
            return scene_values::is_name(name) || name.empty() ? name : printable(name, 100);
        }

        void write(material& m)
        {
            const material plain;
            m.name = name_from(m.name);
            const auto& fields = detail::entry_of(m.kind).fields;
            const auto has = [&](auto member) {
                return std::any_of(fields.begin(), fields.end(), [&](const material_field& f) {
                    const auto* p = std::get_if<decltype(member)>(&f.member);
                    return p != nullptr && *p == member;
                });
            };
            const auto forget_unless_had = [&](auto member) {
                if (!has(member))
                    m.*member = plain.*member;
            };
            forget_unless_had(&material::reflectance);
            forget_unless_had(&material::index_of_refraction);
            forget_unless_had(&material::roughness);
            forget_unless_had(&material::opacity);
            forget_unless_had(&material::share);
            if (!has_energy(detail::entry_of(m.kind)))
                m.energy = plain.energy;
            if (!is_mixture(m))
                m.parts = plain.parts;
            const auto write_texture = [&](texture_use& t, texture_holds holds) {
                if (!t.map) {
                    t = {};
                    return;
                }
                if (holds == texture_holds::colour)
                    t.channel = {};
                t.file = pictures_.texture(t, holds);
            };
            write_texture(m.texture, texture_holds::colour);
            for (const auto& [key, member] : detail::number_textures)
                write_texture(m.*member, texture_holds::numbers);
        }

        /// A surface is listed in the scene's file if it is small, if the file's numbers hold it, and if it is placed
        /// once: a list of its own in each place would not be the same surface any more.
        void write(placed_mesh& m)
        {
            const auto& s = *m.surface;
            const std::size_t numbers = 3 * s.triangles.size() + s.positions.size() * (s.normals.empty() ? 3 : 6)
                + 2 * s.texture_coordinates.size() + 3 * s.colors.size();
            const bool is_small = s.triangles.size() < small_mesh && listed_ + numbers <= most_listed;
            m.file = "";
            if (is_small && uses_.at(m.surface) == 1 && can_be_listed(s))
                listed_ += numbers;
            else
                m.file = files_.add_surface(m.surface);
        }

        /// PLY files hold larger coordinates, and normals of length 0.
        static bool can_be_listed(const mesh& s)
        {
            const auto is_below = [](const glm::vec3& v) {
                return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) <= 1e9f;
            };
            return is_below(glm::vec3(s.origin)) && std::all_of(s.positions.begin(), s.positions.end(), is_below)
                && std::all_of(s.normals.begin(), s.normals.end(),
                    [&](const glm::vec3& n) { return is_below(n) && glm::length(glm::dvec3(n)) >= 1e-8; });
        }

        scene made_;
        side_files& files_;
        picture_files pictures_;
        std::map<std::shared_ptr<const mesh>, std::size_t> uses_; ///< in how many places each surface is
        std::size_t listed_ = 0;
    };

    /// Gives the materials and lights of `to` the names that those of `from` have.
    void take_names(scene& to, const scene& from)
    {
        to.name = from.name;
        for (std::size_t i = 0; i < std::min(to.materials.size(), from.materials.size()); ++i)
            to.materials[i].name = from.materials[i].name;
        const auto take = [](auto& list, const auto& other) {
            for (std::size_t i = 0; i < std::min(list.size(), other.size()); ++i)
                list[i].name = other[i].name;
        };
        auto lists = light_lists(to);
        const auto others = light_lists(from);
        [&]<std::size_t... I>(std::index_sequence<I...>) { (take(std::get<I>(lists), std::get<I>(others)), ...); }
        (std::make_index_sequence<std::tuple_size_v<decltype(lists)>>{});
    }

    struct format_row {
        std::string_view ending;
        exported_scene (*write)(const std::string& path, const scene& s, const export_settings& settings);
    };
    constexpr format_row written_formats[]
        = {{".json", write_scene}, {".pbrt", write_pbrt}, {".gltf", write_gltf}, {".glb", write_gltf}};

    const format_row& format_for(const std::string& path)
    {
        const auto ending = std::filesystem::path(path).extension() == ".gz" ? "" : ending_of(path);
        for (const auto& f : written_formats)
            if (f.ending == ending)
                return f;
        fail_file(path, "has no known extension; expected .json (photongrid), .pbrt, .gltf or .glb");
    }
} // namespace

exported_scene write_scene(const std::string& path, const scene& s, const export_settings& settings)
{
    const auto refuse
        = [&](const std::string& what) { throw scene_error(path, 0, 0, "cannot hold this scene: " + what); };
    try {
        check(s);
    } catch (const std::invalid_argument& e) {
        refuse(e.what());
    }
    side_files files(path);
    scene_as_written written(s, files, settings.source);
    const auto text = scene_text(written.made(), written.made().render);
    // Scene files have limits of their own, so that what they read is compared with what was to be written.
    try {
        const auto read = parse_scene(path, text);
        take_names(written.made(), read);
        if (!(read == written.made()))
            refuse("it would not read as the same one");
    } catch (const scene_error& e) {
        const std::string said = e.what();
        const auto begin = said.rfind(": error: ");
        refuse(begin == std::string::npos ? said : said.substr(begin + 9));
    }
    return {files.finish(text), {}};
}

exported_scene export_scene(const std::string& path, const scene& s, const export_settings& settings)
{
    return format_for(path).write(path, s, settings);
}

void check_export_path(const std::string& path)
{
    format_for(path);
    check_file_path(path);
}

} // namespace photongrid
