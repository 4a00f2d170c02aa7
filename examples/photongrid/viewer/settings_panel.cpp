#include "settings_panel.hpp"

#include "display.hpp"

#include <photongrid/io/setting_texts.hpp>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

namespace photongrid::viewer {

namespace {
    /// What key() does, for tooltips.
    constexpr std::pair<std::string_view, const char*> keys_of_settings[] = {{setting_table::k.name, "K, k"},
        {setting_table::photons.name, "N, n"}, {setting_table::max_radius.name, "R, r"},
        {setting_table::exposure.name, "E, e"}, {setting_table::map.name, "m"}, {setting_table::search.name, "s"},
        {setting_table::filter.name, "w"}, {setting_table::grid.name, "g"}};
} // namespace

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

// A control for a row of the table of settings, by the kind of its values.

/// A word for each value.
template <class Row, class Value, std::size_t N>
void settings_panel::control(const Row& row, const setting_table::one_of<Value, N>& choice, const char* label)
{
    const auto value = row.of(document_.now().settings);
    if (ImGui::BeginCombo(label, choice.word_for(value))) {
        for (const auto& n : choice.values) {
            if (ImGui::Selectable(n.name, n.value == value))
                change(label, [&](render_settings& s) { row.of(s) = n.value; });
            placed(std::string(label) + ": " + n.name);
        }
        ImGui::EndCombo();
    }
    explain(row, label);
}

/// The box, left of its number, of a setting that the renderer can choose. Returns whether it does.
template <class Row>
bool settings_panel::is_automatic(const Row& row, const char* label)
{
    const auto box = std::string("automatic ") + label;
    const auto now = row.of(document_.now().settings);
    bool automatic = now == row.values.automatic;
    const auto& gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const float width = ImGui::CalcItemWidth() - ImGui::GetFrameHeight() - gap;
    if (ImGui::Checkbox(("##" + box).c_str(), &automatic)) {
        const render_settings by_default;
        change(label, [&](render_settings& s) { row.of(s) = automatic ? row.values.automatic : row.of(by_default); });
    }
    tip(box.c_str(), "Automatic: the renderer chooses it for the scene.");
    ImGui::SameLine(0, gap);
    ImGui::SetNextItemWidth(width);
    if (automatic) {
        ImGui::LabelText(label, "auto");
        explain(row, label);
    }
    return automatic;
}
template <class Row>
void settings_panel::control(const Row& row, const setting_table::whole_or_auto& v, const char* label)
{
    if (!is_automatic(row, label))
        control(row, v.range, label);
}

/// By a slider whose steps are even in the number's logarithm.
template <class Row>
void settings_panel::control(const Row& row, const setting_table::whole_range&, const char* label)
{
    const auto& slider = row.words.slider;
    if (slider.high == 0)
        return;
    int value = static_cast<int>(row.of(document_.now().settings));
    const bool edited = ImGui::SliderInt(label, &value, static_cast<int>(slider.low), static_cast<int>(slider.high),
        "%d", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    if (begun(label) && edited)
        row.of(document_.edit().settings) = static_cast<std::uint32_t>(value);
    explain(row, label);
}

template <class Row>
void settings_panel::control(const Row& row, const real_range&, const char* label)
{
    slide(row, label, 0);
}

template <class Row>
void settings_panel::control(const Row& row, const setting_table::length_or_auto&, const char* label)
{
    if (!is_automatic(row, label))
        slide(row, label, ImGuiSliderFlags_Logarithmic);
}

template <class Row>
void settings_panel::slide(const Row& row, const char* label, int flags)
{
    const auto& slider = row.words.slider;
    float value = static_cast<float>(row.of(document_.now().settings));
    const bool edited = ImGui::SliderFloat(label, &value, static_cast<float>(slider.low),
        static_cast<float>(slider.high), slider.format, flags | ImGuiSliderFlags_AlwaysClamp);
    if (begun(label) && edited)
        row.of(document_.edit().settings) = static_cast<double>(value);
    explain(row, label);
}

/// The exposure, which the picture fits if it is not given.
template <class Row>
void settings_panel::control(const Row& row, const setting_table::real_or_auto&, const char* label)
{
    const auto fitted_label = std::string("fitted ") + label;
    bool fitted = !row.of(document_.now().settings);
    if (ImGui::Checkbox(fitted_label.c_str(), &fitted))
        change(label, [&](render_settings& s) { row.of(s) = fitted ? std::nullopt : std::optional(shown_exposure_); });
    explain(row, fitted_label.c_str());
    const auto& slider = row.words.slider;
    auto value = static_cast<float>(shown_exposure_);
    const bool edited = ImGui::SliderFloat(label, &value, static_cast<float>(slider.low),
        static_cast<float>(slider.high), slider.format, ImGuiSliderFlags_AlwaysClamp);
    if (begun(label) && edited)
        row.of(document_.edit().settings) = static_cast<double>(value);
    explain(row, label);
}

template <class Row>
void settings_panel::control(const Row& row, const setting_table::cells&, const char* label)
{
    const auto fitted_label = std::string("fitted ") + label;
    auto cells = glm::ivec3(row.of(document_.now().settings));
    bool fitted = cells == glm::ivec3(0);
    if (ImGui::Checkbox(fitted_label.c_str(), &fitted))
        change(label, [&](render_settings& s) { s.map.use_grid(fitted ? glm::uvec3(0) : grid_); });
    explain(row, fitted_label.c_str());
    if (fitted)
        return;
    const auto& slider = row.words.slider;
    const bool edited = ImGui::SliderInt3(label, &cells.x, static_cast<int>(slider.low), static_cast<int>(slider.high),
        "%d", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    if (begun(label) && edited)
        row.of(document_.edit().settings) = glm::uvec3(cells);
    explain(row, label);
}

/// The policy without a number.
template <class Row>
void settings_panel::control(const Row& row, const setting_table::policies&, const char*)
{
    bool side = row.of(document_.now().settings).side;
    if (ImGui::Checkbox("side", &side))
        change("side", [&](render_settings& s) { row.of(s).side = side; });
    explain(row, "side");
}

/// The window has its own size.
template <class Row>
void settings_panel::control(const Row&, const setting_table::pixels&, const char*)
{
}

/// The row's words, and the keys that change it, where the mouse rests on its control.
template <class Row>
void settings_panel::explain(const Row& row, const char* label)
{
    auto words = tooltip_of_setting(row.words);
    for (const auto& [setting, keys] : keys_of_settings)
        if (setting == row.name)
            words += std::string(" Keys: ") + keys + ".";
    tip(label, words.c_str());
}

template <class Change>
void settings_panel::change(const std::string& name, Change apply)
{
    document_.begin(name);
    apply(document_.edit().settings);
}

void settings_panel::draw(double shown_exposure)
{
    shown_exposure_ = shown_exposure;
    draw_backend();
    for (std::size_t group = 0; group < std::size(setting_groups); ++group) {
        if (setting_group(group) == setting_group::expert)
            ImGui::Separator();
        for_each_setting([&](const auto& row) {
            if (row.words.group == setting_group(group) && row.words.matters(document_.now().settings))
                control(row, row.values, label_of_setting(row.name).c_str());
        });
    }
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

void settings_panel::key(const key_press& p, double shown_exposure)
{
    const bool up = p.shift;
    const render_settings by_default;
    const auto doubled = [&](const auto& row) {
        change(row.name, [&](render_settings& s) {
            auto& value = row.of(s);
            if (value == row.values.automatic)
                value = row.of(by_default);
            value = std::clamp(up ? value * 2 : value / 2, row.values.range.least, row.values.range.most / 2);
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
    case 'r':
        change("radius", [&](render_settings& s) {
            auto& r = s.estimate.max_radius;
            r = (r == automatic_length ? by_default.estimate.max_radius : r) * (up ? 1.25 : 0.8);
        });
        return;
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
