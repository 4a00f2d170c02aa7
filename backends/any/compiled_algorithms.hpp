// The algorithms and pictures that photongrid::renderer compiles for each backend where PHOTONGRID_COMPILES_ALGORITHMS
// is defined (backends/any/<name>.cpp). A file that links it declares them extern and does not compile them again:
//
//     namespace photongrid {
//     PHOTONGRID_ALGORITHMS(extern, gl_backend)
//     } // namespace photongrid
//
// Only tests do so: it would make each user's build of photongrid::renderer longer.
#pragma once

#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/estimate/knn_neighbours.hpp>
#include <photongrid/map/hashed_route.hpp>
#include <photongrid/map/map_builders.hpp>
#include <photongrid/render/render.hpp>
#include <photongrid/trace/ray_search.hpp>

// Types and `extern` cannot stand in parentheses.
// NOLINTBEGIN(bugprone-macro-parentheses)
#define PHOTONGRID_ALGORITHMS(EXTERN, B)                                                                               \
    EXTERN template sort_report bitonic_sort(B&, buffer_of<B, glm::uvec2>&);                                           \
    EXTERN template buffer_of<B, glm::uvec2> grid_index(B&, const buffer_of<B, glm::uvec2>&, uint);                    \
    EXTERN template map_buffers<B> sorted_map(B&, photons<B>, const grid&, uint);                                      \
    EXTERN template routed_cells<B> stencil_route(B&, const photons<B>&, const grid&, uint, uint, uint);               \
    EXTERN template map_buffers<B> routed_map(B&, photons<B>, const grid&, const routing&);                            \
    EXTERN template routed_survivors<B> hashed_route(                                                                  \
        B&, photons<B>, const virtual_grid&, const hashed_route_settings&);                                            \
    EXTERN template map_buffers<B> block_map(B&, photons<B>, uint);                                                    \
    EXTERN template grid fitting_grid(B&, const photons<B>&, uint, float);                                             \
    EXTERN template map_buffers<B> fitted_map(B&, photons<B>, uint, uint);                                             \
    EXTERN template class knn_radius<B>;                                                                               \
    EXTERN template class knn_search_by_kernels<B>;                                                                    \
    EXTERN template class ray_search<B>;                                                                               \
    EXTERN template neighbour_lists<B> knn_neighbours(                                                                 \
        B&, const map_buffers<B>&, const buffer_of<B, glm::vec4>&, const knn_settings&);                               \
    EXTERN template neighbour_lists<B> knn_neighbours(B&, const map_buffers<B>&, const buffer_of<B, glm::vec4>&,       \
        const buffer_of<B, glm::vec4>&, const knn_settings&);

#define PHOTONGRID_PICTURES(EXTERN, B)                                                                                 \
    EXTERN template device_scene<B> upload_scene(B&, const scene&);                                                    \
    EXTERN template std::shared_ptr<world<B>> prepare(B&, const scene&, const render_observer&);                       \
    EXTERN template traced_photons<B> trace_photons(                                                                   \
        B&, const device_scene<B>&, const render_settings&, const render_observer&);                                   \
    EXTERN template uint trace_batch(                                                                                  \
        B&, const device_scene<B>&, detail::photon_frames<B>&, const path_batch<B>&, const render_settings&);          \
    EXTERN template void detail::trace_eye_rays(B&, const device_scene<B>&, const detail::eye_view&,                   \
        const detail::ray_of_pixels&, detail::eye_hits<B>&, buffer_of<B, uint>&);                                      \
    EXTERN template void detail::direct_light(B&, const device_scene<B>&, const detail::ray_of_pixels&,                \
        const detail::eye_hits<B>&, buffer_of<B, glm::vec4>&, const buffer_of<B, glm::vec4>*);                         \
    EXTERN template std::vector<glm::vec4> learn_sky(B&, const device_scene<B>&, const camera&, double);               \
    EXTERN template class photon_tracing<B>;                                                                           \
    EXTERN template void detail::mesh_rays<B>::find(B&, const device_scene<B>&, detail::mesh_hits<B>&) const;          \
    EXTERN template buffer_of<B, glm::vec4> covered_shares(B&, const device_scene<B>&, const buffer_of<B, glm::vec4>&, \
        const buffer_of<B, glm::vec4>&, const buffer_of<B, glm::vec4>&, const disc_kind&);                             \
    EXTERN template disc_moments<B> covered_moments(B&, const device_scene<B>&, const buffer_of<B, glm::vec4>&,        \
        const buffer_of<B, glm::vec4>&, const buffer_of<B, glm::vec4>&, const disc_kind&);                             \
    EXTERN template probed_discs<B> probe_discs(B&, const device_scene<B>&, const buffer_of<B, glm::vec4>&,            \
        const buffer_of<B, glm::vec4>&, const disc_probing&);                                                          \
    EXTERN template void correct_edges(B&, const device_scene<B>&, const buffer_of<B, glm::vec4>&,                     \
        const buffer_of<B, glm::vec4>&, knn_estimates<B>&, const disc_kind&);                                          \
    EXTERN template class gather_map_building<B>;                                                                      \
    EXTERN template void add_gather_rays(                                                                              \
        B&, const gather_sources<B>&, const detail::eye_hits<B>&, detail::gather_ray, buffer_of<B, glm::vec4>&);       \
    EXTERN template void add_path(B&, const device_scene<B>&, const near_light<B>&, const detail::eye_hits<B>&,        \
        detail::gather_ray, buffer_of<B, glm::vec4>&);                                                                 \
    EXTERN template built_map<B> build_map(B&, const scene&, const render_settings&, const render_observer&);          \
    EXTERN template rendered draw(                                                                                     \
        B&, const built_map<B>&, const camera&, const render_settings&, const render_observer&);                       \
    EXTERN template class running_search<B>;                                                                           \
    EXTERN template class point_estimates<B>;                                                                          \
    EXTERN template class interpolated_estimates<B>;                                                                   \
    EXTERN template class view_pass<B>;                                                                                \
    EXTERN template pass_pixels draw_pass(                                                                             \
        B&, const built_map<B>&, const camera&, const render_settings&, render_stats&, const pass_options<B>&);        \
    EXTERN template pass_pixels draw_pass(B&, std::shared_ptr<world<B>>, const camera&, const render_settings&, uint); \
    EXTERN template rendered render(B&, const scene&, const render_settings&, const render_observer&);                 \
    EXTERN template class progressive_render<B>;
// NOLINTEND(bugprone-macro-parentheses)
