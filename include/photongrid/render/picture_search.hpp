// The search in the photon map that a picture's settings ask for, and that of its previews.
#pragma once

#include <photongrid/estimate/knn_settings.hpp>
#include <photongrid/render/previews.hpp>

#include <algorithm>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

/// The search in a photon map that the settings of the estimate ask for.
inline knn_settings search_for(const estimate_settings& s)
{
    knn_settings k;
    k.k = s.k;
    k.max_radius = static_cast<float>(s.max_radius);
    k.search = s.search;
    k.filter = s.filter;
    k.bias = s.bias;
    k.leaks = s.leaks;
    return k;
}

/// The search in the photon map where eye rays end, for a picture with settings `s`.
inline knn_settings search_for(const render_settings& s)
{
    knn_settings k = search_for(s.estimate);
    if (s.output.only == light_part::direct || (has_gather_rays(s) && s.output.only == light_part::indirect))
        k.max_radius = 0; // nothing of the map is seen
    k.errors = s.output.aov;
    k.biases = reports_bias(s);
    return k;
}
/// The search for caustic photons, whichever map they are in.
inline knn_settings search_for_caustics(const render_settings& s)
{
    knn_settings k = search_for(s.estimate);
    k.k = s.estimate.sought(has_caustic_map(s));
    k.errors = s.output.aov;
    k.biases = reports_bias(s);
    return k;
}

/// The search for a preview of a picture that searches with `k`.
inline knn_settings search_for_preview(knn_settings k, const preview& p)
{
    k.k = std::min(k.k, std::max(8u, k.k / p.k_divisor));
    k.errors = k.biases = false;
    if (k.search == search_kind::exact_k)
        k.bias = bias_kind::unbiased; // the paper's is too high by k / (k - 1), which is visible for small k
    return k;
}

} // namespace photongrid::detail

#include <photongrid/core/exact_end.hpp>
