// The parsed command line, as data.
#pragma once

#include "picture_series.hpp"

#include <photongrid/compare/flip.hpp>
#include <photongrid/io/imported_scene.hpp>
#include <photongrid/reference/settings.hpp>
#include <photongrid/scene/scene.hpp>

#include <glm/vec2.hpp>

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace photongrid {

/// Exit codes; --help lists them.
enum exit_code {
    success = 0,
    failure = 1,
    usage_error = 2,
    scene_file_error = 3,
    backend_failure = 4,
    file_failure = 5,
    interrupted = 130
};

/// Options of `render`. Empty members keep the scene file's value.
struct render_options {
    std::string scene_path, backend = "auto", device;
    import_settings how; ///< scenes of other programs are read
    std::optional<std::uint32_t> threads;
    std::vector<std::function<void(render_settings&)>> settings; ///< the settings given; each changes the scene's
    bool aov = false, as_paper = false, exact = false;
    std::vector<std::string> outputs;
    std::string stats, progressive, strip, reference, resume;
    std::optional<crop> strip_crop;
    double every = 0;                        ///< ms
    std::optional<std::string> shader_cache; ///< "none": none
    bool time_passes = false, quiet = false;
};

/// `view`.
struct view_options {
    render_options picture; ///< without the members for output
    std::string journal;
    bool no_reload = false;
};

/// Options of `reference`. Empty members keep the value of the scene file or of reference_settings.
struct reference_options {
    std::string scene_path;
    import_settings how; ///< scenes of other programs are read
    std::optional<std::uint32_t> spp, threads, depth, photon_depth, seed;
    std::optional<std::uint64_t> paths;
    std::optional<glm::uvec2> size;
    std::optional<double> bin;
    std::optional<caustics_by> caustics;
    std::optional<pixel_filter> filter;
    /// EV, PNG only, or none: fitted to the picture. Not given: the scene's.
    std::optional<std::optional<double>> exposure;
    std::vector<std::string> outputs;
    std::string error, stats;
    bool quiet = false;
};

struct compare_options {
    std::string a, b;
    double max_relmse = std::numeric_limits<double>::infinity();
    std::optional<double> exposure; ///< EV, for structural similarity; none: fitted to the reference
    std::uint32_t average = 1;      ///< blocks of so many pixels a side are compared
    std::string again;              ///< a picture like a with another seed
    bool noise = false;             ///< whether to estimate the pictures' own noise
};

/// A region that a picture gives `error`.
struct region_source {
    std::string name, path;
    bool outside = false; ///< the pixels that are not bright
    double level = 0.1;   ///< bright is more than the picture's mean luminance times this
};

struct error_options {
    std::string picture, reference;
    std::vector<std::string> outputs;
    std::string stats;
    std::optional<double> exposure; ///< EV; none: fitted to the reference
    double pixels_per_degree = usual_pixels_per_degree;
    glm::dvec2 range{1e-3, 1}; ///< relative errors with the ends of the false colours
    std::uint32_t average = 1; ///< blocks of so many pixels a side are compared
    std::vector<region_source> regions;
};

struct check_options {
    std::string scene_path;
    import_settings how; ///< scenes of other programs are read
};

struct convert_options {
    std::string scene_path, output;
    import_settings how; ///< scenes of other programs are read; `strict` is for what is written, too
};

struct devices_options {};

/// The command to run, or the exit code if parsing has already printed the answer (help, version, mistake).
using command = std::variant<exit_code, render_options, view_options, reference_options, compare_options, error_options,
    check_options, convert_options, devices_options>;

command read_command_line(int argc, char** argv);

/// The scene's settings, with the paper's estimate for --as-paper, and overridden by those of the command line. Throws
/// std::invalid_argument.
render_settings settings_for(const scene& s, const render_options& o);

} // namespace photongrid
