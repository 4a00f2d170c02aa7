// The picture as a sum of passes. Passes are added in any order; the spread between them measures the noise.
#pragma once

#include <photongrid/render/exact_sum.hpp>
#include <photongrid/render/image.hpp>
#include <photongrid/render/pass_groups.hpp>
#include <photongrid/render/pixel_bias.hpp>
#include <photongrid/scene/scene.hpp>

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The result of one pass, row by row from the top left.
struct pass_pixels {
    std::vector<glm::vec4> pixels; ///< rgb: radiance, W/(m^2 sr)
    // Empty unless output_settings::aov.
    std::vector<glm::vec4> searches; ///< sums over a pixel's searches: photons used, radius, photons visited, searches
    std::vector<glm::vec4> errors;   ///< x: sum of relative standard errors
    pass_biases biases{};            ///< empty unless they are reported (reports_bias)

    /// All of its vectors, in the order of a film's bytes.
    std::array<std::vector<glm::vec4>*, 6> parts()
    {
        return {&pixels, &searches, &errors, &biases.bias, &biases.tilt, &biases.jump};
    }
    std::array<const std::vector<glm::vec4>*, 6> parts() const
    {
        return {&pixels, &searches, &errors, &biases.bias, &biases.tilt, &biases.jump};
    }
};

/// A picture, and the number of pixels that were NaN or infinite in some pass. Those count as black in that pass.
struct developed_picture {
    image picture;
    std::uint64_t invalid_pixels = 0;
};

/// Sums passes. The picture of a single pass has exactly its floats. The mean of several passes is exact up to the
/// final rounding and does not depend on the order of the passes.
class film {
public:
    film() = default;
    /// For pictures of width x height pixels. `unit` is a typical radiance, a power of two: sums have a resolution of
    /// 2^-64 units, and pixels above 2^40 units count as infinite. `layers`: also sum the layers
    /// (output_settings::aov). `biases`: also sum the biases of pixels (reports_bias), of estimates by `filter`.
    film(std::uint32_t width, std::uint32_t height, double unit, bool layers, bool biases = false,
        filter_kind filter = filter_kind::silverman)
        : width_(width), height_(height), unit_(unit), layers_(layers), biases_(biases), filter_(filter)
    {
    }

    /// Adds pass number `pass`.
    /// \throws std::invalid_argument for a pass that was added before, or one of another size.
    void add(std::uint32_t pass, pass_pixels p)
    {
        const std::size_t n = size(), layer = layers_ ? n : 0;
        if (p.pixels.size() != n || p.searches.size() != layer || p.errors.size() != layer
            || !p.biases.have(biases_ ? n : 0))
            throw std::invalid_argument("film::add: pass " + std::to_string(pass) + ": has "
                + std::to_string(p.pixels.size()) + " pixels; the film has " + std::to_string(n));
        if (holds(pass))
            throw std::invalid_argument("film::add: pass " + std::to_string(pass) + " was added before");
        if (passes_.empty()) {
            only_ = std::move(p);
        } else {
            begin_sums();
            add_up(pass, p);
        }
        passes_.insert(pass);
    }
    /// Adds the passes of another film, as if each were added here. Threads and machines can each have a film of their
    /// own: in any order, these add up to the same bytes.
    /// \throws std::invalid_argument for a film of another size or unit, or one with a pass that was added before.
    void add(film other)
    {
        if (other.passes_.empty())
            return;
        if (!other.is_for(width_, height_, layers_, biases_) || other.unit_ != unit_)
            throw std::invalid_argument("film::add: the other film has another size, unit or layers");
        for (const auto pass : other.passes_)
            if (holds(pass))
                throw std::invalid_argument("film::add: pass " + std::to_string(pass) + " was added before");
        if (other.only_) {
            add(*other.passes_.begin(), std::move(*other.only_));
        } else if (passes_.empty()) {
            *this = std::move(other);
        } else {
            begin_sums();
            for (std::size_t i = 0; i < sums_.size(); ++i)
                sums_[i].add(other.sums_[i]);
            groups_.add(std::move(other.groups_));
            for (std::size_t i = 0; i < layer_sums_.size(); ++i)
                layer_sums_[i].add(other.layer_sums_[i]);
            for (std::size_t i = 0; i < bias_sums_.size(); ++i)
                bias_sums_[i].add(other.bias_sums_[i]);
            passes_.merge(other.passes_);
        }
    }

    /// Whether pass number `pass` was added.
    bool holds(std::uint32_t pass) const { return passes_.contains(pass); }
    /// Whether pictures of it have this size and these layers.
    bool is_for(std::uint32_t width, std::uint32_t height, bool layers, bool biases = false) const
    {
        return width == width_ && height == height_ && layers == layers_ && biases == biases_;
    }
    /// The number of passes added.
    std::uint32_t passes() const { return static_cast<std::uint32_t>(passes_.size()); }
    /// The number of pixels.
    std::size_t size() const { return std::size_t{width_} * height_; }

    /// The film as bytes, for a file. The same passes give the same bytes in any order.
    std::string bytes() const
    {
        std::string out;
        const auto put = [&](const void* data, std::size_t size) {
            if (size > 0)
                out.append(static_cast<const char*>(data), size);
        };
        const std::uint32_t head[] = {width_, height_,
            (layers_ ? 1u : 0u) | (biases_ ? 2u : 0u) | static_cast<std::uint32_t>(filter_) << 2, passes()};
        put(head, sizeof head);
        put(&unit_, sizeof unit_);
        for (const auto pass : passes_)
            put(&pass, sizeof pass);
        if (only_)
            for (const auto* part : std::as_const(*only_).parts())
                put(part->data(), part->size() * sizeof(glm::vec4));
        put(sums_.data(), sums_.size() * sizeof(pixel_sums));
        groups_.append_to(out);
        put(layer_sums_.data(), layer_sums_.size() * sizeof(layer_sums));
        put(bias_sums_.data(), bias_sums_.size() * sizeof(detail::pixel_bias_sums));
        return out;
    }
    /// The film from its bytes.
    /// \throws std::invalid_argument for bytes that are not a film's.
    static film from_bytes(std::string_view in)
    {
        const auto take = [&](void* data, std::size_t size) {
            if (in.size() < size)
                throw std::invalid_argument("film: the data end too early");
            if (size > 0)
                std::memcpy(data, in.data(), size);
            in.remove_prefix(size);
        };
        std::uint32_t head[4];
        double unit = 0;
        take(head, sizeof head);
        take(&unit, sizeof unit);
        if (head[0] > 16384 || head[1] > 16384 || head[2] > 15 || head[3] > 65536 || !(unit > 0) || std::isinf(unit))
            throw std::invalid_argument("film: the data are not a film's");
        film f(head[0], head[1], unit, (head[2] & 1) != 0, (head[2] & 2) != 0, static_cast<filter_kind>(head[2] >> 2));
        const std::size_t n = f.size(), layer = f.layers_ ? n : 0, biases = f.biases_ ? n : 0;
        for (std::uint32_t i = 0; i < head[3]; ++i) {
            std::uint32_t pass = 0;
            take(&pass, sizeof pass);
            f.passes_.insert(pass);
        }
        if (head[3] == 1) {
            if (in.size() != (n + 2 * layer + 3 * biases) * sizeof(glm::vec4))
                throw std::invalid_argument("film: the data have the wrong length");
            f.only_.emplace();
            f.only_->pixels.resize(n);
            f.only_->searches.resize(layer);
            f.only_->errors.resize(layer);
            for (auto* part : f.only_->biases.parts())
                part->resize(biases);
            for (auto* part : f.only_->parts())
                take(part->data(), part->size() * sizeof(glm::vec4));
        } else if (head[3] > 1) {
            const auto groups = detail::pass_groups(f.passes_, 0).bytes_per_pixel();
            if (in.size()
                != n * sizeof(pixel_sums) + n * groups + layer * sizeof(layer_sums)
                    + biases * sizeof(detail::pixel_bias_sums))
                throw std::invalid_argument("film: the data have the wrong length");
            f.sums_.resize(n);
            f.groups_ = detail::pass_groups(f.passes_, n);
            f.layer_sums_.resize(layer);
            f.bias_sums_.resize(biases);
            take(f.sums_.data(), n * sizeof(pixel_sums));
            f.groups_.take_from(in);
            take(f.layer_sums_.data(), layer * sizeof(layer_sums));
            take(f.bias_sums_.data(), biases * sizeof(detail::pixel_bias_sums));
        }
        if (f.passes() != head[3] || !in.empty())
            throw std::invalid_argument("film: the data are not a film's");
        return f;
    }

    /// The mean of the passes added so far. If the film has layers, `relative_error` is that of the mean of the passes'
    /// estimates, and `noise` needs two passes.
    /// \throws std::logic_error if no pass was added yet.
    developed_picture picture() const
    {
        if (passes_.empty())
            throw std::logic_error("film::picture: no pass was added yet");
        developed_picture out;
        out.picture.width = width_;
        out.picture.height = height_;
        out.picture.pixels.reserve(size());
        if (only_)
            develop_one(out);
        else
            develop_many(out);
        for (std::size_t i = 0; biases_ && i < size(); ++i)
            out.picture.layers.bias.push_back(static_cast<float>(bias_of(i)));
        return out;
    }

    /// Calls visit(mean, standard_error) for every pixel, row by row: the mean of its channels, and the standard error
    /// of that mean from the spread of groups of passes (detail::pass_groups), W/(m^2 sr). The error is infinite where
    /// the spread is unknown, so in a film of one pass.
    template <class Visit>
    void visit_spread(const Visit& visit) const
    {
        if (only_)
            for (const auto& p : only_->pixels)
                visit(finite(p) ? static_cast<double>(p.x + p.y + p.z) / 3 : 0.0,
                    std::numeric_limits<double>::infinity());
        for (std::size_t i = 0; i < sums_.size(); ++i) {
            const auto& rgb = sums_[i].rgb;
            const double all = rgb[0].value() + rgb[1].value() + rgb[2].value();
            visit(all * unit_ / (3 * static_cast<double>(passes_.size())), standard_error_of(i));
        }
    }

    /// Whether the biases of pixels are reported.
    bool has_biases() const { return biases_; }
    /// The bias of the mean of the passes at a pixel, W/(m^2 sr), mean of the channels: detail::pixel_bias_sums::value.
    /// 0 if biases are not reported.
    double bias_of(std::size_t pixel) const
    {
        if (!bias_sums_.empty())
            return bias_sums_[pixel].value(static_cast<double>(passes_.size()), filter_) * unit_;
        if (!biases_ || !only_)
            return 0;
        const auto& b = only_->biases.bias[pixel];
        return finite(b) ? static_cast<double>(b.x + b.y + b.z) / 3 : std::numeric_limits<double>::infinity();
    }

private:
    struct pixel_sums {
        exact_sum rgb[3];
        std::uint32_t invalid = 0;           ///< 1: in some pass it was NaN, infinite or too bright
        std::uint32_t spread_is_unknown = 0; ///< 1: in some pass it was too bright for the sums of groups

        void add(const pixel_sums& other)
        {
            for (int c = 0; c < 3; ++c)
                rgb[c].add(other.rgb[c]);
            invalid |= other.invalid;
            spread_is_unknown |= other.spread_is_unknown;
        }
    };
    struct layer_sums {
        exact_sum searches, count, radius, error;

        void add(const layer_sums& other)
        {
            searches.add(other.searches);
            count.add(other.count);
            radius.add(other.radius);
            error.add(other.error);
        }
    };

    static bool finite(const glm::vec4& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

    /// Turns the floats of the only pass into sums.
    void begin_sums()
    {
        if (!only_)
            return;
        sums_.resize(size());
        if (layers_)
            layer_sums_.resize(size());
        if (biases_)
            bias_sums_.resize(size());
        groups_ = detail::pass_groups({}, size());
        add_up(*passes_.begin(), *std::exchange(only_, std::nullopt));
    }
    /// Adds a pixel of a pass. Returns what it adds to the sums of groups: r + g + b, in units, or 0 if it is too
    /// bright.
    double add_up(const glm::vec4& pixel, pixel_sums& sum) const
    {
        const glm::dvec3 value = glm::dvec3(pixel) / unit_;
        const double all = value.x + value.y + value.z;
        // Each term, too: terms of either sign may cancel. False for NaN.
        const auto holds = [](double x) { return std::abs(x) < largest; };
        if (!holds(value.x) || !holds(value.y) || !holds(value.z) || !holds(all)) {
            sum.invalid = 1;
            return 0;
        }
        for (int c = 0; c < 3; ++c)
            sum.rgb[c].add(value[c]);
        if (std::abs(all) < detail::pass_groups::largest)
            return all;
        sum.spread_is_unknown = 1;
        return 0;
    }
    void add_up(std::uint32_t pass, const pass_pixels& p)
    {
        groups_.add(pass, [&](std::size_t i) { return add_up(p.pixels[i], sums_[i]); });
        for (std::size_t i = 0; i < layer_sums_.size(); ++i) {
            auto& sum = layer_sums_[i];
            const glm::dvec4 tally(p.searches[i]);
            if (!exact_sum::holds(tally.x) || !exact_sum::holds(tally.y) || !exact_sum::holds(tally.w))
                continue; // as if this pass had not searched there
            sum.searches.add(tally.w);
            sum.count.add(tally.x);
            sum.radius.add(tally.y);
            if (const double error = static_cast<double>(p.errors[i].x); exact_sum::holds(error))
                sum.error.add(error);
        }
        add_up(p.biases);
    }

    void add_up(const pass_biases& p)
    {
        for (std::size_t i = 0; i < bias_sums_.size(); ++i)
            bias_sums_[i].add(
                glm::dvec4(p.bias[i]) / unit_, glm::dvec4(p.tilt[i]) / unit_, glm::dvec4(p.jump[i]) / unit_);
    }

    void develop_one(developed_picture& out) const
    {
        for (const auto& p : only_->pixels) {
            out.invalid_pixels += finite(p) ? 0u : 1u;
            out.picture.pixels.push_back(finite(p) ? glm::vec3(p) : glm::vec3(0));
        }
        auto& layers = out.picture.layers;
        for (std::size_t i = 0; i < only_->errors.size(); ++i) {
            const auto finite_or_0 = [](float x) { return std::isfinite(x) ? x : 0.0f; };
            const auto& tally = only_->searches[i];
            const bool counts = std::isfinite(tally.x) && std::isfinite(tally.y) && std::isfinite(tally.w);
            const float mean = counts && tally.w > 0 ? 1.0f / tally.w : 0.0f; // per search
            layers.radius.push_back(counts ? tally.y * mean : 0.0f);
            layers.count.push_back(counts ? tally.x * mean : 0.0f);
            layers.relative_error.push_back(finite_or_0(only_->errors[i].x * mean));
        }
    }

    void develop_many(developed_picture& out) const
    {
        const double n = static_cast<double>(passes_.size());
        auto& layers = out.picture.layers;
        if (layers_)
            layers.noise = noise();
        for (std::size_t i = 0; i < sums_.size(); ++i) {
            const auto& sum = sums_[i];
            out.invalid_pixels += sum.invalid;
            const glm::dvec3 total(sum.rgb[0].value(), sum.rgb[1].value(), sum.rgb[2].value());
            out.picture.pixels.emplace_back(total * (unit_ / n));
        }
        for (const auto& sum : layer_sums_) {
            const double searches = sum.searches.value(), mean = searches > 0 ? 1 / searches : 0;
            layers.radius.push_back(static_cast<float>(sum.radius.value() * mean));
            layers.count.push_back(static_cast<float>(sum.count.value() * mean));
            layers.relative_error.push_back(static_cast<float>(sum.error.value() * mean / std::sqrt(n)));
        }
    }

    /// Of the mean of a pixel's channels.
    double standard_error_of(std::size_t pixel) const
    {
        if (sums_[pixel].spread_is_unknown != 0)
            return std::numeric_limits<double>::infinity();
        return std::sqrt(groups_.variance_of_mean(pixel)) / 3 * unit_;
    }
    /// The standard errors of all pixels, each no less than a quarter of those of two neighbours: what they see, as the
    /// edge of a lamp, the pixel may only not have met yet.
    std::vector<float> noise() const
    {
        // With a frame of zeros round the picture.
        const std::size_t row = std::size_t{width_} + 2;
        std::vector<float> own(row * (std::size_t{height_} + 2)), told(sums_.size());
        for (std::size_t y = 0, i = 0; y < height_; ++y)
            for (std::size_t x = 0; x < width_; ++x, ++i)
                own[(y + 1) * row + x + 1] = static_cast<float>(standard_error_of(i));
        for (std::size_t y = 0, i = 0; y < height_; ++y)
            for (std::size_t x = 0; x < width_; ++x, ++i) {
                const float* const at = &own[(y + 1) * row + x + 1];
                float largest_near = 0, second = 0;
                for (const float* const near : {at - row, at, at + row})
                    for (const float e : {near[-1], near == at ? 0.0f : near[0], near[1]}) {
                        second = std::max(second, std::min(e, largest_near));
                        largest_near = std::max(largest_near, e);
                    }
                told[i] = std::isinf(second) ? *at : std::max(*at, 0.25f * second);
            }
        return told;
    }

    // Terms of exact_sum are below 2^46.
    static constexpr double largest = 0x1p40; ///< of a pixel's r + g + b, in units

    std::uint32_t width_ = 0, height_ = 0;
    double unit_ = 1;
    bool layers_ = false, biases_ = false;
    filter_kind filter_ = filter_kind::silverman;
    std::set<std::uint32_t> passes_;
    std::optional<pass_pixels> only_; ///< the floats of the only pass, while there is one
    std::vector<pixel_sums> sums_;
    detail::pass_groups groups_; ///< of r + g + b, in units
    std::vector<layer_sums> layer_sums_;
    std::vector<detail::pixel_bias_sums> bias_sums_;
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
