#include "scene_options.hpp"

#include <map>
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
    to.add_option("scene", path, "scene file: photongrid's own, glTF, OBJ, PLY, pbrt-v4 or Mitsuba")
        ->required()
        ->type_name("SCENE");
    to.add_flag(
        "--strict", how.strict, "refuse a scene of another program if anything in it would be replaced or left out");
    to.add_flag(
        "--allow-outside", how.allow_outside, "let a scene of another program name files outside of its own folder");
    to.add_option("--unit", how.unit,
          "length of the unit of another program's scene, m; default: that of its format; its lights are scaled "
          "along, so that the picture stays the same")
        ->type_name("METRES")
        ->check(CLI::Range(1e-9, 1e9).description(""));
    to.add_flag(
        "--z-up", how.z_up, "z is up in a scene of another program, as in plans and surveys: turn it so that y is");
    to.add_option("--max-pixels", how.max_pixels,
          "the most pixels that the scene's pictures may claim, beside 32 for each of their bytes; default: 2^26")
        ->type_name("N")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40).description(""));
    to.add_option("--camera-from", how.camera_from,
          "scene of any format whose camera and size of the picture are taken in place of the scene's own")
        ->type_name("SCENE");
    to.add_option("--environment", how.environment,
          "picture of light from everywhere, by longitude and latitude, in place of the scene's environments")
        ->type_name("PICTURE.exr|.hdr|...");
    to.add_option("--environment-rotate", how.environment_rotate,
          "how far that picture is turned about y: with 0 its middle is at z, with 90 at x; default: 90 for a scene "
          "that "
          "Blender wrote, where it stands so, else 0")
        ->type_name("DEGREES")
        ->check(CLI::Range(-360.0, 360.0).description(""));
    to.add_option("--emission-unit", how.emission_unit,
          "unit of the radiance of surfaces in a glTF file: watts/(m^2 sr) or nits; default: watts for a scene that "
          "Blender wrote, which has them so, else nits")
        ->type_name("watts|nits")
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, import_settings::emission>{
                {"watts", import_settings::emission::watts}, {"nits", import_settings::emission::nits}})
                        .description(""));
}

files_of_command::files_of_command(const std::string& scene, const import_settings& how)
{
    files_.push_back({"the scene", resolved(scene)});
    read(how.camera_from);
    read(how.environment);
}

void files_of_command::read(const std::string& path)
{
    if (!path.empty())
        files_.push_back({"a file that is read", resolved(path)});
}

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
