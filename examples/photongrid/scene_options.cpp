#include "scene_options.hpp"

#include <system_error>

namespace photongrid {

namespace {
    std::filesystem::path resolved(const std::string& path)
    {
        std::error_code none;
        const auto real = std::filesystem::weakly_canonical(std::filesystem::absolute(path, none), none);
        return none ? std::filesystem::path(path) : real;
    }
} // namespace

void add_scene(CLI::App& to, std::string& path, import_settings& how)
{
    to.add_option("scene", path, "scene file, of photongrid or of pbrt-v4")->required()->type_name("SCENE");
    to.add_flag(
        "--strict", how.strict, "refuse a scene of another program if anything in it would be replaced or left out");
    to.add_flag(
        "--allow-outside", how.allow_outside, "let a scene of another program name files outside of its own folder");
    to.add_option("--unit", how.unit,
          "length of the unit of another program's scene, m; default: that of its format; its lights are scaled "
          "along, so that the picture stays the same")
        ->type_name("METRES")
        ->check(CLI::Range(1e-9, 1e9).description(""));
}

files_of_command::files_of_command(const std::string& scene) { files_.push_back({"the scene", resolved(scene)}); }

void files_of_command::add(const std::string& option, const std::string& path)
{
    if (path.empty())
        return;
    const auto real = resolved(path);
    for (const auto& f : files_)
        if (f.path == real)
            throw CLI::ValidationError(option, "\"" + path + "\" is " + f.what + "; expected another file");
    files_.push_back({"the file of " + option + " too", real});
}

} // namespace photongrid
