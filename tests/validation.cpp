// The photon mapper against answers from outside: caustics of mirrors and glass from geometrical optics, irradiance by
// quadrature, two libraries' nearest neighbours, and the rates at which density estimates converge. Prints its numbers.
#include "photon_sets.hpp"
#include "serial_algorithms.hpp"
#include "test_scenes.hpp"

#include <photongrid/reference.hpp>
#include <photongrid/render.hpp>

#include "scene_file.hpp"

#include <flann/flann.hpp>
#include <gtest/gtest.h>
#include <nanoflann.hpp>

#include <cstdio>
#include <functional>
#include <numeric>

namespace photongrid::testing {
namespace {

    using glm::dvec2;
    using glm::vec4;

    /// A photon on the host, in the scene's own coordinates.
    struct landed_photon {
        dvec3 at, direction;
    };

    std::vector<landed_photon> traced(const scene& s)
    {
        serial_backend b;
        const auto device = upload_scene(b, s);
        const auto t = trace_photons(b, s, device, s.render);
        const auto positions = b.download(t.photons.positions), directions = b.download(t.photons.directions);
        std::vector<landed_photon> out;
        for (std::size_t i = 0; i < positions.size(); ++i)
            out.push_back({dvec3(positions[i]) + device.about.center, dvec3(directions[i])});
        return out;
    }

    std::vector<vec4> recentred(const std::vector<dvec3>& points, const dvec3& center)
    {
        std::vector<vec4> out;
        for (const auto& p : points)
            out.emplace_back(glm::vec3(p - center), 1.0f);
        return out;
    }

    // --- mirror cylinders
    // -------------------------------------------------------------------------------------------------
    //
    // A standing cylinder turns horizontal directions as a circle does and leaves heights alone, so seen from above its
    // light on the floor is the plane problem, whatever the lamp's height.

    using plane_curve = std::function<dvec2(double)>;

    /// How far the brightest line lies from a curve, and how much darker it is beyond it.
    struct ridge {
        double largest_offset = 0, mean_offset = 0; ///< cells
        double dark_over_bright = 0; ///< density 1 to 2 cells beyond the curve over that of the first cell before it
        int stations = 0;
    };

    /// Looks along the curve's normal at each parameter. Rays are tangents of their envelope and tangents run on the
    /// convex side, so that side is bright.
    ridge find_ridge(
        const std::vector<dvec2>& photons, const plane_curve& curve, const std::vector<double>& parameters, double cell)
    {
        ridge out;
        double dark = 0, bright = 0;
        for (const double t : parameters) {
            const double h = 1e-4;
            const dvec2 c = curve(t), d1 = (curve(t + h) - curve(t - h)) / (2 * h),
                        d2 = (curve(t + h) - 2.0 * c + curve(t - h)) / (h * h);
            const double turn = (d1.x * d2.y - d1.y * d2.x) / std::pow(glm::length(d1), 3); // curvature, with its sign
            const dvec2 along = glm::normalize(d1), convex = dvec2(along.y, -along.x) * (turn > 0 ? 1.0 : -1.0);
            constexpr int halves = 10; // half cells on either side
            std::vector<int> count(2 * halves, 0);
            for (const auto& p : photons) {
                const dvec2 v = p - c;
                const double s = glm::dot(v, along);
                if (std::abs(s) > 2 * cell)
                    continue;
                const double u = (glm::dot(v, convex) + 0.5 * std::abs(turn) * s * s)
                    / cell; // to second order off the curve itself
                if (std::abs(u) < 0.5 * halves)
                    ++count[static_cast<std::size_t>(std::floor(2 * u) + halves)];
                dark += u > -2 && u < -1 ? 1 : 0;
                bright += u > 0 && u < 1 ? 1 : 0;
            }
            const auto peak = std::max_element(count.begin(), count.end()) - count.begin();
            const double offset = (static_cast<double>(peak) + 0.5 - halves) / 2;
            EXPECT_LE(std::abs(offset), 1)
                << "cells off the curve at parameter " << t
                << "; photons in the brightest half cell: " << count[static_cast<std::size_t>(peak)];
            out.largest_offset = std::max(out.largest_offset, std::abs(offset));
            out.mean_offset += std::abs(offset);
            ++out.stations;
        }
        out.mean_offset /= std::max(out.stations, 1);
        out.dark_over_bright = dark / std::max(bright, 1.0);
        return out;
    }

    std::vector<double> both_sides(double from, double to, int n, double middle = 0)
    {
        std::vector<double> out;
        for (int i = 0; i < n; ++i) {
            const double t = from + (to - from) * i / (n - 1);
            out.push_back(middle + t);
            out.push_back(middle - t);
        }
        return out;
    }

    void expect_ridge(const char* name, const std::vector<dvec2>& photons, const plane_curve& curve,
        const std::vector<double>& parameters, double cell)
    {
        const auto r = find_ridge(photons, curve, parameters, cell);
        std::printf("%s: %zu photons, ridge at %d places off the curve by %.2f cells on average, %.2f at most; beyond "
                    "it %.3f of the density\n",
            name, photons.size(), r.stations, r.mean_offset, r.largest_offset, r.dark_over_bright);
        EXPECT_LT(r.mean_offset, 0.35) << name << ": the first half cell on the bright side is 0.25 off";
        EXPECT_LT(r.dark_over_bright, 0.5) << name;
        EXPECT_GT(photons.size(), 50000u);
    }

    /// The floor inside a mirror cylinder about the y axis.
    scene mirror_cylinder(double radius, double height)
    {
        scene s;
        s.name = "mirror_cylinder";
        s.materials = {{"black", material_kind::lambertian, dvec3(0)}, {"mirror", material_kind::mirror, dvec3(1)}};
        s.disks = {{{0, 0, 0}, {0, 1, 0}, 0.999 * radius, 0}};
        s.cylinders = {{{0, 0, 0}, {0, height, 0}, radius, 1}};
        s.camera = {{0, 3, 3}, {0, 0, 0}, {0, 1, 0}, 45};
        s.render.photon_depth = 2; // one reflection and the floor
        s.render.photons = 200000;
        return s;
    }

    constexpr double cells_across = 100; // of the photon map over the floor

    TEST(validation, light_from_far_away_draws_a_nephroid)
    {
        // A paraboloid with the lamp at its focus stands for a lamp far away: its light is parallel, and it wastes
        // none.
        const double tilt = M_PI / 4, focal = 0.4, rim = 1.6;
        auto s = mirror_cylinder(1, 1);
        const dvec3 beam(std::cos(tilt), -std::sin(tilt), 0), vertex = dvec3(0, 0.5, 0) - 5.0 * beam;
        s.paraboloids = {{vertex, vertex + rim * rim / (4 * focal) * beam, rim, 1}};
        s.point_lights = {{"lamp", vertex + focal * beam, dvec3(10)}};
        s.render.photon_depth = 3;
        s.render.photons = 400000;
        std::vector<dvec2> photons;
        for (const auto& p : traced(s)) // of the beam, and turned by the cylinder
            if (std::abs(p.direction.y - beam.y) < 1e-3 && p.direction.x < 0.98 * beam.x)
                photons.emplace_back(p.at.x, p.at.z);
        // The nephroid: a circle of radius 1/4 rolling outside one of radius 1/2 (Huygens 1690).
        const auto nephroid = [](double t) {
            return dvec2(3 * std::cos(t) - std::cos(3 * t), 3 * std::sin(t) - std::sin(3 * t)) / 4.0;
        };
        expect_ridge("nephroid", photons, nephroid, both_sides(0.35, 1.0, 20), 2 / cells_across);
    }

    TEST(validation, light_from_the_circle_draws_a_cardioid)
    {
        auto s = mirror_cylinder(1, 0.5);
        s.point_lights = {{"lamp", {-0.999, 0.5, 0}, dvec3(10)}};
        std::vector<dvec2> photons;
        for (const auto& p : traced(s))
            photons.emplace_back(p.at.x, p.at.z);
        // The cardioid: a circle of radius 1/3 rolling round one of the same size (de L'Hopital 1696).
        const auto cardioid = [](double t) {
            return dvec2(2 * std::cos(t) - std::cos(2 * t), 2 * std::sin(t) - std::sin(2 * t)) / 3.0;
        };
        expect_ridge("cardioid", photons, cardioid, both_sides(0.5, 2.1, 24), 2 / cells_across);
    }

    TEST(validation, the_ring_scene_draws_its_catacaustic)
    {
        auto s = read_scene(PHOTONGRID_SCENES "/ring.json");
        const double radius = s.cylinders[0].radius;
        const dvec3 lamp = s.point_lights[0].position;
        s.materials[0].reflectance = dvec3(0);
        s.materials[1].reflectance = dvec3(1);
        s.render.photon_depth = 2;
        s.render.photons = 200000;
        std::vector<dvec2> photons;
        for (const auto& p : traced(s))
            if (std::hypot(p.at.x, p.at.z) < radius) // not what the outside reflects
                photons.emplace_back(p.at.x, p.at.z);
        // A pencil meeting a mirror of radius of curvature R at angle i focuses where 1/s + 1/s' = 2 / (R cos i).
        const auto catacaustic = [&](double t) {
            const dvec2 q(radius * std::cos(t), radius * std::sin(t)), n = -q / radius, way = q - dvec2(lamp.x, lamp.z),
                                                                       d = glm::normalize(way);
            const double cosine = -glm::dot(d, n), s2 = 1 / (2 / (radius * cosine) - 1 / glm::length(way));
            return q + s2 * (d + 2 * cosine * n);
        };
        expect_ridge("ring.json", photons, catacaustic, both_sides(0.3, 0.8, 16, std::atan2(-lamp.z, -lamp.x)),
            2 * radius / cells_across);
    }

    // --- glass ball
    // -------------------------------------------------------------------------------------------------------

    /// Where light off the axis at an angle comes to the floor, and with which share of its power.
    struct glass_path {
        double rho = 0, weight = 0;
        bool arrives = false;
    };

    /// Lamp, ball and floor on one axis, middle of the ball at the origin of heights `lamp` and -`floor`. Light
    /// reflected `order` times: 0 by the outside, n >= 1 refracted in, reflected n - 1 times inside and refracted out.
    glass_path through_ball(double alpha, double lamp, double floor, double radius, double index, int order)
    {
        // In angles: i and o of incidence and refraction; by symmetry they are the same at every meeting with the
        // surface.
        const double i = std::asin(std::min(1.0, lamp * std::sin(alpha) / radius)), o = std::asin(std::sin(i) / index);
        const double rs = std::pow(std::sin(i - o) / std::sin(i + o), 2),
                     rp = std::pow(std::tan(i - o) / std::tan(i + o), 2), r = 0.5 * (rs + rp);
        const double entry = i - alpha;    // position angle off the upward axis
        double place = entry, heading = 0; // heading off straight down, towards growing x
        glass_path out;
        if (order == 0) {
            heading = alpha + M_PI - 2 * i;
            out.weight = r;
        } else {
            place = entry + order * (M_PI - 2 * o);
            heading = alpha - 2 * (i - o) - (order - 1) * (M_PI - 2 * o);
            out.weight = (1 - r) * (1 - r) * std::pow(r, order - 1);
        }
        const dvec2 at(radius * std::sin(place), radius * std::cos(place)), d(std::sin(heading), -std::cos(heading));
        out.arrives = d.y < -1e-9;
        if (out.arrives)
            out.rho = std::abs(at.x + (at.y + floor) / -d.y * d.x);
        return out;
    }

    TEST(validation, a_glass_balls_caustic_has_the_profile_of_ray_density)
    {
        const double radius = 0.3, middle = 0.4, lamp = 0.9, index = 1.5, power = 10;
        scene s;
        s.name = "ball_on_axis";
        s.materials
            = {{"black", material_kind::lambertian, dvec3(0)}, {"glass", material_kind::glass, dvec3(1), index}};
        s.polygons = {{{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}}, 0}};
        s.spheres = {{{0, middle, 0}, radius, 1}};
        s.point_lights = {{"lamp", {0, middle + lamp, 0}, dvec3(power)}};
        s.camera = {{0, 1, -3}, {0, 0, 0}, {0, 1, 0}, 45};
        s.render = {.photons = 150000, .k = 200, .grid = {200, 1, 200}, .max_radius = 0.5};

        // Ray density: power spread over rings of the floor, by angle at the lamp and number of reflections.
        const int steps = 100000, orders = 24;
        const double widest = std::asin(radius / lamp), width = 2.5e-4;
        std::vector<double> rings(4000, 0.0); // flux
        double fold = 0;                      // where the main caustic ends: its radius has a maximum over angles
        for (int order = 0; order < orders; ++order)
            for (int n = 0; n < steps; ++n) {
                const double alpha = (n + 0.5) / steps * widest;
                const auto g = through_ball(alpha, lamp, middle, radius, index, order);
                if (!g.arrives || g.rho >= width * static_cast<double>(rings.size()))
                    continue;
                rings[static_cast<std::size_t>(g.rho / width)]
                    += power / 2 * std::sin(alpha) * widest / steps * g.weight;
                if (order == 1 && alpha < 0.9 * widest)
                    fold = std::max(fold, g.rho);
            }
        const auto density = [&](double rho) { // over 1 mm either side
            const auto first = static_cast<std::size_t>((rho - 1e-3) / width),
                       past = static_cast<std::size_t>((rho + 1e-3) / width);
            const double inner = static_cast<double>(first) * width, outer = static_cast<double>(past) * width;
            return std::accumulate(rings.begin() + static_cast<std::ptrdiff_t>(first),
                       rings.begin() + static_cast<std::ptrdiff_t>(past), 0.0)
                / (M_PI * (outer * outer - inner * inner));
        };
        // The mean over a disc of radius r about a point at `rho`: each ring's share that lies inside.
        const auto disc_mean = [&](double rho, double r) {
            double flux = 0;
            for (std::size_t i = 0; i < rings.size(); ++i) {
                const double ring = width * (static_cast<double>(i) + 0.5),
                             c = (ring * ring + rho * rho - r * r) / (2 * ring * rho);
                flux += c >= 1 ? 0 : c <= -1 ? rings[i] : rings[i] * std::acos(c) / M_PI;
            }
            return flux / (M_PI * r * r);
        };

        serial_backend b;
        const auto device = upload_scene(b, s);
        auto t = trace_photons(b, s, device, s.render);
        const auto map
            = sorted_map(b, std::move(t.photons), make_grid(device.about.low, device.about.high, s.render.grid));
        std::vector<double> radii;
        for (double r = 0.02; r < 0.5; r += r < 0.24 ? 0.02 : 0.05)
            radii.push_back(r);
        const int around = 12;
        std::vector<dvec3> points;
        for (const double r : radii)
            for (int n = 0; n < around; ++n)
                points.emplace_back(
                    r * std::cos(2 * M_PI * n / around + r), 0, r * std::sin(2 * M_PI * n / around + r));
        const auto where = recentred(points, device.about.center);
        const auto estimates = knn_grid_estimate(b, map, b.upload(std::span<const vec4>(where)),
            {.k = s.render.k, .max_radius = static_cast<float>(s.render.max_radius), .errors = true});
        const auto irradiance = b.download(estimates.irradiance), errors = b.download(estimates.standard_error);

        std::printf("glass ball: light refracted twice folds at %.4f m\n| rho, m | ray density, W/m^2 | photon map | "
                    "standard error | mean over the discs searched |\n|---|---|---|---|---|\n",
            fold);
        double chi2 = 0, ratio_sum = 0;
        int compared = 0;
        for (std::size_t i = 0; i < radii.size(); ++i) {
            double mean = 0, variance = 0, discs = 0, largest = 0;
            for (int n = 0; n < around; ++n) {
                const std::size_t q = i * around + static_cast<std::size_t>(n);
                const double r = std::sqrt(static_cast<double>(irradiance[q].w)),
                             e = static_cast<double>(irradiance[q].x), known = disc_mean(radii[i], r);
                largest = std::max(largest, r);
                mean += e / around;
                discs += known / around;
                variance += std::pow(static_cast<double>(errors[q].x) / around, 2);
                // Given where k photons end, those before it lie anywhere in the disc: estimate over the disc's mean is
                // 1 on average for any density, with relative variance 1 / (k - 2).
                ratio_sum += e / known;
                chi2 += std::pow((e - known) / (known / std::sqrt(s.render.k - 2.0)), 2);
                ++compared;
            }
            // Discs round the same circle overlap near the axis, and then their errors do not average out.
            const double se = std::sqrt(variance)
                * std::sqrt(std::max(1.0, around * M_PI * largest * largest / (4 * M_PI * radii[i] * largest)));
            const double known = density(radii[i]);
            std::printf("| %.2f | %.4f | %.4f | %.4f | %.4f |\n", radii[i], known, mean, se, discs);
            EXPECT_NEAR(mean, discs, 5 * se) << "rho " << radii[i];
            if (std::abs(radii[i] - fold) > 5 * largest && radii[i] > largest) { // the density is smooth over the disc
                EXPECT_NEAR(mean, known, 5 * se + 0.02 * known) << "rho " << radii[i];
            }
        }
        std::printf("estimate over known: %.4f on average, chi^2 per point %.2f, %d points\n", ratio_sum / compared,
            chi2 / compared, compared);
        EXPECT_NEAR(ratio_sum / compared, 1, 0.01);
        EXPECT_LT(chi2 / compared, 1.5);
    }

    // --- nearest neighbours
    // -----------------------------------------------------------------------------------------------

    struct cloud {
        const std::vector<vec4>& points;
        std::size_t kdtree_get_point_count() const { return points.size(); }
        float kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][static_cast<int>(axis)]; }
        template <class Box>
        bool kdtree_get_bbox(Box&) const
        {
            return false;
        }
    };

    TEST(validation, exact_k_equals_flann_and_nanoflann)
    {
        // Both trees prune by sums rounded in another order than the distances themselves; a slightly negative epsilon
        // makes them look a little farther, so that no neighbour is lost to the last bit.
        const float slack = -1e-4f;
#if NANOFLANN_VERSION >= 0x150
        const nanoflann::SearchParameters nano_search(slack);
#else
        const nanoflann::SearchParams nano_search(0, slack);
#endif
        flann::SearchParams flann_search(flann::FLANN_CHECKS_UNLIMITED, slack);
        using nano_tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, cloud>, cloud, 3>;
        serial_backend b;
        for (const auto d : all_distributions) {
            auto set = make_photons(d, 6000, {12, 12, 12}, 77);
            random_source u(5);
            for (auto& p : set.powers) // integers whose sums over a set tell sets apart, and stay exact in float
                p = vec4(static_cast<float>(u.below(1u << 13)), static_cast<float>(u.below(1u << 13)),
                    static_cast<float>(u.below(1u << 13)), 0.0f);
            const auto points = make_points(set, 400, 78);
            const auto map = sorted_map(b, upload_photons(b, set), set.g);
            const cloud c{set.positions};
            nano_tree nano(3, c, nanoflann::KDTreeSingleIndexAdaptorParams(10));
            nano.buildIndex();
            std::vector<float> coordinates;
            for (const auto& p : set.positions)
                coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
            flann::KDTreeSingleIndex<flann::L2_Simple<float>> tree(
                flann::Matrix<float>(coordinates.data(), set.positions.size(), 3));
            tree.buildIndex();

            int compared = 0, sets = 0;
            for (const uint k : {1u, 7u, 64u, 500u}) {
                const auto e = knn_grid_estimate(b, map, b.upload(std::span<const vec4>(points)),
                    {.k = k, .max_radius = 10, .bias = bias_kind::paper});
                const auto irradiance = b.download(e.irradiance);
                const auto used = b.download(e.used);
                const float floor2
                    = std::pow(std::max({set.g.cell.x * 12, set.g.cell.y * 12, set.g.cell.z * 12}) * 0x1p-20f, 2.0f);
                for (std::size_t q = 0; q < points.size(); ++q) {
                    float query[3] = {points[q].x, points[q].y, points[q].z};
                    std::vector<std::uint32_t> ids(k + 1);
                    std::vector<float> distances(k + 1);
                    nanoflann::KNNResultSet<float, std::uint32_t> found(k + 1);
                    found.init(ids.data(), distances.data());
                    nano.findNeighbors(found, query, nano_search);
                    std::vector<std::vector<std::size_t>> flann_ids;
                    std::vector<std::vector<float>> flann_distances;
                    tree.knnSearch(flann::Matrix<float>(query, 1, 3), flann_ids, flann_distances, k, flann_search);

                    const auto flushed
                        = [](float x) { return x < std::numeric_limits<float>::min() ? 0.0f : x; }; // as kernels do
                    const float nth = flushed(distances[k - 1]), fth = flushed(flann_distances[0][k - 1]);
                    ASSERT_EQ(irradiance[q].w, nth) << name_of(d) << ", k " << k << ", point " << q << ": nanoflann";
                    ASSERT_EQ(irradiance[q].w, fth) << name_of(d) << ", k " << k << ", point " << q << ": FLANN";
                    ASSERT_EQ(used[q].x, k);
                    ++compared;
                    if (flushed(distances[k]) == nth || nth <= floor2 || k > 64)
                        continue; // a tie at the k-th place: which of the equals is taken, nanoflann does not promise
                    glm::dvec3 sum(0);
                    for (uint n = 0; n < k; ++n)
                        sum += glm::dvec3(set.powers[ids[n]]);
                    for (int channel = 0; channel < 3; ++channel)
                        ASSERT_EQ(std::round(static_cast<double>(irradiance[q][channel])
                                      * static_cast<double>(3.14159265f) * static_cast<double>(nth)),
                            sum[channel])
                            << name_of(d) << ", k " << k << ", point " << q << ": another set";
                    ++sets;
                }
            }
            std::printf("%s: %d k-th distances equal, %d sets\n", name_of(d), compared, sets);
            if (d != distribution::coincident && d != distribution::cell_faces) { // all ties
                EXPECT_GT(sets, 800) << name_of(d);
            }
        }
    }

    // --- one diffuse bounce
    // -----------------------------------------------------------------------------------------------

    /// Two facing discs. A point lamp just under the middle of the upper, black one lights the lower one, whose light
    /// comes back: all photons stored are of that one bounce.
    struct facing_discs {
        double height = 0.5, lower = 1, upper = 0.8, power = 20;
        dvec3 reflectance{0.8, 0.5, 0.2};

        scene made() const
        {
            scene s;
            s.name = "facing_discs";
            s.materials
                = {{"lower", material_kind::lambertian, reflectance}, {"upper", material_kind::lambertian, dvec3(0)}};
            s.disks = {{{0, 0, 0}, {0, 1, 0}, lower, 0}, {{0, height * (1 + 1e-4), 0}, {0, -1, 0}, upper, 1}};
            s.point_lights = {{"lamp", {0, height, 0}, dvec3(power)}};
            s.camera = {{0, 0.2, -3}, {0, 0.2, 0}, {0, 1, 0}, 45};
            s.render = {.grid = {64, 1, 64}, .max_radius = 1, .photon_depth = 2};
            return s;
        }
        /// At the middle of the upper disc, for reflectance 1: direct light is power / (4 pi) h / (h^2 + u)^(3/2) at
        /// distance sqrt(u) from the axis, and the form factor of the ring there h^2 / (h^2 + u)^2 du; their product
        /// integrates in closed form.
        double on_axis() const
        {
            const double h = height;
            return power * h * h * h / (10 * M_PI) * (std::pow(h, -5) - std::pow(h * h + lower * lower, -2.5));
        }
        /// At a distance from the axis: midpoint rule over the lower disc.
        double off_axis(double rho, int rings = 800, int around = 360) const
        {
            double sum = 0;
            const double h = height;
            for (int i = 0; i < rings; ++i) {
                const double r = lower * (i + 0.5) / rings,
                             direct = power / (4 * M_PI) * h / std::pow(h * h + r * r, 1.5);
                for (int j = 0; j < around; ++j) {
                    const double d2 = h * h + r * r + rho * rho - 2 * r * rho * std::cos(2 * M_PI * (j + 0.5) / around);
                    sum += direct / M_PI * h * h / (d2 * d2) * r * (lower / rings) * (2 * M_PI / around);
                }
            }
            return sum;
        }
    };

    /// Irradiance (rgb) and its squared radius at points of the upper disc.
    std::vector<vec4> estimates_on_upper(
        const facing_discs& f, const std::vector<dvec3>& points, uint photons, uint k, uint seed)
    {
        auto s = f.made();
        s.render.photons = photons;
        s.render.seed = seed;
        serial_backend b;
        const auto device = upload_scene(b, s);
        auto t = trace_photons(b, s, device, s.render);
        const auto map
            = sorted_map(b, std::move(t.photons), make_grid(device.about.low, device.about.high, s.render.grid));
        const auto where = recentred(points, device.about.center);
        return b.download(
            knn_grid_estimate(b, map, b.upload(std::span<const vec4>(where)), {.k = k, .max_radius = 1}).irradiance);
    }

    std::vector<dvec3> circles(const facing_discs& f, const std::vector<double>& radii, int around)
    {
        std::vector<dvec3> points;
        for (const double r : radii)
            for (int n = 0; n < around; ++n)
                points.emplace_back(r * std::cos(2 * M_PI * (n + 0.3 * r) / around), f.height * (1 + 1e-4),
                    r * std::sin(2 * M_PI * (n + 0.3 * r) / around));
        return points;
    }

    TEST(validation, light_of_one_diffuse_bounce_has_its_form_factor)
    {
        const facing_discs f;
        EXPECT_NEAR(f.off_axis(0), f.on_axis(), 1e-5 * f.on_axis());
        const std::vector<double> radii = {0, 0.15, 0.3, 0.45, 0.6};
        const int around = 16;
        const uint k = 300;
        double ratio = 0; // over all points
        int count = 0;
        const auto e = estimates_on_upper(f, circles(f, radii, around), 300000, k, 1);
        for (std::size_t i = 0; i < radii.size(); ++i) {
            const int n = i == 0 ? 1 : around;
            const double known = i == 0 ? f.on_axis() : f.off_axis(radii[i]);
            dvec3 mean(0);
            for (int j = 0; j < n; ++j)
                mean += dvec3(e[i * around + static_cast<std::size_t>(j)]) / static_cast<double>(n);
            std::printf(
                "facing discs, %.2f m off the axis: known %.4f W/m^2 x reflectance, photon map %.4f %.4f %.4f\n",
                radii[i], known, mean.x / f.reflectance.x, mean.y / f.reflectance.y, mean.z / f.reflectance.z);
            for (int c = 0; c < 3; ++c) // 0.2 % for the curve of the profile over a disc
                EXPECT_NEAR(
                    mean[c] / f.reflectance[c], known, (5 / std::sqrt(static_cast<double>(k) * n) + 0.002) * known)
                    << radii[i] << ", channel " << c;
            ratio += n * mean.x / f.reflectance.x / known;
            count += n;
        }
        EXPECT_NEAR(ratio / count, 1, 4 / std::sqrt(static_cast<double>(k) * count) + 0.002);
    }

    // --- convergence
    // ------------------------------------------------------------------------------------------------------

    /// One row of a convergence table: means over places of squared errors relative to the known value.
    struct convergence_row {
        double photons = 0, k = 0, bias2 = 0, variance = 0;
        double total() const { return bias2 + variance; }
    };

    double slope(const std::vector<convergence_row>& rows, double (*of)(const convergence_row&))
    {
        double sx = 0, sy = 0, sxx = 0, sxy = 0;
        for (const auto& r : rows) {
            const double x = std::log(r.photons), y = std::log(std::max(of(r), 1e-12));
            sx += x, sy += y, sxx += x * x, sxy += x * y;
        }
        const double n = static_cast<double>(rows.size());
        return (n * sxy - sx * sy) / (n * sxx - sx * sx);
    }

    /// From values[seed][place]: bias^2 and variance, relative, the mean's own noise and the reference's taken off
    /// bias^2.
    convergence_row split_error(const std::vector<std::vector<double>>& values, const std::vector<double>& known,
        const std::vector<double>& known_error, double floor)
    {
        convergence_row row;
        const double seeds = static_cast<double>(values.size()), places = static_cast<double>(known.size());
        for (std::size_t i = 0; i < known.size(); ++i) {
            double mean = 0, spread = 0;
            for (const auto& v : values)
                mean += v[i] / seeds;
            for (const auto& v : values)
                spread += (v[i] - mean) * (v[i] - mean) / (seeds - 1);
            const double scale = 1 / ((known[i] + floor) * (known[i] + floor) * places);
            row.bias2
                += ((mean - known[i]) * (mean - known[i]) - spread / seeds - known_error[i] * known_error[i]) * scale;
            row.variance += spread * scale;
        }
        return row;
    }

    void print(const char* name, const std::vector<convergence_row>& rows)
    {
        std::printf("%s\n\n| photons | k | bias^2 | variance | relMSE |\n|---|---|---|---|---|\n", name);
        for (const auto& r : rows)
            std::printf("| %.0f | %.0f | %.5f | %.5f | %.5f |\n", r.photons, r.k, r.bias2, r.variance, r.total());
        const bool biased = std::all_of(rows.begin(), rows.end(),
            [](const auto& r) { return r.bias2 > 0; }); // below 0: lost in the noise taken off
        std::printf(
            biased ? "| slope | | %.2f |" : "| slope | | - |", slope(rows, [](const auto& r) { return r.bias2; }));
        std::printf(" %.2f | %.2f |\n\n", slope(rows, [](const auto& r) { return r.variance; }),
            slope(rows, [](const auto& r) { return r.total(); }));
        std::fflush(stdout);
    }

    void expect_falling(const std::vector<convergence_row>& rows)
    {
        for (std::size_t i = 1; i < rows.size(); ++i) {
            EXPECT_LT(rows[i].bias2, rows[i - 1].bias2) << rows[i].photons;
            EXPECT_LT(rows[i].variance, rows[i - 1].variance) << rows[i].photons;
        }
    }

    TEST(validation, long_smooth_irradiance_converges_at_the_rate_of_theory)
    {
        // k neighbours of N photons: variance 1 / k; the disc's area goes as k / N, and so does the bias where
        // irradiance is smooth. With k ~ N^(2/3) both squares fall as N^(-2/3).
        const facing_discs f;
        const std::vector<double> radii = {0, 0.05, 0.1, 0.15}; // about the maximum, where the bias has one sign
        const int around = 8;
        std::vector<double> known;
        for (const double r : radii)
            known.insert(known.end(), around, f.off_axis(r) * f.reflectance.x);
        std::vector<convergence_row> rows;
        for (const uint n : {2000u, 8000u, 32000u, 128000u}) {
            const auto k = static_cast<uint>(std::lround(160 * std::pow(n / 2000.0, 2.0 / 3)));
            const uint seeds = n <= 8000 ? 96 : 24; // few photons, many seeds
            std::vector<std::vector<double>> values;
            for (uint seed = 1; seed <= seeds; ++seed) {
                values.emplace_back();
                for (const auto& e : estimates_on_upper(f, circles(f, radii, around), n, k, seed))
                    values.back().push_back(static_cast<double>(e.x));
            }
            rows.push_back(split_error(values, known, std::vector<double>(known.size(), 0.0), 0));
            rows.back().photons = n;
            rows.back().k = k;
        }
        print("facing discs", rows);
        expect_falling(rows);
        EXPECT_NEAR(slope(rows, [](const auto& r) { return r.bias2; }), -2.0 / 3, 0.2);
        EXPECT_NEAR(slope(rows, [](const auto& r) { return r.variance; }), -2.0 / 3, 0.1);
        EXPECT_NEAR(slope(rows, [](const auto& r) { return r.total(); }), -2.0 / 3, 0.15);
    }

    TEST(validation, long_cornell_blocks_converge_to_the_reference)
    {
        auto s = read_scene(PHOTONGRID_SCENES "/cornell_blocks.json");
        auto wanted = reference_settings_for(s.render);
        wanted.width = wanted.height = 32;
        wanted.spp = 4096;
        wanted.seed = 99;
        const auto truth = render_reference(s, s.camera, wanted);

        // Pixels over an edge of a shape or the lamp are left out: their noise is that of 32 eye rays, whatever the
        // photons do.
        const reference::geometry shapes(s);
        const dvec3 forward = glm::normalize(s.camera.look_at - s.camera.position),
                    right = glm::normalize(glm::cross(forward, s.camera.up)), up = glm::cross(right, forward);
        const double pixel = 2 * std::tan(glm::radians(0.5 * s.camera.vertical_fov)) / wanted.height;
        const auto shape_at = [&](double x, double y) {
            return shapes.nearest({s.camera.position,
                glm::normalize(
                    forward + (x - 0.5 * wanted.width) * pixel * right + (0.5 * wanted.height - y) * pixel * up),
                reference::nothing});
        };
        // Of these, pixels with nothing else and no edge near: there irradiance is smooth over the discs of the
        // estimates.
        const double clear = 0.1;
        const auto is_clear = [&](const reference::hit& h) {
            const dvec3 n = glm::dot(h.normal, s.camera.position - h.position) > 0 ? h.normal : -h.normal,
                        u = reference::across(n), v = glm::cross(n, u);
            for (int i = 0; i < 32; ++i) {
                const dvec3 way = std::cos(i * M_PI / 16) * u + std::sin(i * M_PI / 16) * v;
                if (shapes.nearest({h.position + 1e-6 * n, way, reference::nothing}).t < clear
                    || shapes.nearest({h.position + clear * way + 1e-3 * n, -n, reference::nothing}).shape != h.shape)
                    return false;
            }
            return true;
        };
        std::vector<std::size_t> whole;
        std::vector<bool> smooth; // of those
        for (std::uint32_t y = 0; y < wanted.height; ++y)
            for (std::uint32_t x = 0; x < wanted.width; ++x) {
                const auto middle = shape_at(x + 0.5, y + 0.5);
                bool one = middle.shape != reference::nothing && middle.light == reference::nothing;
                for (const auto& [dx, dy] : {std::pair{-0.1, -0.1}, {1.1, -0.1}, {-0.1, 1.1}, {1.1, 1.1}})
                    one = one && shape_at(x + dx, y + dy).shape == middle.shape;
                if (!one)
                    continue;
                whole.push_back(std::size_t{y} * wanted.width + x);
                smooth.push_back(is_clear(middle));
            }
        const auto spread_out = [&](const image& im) {
            std::vector<double> out;
            for (const auto i : whole)
                for (int c = 0; c < 3; ++c)
                    out.push_back(static_cast<double>(im.pixels[i][c]));
            return out;
        };
        const auto smooth_ones = [&](const std::vector<double>& all) {
            std::vector<double> out;
            for (std::size_t i = 0; i < all.size(); ++i)
                if (smooth[i / 3])
                    out.push_back(all[i]);
            return out;
        };
        const auto known = spread_out(truth.mean), known_error = spread_out(truth.standard_error);

        auto settings = s.render;
        settings.width = settings.height = 32;
        settings.spp = 32; // with the shadow rays below, noise of direct light and edges well below the photons'
        settings.light_samples = 16;
        settings.max_radius = 0.5;
        serial_backend b;
        const int seeds = 8;
        std::vector<convergence_row> rows, smooth_rows, corrected_rows;
        const auto row = [&](std::vector<std::vector<double>> values, bool only_smooth) {
            if (only_smooth)
                for (auto& v : values)
                    v = smooth_ones(v);
            auto r = split_error(values, only_smooth ? smooth_ones(known) : known,
                only_smooth ? smooth_ones(known_error) : known_error, 0.01);
            r.photons = settings.photons;
            r.k = settings.k;
            return r;
        };
        for (const uint n : {2000u, 8000u, 32000u, 128000u}) {
            settings.photons = n;
            settings.k = static_cast<uint>(std::lround(30 * std::pow(n / 2000.0, 2.0 / 3)));
            std::vector<std::vector<double>> values, corrected;
            for (uint seed = 1; seed <= seeds; ++seed) {
                settings.seed = seed;
                render_stats stats;
                values.push_back(spread_out(render(b, s, settings, {}, stats)));
                auto with_edges = settings;
                with_edges.leaks.min_cosine = 0.5f;
                with_edges.edges = edge_correction::polygons;
                corrected.push_back(spread_out(render(b, s, with_edges, {}, stats)));
            }
            rows.push_back(row(values, false));
            corrected_rows.push_back(row(corrected, false));
            smooth_rows.push_back(row(values, true));
        }
        std::printf("%zu of %zu pixels lie within one shape, %td of them %.1f m from any edge\n", whole.size(),
            truth.mean.pixels.size(), std::count(smooth.begin(), smooth.end(), true), clear);
        print("cornell_blocks", rows);
        print("cornell_blocks, edges corrected", corrected_rows);
        print("cornell_blocks, far from edges", smooth_rows);
        expect_falling(rows);
        // Near edges discs reach over them and the bias is of order 1 in a strip as wide as the radius, N^(-1/6):
        // bias^2 of a whole room falls between that and N^(-2/3). The variance keeps its rate.
        EXPECT_NEAR(slope(rows, [](const auto& r) { return r.variance; }), -2.0 / 3, 0.2);
        EXPECT_LT(slope(rows, [](const auto& r) { return r.bias2; }), -1.0 / 6 + 0.05);
        EXPECT_LT(slope(rows, [](const auto& r) { return r.total(); }), -0.2);
        EXPECT_GT(slope(rows, [](const auto& r) { return r.total(); }), -1);
        // Far from them the picture converges to the reference at the rate of smooth irradiance.
        EXPECT_NEAR(slope(smooth_rows, [](const auto& r) { return r.total(); }), -2.0 / 3, 0.25);
        EXPECT_LT(
            std::abs(smooth_rows.back().bias2), 1e-4); // 1 % of the whole irradiance; the rest is the reference's error
        EXPECT_LT(smooth_rows.back().total(), 0.01);
    }

} // namespace
} // namespace photongrid::testing
