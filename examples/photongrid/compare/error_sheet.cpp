#include <photongrid/compare/error_sheet.hpp>
#include <photongrid/compare/false_colors.hpp>
#include <photongrid/compare/image_difference.hpp>
#include <photongrid/io/tone_map.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

namespace photongrid {

namespace {
    constexpr std::uint32_t panel_gap = 4, least_panel_width = 240;
    constexpr std::uint32_t bar_height = 10, tick_height = 5, legend_height = panel_gap + bar_height + tick_height;
    constexpr glm::vec3 sheet_background(0.02f), tick_color(0.8f);

    struct region_color {
        const char* name;
        glm::vec3 color;
    };
    constexpr region_color region_colors[] = {{"blue", {0.02f, 0.1f, 1}}, {"yellow", {1, 0.9f, 0.05f}},
        {"orange", {1, 0.25f, 0}}, {"violet", {0.5f, 0.02f, 0.9f}}, {"cyan", {0, 0.8f, 0.9f}}, {"red", {0.8f, 0, 0}}};

    /// A part of the sheet, with the scale of its colours if it has one.
    struct sheet_panel {
        std::vector<glm::vec3> pixels;
        glm::vec3 (*colors)(double place) = nullptr; ///< of the scale's bar, from 0 to 1
        std::vector<double> ticks{};                 ///< places on it
    };

    bool is_finite(const pixel_error& e) { return std::isfinite(e.relative); }

    sheet_panel shown_picture(const image& picture, double exposure)
    {
        const tone_map shown(exposure);
        sheet_panel panel;
        for (const auto& p : picture.pixels)
            panel.pixels.emplace_back(linear_value(shown(p.x)), linear_value(shown(p.y)), linear_value(shown(p.z)));
        return panel;
    }

    sheet_panel difference_panel(std::span<const pixel_error> errors, double limit)
    {
        sheet_panel panel;
        for (const auto& e : errors)
            panel.pixels.push_back(
                is_finite(e) ? false_colors::balance(e.brighter() / limit) : false_colors::not_finite);
        panel.colors = [](double place) { return false_colors::balance(2 * place - 1); };
        panel.ticks = {0, 0.5, 1};
        return panel;
    }

    sheet_panel error_panel(std::span<const pixel_error> errors, const sheet_scales& scales)
    {
        const double low = std::log10(scales.least_error), high = std::log10(scales.most_error);
        sheet_panel panel;
        for (const auto& e : errors) // of no error the logarithm is minus infinity, beyond the end
            panel.pixels.push_back(false_colors::heat((std::log10(e.relative) - low) / (high - low)));
        panel.colors = false_colors::heat;
        for (double power = std::ceil(low - 1e-9); power <= high + 1e-9; ++power)
            panel.ticks.push_back((power - low) / (high - low));
        return panel;
    }

    sheet_panel flip_panel(std::span<const pixel_error> errors, const flip_map& visible)
    {
        sheet_panel panel;
        for (std::size_t i = 0; i < errors.size(); ++i)
            panel.pixels.push_back(is_finite(errors[i]) ? false_colors::heat(static_cast<double>(visible.values[i]))
                                                        : false_colors::not_finite);
        panel.colors = false_colors::heat;
        for (int tenth = 0; tenth <= 10; ++tenth)
            panel.ticks.push_back(tenth / 10.0);
        return panel;
    }

    /// The reference in grey, and each region in a colour.
    sheet_panel regions_panel(const image& reference, std::span<const picture_region> regions, double exposure,
        std::span<const pixel_error> errors)
    {
        auto panel = shown_picture(reference, exposure);
        for (std::size_t i = 0; i < panel.pixels.size(); ++i) {
            auto& p = panel.pixels[i];
            const auto grey = static_cast<float>(luminance_of(p));
            p = glm::vec3(grey);
            for (std::size_t r = 0; r < regions.size(); ++r)
                if (regions[r].pixels[i])
                    p = (0.3f + 0.7f * grey) * region_colors[r % std::size(region_colors)].color;
            if (!is_finite(errors[i]))
                p = false_colors::not_finite;
        }
        return panel;
    }

    /// The number of columns with which the sheet is most like a screen.
    std::uint32_t columns_for(double width, double height)
    {
        constexpr double screen = 1.6;
        std::uint32_t best = 3;
        for (const std::uint32_t columns : {2u, 6u}) {
            const auto unlike
                = [&](std::uint32_t c) { return std::abs(std::log(c * width / (6.0 / c * height) / screen)); };
            if (unlike(columns) < unlike(best))
                best = columns;
        }
        return best;
    }

    /// Draws on the sheet, in pixels of the sheet.
    class sheet_writer {
    public:
        sheet_writer(std::uint32_t width, std::uint32_t height)
            : sheet_{.width = width,
                .height = height,
                .pixels = std::vector<glm::vec3>(std::size_t{width} * height, sheet_background)}
        {
        }
        void fill(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height, const glm::vec3& color)
        {
            for (std::uint32_t row = y; row < y + height; ++row)
                std::fill_n(sheet_.pixels.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * sheet_.width + x),
                    width, color);
        }
        /// The bar of a panel's scale and, below, its ticks.
        void add_scale(std::uint32_t x, std::uint32_t y, std::uint32_t width, const sheet_panel& panel)
        {
            const double last = std::max(width - 1.0, 1.0);
            for (std::uint32_t i = 0; i < width; ++i)
                fill(x + i, y, 1, bar_height, panel.colors(i / last));
            for (const double place : panel.ticks) {
                const auto at = static_cast<std::uint32_t>(std::lround(std::clamp(place, 0.0, 1.0) * last));
                fill(x + std::min(at, width - std::min(width, 2u)), y + bar_height, std::min(width, 2u), tick_height,
                    tick_color);
            }
        }
        image finished() { return std::move(sheet_); }

    private:
        image sheet_;
    };
} // namespace

double difference_limit(std::span<const pixel_error> errors)
{
    std::vector<double> sizes;
    for (const auto& e : errors)
        if (is_finite(e))
            sizes.push_back(std::abs(e.brighter()));
    constexpr double least = 0.001;
    if (sizes.empty())
        return least;
    const auto rank = sizes.begin() + static_cast<std::ptrdiff_t>((sizes.size() * 95 + 99) / 100 - 1);
    std::nth_element(sizes.begin(), rank, sizes.end());
    for (double power = least;; power *= 10)
        for (const double factor : {1, 2, 5})
            if (*rank <= factor * power * (1 + 1e-9))
                return factor * power;
}

const char* region_color_name(std::size_t index) { return region_colors[index % std::size(region_colors)].name; }

image error_sheet(const image& picture, const image& reference, std::span<const pixel_error> errors,
    const flip_map& visible, std::span<const picture_region> regions, const sheet_scales& scales)
{
    detail::require_same_size(picture, reference);
    const std::uint32_t width = picture.width, height = picture.height;
    const std::size_t count = std::size_t{width} * height;
    if (count == 0 || errors.size() != count || visible.values.size() != count
        || std::any_of(regions.begin(), regions.end(), [&](const auto& r) { return r.pixels.size() != count; }))
        throw std::invalid_argument("errors, FLIP or regions are of another picture, or of none");
    const sheet_panel panels[] = {shown_picture(picture, scales.exposure), shown_picture(reference, scales.exposure),
        difference_panel(errors, scales.difference), error_panel(errors, scales), flip_panel(errors, visible),
        regions_panel(reference, regions, scales.exposure, errors)};
    const std::uint32_t zoom = (least_panel_width + width - 1) / width, columns = columns_for(width, height),
                        rows = 6 / columns;
    const std::uint32_t across = zoom * width + panel_gap, down = zoom * height + legend_height + panel_gap;
    sheet_writer sheet(columns * across + panel_gap, rows * down + panel_gap);
    for (std::uint32_t i = 0; i < std::size(panels); ++i) {
        const std::uint32_t left = i % columns * across + panel_gap, top = i / columns * down + panel_gap;
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x)
                sheet.fill(left + x * zoom, top + y * zoom, zoom, zoom, panels[i].pixels[std::size_t{y} * width + x]);
        if (panels[i].colors)
            sheet.add_scale(left, top + zoom * height + panel_gap, zoom * width, panels[i]);
    }
    return sheet.finished();
}

} // namespace photongrid
