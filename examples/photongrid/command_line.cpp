#include "command_line.hpp"

#include "image_file.hpp"
#include "setting_names.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace photongrid {

namespace {
    const char* const footer = R"(Examples:
  photongrid render examples/scenes/cornell_box.json -o cornell.png
  photongrid render ring.json --backend vulkan --map route -o ring.exr -o ring.png --stats ring-stats.json
  photongrid render ring.json --size 128x96 --photons 4000 --exposure 1 --quiet
  photongrid render glass_ball.json --progressive steps --every 50 --strip figure8.png --crop 96x96+180+150
  photongrid render cornell_box.json --spp 256 --resume unfinished -o box.exr
  photongrid render ring.json --only caustic --kernel silverman --leaks side,normals=0.7 --aov -o ring.exr
  photongrid reference ring.json -o reference.exr --error error.exr --paths 100000000
  photongrid compare ring.exr reference.exr --max-relmse 1e-3
  photongrid check my_scene.json
  photongrid view cornell_box.json --size 320x320

Exit codes:
  0    done
  1    compare: relMSE above --max-relmse; render, reference: the picture could not be made
  2    the command line is wrong
  3    the scene file is wrong
  4    the backend or device cannot be had, or failed
  5    a picture or statistics file could not be read or written, or pictures of different sizes were compared
  130  interrupted (Ctrl-C); the best picture so far is written, if there is one; nothing half-written is left
)";

    // Of --leaks normals and disc where no value is given: 60 degrees, and a disc four times as wide as high.
    constexpr float usual_cosine = 0.5f, usual_compression = 4;

    /// --only has no word for everything.
    constexpr named<light_part> drawn_alone[] = {part_names[1], part_names[2], part_names[3]};

    // std::from_chars, so that "010" is ten, "-1" no number and "1e9x" an error.
    template <class T>
    T parsed(const std::string& option, std::string_view text, const char* expected)
    {
        T value{};
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size())
            throw CLI::ValidationError(option, "\"" + std::string(text) + "\" given; expected " + expected);
        return value;
    }

    double parsed_number(const std::string& option, const std::string& text, const char* expected)
    {
        const auto value = parsed<double>(option, text, expected);
        if (!std::isfinite(value))
            throw CLI::ValidationError(option, "\"" + text + "\" given; expected " + expected);
        return value;
    }

    /// Whole numbers with `separator` between them.
    template <glm::length_t N>
    glm::vec<N, glm::uint> parsed_list(
        const std::string& option, std::string_view text, char separator, const char* expected)
    {
        glm::vec<N, glm::uint> v(0);
        for (glm::length_t i = 0; i < N; ++i) {
            const auto end = i + 1 < N ? text.find(separator) : text.size();
            if (end == std::string_view::npos)
                throw CLI::ValidationError(option, std::string("expected ") + expected);
            v[i] = parsed<glm::uint>(option, text.substr(0, end), expected);
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        return v;
    }

    /// Part of a picture, as X11 writes it.
    crop parsed_crop(const std::string& option, const std::string& text)
    {
        const char* const expected = "a part of the picture, WxH+X+Y, with at least one pixel";
        const auto plus = text.find('+');
        if (plus == std::string::npos)
            throw CLI::ValidationError(option, "\"" + text + "\" given; expected " + expected);
        const auto size = parsed_list<2>(option, std::string_view(text).substr(0, plus), 'x', expected);
        const auto corner = parsed_list<2>(option, std::string_view(text).substr(plus + 1), '+', expected);
        if (size.x < 1 || size.y < 1)
            throw CLI::ValidationError(option, "\"" + text + "\" given; expected " + expected);
        return {corner.x, corner.y, size.x, size.y};
    }

    /// Cells along each axis; all 0 for `auto`.
    glm::uvec3 parsed_grid(const std::string& option, const std::string& text)
    {
        if (text == "auto")
            return glm::uvec3(0);
        const auto grid = parsed_list<3>(option, text, ',', "three whole numbers, X,Y,Z, or auto");
        if (grid.x < 1 || grid.y < 1 || grid.z < 1)
            throw CLI::ValidationError(option, "\"" + text + "\" given; each axis needs at least one cell");
        return grid;
    }

    /// A number at or between two limits, as single precision holds it.
    float parsed_from(const std::string& option, const std::string& text, double low, double high, const char* expected)
    {
        const double value = parsed_number(option, text, expected);
        if (value < low || value > high)
            throw CLI::ValidationError(option, "\"" + text + "\" given; expected " + expected);
        return static_cast<float>(value);
    }

    /// Policies with commas between them, each at most once; or `none`.
    leak_policy parsed_leaks(const std::string& option, const std::string& text)
    {
        if (text == "none")
            return {};
        leak_policy leaks;
        std::vector<std::string> given;
        for (std::size_t at = 0; at <= text.size();) {
            const auto end = std::min(text.find(',', at), text.size());
            const auto policy = text.substr(at, end - at);
            const auto name = policy.substr(0, policy.find('='));
            const bool with_value = name.size() < policy.size();
            const auto value = with_value ? policy.substr(name.size() + 1) : "";
            if (std::find(given.begin(), given.end(), name) != given.end())
                throw CLI::ValidationError(
                    option, "\"" + text + "\" has " + name + " twice; expected each policy once");
            given.push_back(name);
            if (policy == "side")
                leaks.side = true;
            else if (name == "normals")
                leaks.min_cosine = with_value ? parsed_from(option, value, -1, 1, "normals=COS, a cosine from -1 to 1")
                                              : usual_cosine;
            else if (name == "disc")
                leaks.compression = with_value
                    ? parsed_from(option, value, 1, 1e6, "disc=C, a compression from 1 to 1e6")
                    : usual_compression;
            else if (policy == "none")
                throw CLI::ValidationError(option, "\"" + text + "\" given; expected none alone, or no none");
            else
                throw CLI::ValidationError(option,
                    "\"" + policy
                        + "\" given; expected none, or some of side, normals, normals=COS, disc, disc=C with commas "
                          "between them");
            at = end + 1;
        }
        return leaks;
    }

    /// An option whose value is one of a setting's words.
    template <class Target, class Setting, std::size_t N>
    void add_choice(CLI::App& to, const std::string& option, Target& target, const named<Setting> (&names)[N],
        const std::string& about)
    {
        std::string type;
        for (const auto& word : words(names))
            type += (type.empty() ? "" : "|") + word;
        to.add_option_function<std::string>(
              option, [&target, &names](const std::string& word) { target = value_of(names, word); }, about)
            ->check(CLI::IsMember(words(names)))
            ->type_name(type);
    }

    void add_whole(
        CLI::App& to, const std::string& option, std::optional<std::uint32_t>& target, const std::string& about)
    {
        to.add_option_function<std::string>(
              option,
              [&target, option](
                  const std::string& text) { target = parsed<std::uint32_t>(option, text, "a whole number"); },
              about)
            ->type_name("N");
    }

    void add_number(CLI::App& to, const std::string& option, std::optional<double>& target, const std::string& about,
        const char* type)
    {
        to.add_option_function<std::string>(
              option, [&target, option](const std::string& text) { target = parsed_number(option, text, "a number"); },
              about)
            ->type_name(type);
    }

    /// Scene, backend and settings: what a picture depends on, in a file or in a window.
    void add_picture(CLI::App& to, render_options& o)
    {
        to.add_option("scene", o.scene_path, "scene file")->required()->type_name("SCENE.json");
        to.add_option("--backend", o.backend, "auto: a hardware Vulkan device, else cpu")
            ->check(CLI::IsMember({"auto", "serial", "cpu", "gl", "gl-osmesa", "vulkan"}))
            ->type_name("auto|serial|cpu|gl|gl-osmesa|vulkan");
        add_whole(to, "--threads", o.threads, "of the cpu backend; default: all; the picture does not depend on it");
        to.add_option("--device", o.device, "Vulkan device (with --backend vulkan); see `photongrid devices`")
            ->type_name("NAME|INDEX");
        add_choice(to, "--map", o.map, map_names, "build the photon map by bitonic sort or stencil routing");
        add_whole(to, "--slots", o.slots, "routed cells have N x N slots, 1 to 16");
        add_whole(to, "--photons", o.photons, "photons stored");
        add_whole(to, "--k", o.k, "photons sought by an estimate; fixed_radius seeks none");
        add_choice(to, "--search", o.search, search_names,
            "photons used: k and a few more, as the paper has it; the k nearest; all within --max-radius; default: the "
            "scene's, else exact_k");
        add_choice(to, "--kernel", o.kernel, kernel_names,
            "weight of a photon by its distance; default: the scene's, else silverman");
        add_choice(to, "--bias", o.bias, bias_names,
            "the photon that sets the radius counts (paper) or is left out of the sum (unbiased); default: the "
            "scene's, else unbiased");
        to.add_option_function<std::string>(
              "--leaks", [&o](const std::string& text) { o.leaks = parsed_leaks("--leaks", text); },
              "photons refused: none, or some of side (came from behind the surface), normals=COS (lie on a surface "
              "turned away by more than this cosine; default 0.5), "
              "disc=C (distances along the normal count C times; default 4), with commas between them; default: the "
              "scene's, else side")
            ->type_name("LIST");
        add_choice(to, "--edge-correction", o.edges, edge_names,
            "polygons: divide estimates by the share of their disc that lies on the surface, so that polygons do not "
            "darken towards their edges; needs normals among --leaks; default: the scene's, else none");
        add_choice(to, "--only", o.only, drawn_alone, "draw this part of the light alone; default: all of it");
        to.add_flag("--as-paper", o.as_paper,
            "the paper's estimate: --search at_least_k --kernel constant --bias paper --leaks none --edge-correction "
            "none; each gives way to the option itself");
        to.add_option_function<std::string>(
              "--grid", [&o](const std::string& text) { o.grid = parsed_grid("--grid", text); },
              "cells of the photon map over the scene, or fitted to the photons and k")
            ->type_name("X,Y,Z|auto");
        add_number(to, "--max-radius", o.max_radius, "largest search radius; of fixed_radius, the radius", "METRES");
        to.add_option_function<std::string>(
              "--size",
              [&o](const std::string& text) { o.size = parsed_list<2>("--size", text, 'x', "width and height: WxH"); },
              "pixels")
            ->type_name("WxH");
        add_whole(to, "--spp", o.spp, "eye rays per pixel and pass");
        add_whole(to, "--passes", o.passes,
            "the picture is the mean of so many, each with photons, eye rays and shadow rays of its own");
        add_whole(to, "--light-samples", o.light_samples, "shadow rays an area light and eye ray");
        add_whole(to, "--depth", o.depth, "reflections and refractions an eye ray follows");
        add_whole(to, "--seed", o.seed, "same seed, same picture");
        add_number(to, "--exposure", o.exposure, "PNG: pixel values times 2^EV", "EV");
        to.add_option("--shader-cache", o.shader_cache,
              "folder where Vulkan's compiled kernels are kept for the next start; default: photongrid in "
              "$XDG_CACHE_HOME or ~/.cache")
            ->type_name("DIR|none");
        to.add_flag("--quiet", o.quiet, "no progress, no remarks");
    }

    void add_render(CLI::App& to, render_options& o)
    {
        add_picture(to, o);
        to.add_option("-o,--output", o.outputs, "picture; may be given several times; default: the scene's name, .png")
            ->allow_extra_args(false)
            ->type_name("OUT.png|.exr|.pfm");
        to.add_flag("--aov", o.aov,
            "EXR: layers estimate.radius (m), estimate.count (photons), estimate.relative_error (standard error over "
            "value) and, of several passes, noise (standard error of the pixel, W/(m^2 sr)) beside the picture");
        to.add_option("--stats", o.stats, "statistics, as JSON")->type_name("OUT.json");
        to.add_flag("--time-passes", o.time_passes,
            "with --backend vulkan, gl or gl-osmesa, and --stats: measure each pass by the device's clock");
        to.add_option("--progressive", o.progressive,
              "folder for numbered pictures of the running estimate, and a table of when each was there and its relMSE "
              "to the last")
            ->type_name("DIR");
        to.add_option_function<std::string>(
              "--every",
              [&o](const std::string& text) {
                  o.every = parsed_number("--every", text, "a number of ms, above 0");
                  if (o.every <= 0)
                      throw CLI::ValidationError("--every", "\"" + text + "\" given; expected a number of ms, above 0");
              },
              "of --progressive and --strip: time between pictures; default: a tenth of the time so far")
            ->type_name("MS");
        to.add_option(
              "--strip", o.strip, "up to six stages of the running estimate side by side, as the paper's figure 8")
            ->type_name("OUT.png|.exr|.pfm");
        to.add_option_function<std::string>(
              "--crop", [&o](const std::string& text) { o.strip_crop = parsed_crop("--crop", text); },
              "part of the picture that --strip shows: width, height and the pixels left of and above it")
            ->type_name("WxH+X+Y");
        to.add_option("--reference", o.reference,
              "picture to measure the table's errors against too, such as `photongrid reference` makes")
            ->type_name("REF.exr|.pfm");
        to.add_option("--resume", o.resume,
              "file for what there is when the render is interrupted; where it exists, goes on from it, and ends with "
              "the same bytes as if never interrupted; removed at the end")
            ->type_name("FILE");
    }

    void add_view(CLI::App& to, view_options& o)
    {
        add_picture(to, o.picture);
        to.add_option("--reference", o.picture.reference,
              "picture to measure the error against, such as `photongrid reference` makes")
            ->type_name("REF.exr|.pfm");
        to.add_option("--journal", o.journal,
              "file for what happens in the window: a line of JSON for each request, picture and error")
            ->type_name("FILE");
    }

    void add_reference(CLI::App& to, reference_options& o)
    {
        to.add_option("scene", o.scene_path, "scene file")->required()->type_name("SCENE.json");
        to.add_option("-o,--output", o.outputs, "picture; may be given several times")
            ->required()
            ->allow_extra_args(false)
            ->type_name("OUT.exr|.pfm|.png");
        to.add_option("--error", o.error, "standard error of each pixel, as a picture")->type_name("OUT.exr|.pfm|.png");
        add_whole(to, "--spp", o.spp, "eye paths a pixel, at least 2");
        to.add_option_function<std::string>(
              "--paths",
              [&o](const std::string& text) { o.paths = parsed<std::uint64_t>("--paths", text, "a whole number"); },
              "light paths, where caustics need bins")
            ->type_name("N");
        add_number(to, "--bin", o.bin, "edge of the bins; default: from the diffuse area and the number of light paths",
            "METRES");
        to.add_option_function<std::string>(
              "--caustics",
              [&o](const std::string& text) { o.caustics = text == "bins" ? caustics_by::bins : caustics_by::paths; },
              "how to find caustics of rectangle lights; those of point lights always need bins")
            ->check(CLI::IsMember({"bins", "paths"}))
            ->type_name("bins|paths");
        to.add_option_function<std::string>(
              "--size",
              [&o](const std::string& text) { o.size = parsed_list<2>("--size", text, 'x', "width and height: WxH"); },
              "pixels")
            ->type_name("WxH");
        add_whole(to, "--depth", o.depth, "mirrors and glass surfaces that an eye path passes before a diffuse one");
        add_whole(to, "--photon-depth", o.photon_depth,
            "surfaces that light meets at most up to the first diffuse one seen from the eye, that one included");
        add_whole(to, "--threads", o.threads, "default: all; the picture does not depend on it");
        add_whole(to, "--seed", o.seed, "same seed, same picture");
        to.add_option_function<std::string>(
              "--exposure",
              [&o](const std::string& text) { o.exposure = parsed_number("--exposure", text, "a number"); },
              "PNG: pixel values times 2^EV")
            ->type_name("EV");
        to.add_option("--stats", o.stats, "statistics, as JSON")->type_name("OUT.json");
        to.add_flag("--quiet", o.quiet, "no progress, no remarks");
    }
} // namespace

command read_command_line(int argc, char** argv)
{
    CLI::App app{"photongrid: photon mapping on any device", "photongrid"};
    app.set_version_flag("--version", std::string("photongrid ") + PHOTONGRID_VERSION);
    app.require_subcommand(1);
    app.footer(footer);

    render_options render;
    auto& render_command = *app.add_subcommand("render", "Draws a scene");
    add_render(render_command, render);

    view_options view;
    auto& view_command = *app.add_subcommand(
        "view", "Opens a window on a scene: move camera, things and lights, change settings, watch the light settle");
    add_view(view_command, view);

    reference_options reference;
    auto& reference_command = *app.add_subcommand("reference",
        "Draws a scene without a photon map, by path tracing in double precision: the truth to compare with");
    add_reference(reference_command, reference);

    compare_options compare;
    auto& compare_command = *app.add_subcommand("compare",
        "MSE, relMSE = mean of (A - B)^2 / (B + 0.01)^2 (pbrt's MRSE), largest difference of two linear pictures");
    compare_command.add_option("A", compare.a, "picture")->required()->type_name("A.exr|.pfm");
    compare_command.add_option("B", compare.b, "reference")->required()->type_name("B.exr|.pfm");
    compare_command
        .add_option_function<std::string>(
            "--max-relmse",
            [&](const std::string& text) { compare.max_relmse = parsed_number("--max-relmse", text, "a number"); },
            "exit with 1 above this")
        ->type_name("V");

    check_options check_scene;
    auto& check_command = *app.add_subcommand("check", "Reads and checks a scene file");
    check_command.add_option("scene", check_scene.scene_path, "scene file")->required()->type_name("SCENE.json");

    auto& devices_command
        = *app.add_subcommand("devices", "Every backend and device that works here, its limits, and why others do not");

    try {
        app.parse(argc, argv);
        for (const auto* picture : {&render, &view.picture})
            if (!picture->device.empty() && picture->backend != "vulkan")
                throw CLI::ValidationError("--device", "names a Vulkan device; expected --backend vulkan with it");
        if (render.time_passes && render.backend != "vulkan" && render.backend != "gl" && render.backend != "gl-osmesa")
            throw CLI::ValidationError("--time-passes",
                "is for --backend vulkan, gl and gl-osmesa; cpu times its passes always, serial never");
        if (render.strip_crop && render.strip.empty())
            throw CLI::ValidationError("--crop", "is what --strip shows; expected --strip OUT.png with it");
        if (render.every > 0 && render.strip.empty() && render.progressive.empty())
            throw CLI::ValidationError(
                "--every", "is between pictures of --progressive or --strip; expected one of them with it");
        if (!render.reference.empty() && render.progressive.empty())
            throw CLI::ValidationError(
                "--reference", "is for the table that --progressive writes; expected --progressive DIR with it");
        if (render.aov && std::none_of(render.outputs.begin(), render.outputs.end(), holds_layers))
            throw CLI::ValidationError("--aov",
                (render.outputs.empty() ? "no output" : "\"" + render.outputs.front() + "\"")
                    + std::string(" given; expected an EXR picture, which holds layers: -o OUT.exr"));
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
    if (check_command.parsed())
        return check_scene;
    return devices_command.parsed() ? command(devices_options{}) : command(usage_error);
}

render_settings settings_for(const scene& s, const render_options& o)
{
    render_settings r = o.as_paper ? as_paper(s.render) : s.render;
    if (o.size) {
        r.width = o.size->x;
        r.height = o.size->y;
    }
    r.builder = o.map.value_or(r.builder);
    r.slots = o.slots.value_or(r.slots);
    r.photons = o.photons.value_or(r.photons);
    r.k = o.k.value_or(r.k);
    r.spp = o.spp.value_or(r.spp);
    r.passes = o.passes.value_or(r.passes);
    r.light_samples = o.light_samples.value_or(r.light_samples);
    r.depth = o.depth.value_or(r.depth);
    r.seed = o.seed.value_or(r.seed);
    r.grid = o.grid.value_or(r.grid);
    r.max_radius = o.max_radius.value_or(r.max_radius);
    r.exposure = o.exposure.value_or(r.exposure);
    r.search = o.search.value_or(r.search);
    r.kernel = o.kernel.value_or(r.kernel);
    r.bias = o.bias.value_or(r.bias);
    r.leaks = o.leaks.value_or(r.leaks);
    r.edges = o.edges.value_or(r.edges);
    r.only = o.only;
    r.aov = o.aov;
    check(r);
    const double cells = static_cast<double>(r.grid.x) * r.grid.y * r.grid.z;
    if (cells > 0x1p31)
        throw std::invalid_argument("grid: more than 2^31 cells");
    return r;
}

} // namespace photongrid
