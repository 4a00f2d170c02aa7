// Stencil routing into buckets of a virtual grid, on any backend. The reference is brute force: std::map, sums in
// double, and the variance of a simple random sample without replacement.
#pragma once

#include "algorithms.hpp"

#include <photongrid/map/hashed_route.hpp>

#include <array>
#include <tuple>

namespace photongrid::testing {

/// x, y, z of a photon's cell, the slowest first: they sort as cell numbers do.
using virtual_cell_coordinates = std::tuple<uint, uint, uint>;

inline virtual_cell_coordinates virtual_cell_of(const virtual_grid& g, const vec4& p)
{
    const glm::vec3 last = glm::vec3(g.axes.resolution) - 1.0f;
    const glm::vec3 cell = glm::clamp(
        glm::floor((glm::vec3(p) - glm::vec3(g.axes.origin)) * glm::vec3(g.axes.inverse_cell)), glm::vec3(0), last);
    return {static_cast<uint>(cell.z), static_cast<uint>(cell.y), static_cast<uint>(cell.x)};
}

/// The bucket of a cell by hash.
inline uint hashed_bucket_of(uint x, uint y, uint z, std::size_t buckets)
{
    return static_cast<uint>(kernels::scrambled(kernels::scrambled(kernels::scrambled(x) + y) + z) % buckets);
}

/// Photons of a set by buckets, in draw order.
struct expected_buckets {
    std::vector<std::vector<uint>> destined;
    std::map<virtual_cell_coordinates, std::vector<uint>> cells; ///< of photons that a map holds
    uint invalid = 0, left_out = 0;
};

inline expected_buckets buckets_by_brute_force(
    const photon_set& set, const virtual_grid& g, const hashed_route_settings& s, std::size_t buckets)
{
    expected_buckets e;
    const auto n = static_cast<uint>(set.positions.size());
    std::vector<uint> held;
    for (uint i = 0; i < n; ++i) {
        const uint id = kernels::shuffled(i, n, s.seed);
        const uint part = set.positions[id].w == 1.0f ? caustic_part : other_part;
        if (!is_finite(set.positions[id]) || !is_finite(set.powers[id])) {
            ++e.invalid;
        } else if ((s.parts & part) == 0) {
            ++e.left_out;
        } else {
            held.push_back(id);
            e.cells[virtual_cell_of(g, set.positions[id])].push_back(id);
        }
    }
    if (s.kind == bucket_kind::rank) {
        for (const auto& [cell, ids] : e.cells)
            e.destined.push_back(ids);
        return e;
    }
    e.destined.resize(buckets);
    for (const uint id : held) {
        const auto [z, y, x] = virtual_cell_of(g, set.positions[id]);
        e.destined[hashed_bucket_of(x, y, z, buckets)].push_back(id);
    }
    return e;
}

/// Checks everything that hashed_route returns for these photons; the largest relative error of a cell's power (rank).
template <backend B>
double expect_survivors(B& b, const photon_set& set, const virtual_grid& g, const hashed_route_settings& s)
{
    const auto n = static_cast<uint>(set.positions.size());
    const uint capacity = std::min(s.m * s.m, 255u);
    const auto r = hashed_route(b, upload_photons(b, set), g, s);
    const auto list = b.download(r.list);
    const auto arrived = b.download(r.arrived);
    const auto buckets = b.download(r.buckets);
    const auto positions = b.download(r.photons.positions), powers = b.download(r.photons.powers);
    const auto e = buckets_by_brute_force(set, g, s, arrived.size());

    EXPECT_EQ(r.photons.size() + r.dropped + r.invalid + r.left_out, n);
    EXPECT_EQ(r.invalid, e.invalid);
    EXPECT_EQ(r.left_out, e.left_out);
    if (s.kind == bucket_kind::rank) {
        EXPECT_EQ(r.occupied_cells, e.cells.size());
        EXPECT_EQ(arrived.size(), std::max<std::size_t>(e.cells.size(), 1));
    } else if (s.buckets != 0) {
        EXPECT_EQ(arrived.size(), s.buckets);
    }
    EXPECT_EQ(list.size(), r.photons.size());
    EXPECT_EQ(positions.size(), list.size());
    EXPECT_EQ(powers.size(), list.size());
    EXPECT_EQ(buckets.size(), arrived.size());
    if (::testing::Test::HasFailure())
        return 0;

    double largest = 0, dropped_power = 0, all_power = 0;
    uint next = 0, overflowing = 0;
    for (std::size_t c = 0; c < e.destined.size(); ++c) {
        const auto& ids = e.destined[c];
        const uint kept = std::min(static_cast<uint>(ids.size()), capacity);
        overflowing += ids.size() > capacity ? 1u : 0u;
        EXPECT_EQ(arrived[c], ids.size()) << "bucket " << c;
        EXPECT_EQ(buckets[c], uvec2(next, kept)) << "bucket " << c;
        if (arrived[c] != ids.size() || buckets[c] != uvec2(next, kept))
            return 0;
        glm::dvec3 all(0), of_kept(0), after(0);
        for (uint i = 0; i < ids.size(); ++i) {
            const glm::dvec3 power(set.powers[ids[i]]);
            all += power;
            if (i < kept)
                of_kept += power;
            else
                dropped_power += power.x + power.y + power.z;
        }
        for (uint i = 0; i < kept; ++i, ++next) {
            const uint id = ids[i];
            EXPECT_EQ(list[next], id) << "bucket " << c << " survivor " << i;
            if (list[next] != id)
                return 0;
            EXPECT_EQ(positions[next], set.positions[id]);
            EXPECT_EQ(powers[next].w, set.powers[id].w);
            after += glm::dvec3(powers[next]);
            for (int channel = 0; channel < 3; ++channel) {
                const auto own = static_cast<double>(set.powers[id][channel]);
                const double expected = ids.size() <= capacity ? own
                    : s.kind == bucket_kind::hash              ? own * static_cast<double>(ids.size()) / kept
                    : of_kept[channel] > 0                     ? own * all[channel] / of_kept[channel]
                                                               : all[channel] / kept;
                EXPECT_NEAR(powers[next][channel], expected, 5e-4 * expected) << "bucket " << c << " survivor " << i;
            }
        }
        if (s.kind == bucket_kind::rank)
            for (int channel = 0; channel < 3; ++channel)
                if (all[channel] > 0)
                    largest = std::max(largest, std::abs(after[channel] / all[channel] - 1));
        all_power += all.x + all.y + all.z;
    }
    EXPECT_EQ(next, list.size());
    EXPECT_EQ(r.overflowing_buckets, overflowing);
    EXPECT_NEAR(redistributed_power(b, r), dropped_power, 1e-4 * all_power + 1e-30);
    EXPECT_LE(largest, 5e-4);
    return largest;
}

/// As many seeds as take a few seconds: software GPUs, whose bits are serial's, take fewer.
template <backend B>
uint seeds_for(const B& b, uint many, uint few)
{
    return b.caps().backend == "serial" || b.caps().backend == "cpu" ? many : few;
}

TEST(shuffle, is_a_permutation_for_every_size_and_seed)
{
    for (const uint n : {1u, 2u, 3u, 5u, 64u, 256u, 257u, 1000u, 4097u, 70000u})
        for (const uint seed : {0u, 1u, 0xDEADBEEFu}) {
            std::vector<bool> seen(n);
            for (uint i = 0; i < n; ++i) {
                const uint p = kernels::shuffled(i, n, seed);
                ASSERT_LT(p, n);
                ASSERT_FALSE(seen[p]);
                seen[p] = true;
            }
        }
}

TEST(shuffle, draws_uniform_samples_by_neighbouring_seeds)
{
    // Of N photons, every `apart`-th from the fifth on, the first K in draw order: each is among them with probability
    // K/N, each pair with K (K - 1) / (N (N - 1)). Chi-squared over 4,000 seeds has N - 1 degrees of freedom; z beyond
    // 5 happens once in 10^5 (its upper tail, for 5 to 199 degrees of freedom).
    constexpr uint seeds = 4000;
    struct sample {
        uint n, apart, N, K;
    };
    for (const auto& [n, apart, N, K] : {sample{7, 1, 6, 2}, sample{64, 1, 40, 16}, sample{300, 7, 30, 9},
             sample{3000, 64, 20, 1}, sample{4096, 1, 200, 16}}) {
        std::vector<uint> member(n, no_id);
        for (uint j = 0; j < N; ++j)
            member[(5 + apart * j) % n] = j;
        std::vector<double> kept(N), pairs(std::size_t{N} * N);
        for (uint seed = 0; seed < seeds; ++seed) {
            std::vector<uint> first;
            for (uint i = 0; first.size() < K; ++i)
                if (const uint j = member[kernels::shuffled(i, n, seed)]; j != no_id)
                    first.push_back(j);
            for (const uint j : first)
                for (const uint other : first)
                    ++(j == other ? kept[j] : pairs[std::size_t{j} * N + other]);
        }
        const double p = static_cast<double>(K) / N, both = p * (K - 1) / (N - 1);
        double chi2 = 0, pairs2 = 0;
        for (const double k : kept)
            chi2 += (k - seeds * p) * (k - seeds * p) / (seeds * p * (1 - p)) * (N - 1) / N;
        EXPECT_LT((chi2 - (N - 1)) / std::sqrt(2.0 * (N - 1)), 5.0) << n << " photons, " << N << " of a bucket";
        if (K == 1)
            continue;
        for (std::size_t j = 0; j < N; ++j)
            for (std::size_t other = 0; other < N; ++other)
                if (const double d = pairs[j * N + other] - seeds * both; j != other)
                    pairs2 += d * d / (seeds * both * (1 - both)) / (static_cast<double>(N) * (N - 1));
        EXPECT_NEAR(pairs2, 1.0, 5 * std::sqrt(2.0 / (N - 1))) << n << " photons, " << N << " of a bucket";
    }
}

TEST(virtual_grid, hashes_its_cells_evenly)
{
    // Chi-squared of 32,768 cells in buckets: cells of a cube, of a plane, and far apart. z beyond 5 happens once in
    // 10^6.
    for (const uint buckets : {2u, 64u, 1000u, 4096u})
        for (const auto& [side, apart] : {std::pair{glm::uvec3(32, 32, 32), 1u}, std::pair{glm::uvec3(256, 1, 128), 1u},
                 std::pair{glm::uvec3(32768, 1, 1), 1u}, std::pair{glm::uvec3(1, 1, 32768), 1u},
                 std::pair{glm::uvec3(32, 32, 32), 1u << 16}}) {
            std::vector<double> held(buckets);
            for (uint x = 0; x < side.x; ++x)
                for (uint y = 0; y < side.y; ++y)
                    for (uint z = 0; z < side.z; ++z)
                        ++held[hashed_bucket_of(apart * x, apart * y, apart * z, buckets)];
            double chi2 = 0;
            for (const double h : held)
                chi2 += (h - 32768.0 / buckets) * (h - 32768.0 / buckets) / (32768.0 / buckets);
            EXPECT_LT((chi2 - (buckets - 1)) / std::sqrt(2.0 * (buckets - 1)), 5.0)
                << buckets << " buckets, " << side.x << " x " << side.y << " x " << side.z << " cells";
        }
}

TEST(virtual_grid, has_the_cells_that_double_precision_has)
{
    // 2^21 cells along each axis of a box that floats do not divide evenly. A float has 24 digits: coordinates in cells
    // are off by 1/8 at most.
    const glm::vec3 low(-0.3f, 0.1f, 5.0f), high(0.7f, 3.3f, 5.9f);
    const auto g = make_virtual_grid(low, high, glm::uvec3(1u << 21));
    EXPECT_EQ(cell_count(g), std::uint64_t{1} << 63);
    EXPECT_EQ(cell_number(g, low), 0u);
    EXPECT_EQ(cell_number(g, high + 1.0f), (std::uint64_t{1} << 63) - 1);
    EXPECT_EQ(cell_number(g, low - 1.0f), 0u);
    random_source u(7);
    for (int i = 0; i < 100000; ++i) {
        const glm::vec3 p = low + (high - low) * glm::vec3(u(), u(), u());
        const glm::dvec3 expected = (glm::dvec3(p) - glm::dvec3(low)) / (glm::dvec3(high) - glm::dvec3(low)) * 0x1p21;
        const auto number = cell_number(g, p);
        for (int axis = 0; axis < 3; ++axis) {
            const auto cell = static_cast<double>((number >> (21 * axis)) & 0x1FFFFFu);
            ASSERT_GE(expected[axis], cell - 0.125) << "axis " << axis;
            ASSERT_LE(expected[axis], cell + 1.125) << "axis " << axis;
        }
    }
}

TEST(virtual_grid, says_what_is_wrong)
{
    const auto refuses = [](glm::vec3 low, glm::vec3 high, glm::uvec3 resolution, const char* words) {
        try {
            (void)make_virtual_grid(low, high, resolution);
            ADD_FAILURE() << "accepted: " << words;
        } catch (const std::invalid_argument& e) {
            EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
        }
    };
    refuses(glm::vec3(0), glm::vec3(1), {4, 0, 4}, "make_virtual_grid: resolution: axis 1 has 0 cells");
    refuses(glm::vec3(0), glm::vec3(1), {4, 4, (1u << 21) + 1}, "axis 2 has 2097153 cells");
    refuses(glm::vec3(0, 0, 2), glm::vec3(1), {4, 4, 4}, "make_virtual_grid: low, high: axis 2");
    refuses(glm::vec3(NAN), glm::vec3(1), {4, 4, 4}, "make_virtual_grid: low, high: axis 0");
}

TYPED_TEST_P(algorithms, hashed_buckets_keep_the_first_in_draw_order)
{
    auto& b = this->b();
    double largest = 0;
    for (const auto d : {distribution::uniform, distribution::clustered, distribution::coincident,
             distribution::cell_faces, distribution::box_faces})
        for (const auto kind : {bucket_kind::rank, bucket_kind::hash})
            for (const uint m : {1u, 3u, 16u})
                for (const uint side : {4u, 300u}) {
                    const auto set = make_photons(d, 1500, {6, 5, 4}, m);
                    const auto g = make_virtual_grid(glm::vec3(0), glm::vec3(1), {side + 2, side + 1, side});
                    const hashed_route_settings s{
                        .kind = kind, .m = m, .buckets = kind == bucket_kind::hash ? 60 / m : 0, .seed = 3 + m};
                    SCOPED_TRACE(std::string(name_of(d)) + " kind " + std::to_string(static_cast<int>(kind)) + " m "
                        + std::to_string(m) + " side " + std::to_string(side));
                    largest = std::max(largest, expect_survivors(b, set, g, s));
                }
    this->report("A18", "relative error of a virtual cell's power:", largest);
}

TYPED_TEST_P(algorithms, hashed_routes_take_hard_cases)
{
    auto& b = this->b();
    for (const auto kind : {bucket_kind::rank, bucket_kind::hash}) {
        SCOPED_TRACE("kind " + std::to_string(static_cast<int>(kind)));
        const auto fine = make_virtual_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(1u << 21));
        // Nothing, one photon, and as many as fit.
        for (const std::size_t n : {0u, 1u, 2u, 4u, 5u})
            for (const uint buckets : {0u, 1u, 7u})
                if (buckets == 0 || kind == bucket_kind::hash)
                    expect_survivors(b, make_photons(distribution::coincident, n, {2, 2, 2}, 1), fine,
                        {.kind = kind, .m = 2, .buckets = buckets, .seed = 1});
        // Cells that differ in one digit of their numbers only, the first and the last ones, and photons outside.
        photon_set s;
        random_source u(5);
        std::vector<glm::uvec3> cells{{0, 0, 0}, glm::uvec3((1u << 21) - 1)};
        for (int axis = 0; axis < 3; ++axis)
            for (uint digit = 0; digit < 21; ++digit) {
                cells.emplace_back(0);
                cells.back()[axis] = 1u << digit;
            }
        for (uint i = 0; i < 700; ++i) {
            const auto& c = cells[u.below(static_cast<uint>(cells.size()))];
            s.positions.emplace_back((glm::vec3(c) + 0.5f) * 0x1p-21f, i % 3 == 0 ? 1.0f : 0.0f);
            s.powers.emplace_back(u(), i % 50 == 7 ? 1.0f : 0.0f, u(), 0.5f);
        }
        for (uint i = 0; i < 30; ++i) {
            s.positions[i * 20] = vec4(1e30f * (u() - 0.5f), 7.0f * u() - 3.0f, -1e-3f, s.positions[i * 20].w);
            s.positions[i * 20 + 1].y
                = i % 2 == 0 ? std::numeric_limits<float>::quiet_NaN() : -std::numeric_limits<float>::infinity();
            s.powers[i * 20 + 2].z = std::numeric_limits<float>::quiet_NaN();
        }
        for (const uint parts : {every_part, other_part, caustic_part, 0u})
            expect_survivors(b, s, fine, {.kind = kind, .m = 2, .seed = 9, .parts = parts});
        // One bucket for all of them.
        if (kind == bucket_kind::hash)
            for (const uint m : {1u, 16u})
                expect_survivors(b, s, fine, {.kind = kind, .m = m, .buckets = 1, .seed = 9});
        // Flat grids, of which one word of the cells' numbers tells little.
        for (const auto resolution :
            {glm::uvec3(1u << 21, 1, 1), glm::uvec3(1, 1u << 21, 1), glm::uvec3(1, 1, 1u << 21)})
            expect_survivors(
                b, s, make_virtual_grid(glm::vec3(0), glm::vec3(1), resolution), {.kind = kind, .m = 3, .seed = 2});
    }
}

TYPED_TEST_P(algorithms, hashed_routes_conserve_power_in_crowded_cells)
{
    // 70,000 equal photons in a cell, whose powers do not add up exactly: 5e-4.
    auto& b = this->b();
    const uint n = 70000;
    const auto g = make_virtual_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(1u << 20));
    photon_set set;
    set.positions.assign(n, vec4(0.2f, 0.7f, 0.2f, 0.0f));
    set.powers.assign(n, vec4(1.0f / 3, 0.1f, 1e-4f / 3, 0.0f));
    for (const auto kind : {bucket_kind::rank, bucket_kind::hash}) {
        const auto r = hashed_route(
            b, upload_photons(b, set), g, {.kind = kind, .m = 4, .buckets = kind == bucket_kind::hash ? 3u : 0u});
        EXPECT_EQ(r.photons.size(), 16u);
        EXPECT_EQ(r.dropped, n - 16);
        glm::dvec3 after(0);
        for (const auto& power : b.download(r.photons.powers))
            after += glm::dvec3(power);
        double largest = 0;
        for (int c = 0; c < 3; ++c)
            largest = std::max(largest, std::abs(after[c] / (n * static_cast<double>(set.powers[0][c])) - 1));
        EXPECT_LE(largest, kind == bucket_kind::hash ? 1e-6 : 5e-4); // weights do not depend on sums of power
        this->report(kind == bucket_kind::hash ? "A18_hash" : "A18_rank",
            "relative error of power, 70,000 equal photons in a virtual cell:", largest);
    }
}

TYPED_TEST_P(algorithms, ranks_of_virtual_cells_are_the_occupied_cells_of_a_stored_grid)
{
    auto& b = this->b();
    for (const auto d : all_distributions) {
        const auto set = make_photons(d, 1000, {6, 5, 4}, 2);
        virtual_grid g;
        g.axes = set.g;
        const auto ranked = hashed_route(b, upload_photons(b, set), g, {.kind = bucket_kind::rank, .m = 3});
        const auto routed = stencil_route(b, upload_photons(b, set), set.g, 3);
        auto stored = b.download(routed.arrived);
        stored.erase(std::remove(stored.begin(), stored.end(), 0u), stored.end());
        EXPECT_EQ(b.download(ranked.arrived), stored) << name_of(d);
        EXPECT_EQ(ranked.overflowing_buckets, routed.overflowing_cells) << name_of(d);
    }
}

TYPED_TEST_P(algorithms, hashed_routes_equal_the_serial_backends)
{
    auto& b = this->b();
    serial_backend serial;
    for (const auto d : {distribution::uniform, distribution::clustered, distribution::far_from_origin})
        for (const auto kind : {bucket_kind::rank, bucket_kind::hash})
            for (const uint m : {1u, 4u}) {
                auto set = make_photons(d, 3000, {4, 4, 4}, 11);
                set.positions[77].x = std::numeric_limits<float>::quiet_NaN();
                const glm::vec3 low(set.g.origin);
                const auto run = [&](auto& device) {
                    auto photons = upload_photons(device, set);
                    photons.directions = device.upload(std::span<const vec4>(set.powers)); // any vectors
                    auto r = hashed_route(device, std::move(photons),
                        make_virtual_grid(low, low + 1.0f, glm::uvec3(100, 20, 100)),
                        {.kind = kind, .m = m, .seed = 5});
                    return std::tuple{device.download(r.list), device.download(r.photons.positions),
                        device.download(r.photons.directions), device.download(r.arrived), device.download(r.buckets),
                        device.download(r.photons.powers),
                        std::array{r.occupied_cells, r.overflowing_buckets, r.dropped, r.invalid, r.left_out}};
                };
                const auto [list, positions, directions, arrived, buckets, powers, counts] = run(b);
                const auto [list_s, positions_s, directions_s, arrived_s, buckets_s, powers_s, counts_s] = run(serial);
                const auto where = std::string(name_of(d)) + " m " + std::to_string(m);
                EXPECT_EQ(list, list_s) << where;
                EXPECT_EQ(count_different_bits(positions, positions_s), 0u) << where;
                EXPECT_EQ(count_different_bits(directions, directions_s), 0u) << where;
                EXPECT_EQ(arrived, arrived_s) << where;
                EXPECT_EQ(buckets, buckets_s) << where;
                EXPECT_EQ(counts, counts_s) << where;
                for (std::size_t i = 0; i < list.size(); ++i)
                    EXPECT_EQ(directions[i], set.powers[list[i]]);
                if (b.caps().exact_division) {
                    EXPECT_EQ(count_different_bits(powers, powers_s), 0u) << where;
                }
                for (std::size_t i = 0; i < powers.size(); ++i)
                    for (int c = 0; c < 3; ++c)
                        ASSERT_NEAR(powers[i][c], powers_s[i][c], 1e-6f * powers_s[i][c]) << where;
            }
}

TYPED_TEST_P(algorithms, hashed_cells_have_their_power_in_the_mean_and_the_predicted_variance)
{
    // 1,000 seeds; few on slow devices, whose bits are serial's. Each bucket has photons of several cells.
    auto& b = this->b();
    const uint n = 1500, buckets = 40, m = 2, seeds = seeds_for(b, 1000, 60);
    const auto set = make_photons(distribution::clustered, n, {8, 8, 8}, 21);
    const auto g = make_virtual_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(50));
    hashed_route_settings s{.kind = bucket_kind::hash, .m = m, .buckets = buckets};
    const auto e = buckets_by_brute_force(set, g, s, buckets);

    // Of each cell: its power, and the variance of a sample of its bucket, y_j being 0 for other cells' photons.
    struct cell {
        glm::dvec3 power{0}, variance{0}, sum{0};
    };
    std::map<virtual_cell_coordinates, cell> cells;
    std::size_t shared = 0;
    for (const auto& ids : e.destined) {
        const auto N = static_cast<double>(ids.size()), K = std::min(N, static_cast<double>(m * m));
        std::map<virtual_cell_coordinates, std::pair<glm::dvec3, glm::dvec3>> sums; // of y and y^2
        for (const uint id : ids) {
            const glm::dvec3 y(set.powers[id]);
            auto& [first, second] = sums[virtual_cell_of(g, set.positions[id])];
            first += y;
            second += y * y;
        }
        shared += sums.size() > 1 ? 1u : 0u;
        for (const auto& [at, y] : sums) {
            const glm::dvec3 s2 = (y.second - y.first * y.first / N) / std::max(N - 1, 1.0);
            cells[at] = {y.first, N * N * (1 - K / N) * s2 / K, {}};
        }
    }
    ASSERT_GT(shared, buckets / 2);
    double predicted = 0;
    for (const auto& [at, c] : cells)
        predicted += c.variance.x + c.variance.y + c.variance.z;

    const auto device_photons = [&] { return upload_photons(b, set); };
    double squares = 0, squares2 = 0; // of the sum over cells of squared errors, per seed
    for (uint seed = 0; seed < seeds; ++seed) {
        s.seed = seed;
        const auto r = hashed_route(b, device_photons(), g, s);
        const auto list = b.download(r.list);
        const auto powers = b.download(r.photons.powers);
        std::map<virtual_cell_coordinates, glm::dvec3> found;
        for (std::size_t i = 0; i < list.size(); ++i)
            found[virtual_cell_of(g, set.positions[list[i]])] += glm::dvec3(powers[i]);
        double square = 0;
        for (auto& [at, c] : cells) {
            const auto estimate = found.find(at);
            const glm::dvec3 power = estimate != found.end() ? estimate->second : glm::dvec3(0);
            c.sum += power;
            square += glm::dot(power - c.power, power - c.power);
        }
        squares += square;
        squares2 += square * square;
    }
    const double ratio = squares / seeds / predicted;
    const double error = std::sqrt((squares2 / seeds - squares / seeds * (squares / seeds)) / (seeds - 1)) / predicted;
    this->report("A18_variance",
        "squared error of virtual cells over the predicted, " + std::to_string(seeds) + " seeds, +- "
            + std::to_string(error) + ":",
        ratio);
    EXPECT_NEAR(ratio, 1.0, seeds >= 1000 ? 0.05 : 5 * error + 0.05);

    // The means: about 500 z-values. The least likely mean of a cell is that of a lone photon, kept with probability
    // K/N. |z| > 6 happens to one of a thousand normal values with probability 2e-6, and skewness at most doubles z's
    // tail.
    double largest = 0;
    for (const auto& [at, c] : cells)
        for (int channel = 0; channel < 3; ++channel) {
            const double off = c.sum[channel] / seeds - c.power[channel];
            if (c.variance[channel] > 1e-12)
                largest = std::max(largest, std::abs(off) / std::sqrt(c.variance[channel] / seeds));
            else
                EXPECT_NEAR(off, 0.0, 1e-5 * c.power[channel]);
        }
    EXPECT_LT(largest, 6.0);
    this->report("A18_mean", "largest error of a virtual cell's mean power in standard errors:", largest);
}

TYPED_TEST_P(algorithms, errors_of_hashed_survivors_cover_the_thinning)
{
    auto& b = this->b();
    const uint n = 2000, buckets = 60, m = 3, seeds = seeds_for(b, 1000, 60);
    const auto set = make_photons(distribution::clustered, n, {8, 8, 8}, 22);
    const auto g = make_virtual_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(40));
    hashed_route_settings s{.kind = bucket_kind::hash, .m = m, .buckets = buckets};
    const auto e = buckets_by_brute_force(set, g, s, buckets);
    const float radius = 0.1f;
    std::vector<vec4> points;
    for (const auto& p : make_points(set, 60, 22))
        points.push_back(p);
    const auto at = b.upload(std::span<const vec4>(points));
    const knn_settings search{
        .max_radius = radius, .search = search_kind::fixed_radius, .filter = filter_kind::constant, .errors = true};
    const auto sum_of
        = [](const vec4& v) { return static_cast<double>(v.x) + static_cast<double>(v.y) + static_cast<double>(v.z); };

    // Of the sum over points: the squared error that sampling predicts, and how much the weights add to the mean of the
    // squared standard error. The latter is never less.
    const double per_area = 1 / (M_PI * static_cast<double>(radius) * static_cast<double>(radius));
    double predicted = 0, added = 0;
    for (const auto& point : points)
        for (const auto& ids : e.destined) {
            const auto N = static_cast<double>(ids.size()), K = std::min(N, static_cast<double>(m * m));
            double y1 = 0, y2 = 0;
            for (const uint id : ids)
                if (distance2(point, set.positions[id]) <= radius * radius) {
                    const double y = per_area * sum_of(set.powers[id]);
                    y1 += y;
                    y2 += y * y;
                }
            if (N > K) {
                predicted += N * N * (1 - K / N) / K * (y2 - y1 * y1 / N) / (N - 1);
                added += (N / K - 1) * y2;
            }
        }
    ASSERT_GT(predicted, 0.0);
    ASSERT_LE(predicted, added);

    const auto all = block_map(b, upload_photons(b, set));
    const auto exact = knn_grid_estimate(b, all, at, search);
    const auto expected = b.download(exact.irradiance), own_errors = b.download(exact.standard_error);
    double squares = 0, squares2 = 0, reported = 0, reported2 = 0, own = 0;
    for (const auto& v : own_errors)
        own += static_cast<double>(v.w) * static_cast<double>(v.w);
    for (uint seed = 0; seed < seeds; ++seed) {
        s.seed = seed;
        const auto map = block_map(b, hashed_route(b, upload_photons(b, set), g, s).photons);
        const auto estimate = knn_grid_estimate(b, map, at, search);
        const auto irradiance = b.download(estimate.irradiance), errors = b.download(estimate.standard_error);
        double square = 0, report = 0;
        for (std::size_t q = 0; q < points.size(); ++q) {
            const double off = sum_of(irradiance[q]) - sum_of(expected[q]);
            square += off * off;
            report += static_cast<double>(errors[q].w) * static_cast<double>(errors[q].w);
        }
        squares += square / seeds;
        squares2 += square * square / seeds;
        reported += report / seeds;
        reported2 += report * report / seeds;
    }
    const double error = std::sqrt(std::max(squares2 - squares * squares, 0.0) / (seeds - 1)) / predicted;
    const double error_of_reported = std::sqrt(std::max(reported2 - reported * reported, 0.0) / (seeds - 1));
    EXPECT_NEAR(squares / predicted, 1.0, 5 * error + 1e-3);
    EXPECT_NEAR(reported, own + added, 5 * error_of_reported + 1e-3 * (own + added));
    EXPECT_LE(squares, reported);
    this->report("A18_errors",
        "squared error of " + std::to_string(seeds) + " thinned maps over the predicted, +- " + std::to_string(error)
            + ", and over the squared standard error " + std::to_string(squares / reported) + ":",
        squares / predicted);
}

TYPED_TEST_P(algorithms, searches_among_hashed_survivors_are_exact)
{
    auto& b = this->b();
    const auto set = make_photons(distribution::clustered, 3000, {4, 4, 4}, 4);
    const auto points = make_points(set, 100, 4);
    const auto at = b.upload(std::span<const vec4>(points));
    for (const auto kind : {bucket_kind::rank, bucket_kind::hash}) {
        auto r
            = hashed_route(b, upload_photons(b, set), make_virtual_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(1000)),
                {.kind = kind, .m = 2, .buckets = kind == bucket_kind::hash ? 200u : 0u});
        const auto left = b.download(r.photons.positions);
        ASSERT_GT(left.size(), 500u);
        const auto map = fitted_map(b, std::move(r.photons), 20);
        const auto irradiance = b.download(knn_grid_estimate(b, map, at, {.k = 20}).irradiance);
        for (std::size_t q = 0; q < points.size(); ++q) {
            std::vector<float> near;
            for (const auto& p : left)
                near.push_back(distance2(points[q], p));
            std::nth_element(near.begin(), near.begin() + 19, near.end());
            ASSERT_EQ(irradiance[q].w, near[19]) << "point " << q;
        }
    }
}

TYPED_TEST_P(algorithms, hashed_routes_throw_for_wrong_arguments)
{
    auto& b = this->b();
    const auto set = make_photons(distribution::uniform, 10, {2, 2, 2}, 1);
    const auto g = make_virtual_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(8));
    const auto refuses = [&](const virtual_grid& grid, const hashed_route_settings& s, const char* words) {
        try {
            (void)hashed_route(b, upload_photons(b, set), grid, s);
            ADD_FAILURE() << "accepted: " << words;
        } catch (const std::invalid_argument& e) {
            EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
        }
    };
    refuses(g, {.m = 0}, "hashed_route: m: 0");
    refuses(g, {.m = 17}, "hashed_route: m: 17");
    refuses(g, {.kind = bucket_kind::rank, .buckets = 5}, "hashed_route: buckets: 5");
    refuses(g, {.kind = static_cast<bucket_kind>(7)}, "hashed_route: kind: 7");
    refuses({}, {}, "hashed_route: grid: resolution: axis 0 has 0 cells");
    try {
        (void)hashed_route(b, upload_photons(b, set), g, {.m = 16, .buckets = 2000000000});
        FAIL() << "510,000,000,000 slots were not refused";
    } catch (const backend_error& e) {
        EXPECT_NE(std::string(e.what()).find("hashed_route: 2000000000 buckets"), std::string::npos) << e.what();
    }
}

} // namespace photongrid::testing
