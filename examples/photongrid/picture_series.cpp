#include "picture_series.hpp"

#include <photongrid/compare/image_difference.hpp>
#include <photongrid/compare/structural_similarity.hpp>
#include <photongrid/io/tone_map.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <set>

namespace photongrid {

namespace {
    /// Stages that a strip shows, as the paper's figure 8 does.
    constexpr std::size_t strip_stages = 6;

    image cut(const image& whole, const crop& c)
    {
        image part;
        part.width = c.width;
        part.height = c.height;
        for (std::uint32_t y = 0; y < c.height; ++y)
            for (std::uint32_t x = 0; x < c.width; ++x)
                part.pixels.push_back(whole.pixels[std::size_t{c.y + y} * whole.width + c.x + x]);
        return part;
    }

    /// Pictures of equal height side by side, with a line of white between them.
    image side_by_side(const std::vector<image>& pictures)
    {
        constexpr std::uint32_t gap = 2;
        image all;
        all.height = pictures.at(0).height;
        for (const auto& p : pictures)
            all.width += p.width + (all.width > 0 ? gap : 0);
        for (std::uint32_t y = 0; y < all.height; ++y)
            for (const auto& p : pictures) {
                if (&p != &pictures.front())
                    all.pixels.insert(all.pixels.end(), gap, glm::vec3(1e6f)); // white at any exposure
                const auto row = p.pixels.begin() + static_cast<std::ptrdiff_t>(std::size_t{y} * p.width);
                all.pixels.insert(all.pixels.end(), row, row + p.width);
            }
        return all;
    }
} // namespace

picture_series::picture_series(series_options o) : options_(std::move(o))
{
    if (!options_.strip.empty())
        check_image_path(options_.strip);
    const auto& size = options_.size;
    if (!options_.reference.empty()) {
        reference_ = read_image(options_.reference);
        if (reference_->width != size.x || reference_->height != size.y)
            throw std::invalid_argument("--reference " + options_.reference + ": has "
                + std::to_string(reference_->width) + " x " + std::to_string(reference_->height)
                + " pixels; the picture has " + std::to_string(size.x) + " x " + std::to_string(size.y));
    }
    if (const auto& c = options_.strip_crop;
        c && (c->width > size.x || c->x > size.x - c->width || c->height > size.y || c->y > size.y - c->height))
        throw std::invalid_argument("--crop: does not lie in the picture, which has " + std::to_string(size.x) + " x "
            + std::to_string(size.y) + " pixels");
    if (options_.folder.empty())
        return;
    std::error_code error;
    std::filesystem::create_directories(options_.folder, error);
    if (error)
        throw file_error(options_.folder + ": cannot be made: " + error.message());
    check_image_path(path(1));
    start_ = clock::now();
}

bool picture_series::due() const
{
    if (!enabled())
        return false;
    const double now = elapsed_ms();
    return steps_.empty() || now - steps_.back().ms >= (options_.every_ms > 0 ? options_.every_ms : 0.1 * now);
}

void picture_series::add(const image& picture)
{
    if (!enabled())
        return;
    const auto begin = clock::now();
    steps_.push_back({picture, elapsed_ms()});
    if (!options_.folder.empty())
        write_image(path(steps_.size()), picture, exposure_for(picture, options_.exposure));
    spent_ms_ += std::chrono::duration<double, std::milli>(clock::now() - begin).count();
}

void picture_series::finish(const image& picture)
{
    if (!enabled())
        return;
    add(picture);
    if (!options_.folder.empty())
        write_table();
    if (!options_.strip.empty())
        write_strip();
}

std::string picture_series::path(std::size_t number) const
{
    char digits[24];
    std::snprintf(digits, sizeof digits, "-%04zu.png", number);
    return options_.folder + "/" + options_.stem + digits;
}

void picture_series::write_table() const
{
    std::string table
        = std::string("picture,ms,relmse,ssim") + (reference_ ? ",relmse_to_reference,ssim_to_reference" : "") + "\n";
    const auto likeness = [&](const image& a, const image& b) {
        char text[64];
        std::snprintf(text, sizeof text, ",%.6g,%.6g", compare_images(a, b).relmse,
            structural_similarity(a, b, exposure_for(b, options_.exposure)));
        return std::string(text);
    };
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        char ms[32];
        std::snprintf(ms, sizeof ms, ",%.3f", steps_[i].ms);
        table += std::filesystem::path(path(i + 1)).filename().string() + ms
            + likeness(steps_[i].picture, steps_.back().picture)
            + (reference_ ? likeness(steps_[i].picture, *reference_) : "") + '\n';
    }
    write_file(options_.folder + "/" + options_.stem + ".csv", table);
}

void picture_series::write_strip()
{
    // Even steps of the logarithm of time: the first pictures follow each other fast.
    const auto log_ms = [](const step& s) { return std::log(std::max(s.ms, 1e-3)); };
    const double first = log_ms(steps_.front()), last = log_ms(steps_.back());
    std::set<std::size_t> chosen;
    for (std::size_t stage = 0; stage < strip_stages; ++stage) {
        const double target = first + (last - first) * static_cast<double>(stage) / (strip_stages - 1);
        std::size_t nearest = steps_.size() - 1;
        for (std::size_t i = 0; i < steps_.size(); ++i)
            if (std::abs(log_ms(steps_[i]) - target) < std::abs(log_ms(steps_[nearest]) - target))
                nearest = i;
        chosen.insert(nearest);
    }
    std::vector<image> stages;
    for (const auto i : chosen) {
        const auto& p = steps_[i].picture;
        stages.push_back(cut(p, options_.strip_crop.value_or(crop{0, 0, p.width, p.height})));
        strip_times_.push_back(steps_[i].ms);
    }
    write_image(options_.strip, side_by_side(stages), exposure_for(steps_.back().picture, options_.exposure));
}

} // namespace photongrid
