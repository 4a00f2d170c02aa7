#include "settings_panel.hpp"

#include "display.hpp"

#include <photongrid/scene/setting_table.hpp>

#include <algorithm>
#include <iterator>

namespace photongrid::viewer {

void settings_panel::begin_anew()
{
    const auto given = document_.now().settings.map.grid;
    grid_ = given == glm::uvec3(0) ? glm::uvec3(32) : given;
}

/// After an item that changes settings: one drag is one undo step.
bool settings_panel::begun(const char* name)
{
    if (ImGui::IsItemActivated())
        held_ = document_.now();
    if (!ImGui::IsItemEdited())
        return false;
    if (held_) {
        document_.begin(name);
        held_.reset();
    }
    return true;
}

// A control for a row of the table of settings. Its label may be more than the setting's name.

/// A word for each value.
template <class Row>
void settings_panel::choice(const Row& row, const char* label, const char* help)
{
    const auto value = row.of(document_.now().settings);
    if (ImGui::BeginCombo(label, row.values.word_for(value))) {
        for (const auto& n : row.values.values) {
            if (ImGui::Selectable(n.name, n.value == value))
                change(label, [&](render_settings& s) { row.of(s) = n.value; });
            placed(std::string(label) + ": " + n.name);
        }
        ImGui::EndCombo();
    }
    tip(label, help);
}

/// A whole number, by a slider whose steps are even in its logarithm.
template <class Row>
void settings_panel::number(const Row& row, const char* label, int low, int high, const char* help)
{
    int value = static_cast<int>(row.of(document_.now().settings));
    const bool edited
        = ImGui::SliderInt(label, &value, low, high, "%d", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    if (begun(label) && edited)
        row.of(document_.edit().settings) = static_cast<std::uint32_t>(value);
    tip(label, help);
}

template <class Row>
void settings_panel::measure(
    const Row& row, const char* label, float low, float high, const char* format, bool logarithmic, const char* help)
{
    float value = static_cast<float>(row.of(document_.now().settings));
    const bool edited = ImGui::SliderFloat(label, &value, low, high, format,
        (logarithmic ? ImGuiSliderFlags_Logarithmic : 0) | ImGuiSliderFlags_AlwaysClamp);
    if (begun(label) && edited)
        row.of(document_.edit().settings) = static_cast<double>(value);
    tip(label, help);
}

template <class Change>
void settings_panel::change(const std::string& name, Change apply)
{
    document_.begin(name);
    apply(document_.edit().settings);
}

void settings_panel::draw(double shown_exposure)
{
    draw_backend();
    const auto& s = document_.now().settings;
    number(setting_table::photons, "photons", 256, 4000000,
        "Photons stored (N, n). Speed: tracing and sorting take time in proportion. Error: noise falls with the square "
        "root of their number.");
    number(setting_table::k, "k", 1, 4000,
        "Photons per estimate (K, k). Speed: more take longer. Error: with more, estimates are smoother, but shadows "
        "and caustics are more blurred.");
    number(setting_table::caustic_photons, "caustic photons", 0, 1 << 20,
        "Caustic photons stored in a map of their own; 0: they are among the photons. Error: sharper caustics.");
    if (s.map.caustic_photons > 0)
        number(setting_table::caustic_k, "caustic k", 1, 2000,
            "Photons per estimate in that map. Error: with more photons caustics are smoother and more blurred.");
    choice(setting_table::emission, "emission",
        "Photons leave the lights in proportion to power alone, or more often where pilot paths stored photons. Speed: "
        "guided paths are fewer where most would be in vain.");
    measure(setting_table::max_radius, "radius, m", 1e-3f, 10.0f, "%.4f", true,
        "Largest search radius (R, r). Speed: searches in dark regions go this far. Error: where fewer than k photons "
        "lie within it, estimates are noisier instead of more blurred.");
    choice(setting_table::search, "search",
        "Which photons count (s): the k nearest; at least k, as in the paper, which uses more photons and is a "
        "little too bright; or all within the radius.");
    choice(setting_table::filter, "filter",
        "Weight of a photon by its distance (w). Speed: the same. Error: constant is the least noisy, but shows discs; "
        "silverman is the smoothest.");
    choice(setting_table::bias, "bias",
        "The photon that sets the radius: paper counts it, and is too bright by k / (k - 1); unbiased leaves it out.");
    draw_grid();
    choice(setting_table::map, "map",
        "How the photon map is built (m). sort and blocks are exact; blocks are fast where photons lie in clusters; "
        "auto takes the one that suits the photons; route takes fewer passes, but is approximate where cells "
        "overflow.");
    if (s.map.builder == map_builder::route) {
        number(setting_table::slots, "slots", 1, 16,
            "Cells hold at most slots x slots photons. With more, fewer photons are lost and more memory is used.");
        choice(setting_table::surplus, "surplus",
            "Photons for which a cell has no slot: those that it keeps stand for them (photons), or only take their "
            "power (the paper), which blurs caustics.");
    }
    ImGui::Separator();
    number(setting_table::spp, "eye rays", 1, 64,
        "Eye rays per pixel. Speed: time in proportion. Error: smoother edges, less noise from glass and lamps.");
    choice(setting_table::pixel_filter, "pixel filter",
        "Weight of an eye ray by its place: even over its pixel, or a tent of two pixels. Speed: the same. Error: a "
        "tent "
        "is smoother at edges, and a little blurred.");
    number(setting_table::passes, "passes", 1, 1024,
        "The picture is the mean of this many passes, each with its own photons and rays. Speed: time in proportion. "
        "Error: noise and blotches fade with every pass.");
    measure(setting_table::until_error, "until error", 0.0f, 0.2f, "%.3f", false,
        "Passes are added until the noise of most pixels is at most this part of their light; 0: off. passes is then "
        "the "
        "limit, and 1 is none.");
    measure(setting_table::seconds, "seconds", 0.0f, 600.0f, "%.0f", false,
        "Passes are added for this time; 0: off. passes is then the limit, and 1 is none.");
    choice(setting_table::radii, "radii",
        "From pass to pass: each pass finds its own (per_pass), or they shrink (shrinking). Speed: shrinking radii "
        "take "
        "a search more. Error: blur fades with every pass, too.");
    measure(setting_table::interpolation, "interpolation", 0.0f, 0.5f, "%.2f", false,
        "Estimates are interpolated between those that are at most so many of their radii away; 0: none are. Speed: "
        "fewer searches. Error: a little more blur.");
    choice(setting_table::tell_bias, "tell bias",
        "Whether until error counts the blur of each pixel, and not its noise alone; auto: if radii shrink. Speed: "
        "searches "
        "take a little longer. Error: none.");
    number(setting_table::light_samples, "light samples", 1, 256,
        "Shadow rays per lamp and eye ray. Speed: time in proportion, for direct light. Error: smoother penumbras.");
    choice(setting_table::indirect, "indirect light",
        "From the photons where eye rays end (map), or by a final gather of the light of all other surfaces, whose "
        "rays "
        "look at photons (gather) or go on as paths (paths). Speed: a gather takes longer, paths longer still. Error: "
        "noise instead of blotches; of paths the mean is exact.");
    if (s.estimate.indirect != indirect_kind::map)
        number(setting_table::gather_rays, "gather rays", 1, 1024,
            "Rays of the final gather per eye ray. Speed: time in proportion. Error: less noise.");
    choice(setting_table::only, "light",
        "Which part of the light is shown. Caustics or indirect light alone need a map of their own.");
    bool side = s.estimate.leaks.side;
    if (ImGui::Checkbox("side", &side))
        change("side", [&](render_settings& r) { r.estimate.leaks.side = side; });
    tip("side",
        "Rejects photons that arrive from behind a surface. Speed: almost the same. Error: no light leaks through "
        "walls.");
    draw_exposure(shown_exposure);
}

void settings_panel::draw_backend()
{
    const auto& now = document_.now().backend;
    if (ImGui::BeginCombo("backend", now.c_str())) {
        for (const auto* name : {"serial", "cpu", "gl", "gl-osmesa", "vulkan"}) {
            if (ImGui::Selectable(name, now == name)) {
                document_.begin("backend");
                document_.edit().backend = name;
            }
            placed(std::string("backend: ") + name);
        }
        ImGui::EndCombo();
    }
    tip("backend",
        "What draws the picture (b). The same photons give the same picture on each; speed differs. cpu is the fastest "
        "without a GPU.");
}

void settings_panel::draw_exposure(double shown)
{
    bool fitted = !document_.now().settings.output.exposure;
    if (ImGui::Checkbox("fitted exposure", &fitted))
        change(
            "exposure", [&](render_settings& r) { r.output.exposure = fitted ? std::nullopt : std::optional(shown); });
    tip("fitted exposure",
        "Fits the exposure to the picture: the geometric mean of the luminance becomes middle grey.");
    auto value = static_cast<float>(shown);
    const bool edited = ImGui::SliderFloat("exposure, EV", &value, -10, 10, "%+.1f", ImGuiSliderFlags_AlwaysClamp);
    if (begun("exposure, EV") && edited)
        document_.edit().settings.output.exposure = static_cast<double>(value);
    tip("exposure, EV", "Brightness of the screen and of saved PNGs (E, e). Nothing is drawn again.");
}

void settings_panel::draw_grid()
{
    auto cells = glm::ivec3(document_.now().settings.map.grid);
    bool fitted = cells == glm::ivec3(0);
    if (ImGui::Checkbox("fitted grid", &fitted))
        change("grid", [&](render_settings& r) { r.map.use_grid(fitted ? glm::uvec3(0) : grid_); });
    tip("fitted grid",
        "Fits the cells of the photon map to the photons and k (g). Speed: searches take longer in a grid that is too "
        "coarse or too fine. Error: none for the k nearest; at_least_k depends on the cells.");
    if (!fitted) {
        const bool edited = ImGui::SliderInt3(
            "grid", &cells.x, 1, 256, "%d", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
        if (begun("grid") && edited)
            document_.edit().settings.map.grid = glm::uvec3(cells);
        tip("grid", "Cells along x, y and z.");
    }
}

void settings_panel::key(const key_press& p, double shown_exposure)
{
    const bool up = p.shift;
    const auto doubled = [&](const auto& row) {
        change(row.name, [&](render_settings& s) {
            auto& value = row.of(s);
            value = std::clamp(up ? value * 2 : value / 2, row.values.least, row.values.most / 2);
        });
    };
    const auto next = [&](const auto& row) {
        change(row.name, [&](render_settings& s) {
            const auto& all = row.values.values;
            std::size_t i = 0;
            while (all[i].value != row.of(s))
                ++i;
            row.of(s) = all[(i + 1) % std::size(all)].value;
        });
    };
    switch (p.key) {
    case 'k': doubled(setting_table::k); return;
    case 'n': doubled(setting_table::photons); return;
    case 'r': change("radius", [&](render_settings& s) { s.estimate.max_radius *= up ? 1.25 : 0.8; }); return;
    case 'e':
        change("exposure", [&](render_settings& s) {
            s.output.exposure = std::clamp(s.output.exposure.value_or(shown_exposure) + (up ? 0.5 : -0.5), -64.0, 64.0);
        });
        return;
    default: break;
    }
    if (p.repeated)
        return; // choices do not change while a key is held
    switch (p.key) {
    case 'm': next(setting_table::map); return;
    case 's': next(setting_table::search); return;
    case 'w': next(setting_table::filter); return;
    case 'g':
        change(
            "grid", [&](render_settings& s) { s.map.use_grid(s.map.grid == glm::uvec3(0) ? grid_ : glm::uvec3(0)); });
        return;
    case 'b': {
        document_.begin("backend");
        auto& b = document_.edit().backend;
        b = b == "serial" ? "cpu" : b == "cpu" ? "gl" : b == "gl" ? "vulkan" : "serial";
        return;
    }
    default: return;
    }
}

} // namespace photongrid::viewer
