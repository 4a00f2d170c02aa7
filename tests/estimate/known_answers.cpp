#include "known_answers.hpp"

#include <flann/flann.hpp>

#include <algorithm>
#include <map>

namespace photongrid::testing {

using glm::uvec3;
using glm::vec4;

namespace {

    std::vector<vec4> random_units(std::size_t n, std::uint64_t seed)
    {
        random_source u(seed);
        std::vector<vec4> v;
        while (v.size() < n) {
            const glm::vec3 p = 2.0f * glm::vec3(u(), u(), u()) - 1.0f;
            const float l = glm::length(p);
            if (l > 0.1f && l < 1)
                v.emplace_back(p / l, 0.0f);
        }
        return v;
    }

    constexpr int pieces = 16;
    struct gauss_point {
        double at, weight; ///< in a piece of length 1 about 0
    };
    /// Gauss' five points.
    constexpr gauss_point gauss[5] = {{-0.4530899229693320, 0.1184634425280945},
        {-0.2692346550528416, 0.2393143352496833}, {0, 0.2844444444444444}, {0.2692346550528416, 0.2393143352496833},
        {0.4530899229693320, 0.1184634425280945}};

    /// Adds what lies where |y| is fixed and x from a to b, in pieces either side of x = 0.
    void add_line(disc_part& sum, double thickness, double y, double a, double b)
    {
        const double half = std::sqrt(std::max(0.0, 1 - y * y));
        for (const auto& [from, to] :
            {std::pair{std::max(a, -half), std::min(b, 0.0)}, std::pair{std::max(a, 0.0), std::min(b, half)}}) {
            const double step = (to - from) / pieces;
            if (!(step > 0))
                continue;
            for (int piece = 0; piece < pieces; ++piece)
                for (const auto& g : gauss) {
                    const double x = from + (piece + 0.5 + g.at) * step, t = x * x + y * y;
                    const auto by_filter = thickness * step * g.weight
                        * glm::dvec4(1, 3 * (1 - std::sqrt(t)), 2 * (1 - t), 3 * (1 - t) * (1 - t)) / M_PI;
                    sum.share += by_filter;
                    sum.first_x += x * by_filter;
                    sum.first_y += y * by_filter;
                    sum.second += by_filter[0] * glm::dvec3(x * x, x * y, y * y);
                }
        }
    }

    /// Adds the heights where the line from p to q meets the unit circle.
    void add_crossings(std::vector<double>& heights, glm::dvec2 p, glm::dvec2 q)
    {
        const auto d = q - p;
        const double a = glm::dot(d, d), b = glm::dot(p, d), discriminant = b * b - a * (glm::dot(p, p) - 1);
        if (discriminant > 0)
            for (const double sign : {-1.0, 1.0})
                heights.push_back(std::clamp(p.y + d.y * (sign * std::sqrt(discriminant) - b) / a, -1.0, 1.0));
    }

} // namespace

oriented_set make_oriented(distribution d, std::size_t n, uvec3 resolution, std::size_t points, std::uint64_t seed)
{
    oriented_set s;
    s.photons = make_photons(d, n, resolution, seed);
    s.directions = random_units(n, seed + 1);
    s.normals = random_units(n, seed + 2);
    s.points = make_points(s.photons, points, seed);
    s.point_normals = random_units(points, seed + 3);
    return s;
}

oriented_set make_oriented(
    distribution d, const std::vector<std::uint64_t>& numbers, uvec3 resolution, std::size_t points)
{
    oriented_set s;
    s.photons = make_photons(d, numbers, resolution);
    for (const auto number : numbers) {
        s.directions.push_back(random_units(1, number + 1).front());
        s.normals.push_back(random_units(1, number + 2).front());
    }
    const auto seed = numbers.empty() ? 0 : numbers.front();
    s.points = make_points(s.photons, points, seed);
    s.point_normals = random_units(points, seed + 3);
    return s;
}

std::optional<float> policy_distance2(const oriented_set& s, std::size_t q, std::size_t id, const leak_policy& leaks)
{
    const vec4 a = s.photons.positions[id], p = s.points[q], n = s.point_normals[q];
    const float dx = a.x - p.x, dy = a.y - p.y, dz = a.z - p.z;
    const float plain2 = dx * dx + dy * dy + dz * dz;
    float d2 = plain2;
    if (leaks.flattening > 1) {
        const float h = dx * n.x + dy * n.y + dz * n.z;
        d2 = d2 + (leaks.flattening * leaks.flattening - 1.0f) * (h * h);
    }
    const auto dot = [](const vec4& x, const vec4& y) { return x.x * y.x + x.y * y.y + x.z * y.z; };
    if (leaks.side && !(dot(s.directions[id], n) < 0))
        return {};
    if (leaks.needs_photon_normals()) {
        const vec4 sum = n + s.normals[id];
        const float cosine = dot(s.normals[id], n), rise = dx * sum.x + dy * sum.y + dz * sum.z;
        const float rounding = (std::abs(p.x) + std::abs(p.y) + std::abs(p.z)) * 0x1p-17f;
        const float most2 = plain2 * ((1 - cosine) * (1 + cosine) + 0.04f)
            + (rounding * rounding + std::numeric_limits<float>::min());
        if (!(cosine >= leaks.min_cosine) || !(rise * rise <= most2))
            return {};
    }
    return d2 < std::numeric_limits<float>::min() ? 0.0f : d2;
}

double least_disc2(const vec4& point, float min_radius)
{
    const glm::dvec3 size = glm::abs(glm::dvec3(point)) * 0x1p-24;
    const double radius = std::max({static_cast<double>(min_radius), size.x, size.y, size.z, 1e-18});
    return radius * radius;
}

float radius2_in_blocks(float d2, float max_radius2)
{
    int exponent = 0;
    const double eighths = std::ceil(8 * std::frexp(static_cast<double>(d2), &exponent));
    return std::min(static_cast<float>(std::ldexp(eighths / 8, exponent)), max_radius2);
}

std::pair<glm::dvec3, double> half_space_by_force(const vec4& normal, float radius)
{
    if (normal.w == 0)
        return {glm::dvec3(0), std::numeric_limits<double>::infinity()};
    const auto code = static_cast<uint>(normal.w) - 1;
    const double turn = (code >> 12) / 1024.0; // round the square from (1, 0) over (0, 1), (-1, 0) and (0, -1)
    const glm::dvec2 corners[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}};
    const auto side = static_cast<uint>(turn);
    const auto p = glm::normalize(glm::mix(corners[side], corners[side + 1], turn - side));
    const auto basis = kernels::basis_about(glm::vec3(normal));
    return {
        p.x * glm::dvec3(basis.u) + p.y * glm::dvec3(basis.v), (code & 4095) / 4095.0 * static_cast<double>(radius)};
}

brute_estimate estimate_by_force(const oriented_set& s, const std::vector<uint>& in_map,
    const std::vector<vec4>& powers, std::size_t q, const knn_settings& k, std::optional<float> at_least_radius2)
{
    std::vector<std::pair<float, uint>> near;
    const float max2 = k.max_radius * k.max_radius;
    const auto before = half_space_by_force(s.point_normals[q], std::sqrt(s.points[q].w));
    for (const uint id : in_map)
        if (const auto d2 = policy_distance2(s, q, id, k.leaks); d2 && *d2 <= max2
            && !(k.half_spaces
                && glm::dot(before.first, glm::dvec3(s.photons.positions[id] - s.points[q])) > before.second))
            near.emplace_back(*d2, id);
    std::sort(near.begin(), near.end());
    brute_estimate e;
    e.radius2 = static_cast<double>(max2);
    if (k.search == search_kind::exact_k && near.size() >= k.k) {
        near.resize(k.k);
        e.kth = true;
        e.radius2 = static_cast<double>(near.back().first);
    }
    if (k.search == search_kind::at_least_k && near.size() >= k.k) {
        e.kth = at_least_radius2.has_value();
        const float radius2 = at_least_radius2.value_or(radius2_in_blocks(near[k.k - 1].first, max2));
        std::erase_if(near, [&](const auto& x) { return x.first > radius2; });
        e.radius2 = static_cast<double>(radius2);
    }
    const double min2 = least_disc2(s.points[q], k.min_radius);
    const double disc2 = std::max(e.radius2, min2);
    std::map<uint, uint> entries; // routed maps hold a photon several times
    for (const uint id : in_map)
        ++entries[id];
    const bool excludes = k.bias == bias_kind::unbiased && e.kth && e.radius2 >= min2;
    double terms = 0;
    constexpr double norms[] = {1, 3, 2, 3};
    for (std::size_t i = 0; i < near.size(); ++i) {
        e.ids.push_back(near[i].second);
        if (excludes && i + 1 == near.size())
            continue;
        ++terms;
        const double t = static_cast<double>(near[i].first) / disc2;
        const double w[] = {1, 1 - std::sqrt(t), 1 - t, (1 - t) * (1 - t)};
        const glm::dvec3 power = w[static_cast<int>(k.filter)] * glm::dvec3(powers[near[i].second]);
        const double all = power.x + power.y + power.z;
        e.irradiance += power;
        e.standard_error += static_cast<double>(entries[near[i].second]) * glm::dvec4(power * power, all * all);
    }
    const double per_area = norms[static_cast<int>(k.filter)] / (M_PI * disc2);
    e.irradiance *= per_area;
    const glm::dvec3 at(s.points[q]), normal(s.point_normals[q]);
    constexpr double mean_distance2[] = {1 / 2.0, 3 / 10.0, 1 / 3.0, 1 / 4.0};
    for (const auto& [d2, id] : near) {
        if (static_cast<double>(d2) >= e.radius2)
            continue;
        const double t = static_cast<double>(d2) / disc2;
        const glm::dvec3 power = glm::dvec3(powers[id]) / (M_PI * disc2);
        e.constant += power;
        e.bias += power * (1 - 2 * (1 - t)); // by the constant filter less by Epanechnikov's
        glm::dvec3 offset = (glm::dvec3(s.photons.positions[id]) - at) / std::sqrt(disc2);
        offset -= glm::dot(offset, normal) * normal;
        offset *= (power.x + power.y + power.z) / 3;
        e.tilt += offset;
        if (t > 0)
            e.jump += offset * (1 / std::sqrt(t) - 4.0 / 3);
    }
    e.bias *= 6 * mean_distance2[static_cast<int>(k.filter)];
    // If the n-th photon sets the radius and all have one power, n / (pi r^2) has the relative variance 1 / (n - 2).
    // The sum of their squares gives 1 / (the number summed) in its place.
    const double n = static_cast<double>(near.size());
    const double spread = e.kth && n > 2 ? terms / (n - 2) : 1;
    e.standard_error = per_area * glm::sqrt(spread * e.standard_error);
    return e;
}

float grown_by_force(const std::vector<vec4>& positions, const grid& g, const std::vector<std::vector<uint>>& in_cells,
    const vec4& point, const knn_settings& k)
{
    const auto cell_of = [&](float x, int axis) {
        const float u = std::floor((x - g.origin[axis]) * g.inverse_cell[axis]);
        const auto last = static_cast<int>(g.resolution[axis]) - 1;
        return u > 0 ? static_cast<int>(std::min(u, static_cast<float>(last))) : 0;
    };
    const int c[] = {cell_of(point.x, 0), cell_of(point.y, 1), cell_of(point.z, 2)};
    std::vector<std::pair<int, uint>> order; // ring, cell: cells are numbered x first, z last
    for (uint cell = 0; cell < in_cells.size(); ++cell) {
        const int x = static_cast<int>(cell % g.resolution.x),
                  y = static_cast<int>(cell / g.resolution.x % g.resolution.y),
                  z = static_cast<int>(cell / g.resolution.x / g.resolution.y);
        order.emplace_back(std::max({std::abs(x - c[0]), std::abs(y - c[1]), std::abs(z - c[2])}), cell);
    }
    std::sort(order.begin(), order.end());
    const float max2 = std::min(k.max_radius * k.max_radius, 1e38f);
    float farthest2 = 0;
    uint found = 0;
    for (const auto& [ring, cell] : order)
        for (const uint id : in_cells[cell])
            if (const float d2 = distance2(positions[id], point); d2 <= max2) {
                farthest2 = std::max(farthest2, d2);
                if (++found == k.k)
                    return farthest2;
            }
    return max2;
}

std::vector<std::optional<float>> kth_by_flann(
    const std::vector<vec4>& positions, const std::vector<vec4>& points, uint k)
{
    std::vector<std::optional<float>> kth(points.size());
    if (positions.size() < k)
        return kth;
    std::vector<float> coordinates;
    for (const auto& p : positions)
        coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
    flann::KDTreeSingleIndex<flann::L2_Simple<float>> tree(
        flann::Matrix<float>(coordinates.data(), positions.size(), 3));
    tree.buildIndex();
    for (std::size_t q = 0; q < points.size(); ++q) {
        float query[3] = {points[q].x, points[q].y, points[q].z};
        std::vector<std::vector<std::size_t>> indices;
        std::vector<std::vector<float>> distances;
        tree.knnSearch(flann::Matrix<float>(query, 1, 3), indices, distances, k,
            flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
        if (distances[0].size() == k)
            kth[q] = distances[0].back();
    }
    return kth;
}

disc_part part_by_lines(const std::vector<glm::dvec2>& corners, glm::dvec2 center, double radius)
{
    std::vector<glm::dvec2> c;
    for (const auto& p : corners)
        c.push_back((p - center) / radius);
    std::vector<double> heights{-1, 0, 1};
    for (std::size_t e = 0; e < c.size(); ++e) {
        heights.push_back(std::clamp(c[e].y, -1.0, 1.0));
        add_crossings(heights, c[e], c[(e + 1) % c.size()]);
    }
    std::sort(heights.begin(), heights.end());
    disc_part sum;
    for (std::size_t h = 0; h + 1 < heights.size(); ++h) {
        const double low = std::asin(heights[h]), step = (std::asin(heights[h + 1]) - low) / pieces;
        if (!(step > 0))
            continue;
        for (int piece = 0; piece < pieces; ++piece)
            for (const auto& g : gauss) {
                const double angle = low + (piece + 0.5 + g.at) * step, y = std::sin(angle);
                double from = 2, to = -2;
                for (std::size_t e = 0; e < c.size(); ++e) {
                    const auto &p = c[e], &q = c[(e + 1) % c.size()];
                    if ((p.y <= y) == (q.y <= y))
                        continue;
                    const double x = p.x + (q.x - p.x) * (y - p.y) / (q.y - p.y);
                    from = std::min(from, x);
                    to = std::max(to, x);
                }
                add_line(sum, step * g.weight * std::cos(angle), y, from, to);
            }
    }
    return sum;
}

} // namespace photongrid::testing
