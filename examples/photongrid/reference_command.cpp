#include "reference_command.hpp"

#include "progress_bar.hpp"
#include "scene_notes.hpp"
#include <photongrid/io/image_file.hpp>
#include <photongrid/io/tone_map.hpp>
#include <photongrid/scene/setting_table.hpp>

#include <photongrid/reference/reference.hpp>

#include <nlohmann/json.hpp>

#include <iostream>

namespace photongrid {

namespace {
    using json = nlohmann::ordered_json;

    reference_settings settings_for(const scene& s, const reference_options& o)
    {
        reference_settings r = reference_settings_for(s.render);
        if (o.size) {
            r.width = o.size->x;
            r.height = o.size->y;
        }
        r.spp = o.spp.value_or(r.spp);
        r.filter = o.filter.value_or(r.filter);
        r.paths = o.paths.value_or(r.paths);
        r.threads = o.threads.value_or(r.threads);
        r.seed = o.seed.value_or(r.seed);
        r.depth = o.depth.value_or(r.depth);
        r.photon_depth = o.photon_depth.value_or(r.photon_depth);
        r.area_light_caustics = o.caustics.value_or(r.area_light_caustics);
        if (o.bin) {
            detail::require(*o.bin > 0, "bin: must be finite and greater than 0");
            r.bin = *o.bin;
        }
        check(r);
        return r;
    }

    json settings_json(const reference_settings& s)
    {
        return {{"size", {s.width, s.height}}, {"spp", s.spp},
            {"pixel_filter", setting_table::pixel_filter.values.word_for(s.filter)}, {"paths", s.paths}, {"bin", s.bin},
            {"depth", s.depth}, {"photon_depth", s.photon_depth},
            {"caustics", s.area_light_caustics == caustics_by::bins ? "bins" : "paths"}, {"seed", s.seed}};
    }
} // namespace

exit_code run_reference(const reference_options& o, const std::function<bool()>& cancelled)
{
    const auto s = open_scene(o.scene_path, o.how, o.quiet).scene;
    reference_settings settings;
    try {
        settings = settings_for(s, o);
        if (o.exposure)
            setting_table::exposure.values.check("exposure", *o.exposure);
    } catch (const std::invalid_argument& e) {
        std::cerr << "photongrid: error: on the command line: " << e.what() << '\n';
        return usage_error;
    }
    for (const auto& path : o.outputs)
        check_image_path(path);
    if (!o.error.empty())
        check_image_path(o.error);
    if (!o.stats.empty())
        check_file_path(o.stats);

    progress_bar bar(o.quiet);
    render_observer observer;
    observer.progress = [&](std::string_view stage, double fraction) { bar.show(stage, fraction); };
    observer.cancelled = cancelled;
    const auto result = render_reference(s, s.camera, settings, observer);
    bar.clear();
    if (cancelled())
        throw render_cancelled();

    const auto& stats = result.stats;
    if (stats.invalid_samples > 0)
        std::cerr << "photongrid: warning: " << stats.invalid_samples
                  << " samples were NaN or infinite and count as black\n";
    if (!o.quiet && stats.light_paths > 0)
        std::cerr << "photongrid: caustics from bins of " << stats.bin_size << " m, over which they are blurred\n";
    const image_notes notes{{"scene", s.name}, {"backend", "reference"}, {"seed", std::to_string(settings.seed)},
        {"settings", settings_json(settings).dump()}, {"version", std::string("photongrid ") + PHOTONGRID_VERSION}};
    const double exposure = exposure_for(result.mean, o.exposure.value_or(s.render.output.exposure));
    for (const auto& path : o.outputs) {
        write_image(path, result.mean, exposure, notes);
        std::cout << path << '\n';
    }
    if (!o.error.empty()) {
        write_image(o.error, result.standard_error, exposure, notes);
        std::cout << o.error << '\n';
    }
    if (!o.stats.empty()) {
        const json all = {{"version", PHOTONGRID_VERSION}, {"scene", s.name}, {"settings", settings_json(settings)},
            {"threads", stats.threads}, {"spp", stats.spp}, {"light_paths", stats.light_paths},
            {"caustic_hits", stats.caustic_hits}, {"bins", stats.bins}, {"bin_size", stats.bin_size},
            {"mean_standard_error", stats.mean_standard_error}, {"invalid_samples", stats.invalid_samples},
            {"light_seconds", stats.light_seconds}, {"eye_seconds", stats.eye_seconds}};
        write_file(o.stats, all.dump(2) + "\n");
    }
    return success;
}

} // namespace photongrid
