#include "stats_file.hpp"

#include <photongrid/io/scene_writer.hpp>

#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>

#include <sys/resource.h>

namespace photongrid {

namespace {
    using json = nlohmann::ordered_json;

    json stage_json(const stage_stats& s)
    {
        return {{"ms", s.ms}, {"compile_ms", s.compile_ms}, {"passes", s.passes}, {"device_bytes", s.device_bytes}};
    }
    /// JSON has no infinity.
    json number_or_null(double x) { return std::isfinite(x) ? json(x) : json(); }

    const char* word_for(ended_by by)
    {
        switch (by) {
        case ended_by::passes: return "passes";
        case ended_by::error: return "error";
        case ended_by::seconds: return "seconds";
        case ended_by::nothing: break;
        }
        return "nothing";
    }

    /// What a pilot measured of the picture, as parts of the square of a pixel's radiance (chosen_settings.hpp).
    json pilot_json(const std::optional<pilot_measures>& pilot)
    {
        if (!pilot)
            return nullptr;
        const auto map = [](const pilot_photons& of) {
            return json{{"spread", of.spread}, {"noise", of.noise}, {"blur2", of.blur2}, {"growth", of.growth},
                {"segments", of.segments}, {"stored", of.stored}};
        };
        return {{"spread", pilot->spread}, {"light_spread", pilot->light_spread}, {"edges", pilot->edges},
            {"caustic", map(pilot->maps[0])}, {"other", map(pilot->maps[1])}, {"together", map(pilot->together)},
            {"of_ray", pilot->of_ray}, {"ends", pilot->ends}, {"lamps", pilot->lamps}};
    }
} // namespace

std::string stats_json(
    const imported_scene& s, const render_settings& settings, const renderer& result, double total_ms)
{
    json notes = json::array();
    for (const auto& n : s.notes)
        notes.push_back(text_of(n));
    const auto& r = result.stats();
    const auto& p = r.photons;
    json kernels = json::object();
    double compile_ms = 0;
    for (const auto& [name, cost] : result.costs()) {
        compile_ms += cost.compile_ms;
        kernels[name] = {{"instructions", cost.instructions}, {"compile_ms", cost.compile_ms}, {"ms", cost.ms},
            {"passes", cost.passes}};
    }
    const json all = {{"version", PHOTONGRID_VERSION}, {"scene", s.scene.name}, {"notes", notes},
        {"backend", result.caps().backend}, {"device", result.caps().device}, {"seed", settings.seed},
        {"settings", json::parse(settings_text(settings))}, {"pilot", pilot_json(r.pilot)},
        {"picture",
            {{"passes", r.end.passes}, {"error", number_or_null(r.end.error)},
                {"percentile", settings.output.percentile}, {"ended_by", word_for(r.end.by)}}},
        {"photons",
            {{"asked", p.asked}, {"emitted", p.emitted}, {"absorbed", p.absorbed}, {"escaped", p.escaped},
                {"cut_off", p.cut_off}, {"invalid", p.invalid}, {"stored", p.stored}, {"direct", p.direct},
                {"left_to_caustics", p.left_to_caustics}, {"dropped", p.dropped}}},
        {"map",
            {{"builder", setting_table::map.values.word_for(r.map.builder)}, {"blocks", r.map.blocks},
                {"cells", r.map.cells}, {"resolution", {r.map.resolution.x, r.map.resolution.y, r.map.resolution.z}},
                {"overflowing_cells", r.map.overflowing_cells}, {"redistributed_power", r.map.redistributed_power},
                {"left_out", r.map.left_out}}},
        {"stages",
            {{"prepare_scene", stage_json(r.prepare_scene)}, {"trace_photons", stage_json(r.trace_photons)},
                {"build_map", stage_json(r.build_map)}, {"trace_rays", stage_json(r.trace_rays)},
                {"radiance_estimate", stage_json(r.radiance_estimate)}}},
        {"estimate",
            {{"mean_count", r.estimate.mean_count}, {"mean_radius", r.estimate.mean_radius},
                {"mean_visited", r.estimate.mean_visited}, {"points", r.estimate.points}}},
        {"kernels", kernels}, {"peak_memory_bytes", peak_memory_bytes()}, {"peak_device_bytes", r.peak_device_bytes},
        {"compile_ms", compile_ms}, {"total_ms", total_ms}};
    return all.dump(2) + "\n";
}

image_notes picture_notes(const scene& s, const render_settings& settings, const renderer& result)
{
    return {{"scene", s.name}, {"backend", result.caps().backend}, {"device", result.caps().device},
        {"seed", std::to_string(settings.seed)}, {"settings", settings_text(settings)},
        {"passes", std::to_string(result.stats().end.passes)},
        {"version", std::string("photongrid ") + PHOTONGRID_VERSION}};
}

std::uint64_t peak_memory_bytes()
{
    // getrusage's value survives exec: a small program started by a large one would report the large one's.
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (std::uint64_t kib = 0; word == "VmHWM:" && status >> kib)
            return kib * 1024;
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

} // namespace photongrid
