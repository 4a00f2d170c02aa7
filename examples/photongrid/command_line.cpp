// The options of every command. The file is long because it is the whole of `--help`, in its order, and commands share
// options and checks.
#include "command_line.hpp"

#include "error_options.hpp"
#include "option_values.hpp"
#include "scene_options.hpp"

#include <photongrid/io/image_file.hpp>
#include <photongrid/io/setting_texts.hpp>
#include <photongrid/scene/setting_table.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <sstream>
#include <string_view>
#include <type_traits>
#include <utility>

namespace photongrid {

namespace {
    constexpr const char* commands[]
        = {"render", "view", "reference", "compare", "error", "check", "convert", "devices"};

    constexpr std::string_view examples[] = {"render examples/scenes/cornell_box.json -o cornell.png",
        "render ring.json --backend vulkan --map route -o ring.exr -o ring.png --stats ring-stats.json",
        "render ring.json --size 128x96 --photons 4000 --exposure 1 --quiet",
        "render glass_ball.json --progressive steps --every 50 --strip figure8.png --crop 96x96+180+150",
        "render cornell_box.json --spp 256 --resume unfinished -o box.exr",
        "render cornell_box.json --until-error 0.02 --seconds 600 -o box.exr",
        "render ring.json --only caustic --filter silverman --leaks side,min_cosine=0.7 --aov -o ring.exr",
        "reference ring.json -o reference.exr --error error.exr --paths 1e8",
        "compare ring.exr reference.exr --max-relmse 1e-3",
        "error ring.exr reference.exr --region shadows!=direct.exr --region caustics=caustic.exr,1 -o errors.png",
        "check my_scene.json", "convert examples/scenes/still_life.pbrt still_life.json",
        "convert cornell_box.json cornell_box.glb", "view cornell_box.json --size 320x320"};

    constexpr const char* exit_codes = R"(Exit codes:
  0    done
  1    compare: relMSE above --max-relmse; compare, error: no pixel is finite in both pictures; render, reference: the
       picture could not be made
  2    the command line is wrong
  3    the scene file is wrong
  4    the backend or device is not available, or it failed
  5    a picture or statistics file could not be read or written, or pictures of different sizes were compared,
       or a region is empty
  130  interrupted (Ctrl-C); the best picture so far is written, if there is one; no file is left half-written
)";

    // What --help of a command ends with, or of the whole program if that is "".
    std::string footer(std::string_view command)
    {
        std::string lines;
        for (const auto e : examples)
            if (e.starts_with(command))
                lines += "  photongrid " + std::string(e) + "\n";
        return (lines.empty() ? "" : "Examples:\n" + lines + "\n") + exit_codes;
    }

    /// Throws if the first word is no command: CLI11 only says that one is required.
    void expect_command(int argc, char** argv)
    {
        const std::string_view first = argc > 1 ? argv[1] : "";
        if (first.empty() || first.starts_with("-")
            || std::find(std::begin(commands), std::end(commands), first) != std::end(commands))
            return;
        if (std::error_code none; std::filesystem::is_regular_file(first, none)) {
            const std::string file(first);
            throw CLI::ValidationError(
                "photongrid", "\"" + file + "\" is a file, not a command; \"photongrid render " + file + "\" draws it");
        }
        std::string expected;
        for (const auto* name : commands)
            expected += (name == commands[0] ? "" : name == *std::rbegin(commands) ? " or " : ", ") + std::string(name);
        throw CLI::ValidationError(
            "photongrid", "\"" + std::string(first) + "\" is not a command; expected " + expected);
    }

    bool is_stop_rule(const char* setting)
    {
        return setting == std::string_view(setting_table::until_error.name)
            || setting == std::string_view(setting_table::seconds.name);
    }

    /// Wraps descriptions, so that they stay beside the options.
    class wrapped_help : public CLI::Formatter {
    public:
        std::string make_option_desc(const CLI::Option* option) const override
        {
            constexpr std::size_t most = 88;
            std::istringstream words(CLI::Formatter::make_option_desc(option));
            std::string all, line;
            for (std::string word; words >> word; line += (line.empty() ? "" : " ") + word)
                if (!line.empty() && line.size() + 1 + word.size() > most)
                    all += std::exchange(line, "") + "\n";
            return all + line;
        }
    };

    void add_to_group(CLI::App& to, const std::string& group) { to.option_defaults()->group(group); }

    /// An option for a row of the table of settings.
    template <class Row>
    void add_setting(CLI::App& to, const Row& row, render_options& o)
    {
        const auto option = option_of_setting(row.name);
        to.add_option_function<std::string>(
              option,
              [option, row, &o](const std::string& text) {
                  const auto value = parsed_setting(option, text, row.values);
                  if constexpr (std::is_same_v<std::decay_t<decltype(row.values)>, setting_table::pixels>)
                      o.settings.push_back([value](render_settings& s) {
                          s.output.width = value.x;
                          s.output.height = value.y;
                      });
                  else if constexpr (std::is_same_v<std::decay_t<decltype(row.values)>, setting_table::cells>)
                      // First, whatever the order of options: a map that is named as well stays.
                      o.settings.insert(o.settings.begin(), [value](render_settings& s) { s.map.use_grid(value); });
                  else
                      o.settings.push_back([row, value](render_settings& s) { row.of(s) = value; });
                  // A stop rule that is asked for here lifts the scene's limit, but not one that is given as well.
                  if constexpr (std::is_same_v<std::decay_t<decltype(row.values)>, real_range>)
                      if (value > 0 && is_stop_rule(row.name))
                          o.settings.insert(o.settings.begin(), [](render_settings& s) { s.output.passes = 1; });
              },
              help_of_setting(row.words) + syntax_of(row.values)
                  + (row.use == in_scenes::never ? " (not in scenes)" : ""))
            ->type_name(type_of(row.values));
    }

    void add_settings(CLI::App& to, setting_group group, render_options& o)
    {
        add_to_group(to, setting_groups[static_cast<std::size_t>(group)] + std::string(" (default: the scene's)"));
        for_each_setting([&](const auto& row) {
            if (row.words.group == group)
                add_setting(to, row, o);
        });
    }

    /// Options for scene, backend and settings, common to `render` and `view`.
    void add_picture(CLI::App& to, render_options& o)
    {
        to.formatter(std::make_shared<wrapped_help>());
        add_to_group(to, "Scene");
        add_scene(to, o.scene_path, o.how);
        add_settings(to, setting_group::picture, o);
        to.add_flag("--exact", o.exact,
            "a picture whose error goes to 0 as passes are added: --radii shrinking --indirect paths, --k at most 50, "
            "no routed map, and passes without end unless --passes, --until-error or --seconds ends it");
        for (const auto group : {setting_group::light, setting_group::photons, setting_group::estimate})
            add_settings(to, group, o);
        add_to_group(to, "Backend");
        to.add_option("--backend", o.backend,
              "backend; auto: the fastest for the picture of a hardware Vulkan device, if there is one, and cpu, or "
              "serial in a build without cpu")
            ->check(CLI::IsMember({"auto", "serial", "cpu", "gl", "gl-osmesa", "vulkan"}).description(""))
            ->type_name("auto|serial|cpu|gl|gl-osmesa|vulkan");
        add_whole(to, "--threads", o.threads, "threads of the cpu backend; default: all; does not affect the picture");
        to.add_option("--device", o.device, "Vulkan device (with --backend vulkan); see `photongrid devices`")
            ->type_name("NAME|INDEX");
        to.add_option("--shader-cache", o.shader_cache,
              "folder in which compiled Vulkan kernels are kept for later runs; default: photongrid in "
              "$XDG_CACHE_HOME or ~/.cache")
            ->type_name("DIR|none");
    }
    /// Those that most pictures do without come last.
    void add_expert(CLI::App& to, render_options& o)
    {
        add_settings(to, setting_group::expert, o);
        to.add_flag("--as-paper", o.as_paper,
              "the paper's method: --search at_least_k --filter constant --bias paper --leaks none --edge-correction "
              "none --interpolation 0 --surplus power --passes 1 --until-error 0 --spp 1 with the shadow rays of all "
              "eye rays, and what the scene has under \"as_paper\"; any option that is given as well takes precedence")
            ->excludes("--exact");
    }

    void add_render(CLI::App& to, render_options& o)
    {
        add_picture(to, o);
        add_to_group(to, "Output");
        to.add_option("-o,--output", o.outputs, "picture; may be given several times; default: the scene's name, .png")
            ->allow_extra_args(false)
            ->type_name("OUT.png|.exr|.pfm");
        to.add_flag("--aov", o.aov,
            "EXR: also write the layers estimate.radius (m), estimate.count (photons), estimate.relative_error "
            "(standard error over value) and, with several passes, noise (standard error of the pixel, W/(m^2 sr))");
        to.add_option("--stats", o.stats, "statistics, as JSON")->type_name("OUT.json");
        to.add_flag("--time-passes", o.time_passes,
            "measure each pass with the device's clock, for --stats; needs --backend vulkan, gl or gl-osmesa");
        to.add_option("--resume", o.resume,
              "file for the unfinished picture if the render is interrupted; if it exists, the render continues from "
              "it, and the result has the same bytes as without the interruption; removed when the picture is done, "
              "unless --until-error or --seconds ended it: a smaller error or a longer time then goes on from it")
            ->type_name("FILE");
        to.add_flag("--quiet", o.quiet, "print neither progress nor notes");
        add_to_group(to, "Pictures of the running estimate");
        to.add_option("--progressive", o.progressive,
              "folder for numbered pictures of the running estimate, and a table with the time of each, its relMSE to "
              "the last one and its structural similarity (SSIM) to it")
            ->type_name("DIR");
        to.add_option_function<std::string>(
              "--every",
              [&o](const std::string& text) {
                  o.every = parsed_number("--every", text, "a number of ms, above 0");
                  if (o.every <= 0)
                      throw CLI::ValidationError("--every", "\"" + text + "\" given; expected a number of ms, above 0");
              },
              "time between pictures of --progressive and --strip; default: a tenth of the time so far")
            ->type_name("MS");
        to.add_option(
              "--strip", o.strip, "up to six stages of the running estimate side by side, as in the paper's figure 8")
            ->type_name("OUT.png|.exr|.pfm");
        to.add_option_function<std::string>(
              "--crop", [&o](const std::string& text) { o.strip_crop = parsed_crop("--crop", text); },
              "part of the picture that --strip shows: width, height, and how many pixels are to its left and above it")
            ->type_name("WxH+X+Y");
        to.add_option("--reference", o.reference,
              "picture against which the table of --progressive also gives the error, such as one made by `photongrid "
              "reference`")
            ->type_name("REF.exr|.pfm");
        add_expert(to, o);
    }

    void add_view(CLI::App& to, view_options& o)
    {
        add_picture(to, o.picture);
        add_to_group(to, "Window");
        to.add_option("--reference", o.picture.reference,
              "picture to measure the error against, such as one made by `photongrid reference`")
            ->type_name("REF.exr|.pfm");
        to.add_flag("--no-reload", o.no_reload, "do not read the scene again when its files change");
        to.add_option("--journal", o.journal,
              "log of what happens in the window: one line of JSON per request, picture and error")
            ->type_name("FILE");
        to.add_flag("--quiet", o.picture.quiet, "print neither progress nor notes");
        add_expert(to, o.picture);
    }

    void add_reference(CLI::App& to, reference_options& o)
    {
        add_scene(to, o.scene_path, o.how);
        to.add_option("-o,--output", o.outputs, "picture; may be given several times")
            ->required()
            ->allow_extra_args(false)
            ->type_name("OUT.exr|.pfm|.png");
        to.add_option("--error", o.error, "standard error of each pixel, as a picture")->type_name("OUT.exr|.pfm|.png");
        add_whole(to, "--spp", o.spp, "eye paths per pixel, at least 2");
        to.add_option_function<std::string>(
              "--pixel-filter",
              [&o](const std::string& text) {
                  o.filter = parsed_setting("--pixel-filter", text, setting_table::pixel_filter.values);
              },
              "weight of an eye path by its place; default: the scene's")
            ->type_name(type_of(setting_table::pixel_filter.values));
        to.add_option_function<std::string>(
              "--paths",
              [&o](const std::string& text) { o.paths = parsed<std::uint64_t>("--paths", text, "a whole number"); },
              "light paths traced for caustics that need bins")
            ->type_name("N");
        add_number(to, "--bin", o.bin,
            "edge length of the bins; default: computed from the diffuse area and the number of light paths", "METRES");
        to.add_option_function<std::string>(
              "--caustics",
              [&o](const std::string& text) { o.caustics = text == "bins" ? caustics_by::bins : caustics_by::paths; },
              "how to compute caustics of rectangle lights; those of point lights always need bins")
            ->check(CLI::IsMember({"bins", "paths"}).description(""))
            ->type_name("bins|paths");
        to.add_option_function<std::string>(
              "--size", [&o](const std::string& text) { o.size = parsed_size("--size", text); }, "pixels")
            ->type_name("WxH");
        add_whole(to, "--depth", o.depth, "most mirror and glass surfaces that an eye path hits before a diffuse one");
        add_whole(to, "--photon-depth", o.photon_depth,
            "most surfaces that light hits, up to and including the first diffuse one seen from the eye");
        add_whole(to, "--threads", o.threads, "threads; default: all; does not affect the picture");
        add_whole(to, "--seed", o.seed, "same seed, same picture");
        add_exposure(to, o.exposure, "PNG: pixel values times 2^EV; default: the scene's");
        to.add_option("--stats", o.stats, "statistics, as JSON")->type_name("OUT.json");
        to.add_flag("--quiet", o.quiet, "print neither progress nor notes");
    }

    void add_compare(CLI::App& to, compare_options& o)
    {
        to.add_option("A", o.a, "picture")->required()->type_name("A.exr|.pfm");
        to.add_option("B", o.b, "reference")->required()->type_name("B.exr|.pfm");
        to.add_option_function<std::string>(
              "--max-relmse",
              [&o](const std::string& text) { o.max_relmse = parsed_number("--max-relmse", text, "a number"); },
              "exit with code 1 if relMSE is above this")
            ->type_name("V");
        to.add_option("--average", o.average,
              "compare the means of blocks of N x N pixels, so that noise of single pixels and pixel filters of other "
              "programs matter less")
            ->type_name("N")
            ->check(CLI::Range(1, 1024).description(""));
        to.add_option("--again", o.again,
              "a picture like A with another seed: also print what part of relMSE is noise of A, blotches too")
            ->type_name("A2.exr|.pfm");
        to.add_flag("--noise", o.noise,
            "also print what relMSE the noise of each picture makes, estimated from that picture alone; blotches of "
            "photon "
            "maps are not found");
        add_exposure(to, o.exposure, "compare the looks of pixel values times 2^EV; default: auto, fitted to B");
    }

    void check_files(const render_options& o, const std::string& journal = {})
    {
        files_of_command files(o.scene_path, o.how);
        files.add("--reference", o.reference);
        for (const auto& output : o.outputs)
            files.add("-o", output);
        files.add("--stats", o.stats);
        files.add("--strip", o.strip);
        files.add("--resume", o.resume);
        files.add("--journal", journal);
    }

    void check_files(const reference_options& o)
    {
        files_of_command files(o.scene_path, o.how);
        for (const auto& output : o.outputs)
            files.add("-o", output);
        files.add("--error", o.error);
        files.add("--stats", o.stats);
    }

    void check_files(const convert_options& o) { files_of_command(o.scene_path, o.how).add("OUT", o.output); }

    void check_files(const error_options& o)
    {
        files_of_command files;
        files.read(o.picture);
        files.read(o.reference);
        for (const auto& region : o.regions)
            files.read(region.path);
        for (const auto& output : o.outputs)
            files.add("-o", output);
        files.add("--stats", o.stats);
    }

    void check_device(const render_options& o)
    {
        if (!o.device.empty() && o.backend != "vulkan")
            throw CLI::ValidationError("--device", "names a Vulkan device; expected --backend vulkan with it");
    }

    /// Options that mean something only beside others.
    void check_combinations(const render_options& o)
    {
        if (o.time_passes && o.backend != "vulkan" && o.backend != "gl" && o.backend != "gl-osmesa")
            throw CLI::ValidationError("--time-passes",
                "is for --backend vulkan, gl and gl-osmesa; cpu always times its passes, serial never does");
        if (o.strip_crop && o.strip.empty())
            throw CLI::ValidationError(
                "--crop", "selects the part that --strip shows; expected --strip OUT.png with it");
        if (o.every > 0 && o.strip.empty() && o.progressive.empty())
            throw CLI::ValidationError(
                "--every", "is the time between pictures of --progressive or --strip; expected one of them with it");
        if (!o.reference.empty() && o.progressive.empty())
            throw CLI::ValidationError(
                "--reference", "is for the table that --progressive writes; expected --progressive DIR with it");
        if (o.aov && std::none_of(o.outputs.begin(), o.outputs.end(), holds_layers))
            throw CLI::ValidationError("--aov",
                (o.outputs.empty() ? "no output" : "\"" + o.outputs.front() + "\"")
                    + std::string(" given; expected an EXR picture, which holds layers: -o OUT.exr"));
    }
} // namespace

command read_command_line(int argc, char** argv)
{
    CLI::App app{"photongrid: photon mapping on any device", "photongrid"};
    app.set_version_flag("--version", std::string("photongrid ") + PHOTONGRID_VERSION);
    app.require_subcommand(1);
    app.footer(footer(""));

    render_options render;
    auto& render_command = *app.add_subcommand("render", "Draws a scene");
    add_render(render_command, render);

    view_options view;
    auto& view_command = *app.add_subcommand("view",
        "Opens a window on a scene: move the camera, objects and lights, change settings, watch the picture converge");
    add_view(view_command, view);

    reference_options reference;
    auto& reference_command = *app.add_subcommand("reference",
        "Draws a scene without a photon map, by path tracing in double precision: the reference to compare with");
    add_reference(reference_command, reference);

    compare_options compare;
    auto& compare_command = *app.add_subcommand("compare",
        "Prints MSE, relMSE = mean of (A - B)^2 / (B + 0.01)^2 (pbrt's MRSE), the largest difference of two linear "
        "pictures, and their structural similarity (SSIM) as PNG files: 1 if they look the same");
    add_compare(compare_command, compare);

    error_options error;
    auto& error_command = *app.add_subcommand("error",
        "Draws what differs between a picture and its reference, and where: both, the difference of luminance, the "
        "relative error in false colours, what is visible of it (FLIP) and regions; prints statistics of each region");
    add_error(error_command, error);

    check_options check_scene;
    auto& check_command = *app.add_subcommand("check", "Reads and checks a scene file");
    add_scene(check_command, check_scene.scene_path, check_scene.how);

    convert_options convert;
    auto& convert_command = *app.add_subcommand("convert",
        "Writes a scene in another format, with its meshes and pictures; prints on stderr what the format does not "
        "have");
    add_scene(convert_command, convert.scene_path, convert.how);
    convert_command.add_option("OUT", convert.output, "scene file to write; one that exists is replaced")
        ->required()
        ->type_name("OUT.json|.pbrt|.gltf|.glb");

    auto& devices_command = *app.add_subcommand(
        "devices", "Lists every backend and device that works here, with its limits, and why the others do not work");

    for (auto* each : app.get_subcommands([](const CLI::App*) { return true; }))
        each->footer(footer(each->get_name()));

    try {
        expect_command(argc, argv);
        app.parse(argc, argv);
        check_device(render);
        check_device(view.picture);
        check_combinations(render);
        check_files(render);
        check_files(view.picture, view.journal);
        check_files(reference);
        check_files(error);
        check_files(convert);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? success : usage_error;
    }
    if (render_command.parsed())
        return render;
    if (view_command.parsed())
        return view;
    if (reference_command.parsed())
        return reference;
    if (compare_command.parsed())
        return compare;
    if (error_command.parsed())
        return error;
    if (check_command.parsed())
        return check_scene;
    if (convert_command.parsed())
        return convert;
    return devices_command.parsed() ? command(devices_options{}) : command(usage_error);
}

render_settings settings_for(const scene& s, const render_options& o)
{
    auto settings = o.as_paper ? as_paper(s) : s.render;
    if (o.exact)
        settings.output.passes = 1; // the scene's limit is for its usual picture
    for (const auto& give : o.settings)
        give(settings);
    if (o.exact)
        settings = as_exact(settings);
    settings.output.aov = o.aov;
    check(settings);
    return settings;
}

} // namespace photongrid
