// The table of settings: name, member of render_settings, range and words of each. Scene files, statistics, the command
// line and the window read, write, check and explain settings by this table. A new setting is a member of a stage's
// struct and a row here.
#pragma once

#include <photongrid/scene/check.hpp>
#include <photongrid/scene/render_settings.hpp>

#include <cmath>
#include <string>
#include <string_view>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A value of a setting and its name.
template <class Value>
struct named {
    const char* name;
    Value value;
};
template <class Value>
named(const char*, Value) -> named<Value>;

namespace setting_table {

    // The ranges of settings. Each has check(), which throws std::invalid_argument "name: must be …".

    /// A whole number, both ends included.
    struct whole_range {
        std::uint32_t least, most;
        void check(const char* name, std::uint32_t v) const
        {
            detail::require(v >= least && v <= most,
                std::string(name) + ": must be from " + std::to_string(least) + " to " + std::to_string(most));
        }
    };
    using photongrid::real_range;
    /// A length, m.
    struct any_length {
        void check(const char* name, double v) const
        {
            detail::require(detail::finite(v) && v > 0, std::string(name) + ": must be finite and greater than 0");
        }
    };
    /// A number, or automatic (auto): a pilot chooses it.
    struct whole_or_auto {
        whole_range range;
        static constexpr auto automatic = automatic_number;
        void check(const char* name, std::uint32_t v) const
        {
            if (v != automatic)
                range.check(name, v);
        }
    };
    /// A length, m, or automatic (auto): a pilot chooses it.
    struct length_or_auto {
        static constexpr auto automatic = automatic_length;
        void check(const char* name, double v) const
        {
            if (v != automatic)
                any_length{}.check(name, v);
        }
    };
    /// One of several words.
    template <class Value, std::size_t N>
    struct one_of {
        named<Value> values[N];

        constexpr const char* word_for(Value v) const
        {
            for (const auto& n : values)
                if (n.value == v)
                    return n.name;
            return nullptr;
        }
        /// Null for an unknown word.
        constexpr const Value* find(std::string_view word) const
        {
            for (const auto& n : values)
                if (n.name == word)
                    return &n.value;
            return nullptr;
        }
        void check(const char* name, Value v) const
        {
            detail::require(word_for(v) != nullptr, std::string(name) + ": must be one of the enumerators");
        }
    };
    template <class Value, std::size_t N>
    one_of(const named<Value> (&)[N]) -> one_of<Value, N>;
    /// A number, or nullopt (auto): fitted to the picture.
    struct real_or_auto {
        real_range range;
        void check(const char* name, const std::optional<double>& v) const
        {
            if (v)
                range.check(name, *v);
        }
    };
    /// Numbers of cells of the photon map along three axes, or 0, 0, 0.
    struct cells {
        std::uint32_t most_per_axis;
        double most;
        void check(const char* name, const glm::uvec3& v) const
        {
            const bool fitted = v == glm::uvec3(0);
            detail::require(fitted || (v.x >= 1 && v.y >= 1 && v.z >= 1),
                std::string(name) + ": each axis needs at least one cell (or all three 0: fitted to the photons)");
            detail::require(v.x <= most_per_axis && v.y <= most_per_axis && v.z <= most_per_axis,
                std::string(name) + ": must be at most " + std::to_string(most_per_axis) + " cells along an axis");
            detail::require(static_cast<double>(v.x) * v.y * v.z <= most, std::string(name) + ": more than 2^31 cells");
        }
    };
    /// Width and height.
    struct pixels {
        std::uint32_t most;
        void check(const char* name, const output_settings& s) const
        {
            detail::require(s.width >= 1 && s.height >= 1 && s.width <= most && s.height <= most,
                std::string(name) + ": width and height must be from 1 to " + std::to_string(most) + " pixels");
        }
    };
    /// Leak policies.
    struct policies {
        real_range min_cosine, flattening;
        void check(const char* name, const leak_policy& l) const
        {
            min_cosine.check((std::string(name) + ": min_cosine").c_str(), static_cast<double>(l.min_cosine));
            flattening.check((std::string(name) + ": flattening").c_str(), static_cast<double>(l.flattening));
        }
    };
} // namespace setting_table

/// Whether scene files may contain a setting.
enum class in_scenes { optional, never };

/// What settings are about, in the order of `--help` and docs/reference/settings.md.
enum class setting_group { picture, light, photons, estimate, expert };
inline constexpr const char* setting_groups[]
    = {"Picture", "Light", "Photons", "Estimate", "The paper's method and fine tuning"};

/// The ends of the window's slider, within the setting's range, and the format of its number if that is no whole one.
struct slider_range {
    double low = 0, high = 0;
    const char* format = "%.3f";
};

/// The words of a setting, which are written nowhere else: `--help`, the window's tooltips, the schema of scene files
/// and the rows of docs/reference/settings.md have them from here (examples/photongrid/io/setting_texts.hpp). A setting
/// is named in backticks, which `--help` makes an option, and a value between asterisks.
struct setting_words {
    setting_group group;
    const char* what;         ///< in one line, for all four
    const char* more = "";    ///< sentences, for tooltips and the page: details, speed and error
    const char* section = ""; ///< of the page, that explains it: its anchor
    slider_range slider = {};
    /// Whether it matters beside the others, as the window asks.
    bool (*matters)(const render_settings&) = [](const render_settings&) { return true; };
};

/// A row of the table. `of(s)` is the member of the render_settings `s`.
template <class Member, class Values>
struct setting {
    const char* name; ///< in scene files and statistics; on the command line --name, with - for _
    Member of;
    Values values;
    in_scenes use;
    setting_words words;
};
template <class Member, class Values>
setting(const char*, Member, Values, in_scenes, setting_words) -> setting<Member, Values>;

/// The rows.
namespace setting_table {
    constexpr auto names_of_filters()
    {
        one_of<filter_kind, filters.size()> all{};
        for (std::size_t i = 0; i < filters.size(); ++i)
            all.values[i] = {filters[i].name, filters[i].kind};
        return all;
    }

    // The member of render_settings that holds the settings of a stage.
    template <class Stage>
    inline constexpr Stage render_settings::*stage_of = nullptr;
    template <>
    inline constexpr map_settings render_settings::*stage_of<map_settings> = &render_settings::map;
    template <>
    inline constexpr estimate_settings render_settings::*stage_of<estimate_settings> = &render_settings::estimate;
    template <>
    inline constexpr view_settings render_settings::*stage_of<view_settings> = &render_settings::view;
    template <>
    inline constexpr output_settings render_settings::*stage_of<output_settings> = &render_settings::output;

    // of(&map_settings::photons) finds s.map.photons, of(&render_settings::seed) s.seed.
    template <class Stage, class Value>
    constexpr auto of(Value Stage::*value)
    {
        return [=](auto& s) -> auto& { return s.*stage_of<Stage>.*value; };
    }
    template <class Value>
    constexpr auto of(Value render_settings::*value)
    {
        return [=](auto& s) -> auto& { return s.*value; };
    }

    inline constexpr setting size{"size", of(&render_settings::output), pixels{16384}, in_scenes::optional,
        {.group = setting_group::picture, .what = "width and height, pixels"}};
    inline constexpr setting photons{"photons", of(&map_settings::photons), whole_or_auto{{1, 1u << 27}},
        in_scenes::optional,
        {.group = setting_group::photons,
            .what = "photons stored",
            .more = "Noise falls with the square root of their number. Tracing and sorting take time in proportion.",
            .slider = {256, 4e6}}};
    inline constexpr setting caustic_photons{"caustic_photons", of(&map_settings::caustic_photons),
        whole_or_auto{{0, 1u << 27}}, in_scenes::optional,
        {.group = setting_group::photons,
            .what = "caustic photons stored in a map of their own; 0: they are among `photons`",
            .more = "With a map of their own caustics are sharper.",
            .section = "caustic-photons",
            .slider = {0, 1 << 20}}};
    inline constexpr setting caustic_k{"caustic_k", of(&estimate_settings::caustic_k), whole_or_auto{{1, 1u << 24}},
        in_scenes::optional,
        {.group = setting_group::estimate,
            .what = "photons sought per estimate in the map of `caustic_photons`",
            .more = "With more, caustics are smoother and more blurred.",
            .section = "caustic-photons",
            .slider = {1, 2000},
            .matters = [](const render_settings& s) { return s.map.caustic_photons > 0; }}};
    inline constexpr setting k{"k", of(&estimate_settings::k), whole_or_auto{{1, 1u << 24}}, in_scenes::optional,
        {.group = setting_group::estimate,
            .what = "photons sought per estimate; not used by *fixed_radius*",
            .more
            = "With more, estimates are smoother, but shadows and caustics more blurred, and searches take longer.",
            .slider = {1, 4000}}};
    inline constexpr setting grid{"grid", of(&map_settings::grid), cells{1u << 20, 0x1p31}, in_scenes::optional,
        {.group = setting_group::expert,
            .what = "cells along x, y and z of a sorted or routed photon map, at most 2^31 in all; *auto*: fitted to "
                    "the photons and `k`",
            .more = "They fill the scene's bounding box. Searches take longer in a grid that is too coarse or too "
                    "fine; *at_least_k* finds other photons in it. Cells given in place of *auto* make an automatic "
                    "`map` a sorted one.",
            .slider = {1, 256}}};
    inline constexpr setting max_radius{"max_radius", of(&estimate_settings::max_radius), length_or_auto{},
        in_scenes::optional,
        {.group = setting_group::estimate,
            .what = "largest search radius; with *fixed_radius*, the radius",
            .more = "Where fewer than `k` photons lie within it, estimates are noisier instead of more blurred. "
                    "Searches in dark regions go this far.",
            .slider = {1e-3, 10, "%.4f m"}}};
    inline constexpr setting light_samples{"light_samples", of(&view_settings::light_samples),
        whole_or_auto{{1, 65536}}, in_scenes::optional,
        {.group = setting_group::light,
            .what = "shadow rays per eye ray and light that has an area or is an environment; other lights take one",
            .more = "Of more than 16 lights each ray goes to one, chosen by estimates of their light. More rays make "
                    "smoother penumbras and take time in proportion.",
            .slider = {1, 256}}};
    inline constexpr setting spp{"spp", of(&view_settings::spp), whole_or_auto{{1, 65536}}, in_scenes::optional,
        {.group = setting_group::picture,
            .what = "eye rays per pixel and pass",
            .more = "More make smoother edges and less noise from glass and lamps, and take time in proportion.",
            .slider = {1, 64}}};
    inline constexpr setting pixel_filter{"pixel_filter", of(&view_settings::filter),
        one_of{{named{"box", photongrid::pixel_filter::box}, {"tent", photongrid::pixel_filter::tent}}},
        in_scenes::optional,
        {.group = setting_group::picture,
            .what = "weight of an eye ray by its place: *box*, even over its pixel; *tent*, falling linearly to the "
                    "middles of the neighbouring pixels",
            .more = "A tent is smoother at edges, and a little blurred. A single eye ray per pixel has no filter."}};
    inline constexpr setting passes{"passes", of(&output_settings::passes),
        whole_or_auto{{1, output_settings::most_passes}}, in_scenes::optional,
        {.group = setting_group::picture,
            .what = "number of passes averaged, each with its own photons, eye rays and shadow rays; with "
                    "`until_error` or `seconds`, the most (1: no limit)",
            .more = "Noise and blotches fade with every pass. Time is in proportion.",
            .slider = {1, 1024}}};
    inline constexpr setting until_error{"until_error", of(&output_settings::until_error), real_range{0, 1, ""},
        in_scenes::optional,
        {.group = setting_group::picture,
            .what = "add passes until the error of most pixels (`percentile`) is at most this part of their light, "
                    "e.g. 0.02; 0: off",
            .section = "stop-rules",
            .slider = {0, 0.2}}};
    inline constexpr setting percentile{"percentile", of(&output_settings::percentile), real_range{0, 1, ""},
        in_scenes::optional,
        {.group = setting_group::picture,
            .what = "part of the pixels whose error `until_error` limits",
            .section = "stop-rules",
            .slider = {0, 1},
            .matters = [](const render_settings& s) { return s.output.until_error > 0; }}};
    inline constexpr setting seconds{"seconds", of(&output_settings::seconds), real_range{0, 1e8, " s"},
        in_scenes::never,
        {.group = setting_group::picture,
            .what = "add passes as long as they end within this time of drawing; 0: off",
            .section = "stop-rules",
            .slider = {0, 600, "%.0f s"}}};
    inline constexpr setting depth{"depth", of(&view_settings::depth), whole_range{0, 64}, in_scenes::optional,
        {.group = setting_group::light,
            .what = "most reflections, refractions and clear surfaces that an eye ray follows; past 8 faint rays end "
                    "by Russian roulette"}};
    inline constexpr setting photon_depth{"photon_depth", of(&map_settings::photon_depth), whole_range{1, 64},
        in_scenes::optional, {.group = setting_group::photons, .what = "most surfaces that a photon path hits"}};
    inline constexpr setting emission{"emission", of(&map_settings::emission),
        one_of{{named{"power", photon_emission::power}, {"guided", photon_emission::guided}}}, in_scenes::optional,
        {.group = setting_group::photons,
            .what = "how photons leave the lights: *power*, in proportion to power alone; *guided*, more often where "
                    "pilot paths stored photons",
            .more = "Guided paths are fewer where most would be in vain.",
            .section = "guided-emission"}};
    inline constexpr setting seed{"seed", of(&render_settings::seed), whole_range{0, 0xFFFFFFFFu}, in_scenes::optional,
        {.group = setting_group::picture, .what = "same seed, same picture"}};
    inline constexpr setting map{"map", of(&map_settings::builder),
        one_of{{named{"sort", map_builder::sort}, {"route", map_builder::route}, {"blocks", map_builder::blocks},
            {"auto", map_builder::automatic}}},
        in_scenes::optional,
        {.group = setting_group::photons,
            .what = "how the photon map is built: *sort* (bitonic sort) or *route* (stencil routing), in the `grid`; "
                    "*blocks*, along a curve; *auto*, in a fitted grid or blocks, as suits the photons; a scene with a "
                    "`grid` has *sort* by default",
            .more = "*sort* and *blocks* are exact; *blocks* are fast where photons lie in clusters; *route* takes "
                    "fewer passes, but is approximate where cells overflow."}};
    inline constexpr setting slots{"slots", of(&map_settings::slots), whole_range{1, 16}, in_scenes::optional,
        {.group = setting_group::expert,
            .what = "a routed cell has so many times so many slots for photons",
            .more = "The photons that have one stand for the others of their cell. Where one stands for more than `k`, "
                    "estimates are too dark. More slots lose fewer photons and take more memory.",
            .slider = {1, 16},
            .matters = [](const render_settings& s) { return s.map.builder == map_builder::route; }}};
    inline constexpr setting surplus{"surplus", of(&map_settings::surplus),
        one_of{{named{"photons", surplus_kind::photons}, {"power", surplus_kind::power}}}, in_scenes::optional,
        {.group = setting_group::expert,
            .what = "photons for which a routed cell has no slot: *photons*, those kept stand for them; *power*, those "
                    "kept only take their power, as in the paper",
            .more = "With *photons*, those kept are stored once per photon that they stand for. With *power*, searches "
                    "reach too far and blur caustics.",
            .matters = [](const render_settings& s) { return s.map.builder == map_builder::route; }}};
    inline constexpr setting exposure{"exposure", of(&output_settings::exposure), real_or_auto{{-64, 64, " EV"}},
        in_scenes::optional,
        {.group = setting_group::picture,
            .what = "PNG: pixel values times 2^EV; *auto*: the geometric mean of the luminance of lit pixels becomes "
                    "middle grey",
            .more = "Nothing is drawn again.",
            .slider = {-10, 10, "%+.1f EV"}}};
    inline constexpr setting search{"search", of(&estimate_settings::search),
        one_of{{named{"at_least_k", search_kind::at_least_k}, {"exact_k", search_kind::exact_k},
            {"fixed_radius", search_kind::fixed_radius}}},
        in_scenes::optional,
        {.group = setting_group::estimate,
            .what = "photons used: *at_least_k*, `k` or more, as in the paper; *exact_k*, the `k` nearest; "
                    "*fixed_radius*, all within `max_radius`",
            .more = "How many *at_least_k* uses depends on the grid (section 2.3), and it is a little too bright."}};
    inline constexpr setting filter{"filter", of(&estimate_settings::filter), names_of_filters(), in_scenes::optional,
        {.group = setting_group::estimate,
            .what = "weight of a photon by its distance",
            .more = "*constant* is the least noisy, but shows discs; *silverman* is the smoothest.",
            .section = "filters"}};
    inline constexpr setting bias{"bias", of(&estimate_settings::bias),
        one_of{{named{"paper", bias_kind::paper}, {"unbiased", bias_kind::unbiased}}}, in_scenes::optional,
        {.group = setting_group::expert,
            .what = "the photon that sets the radius: *paper*, it counts; *unbiased*, it is left out of the sum",
            .more = "Where it counts, estimates are too bright by k / (k - 1)."}};
    inline constexpr setting leaks{"leaks", of(&estimate_settings::leaks), policies{{-1, 1, ""}, {1, 1e6, ""}},
        in_scenes::optional,
        {.group = setting_group::estimate,
            .what
            = "photons rejected: *side*, those from behind the surface; *min_cosine*, those on other surfaces, whose "
              "normal has a smaller cosine with the point's or which lie above or below its own; *flattening*, "
              "distances along the normal count so many times",
            .more = "Against light from behind walls and around corners. It takes hardly any time.",
            .section = "leaks"}};
    inline constexpr setting edge_correction{"edge_correction", of(&estimate_settings::edges),
        one_of{{named{"none", photongrid::edge_correction::none}, {"polygons", photongrid::edge_correction::polygons},
            {"probes", photongrid::edge_correction::probes}}},
        in_scenes::optional,
        {.group = setting_group::expert,
            .what
            = "divide estimates by the share of their disc that lies on the surface: *probes*, as short rays find "
              "it on surfaces of every kind; *polygons*, exactly, on polygons alone; needs *min_cosine* in "
              "`leaks`",
            .more = "With *none* an estimate at a straight edge is half of the irradiance, in a right-angled corner a "
                    "quarter.",
            .section = "edge-correction",
            .matters = [](const render_settings& s) { return s.estimate.leaks.min_cosine > 0; }}};
    inline constexpr setting indirect{"indirect", of(&estimate_settings::indirect),
        one_of{{named{"map", indirect_kind::map}, {"gather", indirect_kind::gather},
            named{"paths", indirect_kind::paths}}},
        in_scenes::optional,
        {.group = setting_group::light,
            .what = "indirect light that is no caustic: *map*, from the photons where eye rays end; *gather*, by rays "
                    "from there to photons elsewhere (a final gather); *paths*, by rays that go on and look at no "
                    "photons but caustic ones",
            .more = "A gather takes longer, paths longer still. Both have noise instead of blotches; the mean of "
                    "*paths* is exact.",
            .section = "final-gather"}};
    inline constexpr setting gather_rays{"gather_rays", of(&estimate_settings::gather_rays), whole_range{1, 65536},
        in_scenes::optional,
        {.group = setting_group::light,
            .what = "rays or paths of a final gather per eye ray",
            .more = "More make less noise and take time in proportion.",
            .section = "final-gather",
            .slider = {1, 1024},
            .matters = [](const render_settings& s) { return s.estimate.indirect != indirect_kind::map; }}};
    inline constexpr setting radii{"radii", of(&estimate_settings::radii),
        one_of{{named{"per_pass", radius_kind::per_pass}, {"shrinking", radius_kind::shrinking}}}, in_scenes::optional,
        {.group = setting_group::estimate,
            .what = "radii of estimates: *per_pass*, found by each pass; *shrinking*, from pass to pass, if there are "
                    "several, so that the picture converges",
            .more = "Where they shrink, blur fades with every pass, too; it takes a search more.",
            .section = "shrinking-radii"}};
    inline constexpr setting interpolation{"interpolation", of(&estimate_settings::interpolation),
        real_range{0, 0.5, ""}, in_scenes::optional,
        {.group = setting_group::estimate,
            .what = "estimates are interpolated between those of the same surface that are at most so many of their "
                    "radii away; 0: none are",
            .more = "Fewer searches, a little more blur.",
            .section = "interpolation",
            .slider = {0, 0.5, "%.2f"}}};
    inline constexpr setting report_bias{"report_bias", of(&output_settings::report_bias),
        one_of{{named{"auto", bias_report::automatic}, {"no", bias_report::no}, {"yes", bias_report::yes}}},
        in_scenes::optional,
        {.group = setting_group::picture,
            .what = "find the blur's part of each pixel, as a layer of EXRs, and count it in `until_error`; *auto*: "
                    "with `until_error` if `radii` are *shrinking*",
            .more = "Searches take a little longer; the light is the same.",
            .section = "bias"}};
    inline constexpr setting only{"only", of(&output_settings::only),
        one_of{{named{"all", light_part::all}, {"direct", light_part::direct}, {"caustic", light_part::caustic},
            {"indirect", light_part::indirect}}},
        in_scenes::never,
        {.group = setting_group::light,
            .what = "draw this part of the light alone",
            .more = "*direct* traces no photons; *caustic* and *indirect* have photon maps of their own."}};
} // namespace setting_table

/// Calls visit(row) for every row, in the order of scene files.
template <class Visit>
constexpr void for_each_setting(const Visit& visit)
{
    namespace t = setting_table;
    const auto all = [&](const auto&... row) { (visit(row), ...); };
    all(t::size, t::photons, t::caustic_photons, t::k, t::caustic_k, t::grid, t::max_radius, t::light_samples, t::spp,
        t::pixel_filter, t::passes, t::until_error, t::percentile, t::depth, t::photon_depth, t::emission, t::seed,
        t::map, t::slots, t::surplus, t::exposure, t::search, t::filter, t::bias, t::leaks, t::edge_correction,
        t::indirect, t::gather_rays, t::radii, t::interpolation, t::report_bias, t::only, t::seconds);
}

/// \throws std::invalid_argument "name: must be …" for a setting out of its range, or for two incompatible settings.
inline void check(const render_settings& s)
{
    for_each_setting([&](const auto& row) { row.values.check(row.name, row.of(s)); });
    detail::require(s.estimate.edges != edge_correction::polygons || s.estimate.leaks.min_cosine > 0,
        "edge_correction: photons of adjoining walls would count, though their area does not; it needs the leak policy "
        "min_cosine above 0, for example 0.5 (or edge_correction none)");
}
/// The same of settings that a pilot no longer has to choose.
inline void check_numbers(const render_settings& s)
{
    check(s);
    for_each_setting([&](const auto& row) {
        if constexpr (requires { row.values.automatic; })
            detail::require(row.of(s) != row.values.automatic,
                std::string(row.name) + ": is automatic; it must be a number here (chosen_settings finds one)");
    });
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
