// The search in the photon map that a picture's settings ask for, and that of its previews.
#pragma once

#include <photongrid/estimate/knn_settings.hpp>
#include <photongrid/render/previews.hpp>

#include <algorithm>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid::detail {

/// The search in the photon map for a picture with settings `s`.
inline knn_settings search_for(const render_settings& s)
{
    knn_settings k;
    k.k = s.estimate.k;
    k.max_radius = s.output.only == light_part::direct ? 0.0f : static_cast<float>(s.estimate.max_radius);
    k.search = s.estimate.search;
    k.filter = s.estimate.filter;
    k.bias = s.estimate.bias;
    k.leaks = s.estimate.leaks;
    k.errors = s.output.aov;
    return k;
}

/// The search for a preview of a picture that searches with `k`.
inline knn_settings search_for_preview(knn_settings k, const preview& p)
{
    k.k = std::min(k.k, std::max(8u, k.k / p.k_divisor));
    k.errors = false;
    if (k.search == search_kind::exact_k)
        k.bias = bias_kind::unbiased; // the paper's is too high by k / (k - 1), which is visible for small k
    return k;
}

} // namespace photongrid::detail

#include <photongrid/backend/exact_end.hpp>
