// The kernel files read as C++ once more, with double in place of float: the numerical oracle of the float pipeline.
// Random numbers are the same, since they are 24-bit integers times 2^-24.
#pragma once

#include "estimator_tests.hpp"
#include "ray_tests.hpp"

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdouble-promotion" // literals keep their suffix f
#endif

namespace photongrid::double_kernels {

using glm::abs, glm::floor, glm::max, glm::min, glm::sqrt;
using glm::uvec2, glm::uvec4;
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using vec4 = glm::dvec4;
using photongrid::uint;

/// For is_finite3: infinite and NaN stay so.
inline uint floatBitsToUint(double x) { return glm::floatBitsToUint(static_cast<float>(x)); }
inline double uintBitsToFloat(uint bits) { return static_cast<double>(glm::uintBitsToFloat(bits)); }

#include <photongrid/kernels/begin.hpp>
#define float double

// What kernels share, too.
#undef PHOTONGRID_SHARED_IS_READ
#include <photongrid/kernels/grid.glsl>
#include <photongrid/kernels/photon_event.glsl>
#include <photongrid/kernels/random.glsl>
#include <photongrid/kernels/scene_layout.glsl>
#include <photongrid/kernels/vector.glsl>
#define PHOTONGRID_SHARED_IS_READ

struct ray_probe {
#include "kernels/ray_probe.glsl"
};
struct glass_probe {
#include "kernels/glass_probe.glsl"
};
struct emit_photon {
#include <photongrid/kernels/emit_photon.glsl>
};
struct bounce_photon {
#include <photongrid/kernels/bounce_photon.glsl>
};
struct gather_start {
#include <photongrid/kernels/gather_start.glsl>
};
struct gather_photons {
#include <photongrid/kernels/gather_photons.glsl>
};
struct irradiance_estimate {
#include <photongrid/kernels/irradiance_estimate.glsl>
};

#undef float
#include <photongrid/kernels/end.hpp>

} // namespace photongrid::double_kernels

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace photongrid::testing {

/// The same numbers in double.
inline std::vector<glm::dvec4> widened(const std::vector<glm::vec4>& v) { return {v.begin(), v.end()}; }

inline double_kernels::Scene widened(const kernels::Scene& s)
{
    return {s.round_things, s.flat_things, s.rest, glm::dvec4(s.scale)};
}

/// The scene's records in double, of the numbers in float: what the float kernels see.
struct double_scene {
    std::vector<glm::dvec4> records;
    double_kernels::Scene layout;
    uint features;
    explicit double_scene(const scene_records& r)
        : records(widened(r.records)), layout(widened(r.layout)), features(r.features)
    {
    }
};

inline double_kernels::Grid widened(const kernels::Grid& g)
{
    return {glm::dvec4(g.origin), glm::dvec4(g.inverse_cell), glm::dvec4(g.cell), g.resolution};
}

/// Prints the largest and the median of errors; returns the largest.
inline double report_errors(const char* what, std::vector<double> errors)
{
    std::sort(errors.begin(), errors.end());
    std::printf("double oracle: %s: largest %.3g, 99th percentile %.3g, median %.3g of %zu\n", what, errors.back(),
        errors[errors.size() * 99 / 100], errors[errors.size() / 2], errors.size());
    return errors.back();
}

TEST(double_oracle, hits_of_rays)
{
    const auto s = all_shapes();
    const auto about = lay_out(s);
    const double_scene wide(about);
    random_source u(61);
    rays r;
    for (int i = 0; i < 100000; ++i)
        r.add(glm::vec3(1.5f * random_direction(u)), random_direction(u), random_direction(u));
    serial_backend b;
    const auto device = upload_scene(b, s);
    auto place = b.make<glm::vec4>(r.size()), facing = b.make<glm::vec4>(r.size()), start = b.make<glm::vec4>(r.size());
    b.run<kernels::ray_probe>({static_cast<uint>(r.size()), 0u, about.features}, {.scene_layout = about.layout},
        reads(device.records, b.upload(std::span<const glm::vec4>(r.origins)),
            b.upload(std::span<const glm::vec4>(r.directions)), b.upload(std::span<const glm::vec4>(r.leavings))),
        writes(place, facing, start));
    const auto places = b.download(place), facings = b.download(facing);

    const auto o = widened(r.origins), d = widened(r.directions), l = widened(r.leavings);
    double_kernels::ray_probe k;
    k.args.scene_layout = wide.layout;
    turn_switches(k, wide.features);
    k.scene_data = wide.records;
    k.origins_data = o;
    k.directions_data = d;
    k.leavings_data = l;
    std::vector<double> t_errors, position_errors, normal_errors;
    std::size_t other = 0;
    for (uint i = 0; i < r.size(); ++i) {
        k.kernel(i);
        // Another surface, or none: within rounding of a silhouette.
        if ((k.place.w < 0) != (places[i].w < 0) || k.facing.w != static_cast<double>(facings[i].w)) {
            ++other;
            continue;
        }
        if (k.place.w < 0)
            continue;
        const double slope = std::abs(glm::dot(dvec3(k.facing), dvec3(d[i])));
        if (slope < 0.01) {
            ++other;
            continue;
        }
        t_errors.push_back(std::abs(k.place.w - static_cast<double>(places[i].w)) * slope);
        position_errors.push_back(glm::length(dvec3(k.place) - dvec3(places[i])) * slope);
        normal_errors.push_back(glm::length(dvec3(k.facing) - dvec3(facings[i])) * slope);
    }
    std::printf("double oracle: %zu of %zu rays meet another surface or graze one\n", other, r.size());
    EXPECT_LE(other, r.size() / 50);
    EXPECT_LE(report_errors("t times the cosine of incidence, m in a scene of some 4 m", t_errors), 2e-5);
    EXPECT_LE(report_errors("position times the cosine of incidence, m", position_errors), 2e-5);
    report_errors("normal times the cosine of incidence", normal_errors);
}

TEST(double_oracle, refraction)
{
    random_source u(62);
    glass_cases g;
    for (int i = 0; i < 100000; ++i)
        g.add(random_direction(u), random_direction(u), 1 + 2 * u());
    serial_backend b;
    g.run(b);
    const auto d = widened(g.directions), n = widened(g.normals);
    double_kernels::glass_probe k;
    k.directions_data = d;
    k.normals_data = n;
    std::vector<double> direction_errors, share_errors;
    for (uint i = 0; i < d.size(); ++i) {
        k.kernel(i);
        // The sine's error, over the refracted cosine, is the direction's: the square root at the critical angle.
        const double cosine = std::abs(glm::dot(dvec3(k.refracted), dvec3(n[i])));
        if ((k.refracted.w >= 1) != (g.refracted[i].w >= 1) || k.refracted.w >= 1)
            continue;
        direction_errors.push_back(glm::length(dvec3(k.refracted) - dvec3(g.refracted[i])) * cosine);
        share_errors.push_back(std::abs(k.refracted.w - static_cast<double>(g.refracted[i].w)) * cosine);
    }
    EXPECT_LE(report_errors("refracted direction times the refracted cosine", direction_errors), 1e-5);
    EXPECT_LE(report_errors("reflected share times the refracted cosine", share_errors), 1e-5);
}

TEST(double_oracle, photons_after_eight_bounces)
{
    auto s = small_cornell();
    s.render.photon_depth = 8;
    const uint paths = 16384, frames = 9;
    const auto about = lay_out(s);
    const double_scene wide(about);
    serial_backend b;
    const auto device = upload_scene(b, s);
    detail::photon_frames<serial_backend> f(b, std::size_t{paths} * frames);
    trace_batch(b, device, f, paths, 0, s.render);
    const auto positions = b.download(f.positions);

    std::vector<glm::dvec4> p(std::size_t{paths} * frames), power(p), direction(p), origin(p), next(p);
    const auto store = [&](std::size_t i, const auto& k) {
        p[i] = k.position;
        power[i] = k.power;
        direction[i] = k.direction;
        origin[i] = k.next_origin;
        next[i] = k.next_direction;
    };
    double_kernels::emit_photon emit;
    emit.args.scene_layout = wide.layout;
    emit.args.first_path = 0;
    emit.args.seed = s.render.seed;
    turn_switches(emit, wide.features);
    emit.scene_data = wide.records;
    for (uint i = 0; i < paths; ++i) {
        emit.kernel(i);
        store(i, emit);
    }
    double_kernels::bounce_photon bounce;
    bounce.args.scene_layout = wide.layout;
    bounce.args.paths = paths;
    bounce.args.first_path = 0;
    bounce.args.last_frame = frames - 1;
    bounce.args.seed = s.render.seed;
    turn_switches(bounce, wide.features);
    bounce.scene_data = wide.records;
    bounce.positions_data = p;
    bounce.powers_data = power;
    bounce.directions_data = direction;
    bounce.next_origins_data = origin;
    bounce.next_directions_data = next;
    for (uint i = paths; i < paths * frames; ++i) {
        bounce.kernel(i);
        store(i, bounce);
    }

    std::vector<bool> same(paths, true);
    std::size_t parted = 0;
    for (uint frame = 1; frame < frames; ++frame) {
        std::vector<double> errors;
        for (uint path = 0; path < paths; ++path) {
            const std::size_t i = std::size_t{frame} * paths + path;
            if (!same[path])
                continue;
            if (p[i].w != static_cast<double>(positions[i].w)) {
                same[path] = false;
                ++parted;
                continue;
            }
            const uint end = kernels::event_end(positions[i]);
            if (end == kernels::GOES_ON || end == kernels::ABSORBED)
                errors.push_back(glm::length(dvec3(p[i]) - dvec3(positions[i])));
        }
        report_errors(("photon positions at bounce " + std::to_string(frame) + ", m in a box of 1 m").c_str(), errors);
        std::sort(errors.begin(), errors.end());
        // Balls magnify what reaches them; away from them errors stay near rounding.
        EXPECT_LE(errors[errors.size() / 2], 1e-6);
    }
    std::printf("double oracle: %zu of %u paths part ways within 8 bounces\n", parted, paths);
    EXPECT_LE(parted, paths / 100);
}

/// The estimating kernels in double over photons binned in double; the k nearest photons are found by sorting all.
class double_estimates {
public:
    /// What one point's estimate is.
    struct estimate {
        std::vector<uint>
            ids; ///< the k nearest in double, the k-th last; none where fewer than k are left by the policies
        glm::dvec4 irradiance{0}, standard_error{0};
        double unweighted = 0;   ///< the first channel's irradiance if every photon had weight 1
        double conditioning = 0; ///< sum of w p^2 over sum of w^2 p^2, of the photons' first channels p
    };

    double_estimates(const oriented_set& s, const knn_settings& settings, float min_radius)
        : settings_(settings), points_(widened(s.points)), normals_(widened(s.point_normals)),
          min_radius2_(static_cast<double>(min_radius) * static_cast<double>(min_radius))
    {
        const auto g = widened(s.photons.g);
        std::vector<std::pair<uint, uint>> order; // cell, id
        for (uint id = 0; id < s.photons.positions.size(); ++id) {
            const auto c = double_kernels::cell_coordinates(g, glm::dvec4(s.photons.positions[id]));
            order.emplace_back(double_kernels::cell_number(g, c.x, c.y, c.z), id);
        }
        std::sort(order.begin(), order.end());
        cells_.assign(g.resolution.w, uvec2(0));
        for (const auto& [cell, id] : order) {
            ++cells_[cell].y;
            list_.push_back(id);
            positions_.emplace_back(s.photons.positions[id]);
            powers_.emplace_back(s.photons.powers[id]);
            directions_.emplace_back(s.directions[id]);
        }
        for (std::size_t c = 1; c < cells_.size(); ++c)
            cells_[c].x = cells_[c - 1].x + cells_[c - 1].y;

        gather_.args.grid = g;
        gather_.args.leaks = glm::dvec4(-1.0,
            static_cast<double>(settings.leaks.compression) * static_cast<double>(settings.leaks.compression) - 1, 0,
            0);
        gather_.args.min_radius2 = min_radius2_;
        gather_.args.visits = settings.visits_per_pass;
        gather_.args.ranges = settings.ranges_per_pass;
        // SWITCHes of gather_photons.glsl: SIDE, FLATTEN, the kernel, LEAVE_OUT, ERRORS.
        turn_switches(gather_,
            (settings.leaks.side ? 1u : 0u) | (settings.leaks.compression > 1 ? 4u : 0u)
                | (settings.kernel == filter_kernel::constant ? 0u : 4u << static_cast<uint>(settings.kernel)) | 1u << 6
                | 1u << 7);
        gather_.points_data = points_;
        gather_.normals_data = normals_;
        gather_.cells_data = cells_;
        gather_.positions_data = positions_;
        gather_.directions_data = directions_;
        gather_.photon_normals_data = directions_;
        gather_.list_data = list_;
        gather_.powers_data = powers_;
    }

    estimate operator()(uint q)
    {
        std::vector<std::pair<double, uint>> near; // squared distance, place
        for (uint at = 0; at < list_.size(); ++at)
            if (const double d2 = gather_.photon_distance2(at, points_[q], normals_[q]); d2 < 1e30)
                near.emplace_back(d2, at);
        estimate e;
        if (near.size() < settings_.k)
            return e;
        std::nth_element(near.begin(), near.begin() + (settings_.k - 1), near.end());
        const double radius2 = near[settings_.k - 1].first;
        double square = 0, linear = 0;
        for (uint j = 0; j < settings_.k; ++j) {
            e.ids.push_back(list_[near[j].second]);
            if (j + 1 == settings_.k)
                continue;
            const double p = powers_[near[j].second].x, t = near[j].first / radius2;
            const double w[] = {1, 1 - std::sqrt(t), 1 - t, (1 - t) * (1 - t)};
            const double weight = w[static_cast<int>(settings_.kernel)];
            e.unweighted += p;
            linear += weight * p * p;
            square += weight * weight * p * p;
        }
        constexpr double norms[] = {1, 3, 2, 3};
        const double norm = norms[static_cast<int>(settings_.kernel)];
        e.unweighted *= norm / (M_PI * std::max(radius2, min_radius2_));
        e.conditioning = linear / square;

        const std::vector<glm::dvec4> reach(1, glm::dvec4(radius2, 1, 0, 0)), one_point(1, points_[q]);
        const std::vector<glm::uvec4> chosen(1, glm::uvec4(settings_.k, 0u, 0xFFFFFFFFu, 0u));
        double_kernels::gather_start start;
        start.args.searching = 1;
        start.points_data = one_point;
        start.chosen_data = chosen;
        start.kernel(0);
        gather_.reach = reach[0];
        gather_.chosen = chosen[0];
        gather_.sum = start.sum;
        gather_.lost = start.lost;
        gather_.squares = start.squares;
        gather_.cursor = start.cursor;
        gather_.tally = start.tally;
        while (!gather_.done())
            gather_.kernel(q);
        const std::vector<glm::dvec4> sums(1, gather_.sum), squares(1, gather_.squares);
        const std::vector<glm::uvec4> tallies(1, gather_.tally);
        double_kernels::irradiance_estimate result;
        result.args.norm = norm;
        result.args.min_radius2 = min_radius2_;
        result.args.left_out = 1;
        result.reach_data = reach;
        result.sums_data = sums;
        result.squares_data = squares;
        result.tallies_data = tallies;
        result.kernel(0);
        constexpr double pi = static_cast<double>(3.14159265f) / M_PI; // the kernel's constant stays a float
        e.irradiance = result.irradiance * pi;
        e.standard_error = result.standard_error * pi;
        return e;
    }

private:
    knn_settings settings_;
    std::vector<glm::dvec4> points_, normals_, positions_, powers_, directions_;
    std::vector<uvec2> cells_;
    std::vector<uint> list_;
    double min_radius2_;
    double_kernels::gather_photons gather_;
};

TEST(double_oracle, estimates)
{
    // Photons and points on the faces of a box.
    auto s = make_oriented(distribution::box_faces, 20000, {12, 12, 12}, 0, 71);
    random_source u(72);
    for (int i = 0; i < 1000; ++i) {
        glm::vec3 p(u(), u(), u());
        const int axis = static_cast<int>(u.below(3));
        const float side = u() < 0.5f ? 0.0f : 1.0f;
        p[axis] = side;
        s.points.emplace_back(p, 1.0f);
        glm::vec3 n(0);
        n[axis] = 1 - 2 * side;
        s.point_normals.emplace_back(n, 0.0f);
    }
    serial_backend b;
    const auto map = sorted_map(b, upload_photons(b, s), s.photons.g);
    const auto points = b.upload(std::span<const vec4>(s.points)),
               normals = b.upload(std::span<const vec4>(s.point_normals));
    struct row {
        const char* name;
        filter_kernel kernel;
        leak_policy leaks;
        uint k;
    };
    const leak_policy strict{.side = true, .compression = 3};
    const row rows[] = {{"constant, k = 50", filter_kernel::constant, {}, 50},
        {"cone, k = 50", filter_kernel::cone, {}, 50}, {"Epanechnikov, k = 50", filter_kernel::epanechnikov, {}, 50},
        {"Silverman, k = 50", filter_kernel::silverman, {}, 50},
        {"constant, k = 1000", filter_kernel::constant, {}, 1000},
        {"Silverman, k = 1000", filter_kernel::silverman, {}, 1000},
        {"Silverman, k = 50, side, flattened 3 times", filter_kernel::silverman, strict, 50}};
    std::size_t other = 0, compared = 0;
    for (const auto& r : rows) {
        knn_settings k{.k = r.k, .max_radius = 10, .min_radius = 1e-6f};
        k.kernel = r.kernel;
        k.leaks = r.leaks;
        k.errors = true;
        const auto e = knn_grid_estimate(b, map, points, normals, k);
        const auto irradiance = b.download(e.irradiance), standard_error = b.download(e.standard_error);
        double_estimates wide(s, k, k.min_radius);
        // In units of 2^-24. A squared distance: 2 for each difference, 1 for its square, 2 for the sum; flattened, up
        // to 18. t = d^2 / r^2: two of them, and 2. A weight's error is that times its slope, and what rounds in it:
        // cone 1 for the root (its slope times t is at most 1/2) and 1, Epanechnikov 1, Silverman twice that and 1.
        const double distance = r.leaks.compression > 1 ? 18 : 5, t = 2 * distance + 2;
        const double weight = r.kernel == filter_kernel::constant ? 0
            : r.kernel == filter_kernel::cone                     ? 0.5 * t + 2
            : r.kernel == filter_kernel::epanechnikov             ? t + 1
                                                                  : 2 * (t + 1) + 1;
        // The rest: the disc, 3.14159265f, two products, a quotient, the weighted power, and 2 for a compensated sum.
        const double rest = distance + 0.5 + 3 + 1 + 2;
        std::vector<double> errors, spread_errors;
        double nearest_limit = 0, nearest_spread_limit = 0;
        for (uint q = 0; q < s.points.size(); ++q) {
            const auto truth = wide(q);
            std::vector<uint> ids;
            uint at_the_radius = 0;
            for (uint id = 0; id < s.photons.positions.size(); ++id)
                if (const auto d2 = policy_distance2(s, q, id, r.leaks); d2 && *d2 <= irradiance[q].w) {
                    ids.push_back(id);
                    at_the_radius += *d2 == irradiance[q].w ? 1u : 0u;
                }
            // The k-th and its neighbour may have changed places or become one distance in float, so that another is
            // left out; or a photon that grazes the surface has changed its side.
            auto expected = truth.ids;
            std::sort(expected.begin(), expected.end());
            ++compared;
            if (expected != ids || at_the_radius != 1
                || *policy_distance2(s, q, truth.ids.back(), r.leaks) != irradiance[q].w) {
                ++other;
                continue;
            }
            const double error = std::abs(static_cast<double>(irradiance[q].x) - truth.irradiance.x);
            nearest_limit
                = std::max(nearest_limit, error * 0x1p24 / (rest * truth.irradiance.x + weight * truth.unweighted));
            errors.push_back(error / truth.irradiance.x);
            // Half the error of the variance, whose k - 2 plain additions round k - 2 times; 3 in each square, 3 in its
            // factor.
            const double spread_error = std::abs(static_cast<double>(standard_error[q].x) / truth.standard_error.x - 1);
            const double spread_limit = rest + 1 + weight * truth.conditioning + 0.5 * (r.k - 2 + 6);
            nearest_spread_limit = std::max(nearest_spread_limit, spread_error * 0x1p24 / spread_limit);
            spread_errors.push_back(spread_error);
        }
        ASSERT_FALSE(errors.empty()) << r.name << ": no point has the photons it should";
        report_errors((std::string("relative error of irradiance, ") + r.name).c_str(), errors);
        report_errors((std::string("relative error of its standard error, ") + r.name).c_str(), spread_errors);
        std::printf(
            "double oracle: %s: at most %.2g and %.2g of the limits\n", r.name, nearest_limit, nearest_spread_limit);
        EXPECT_LE(nearest_limit, 1) << r.name;
        EXPECT_LE(nearest_spread_limit, 1) << r.name;
    }
    std::printf("double oracle: %zu of %zu points have other photons among the k nearest\n", other, compared);
    EXPECT_LE(other, compared / 500);
}

} // namespace photongrid::testing
