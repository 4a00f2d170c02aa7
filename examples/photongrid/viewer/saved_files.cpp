#include "saved_files.hpp"

#include <photongrid/io/files.hpp>
#include <photongrid/io/image_file.hpp>
#include <photongrid/io/scene_edit.hpp>
#include <photongrid/io/scene_file.hpp>

#include <filesystem>

namespace photongrid::viewer {

namespace {
    /// A file's name that is not taken: STEM.png, STEM-2.png, …
    std::string free_name(const std::string& stem, const std::string& ending)
    {
        auto name = stem + ending;
        for (int n = 2; std::filesystem::exists(name); ++n)
            name = std::string(stem).append(1, '-').append(std::to_string(n)).append(ending);
        return name;
    }
} // namespace

std::string saved_files::save(const image& picture, double exposure) const
{
    try {
        const auto png = free_name(stem_, ".png"), exr = png.substr(0, png.size() - 4) + ".exr";
        write_image(png, picture, exposure);
        write_image(exr, picture);
        return "saved " + png + " and " + exr;
    } catch (const file_error& e) {
        return e.what();
    }
}

std::string saved_files::save(const version& v)
{
    if (scene_text_.empty())
        return "not saved: only scenes in photongrid's own format can be";
    try {
        const auto text = edited_scene_text(scene_path_, scene_text_, v.scene, v.settings);
        const auto folder = names_files_ ? std::filesystem::path(scene_path_).parent_path() : std::filesystem::path();
        const auto name = free_name((folder / (stem_ + "-changed")).string(), ".json");
        parse_scene(name, text);
        write_file(name, text);
        last_ = v;
        return "saved " + name;
    } catch (const scene_error& e) {
        return std::string("not saved, since it cannot be rendered: ") + e.what();
    } catch (const std::invalid_argument&) {
        return "not saved: a file that the scene names has changed since it was read; drop the scene's file here to "
               "open "
               "it anew";
    } catch (const file_error& e) {
        return e.what();
    }
}

} // namespace photongrid::viewer
