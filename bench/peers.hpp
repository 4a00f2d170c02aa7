// Peers of the search for the k nearest: CGAL, FLANN and nanoflann, and their points per second. A peer takes every
// n-th run of 64 points so that it ends within the seconds given.
#pragma once

#include "data_sets.hpp"
#include "median.hpp"

#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Simple_cartesian.h>
#include <flann/flann.hpp>
#include <nanoflann.hpp>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace photongrid::bench {

using std::size_t;

inline double seconds_of(const std::function<void()>& work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}
/// Median of three.
inline double median_seconds_of(const std::function<void()>& work)
{
    std::vector<double> all;
    for (int repetition = 0; repetition < 3; ++repetition)
        all.push_back(seconds_of(work));
    return median(all);
}
/// A peer: how long it built, and its search.
struct peer {
    std::string name;
    double build_seconds;
    std::function<float(const vec4& point)> kth; ///< squared distance of the k-th nearest; from any thread
};

using kernel_of_cgal = CGAL::Simple_cartesian<float>;
using cgal_search = CGAL::Orthogonal_k_neighbor_search<CGAL::Search_traits_3<kernel_of_cgal>>;

inline peer cgal(const data_set& s)
{
    std::vector<kernel_of_cgal::Point_3> points;
    for (const auto& p : s.positions)
        points.emplace_back(p.x, p.y, p.z);
    std::shared_ptr<cgal_search::Tree> tree;
    const double build = median_seconds_of([&] {
        tree = std::make_shared<cgal_search::Tree>(points.begin(), points.end());
        tree->build();
    });
    return {"CGAL", build, [tree, k = s.k](const vec4& q) {
                const cgal_search search(*tree, kernel_of_cgal::Point_3(q.x, q.y, q.z), k);
                float last = 0;
                for (const auto& found : search)
                    last = found.second;
                return last;
            }};
}

inline peer flann_tree(const data_set& s, int leaf)
{
    auto coordinates = std::make_shared<std::vector<float>>();
    for (const auto& p : s.positions)
        coordinates->insert(coordinates->end(), {p.x, p.y, p.z});
    const flann::Matrix<float> data(coordinates->data(), s.positions.size(), 3);
    std::shared_ptr<flann::KDTreeSingleIndex<flann::L2_Simple<float>>> tree;
    const double build = median_seconds_of([&] {
        tree = std::make_shared<flann::KDTreeSingleIndex<flann::L2_Simple<float>>>(
            data, flann::KDTreeSingleIndexParams(leaf));
        tree->buildIndex();
    });
    return {"FLANN, leaves of " + std::to_string(leaf), build, [coordinates, tree, k = s.k](const vec4& q) {
                thread_local std::vector<size_t> indices;
                thread_local std::vector<float> distances;
                indices.resize(k);
                distances.resize(k);
                float at[3] = {q.x, q.y, q.z};
                flann::Matrix<size_t> i(indices.data(), 1, k);
                flann::Matrix<float> d(distances.data(), 1, k);
                tree->knnSearch(
                    flann::Matrix<float>(at, 1, 3), i, d, k, flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
                return distances.back();
            }};
}

/// Points as nanoflann wants them.
struct cloud {
    const std::vector<vec4>& points;
    size_t kdtree_get_point_count() const { return points.size(); }
    float kdtree_get_pt(size_t i, size_t axis) const { return points[i][static_cast<int>(axis)]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const
    {
        return false;
    }
};

inline peer nanoflann_tree(const data_set& s, size_t leaf)
{
    using tree_type = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, cloud>, cloud, 3, uint>;
    auto data = std::make_shared<cloud>(cloud{s.positions});
    std::shared_ptr<tree_type> tree;
    const double build = median_seconds_of(
        [&] { tree = std::make_shared<tree_type>(3, *data, nanoflann::KDTreeSingleIndexAdaptorParams(leaf)); });
    return {"nanoflann, leaves of " + std::to_string(leaf), build, [data, tree, k = s.k](const vec4& q) {
                thread_local std::vector<uint> indices;
                thread_local std::vector<float> distances;
                indices.resize(k);
                distances.resize(k);
                const float at[3] = {q.x, q.y, q.z};
                tree->knnSearch(at, k, indices.data(), distances.data());
                return distances.back();
            }};
}

/// Points per second of a peer. Each point's k-th squared distance is compared with `known`, and counted in `wrong` if
/// it differs by more than the rounding of its terms, which the peer's compiler may fuse; the next photon's distance
/// differs by a thousand times as much.
inline double rate(
    const peer& p, const data_set& s, const std::vector<float>& known, unsigned threads, double seconds, size_t& wrong)
{
    constexpr size_t run = 64;
    constexpr float rounding = 0x1p-22f; // four units in the last place
    const size_t runs = s.points.size() / run;
    const auto search = [&](size_t every) {
        std::atomic<size_t> done = 0, differ = 0;
        const auto one = [&](size_t r) {
            size_t bad = 0;
            for (size_t i = r * every * run; i < r * every * run + run; ++i)
                bad += std::abs(p.kth(s.points[i]) - known[i]) <= rounding * known[i] ? 0u : 1u;
            done += run;
            differ += bad;
        };
        const size_t n = std::max<size_t>(runs / every, 1);
        const double t = seconds_of([&] {
            if (threads == 1) {
                for (size_t r = 0; r < n; ++r)
                    one(r);
            } else {
                tbb::task_arena arena(static_cast<int>(threads));
                arena.execute([&] { tbb::parallel_for(size_t{0}, n, one); });
            }
        });
        wrong += differ;
        return static_cast<double>(done) / t;
    };
    const double first = search(std::max<size_t>(runs / 40, 1));
    return search(std::max<size_t>(static_cast<size_t>(static_cast<double>(s.points.size()) / (first * seconds)), 1));
}

} // namespace photongrid::bench
