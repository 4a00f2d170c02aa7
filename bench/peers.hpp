// Peers of the search for the k nearest: CGAL, FLANN and nanoflann, and their points per second. A peer takes every
// n-th run of 64 points so that it ends within the seconds given.
#pragma once

#include "data_sets.hpp"
#include "kth_distances.hpp"
#include "point_runs.hpp"
#include "stopwatch.hpp"

#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Simple_cartesian.h>
#include <flann/flann.hpp>
#include <nanoflann.hpp>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace photongrid::bench {

using std::size_t;

/// A peer: how long it built, and its search.
struct peer {
    std::string name;
    double build_seconds;
    std::function<float(const vec4& point, uint k)> kth; ///< squared distance of the k-th nearest; from any thread
};

using kernel_of_cgal = CGAL::Simple_cartesian<float>;
using cgal_search = CGAL::Orthogonal_k_neighbor_search<CGAL::Search_traits_3<kernel_of_cgal>>;

/// Whether CGAL can build a tree of these photons. Of equal ones it splits off one at a time: so many as 10,000 take a
/// second, ten times as many overflow its stack.
inline bool is_for_cgal(const data_set& s)
{
    constexpr size_t most_equal = 10000;
    auto sorted = s.positions;
    std::sort(sorted.begin(), sorted.end(),
        [](const vec4& a, const vec4& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
    for (size_t i = most_equal; i < sorted.size(); ++i)
        if (sorted[i] == sorted[i - most_equal])
            return false;
    return true;
}

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
    return {"CGAL", build, [tree](const vec4& q, uint k) {
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
    return {"FLANN, leaves of " + std::to_string(leaf), build, [coordinates, tree](const vec4& q, uint k) {
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
    return {"nanoflann, leaves of " + std::to_string(leaf), build, [data, tree](const vec4& q, uint k) {
                thread_local std::vector<uint> indices;
                thread_local std::vector<float> distances;
                indices.resize(k);
                distances.resize(k);
                const float at[3] = {q.x, q.y, q.z};
                tree->knnSearch(at, k, indices.data(), distances.data());
                return distances.back();
            }};
}

/// All peers that can hold these photons, with the sizes of leaves that are fastest for some set. They read `s`, which
/// must outlive them.
inline std::vector<peer> all_peers(const data_set& s)
{
    std::vector<peer> all;
    if (is_for_cgal(s))
        all.push_back(cgal(s));
    for (const int leaf : {10, 25, 50}) {
        all.push_back(flann_tree(s, leaf));
        all.push_back(nanoflann_tree(s, static_cast<size_t>(leaf)));
    }
    return all;
}

/// A peer's search at a set's points for the k nearest, or at the runs of them that it takes in `seconds`.
class peer_search {
public:
    peer_search(const peer& p, const data_set& s, uint k, unsigned threads, double seconds)
        : peer_(p), set_(s), k_(k), threads_(threads), seconds_(seconds)
    {
    }

    /// Points per second. Each point's k-th squared distance is compared with `known`, and counted in `wrong` if it
    /// differs. The first call chooses the runs.
    double rate(kth_distances& known, size_t& wrong)
    {
        if (!runs_)
            runs_ = fitting_runs(set_.points.size(), seconds_, seconds_,
                [&](const point_runs& runs) { return seconds_of_search(runs, known, wrong); });
        return static_cast<double>(runs_->taken()) / seconds_of_search(*runs_, known, wrong);
    }

private:
    double seconds_of_search(const point_runs& runs, kth_distances& known, size_t& wrong) const
    {
        std::atomic<size_t> differ = 0;
        const auto one = [&](size_t r) {
            size_t bad = 0;
            for (size_t i = runs.begin(r); i < runs.end(r); ++i)
                bad += known.differs(i, peer_.kth(set_.points[i], k_)) ? 1u : 0u;
            differ += bad;
        };
        const double t = seconds_of([&] {
            if (threads_ == 1) {
                for (size_t r = 0; r < runs.count(); ++r)
                    one(r);
            } else {
                tbb::task_arena arena(static_cast<int>(threads_));
                arena.execute([&] { tbb::parallel_for(size_t{0}, runs.count(), one); });
            }
        });
        wrong += differ;
        return t;
    }

    const peer& peer_;
    const data_set& set_;
    uint k_;
    unsigned threads_;
    double seconds_;
    std::optional<point_runs> runs_;
};

} // namespace photongrid::bench
