// Whether pictures by routed maps keep what sorted ones show: the brightest places, where cells overflow most. On the
// serial backend; the others make the same decisions.
#pragma once

#include "pictures.hpp"
#include <photongrid/io/scene_file.hpp>

#include <algorithm>
#include <numeric>

namespace photongrid::testing {
namespace {

    /// Light that photons bring, the sum of the channels: its mean over a picture, and over its brightest thousandth.
    struct indirect_light {
        double mean = 0, peak = 0;
    };
    indirect_light indirect_light_of(const image& picture, const image& direct)
    {
        std::vector<double> light;
        for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
            const glm::dvec3 p = glm::dvec3(picture.pixels[i]) - glm::dvec3(direct.pixels[i]);
            light.push_back(p.x + p.y + p.z);
        }
        std::sort(light.begin(), light.end(), std::greater<>());
        const auto mean_of = [&](std::size_t n) {
            return std::accumulate(light.begin(), light.begin() + static_cast<std::ptrdiff_t>(n), 0.0)
                / static_cast<double>(n);
        };
        return {mean_of(light.size()), mean_of(std::max<std::size_t>(light.size() / 1000, 1))};
    }

    /// A ratio over several seeds.
    struct ratio {
        std::vector<double> values;
        double mean() const
        {
            return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
        }
        double standard_error() const
        {
            const double n = static_cast<double>(values.size());
            double squares = 0;
            for (const double v : values)
                squares += (v - mean()) * (v - mean());
            return std::sqrt(squares / (n - 1) / n);
        }
    };

    /// A photon that stands for s photons makes an estimate of k photons at most s / k too bright in the mean: of the
    /// ceil(k / s) photons kept that the estimate takes, the last one sets the radius and counts in part.
    TEST(routed_pictures, are_as_bright_as_sorted_ones)
    {
        const auto s = read_scene(std::string(PHOTONGRID_SCENES) + "/cornell_box.json");
        const auto small = [](render_settings r) {
            r.output.width = 64;
            r.output.height = 48;
            r.view.spp = r.view.light_samples = 1;
            r.output.passes = 1;
            return r;
        };
        auto settings = small(s.render), paper = small(as_paper(s));
        settings.map.caustic_photons = 0; // a map of their own would be sorted
        ratio peak, mean, papers_peak;
        double stands_for = 1;
        for (std::uint32_t seed = 1; seed <= 6; ++seed) {
            serial_backend b;
            settings.seed = paper.seed = seed;
            auto direct_alone = settings, routing = settings, papers_routing = paper;
            direct_alone.output.only = light_part::direct;
            routing.map.builder = papers_routing.map.builder = map_builder::route;
            const auto direct = render(b, s, direct_alone).picture;
            const auto light = [&](const auto& each) { return indirect_light_of(render(b, s, each).picture, direct); };
            const auto sorted = light(settings), routed = light(routing);
            peak.values.push_back(routed.peak / sorted.peak);
            mean.values.push_back(routed.mean / sorted.mean);
            papers_peak.values.push_back(light(papers_routing).peak / light(paper).peak);
            const auto slots = static_cast<double>(route_capacity(settings.map.slots));
            for (const auto& c : b.download(build_map(b, s, routing).map().cells))
                stands_for = std::max(stands_for, c.y / slots);
        }
        const double bias = stands_for / settings.estimate.k;
        std::printf("a photon stands for up to %.0f; route over sort: mean %.4f +- %.4f, brightest thousandth "
                    "%.3f +- %.3f; as the paper: %.3f\n",
            stands_for, mean.mean(), mean.standard_error(), peak.mean(), peak.standard_error(), papers_peak.mean());
        EXPECT_GE(peak.mean(), 1 - 4 * peak.standard_error());
        EXPECT_LE(peak.mean(), 1 + bias + 4 * peak.standard_error());
        EXPECT_GE(mean.mean(), 1 - 4 * mean.standard_error());
        EXPECT_LE(mean.mean(), 1 + bias + 4 * mean.standard_error());
        EXPECT_LT(papers_peak.mean(), 0.5) << "the paper's way loses the caustic";
    }

} // namespace
} // namespace photongrid::testing
