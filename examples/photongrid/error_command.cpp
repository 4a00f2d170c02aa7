#include "error_command.hpp"

#include <photongrid/compare/error_sheet.hpp>
#include <photongrid/compare/image_difference.hpp>
#include <photongrid/compare/picture_regions.hpp>
#include <photongrid/io/image_file.hpp>
#include <photongrid/io/tone_map.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>

namespace photongrid {

namespace {
    using json = nlohmann::ordered_json;

    struct measured_region {
        std::string name;
        error_summary errors;
    };

    /// What is compared, and what was found.
    struct error_report {
        image picture, reference;
        std::vector<pixel_error> errors;
        flip_map visible;
        std::vector<picture_region> regions; ///< the reference's own, then those asked for
        std::size_t own_regions = 0;
        std::vector<measured_region> measured; ///< the whole picture, then each region
        std::vector<error_bin> histogram;
        std::uint64_t not_finite = 0;
        sheet_scales scales;
    };

    image read_averaged(const std::string& path, std::uint32_t n)
    {
        const auto picture = read_image(path);
        try {
            return n == 1 ? picture : averaged(picture, n);
        } catch (const std::invalid_argument& e) {
            fail_file(path, e.what());
        }
    }

    picture_region read_region(const region_source& r, const error_options& o, const image& reference)
    {
        const auto picture = read_averaged(r.path, o.average);
        try {
            detail::require_same_size(picture, reference);
            return region_of(r.name, picture, r.level, r.outside);
        } catch (const std::invalid_argument& e) {
            fail_file(r.path, "--region " + r.name + ": " + e.what());
        }
    }

    error_report report_of(const error_options& o)
    {
        error_report r;
        r.picture = read_averaged(o.picture, o.average);
        r.reference = read_averaged(o.reference, o.average);
        try {
            r.errors = pixel_errors(r.picture, r.reference);
        } catch (const std::invalid_argument& e) {
            throw file_error(o.picture + ", " + o.reference + ": " + e.what());
        }
        r.scales = {.exposure = exposure_for(r.reference, o.exposure),
            .least_error = o.range.x,
            .most_error = o.range.y,
            .difference = difference_limit(r.errors)};
        r.regions = regions_of(r.reference);
        r.own_regions = r.regions.size();
        for (const auto& source : o.regions)
            r.regions.push_back(read_region(source, o, r.reference));
        r.visible = flip_difference(r.picture, r.reference, r.scales.exposure, o.pixels_per_degree);
        r.not_finite = static_cast<std::uint64_t>(
            std::count_if(r.errors.begin(), r.errors.end(), [](const auto& e) { return !std::isfinite(e.relative); }));
        const picture_region all{"all", std::vector<bool>(r.errors.size(), true)};
        r.measured.push_back({all.name, summary_of(r.errors, r.visible.values, all)});
        for (const auto& region : r.regions) {
            r.measured.push_back({region.name, summary_of(r.errors, r.visible.values, region)});
            if (r.measured.size() > r.own_regions + 1 && r.measured.back().errors.pixels == 0)
                throw file_error(o.picture + ", " + o.reference + ": no pixel of the region " + region.name
                    + " is finite in both pictures");
        }
        r.histogram = error_histogram(r.errors);
        return r;
    }

    // --- Pictures ---

    /// The regions that the sheet shows: those asked for, or else the reference's own, without those that are what
    /// remains.
    std::vector<picture_region> drawn_regions(const error_report& r)
    {
        if (r.regions.size() > r.own_regions)
            return {r.regions.begin() + static_cast<std::ptrdiff_t>(r.own_regions), r.regions.end()};
        std::vector<picture_region> drawn;
        for (const auto* name : {"dark", "bright", "edges"})
            drawn.push_back(*std::find_if(
                r.regions.begin(), r.regions.end(), [&](const auto& region) { return region.name == name; }));
        return drawn;
    }

    image relative_differences(const error_report& r)
    {
        image made{.width = r.picture.width, .height = r.picture.height, .pixels = {}};
        for (std::size_t i = 0; i < r.picture.pixels.size(); ++i) {
            const glm::dvec3 p(r.picture.pixels[i]), q(r.reference.pixels[i]);
            made.pixels.emplace_back((p - q) / (q + relmse_floor));
        }
        return made;
    }

    void write_pictures(const error_options& o, const std::vector<std::string>& outputs, const error_report& r)
    {
        const image_notes notes{{"picture", o.picture}, {"reference", o.reference},
            {"version", std::string("photongrid ") + PHOTONGRID_VERSION}};
        for (const auto& path : outputs)
            write_image(path,
                is_for_display(path)
                    ? error_sheet(r.picture, r.reference, r.errors, r.visible, drawn_regions(r), r.scales)
                    : relative_differences(r),
                0, notes);
    }

    // --- Statistics ---

    json region_json(const measured_region& m, double all_squares)
    {
        const auto& e = m.errors;
        json percentiles = json::object();
        for (std::size_t i = 0; i < error_percentiles.size(); ++i)
            percentiles[std::to_string(error_percentiles[i])] = e.percentiles[i];
        return {{"name", m.name}, {"pixels", e.pixels}, {"relmse", e.relmse}, {"trimmed_relmse", e.trimmed_relmse},
            {"share", e.squares / all_squares}, {"mean", e.mean}, {"reference_mean", e.reference_mean},
            {"bias", e.bias()}, {"flip", e.flip}, {"percentiles", percentiles}};
    }

    std::string stats_of(const error_options& o, const error_report& r)
    {
        const double all_squares = r.measured.front().errors.squares;
        json regions = json::array(), histogram = json::array();
        for (const auto& m : r.measured)
            regions.push_back(region_json(m, all_squares));
        for (const auto& bin : r.histogram)
            histogram.push_back(
                {{"from", bin.from}, {"to", bin.to}, {"pixels", bin.pixels}, {"share", bin.squares / all_squares}});
        const json all = {{"version", PHOTONGRID_VERSION}, {"picture", o.picture}, {"reference", o.reference},
            {"size", {r.picture.width, r.picture.height}}, {"average", o.average}, {"exposure", r.scales.exposure},
            {"pixels_per_degree", o.pixels_per_degree}, {"not_finite", r.not_finite},
            {"colors",
                {{"error", {r.scales.least_error, r.scales.most_error}},
                    {"difference", {-r.scales.difference, r.scales.difference}}, {"flip", {0, 1}}}},
            {"regions", regions}, {"histogram", histogram}};
        // NaN and infinity become null.
        return all.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
    }

    // --- What is printed ---

    template <class... Values>
    std::string text_of(const char* format, Values... values)
    {
        char text[128];
        std::snprintf(text, sizeof text, format, values...);
        return text;
    }

    void print_regions(const error_report& r)
    {
        std::cout << "\nregion             pixels     relMSE    trimmed   of relMSE    mean off       FLIP\n";
        const double all_squares = r.measured.front().errors.squares;
        for (const auto& [name, e] : r.measured) {
            std::cout << text_of("%-15.40s %9llu", name.c_str(), static_cast<unsigned long long>(e.pixels));
            if (e.pixels == 0) {
                std::cout << '\n';
                continue;
            }
            std::cout << text_of(" %10.4g %10.4g", e.relmse, e.trimmed_relmse)
                      << (all_squares > 0 ? text_of(" %8.1f %%", 100 * e.squares / all_squares) : "          -")
                      << (e.reference_mean > 0 ? text_of(" %+9.2f %%", 100 * e.bias()) : "           -")
                      << text_of(" %10.4f\n", e.flip);
        }
    }

    void print_histogram(const error_report& r)
    {
        const auto filled = [](const error_bin& bin) { return bin.pixels > 0; };
        const auto first = std::find_if(r.histogram.begin(), r.histogram.end(), filled),
                   last = std::find_if(r.histogram.rbegin(), r.histogram.rend(), filled).base();
        const auto& all = r.measured.front().errors;
        std::cout << "\nrelative error           pixels   of relMSE\n";
        for (auto bin = first; bin < last; ++bin) {
            const double share = static_cast<double>(bin->pixels) / static_cast<double>(all.pixels);
            std::cout << (std::isinf(bin->to) ? text_of("%-9.3g and more    ", bin->from)
                                              : text_of("%-9.3g to %-9.3g", bin->from, bin->to))
                      << text_of(" %8.2f %%", 100 * share)
                      << (all.squares > 0 ? text_of(" %8.2f %%", 100 * bin->squares / all.squares) : "          -");
            if (const auto length = static_cast<std::size_t>(std::lround(40 * share)); length > 0)
                std::cout << "  " << std::string(length, '#');
            std::cout << '\n';
        }
    }

    void print_colors(const error_report& r)
    {
        const auto& s = r.scales;
        std::cout << "\ncolours of the sheet:\n"
                  << text_of(
                         "  difference of luminance: blue -%g, white 0, red %g, relative\n", s.difference, s.difference)
                  << text_of(
                         "  relative error: black %g, white %g, ticks at powers of ten\n", s.least_error, s.most_error)
                  << "  FLIP: black 0, white 1, ticks at tenths\n  regions:";
        const auto drawn = drawn_regions(r);
        for (std::size_t i = 0; i < drawn.size(); ++i)
            std::cout << (i > 0 ? ", " : " ") << drawn[i].name << ' ' << region_color_name(i);
        std::cout << '\n';
    }

    void print_report(const error_options& o, const error_report& r)
    {
        const auto& all = r.measured.front().errors;
        std::cout << "relMSE  " << all.relmse << "; " << all.trimmed_relmse << " without the worst 0.1 % of pixels\n"
                  << "FLIP    " << all.flip << " at " << r.scales.exposure << " EV and " << o.pixels_per_degree
                  << " pixels per degree\nerror   ";
        for (std::size_t i = 0; i < error_percentiles.size(); ++i)
            std::cout << (i > 0 ? ", " : "at most ") << text_of("%.3g", all.percentiles[i]) << " in "
                      << error_percentiles[i] << (i > 0 ? " %" : " % of pixels");
        std::cout << '\n';
        if (r.not_finite > 0)
            std::cout << "skipped " << r.not_finite << " pixels that are not finite; green in the sheet\n";
        print_regions(r);
        print_histogram(r);
    }
} // namespace

exit_code run_error(const error_options& o)
{
    auto outputs = o.outputs;
    if (outputs.empty())
        outputs.push_back(std::filesystem::path(o.picture).stem().string() + "-error.png");
    for (const auto& path : outputs)
        check_image_path(path);
    if (!o.stats.empty())
        check_file_path(o.stats);
    const auto r = report_of(o);
    if (r.not_finite == r.errors.size()) {
        std::cerr << "photongrid: error: no pixel is finite in both pictures\n";
        return failure;
    }
    print_report(o, r);
    if (std::any_of(outputs.begin(), outputs.end(), is_for_display))
        print_colors(r);
    write_pictures(o, outputs, r);
    if (!o.stats.empty())
        write_file(o.stats, stats_of(o, r));
    std::cout << '\n';
    for (const auto& path : outputs)
        std::cout << path << '\n';
    return success;
}

} // namespace photongrid
