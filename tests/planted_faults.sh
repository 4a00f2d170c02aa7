#!/usr/bin/env bash
# Do the tests see what they should? Plants one fault at a time in a copy of the sources, builds the tests of the backend that
# it is in, of serial where it is in none, and expects them to fail. Run by tests/run.sh --full; needs the packages that it
# installs.
#
#   tests/planted_faults.sh [FAULT...]             only those whose name contains one of these words
#   tests/planted_faults.sh --check                only whether each file still holds what a fault replaces; builds nothing
#   tests/planted_faults.sh --generated N SEED     N others that nobody chose, of generated_faults.py. Some of those change
#                                                  nothing that can be seen, so which are missed is printed, to be read
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# name | file | what to replace | by what (plain text) | the test program that should see it, if not that of tests_of below.
# Where the text has moved to another file, and is in no third one, it is found there.
faults=(
  "an edited scene keeps its old meshes|include/photongrid/trace/scene_records.hpp|before_->meshes == from;|from.first_light + 1 > 0;"
  "an edited scene keeps its old textures|include/photongrid/trace/scene_records.hpp|before_->textures == out_.sources.textures;|before_->textures.size() == out_.sources.textures.size();"
  "tracing that ends early loses its powers|include/photongrid/trace/trace_photons.hpp|    keep(found.powers, t_.photons.powers);|"
  "the second light map is not searched|include/photongrid/render/view_pass.hpp|(are_all ? built_.lights.size() : 1) - 1|(are_all ? 1 : 1) - 1"
  "sort loses ties|include/photongrid/map/bitonic_step.glsl|(mine.x == partner.x && mine.y < partner.y)|mine.x == partner.x"
  "sort ignores values|include/photongrid/map/bitonic_step.glsl| \|\| (mine.x == partner.x && mine.y < partner.y)|"
  "edited scenes forget the unit|examples/photongrid/io/scene_edit.cpp|v * u.divide / u.multiply|v * u.multiply / u.multiply|scene_file"
  "edited scenes lose a channel|examples/photongrid/io/scene_edit.cpp|c < 3; ++c)|c < 2; ++c)|scene_file"
  "exact quotients keep the farther number|include/photongrid/core/exact_arithmetic.glsl|abs(its_residual) < abs(residual) ? neighbour|abs(its_residual) > abs(residual) ? neighbour|exact_arithmetic"
  "exact quotients look on the wrong side|include/photongrid/core/exact_arithmetic.glsl|(farther ? 1u : 0xFFFFFFFFu)|(farther ? 0xFFFFFFFFu : 1u)|exact_arithmetic"
  "exact roots are not tested against their neighbours|include/photongrid/core/exact_arithmetic.glsl|over <= 0.0f ? below : root|root|exact_arithmetic"
  "exact quotients: a small dividend has no exact residual|include/photongrid/core/exact_arithmetic.glsl|least >= 1.6543612e-24f|least >= 0.0f|exact_arithmetic"
  "exact quotients: odd powers of two are halved toward 0|include/photongrid/core/exact_arithmetic.glsl|power >> 1|power / 2|exact_arithmetic"
  "exact quotients: all of a power at once|include/photongrid/core/exact_arithmetic.glsl|quotient * power_of_2(half_of_it) * power_of_2(power - half_of_it)|quotient * power_of_2(power)|exact_arithmetic"
  "PLY lists may be endless|examples/photongrid/io/ply_file.cpp|length >= 0 && length <= 4294967295.0|length >= 0|scene_file"
  "exact quotients: subscripts are rewritten|include/photongrid/core/exact_arithmetic.hpp|rewrite && open != '['|rewrite|exact_arithmetic"
  "exact quotients: a product loses its first factor|include/photongrid/core/exact_arithmetic.hpp|(product += pending) += blank + right;|product = right;|exact_arithmetic"
  "index off by one|include/photongrid/map/first_in_cell.glsl|keys_below(i + 1u) - first|keys_below(i + 1u) - first + (first > 3u ? 1u : 0u)"
  "index takes equal keys|include/photongrid/map/first_in_cell.glsl|.x < key|.x <= key"
  "routing keeps one less|backends/serial/serial.hpp|arrived[d] < to.capacity|arrived[d] + 1 < to.capacity"
  "verbs: a pass begins too early|backends/serial/serial.hpp|for (uint i = l.first; i != l.first + l.elements; ++i) {|for (uint i = l.first / 2; i != l.first + l.elements; ++i) {"
  "verbs: switches are all on|backends/serial/serial.hpp|turn_switches(k, l.switches)|turn_switches(k, l.switches + ~l.switches)"
  "verbs: what is done is written|backends/serial/serial.hpp|if (q > 0)|if (q + 1 > 0)"
  "verbs: the last is not counted|backends/serial/serial.hpp|k.holds(i) ?|k.holds(i) && i + 1 != l.first + l.elements ?"
  "verbs: memory is never given back|backends/serial/serial.hpp|account_->now -= data_.size()|account_->now -= 0 * data_.size()"
  "routing drops surplus power|include/photongrid/map/routed_cell.glsl|scale.y = total.y / sum.y|scale.y = 1.0f"
  "a photon stands for one too few|include/photongrid/map/packed_photon.glsl|(slot < all % kept ? 1u : 0u)|0u"
  "photons that stand for others keep all power|include/photongrid/map/share_power.glsl|1.0f / number|1.0f"
  "routed maps count only what they keep|include/photongrid/map/grid_maps.hpp|if (by.surplus == surplus_kind::power)|if (map.cells_of.resolution.w > 0)"
  "entries of one photon are independent|include/photongrid/estimate/gather_photons.glsl|weighted2 = weighted2 * stands_for;|weighted2 = weighted2 * 1.0f;"
  "the paper's routing counts surplus photons|include/photongrid/scene/render_settings.hpp|s.map.surplus = surplus_kind::power;|s.map.surplus = surplus_kind::photons;"
  "hashed: survivors do not stand for the others|include/photongrid/map/routed_cell.glsl|float(destined) / float(kept)|1.0f"
  "hashed: redistribution is omitted|include/photongrid/map/survivor_power.glsl|scales(bucket), surpluses|vec4(1.0f, 1.0f, 1.0f, 1.0f), surpluses"
  "hashed: draws in order of id|include/photongrid/map/route_by_bucket.glsl|shuffled(i, args.photons, args.seed)|i"
  "hashed: draws by a permutation of shifts|include/photongrid/map/route_by_bucket.glsl|shuffled(i|permuted(i"
  "hashed: cells differ in their low word only|include/photongrid/map/begins_cell.glsl|&& before.y == cell.y |"
  "hashed: shared buckets conserve their power|include/photongrid/map/hashed_route.hpp|s.m, sums, ranked}, scales|s.m, sums, true}, scales"
  "routing draws in order of id|include/photongrid/map/route_photon.glsl|permuted(i, args.photons, args.seed)|i"
  "search ends a ring early|include/photongrid/estimate/knn_visit.glsl|unexplored * unexplored > limit2;|unexplored * unexplored > 0.25f * limit2;"
  "search takes all within the maximum radius|include/photongrid/estimate/knn_visit.glsl|d2 <= (held < args.k ? args.max_radius2 : radius2)|d2 <= args.max_radius2"
  "search skips the last photon|include/photongrid/estimate/knn_visit.glsl|end = final.x + final.y;|end = final.x + final.y - (final.y > 4u ? 1u : 0u);"
  "cells without clamp at the top|include/photongrid/map/grid.glsl|f = f < last ? f : last;|f = last < 0.0f ? last : f;"
  "cells clamped to a rounded number|include/photongrid/map/grid.glsl|min(uint(f), resolution - 1u)|min(uint(f), resolution)"
  "wrong normalisation|include/photongrid/estimate/knn_result.glsl|3.14159265f|3.0f"
  "direct light stored too|include/photongrid/trace/photon_event.glsl|((kinds >> event_before(position)) & 1u) != 0u|(((kinds + 1u) >> event_before(position)) & 1u) != 0u"
  "interpolation: over any distance|include/photongrid/render/interpolation_round.glsl|away2 <= largest2 && |"
  "interpolation: over steps|include/photongrid/render/interpolation_round.glsl|height * height <= flat2 && |"
  "interpolation: around edges|include/photongrid/render/interpolation_round.glsl|>= 0.99f|>= -2.0f"
  "interpolation: rows for columns|include/photongrid/render/interpolation_round.glsl|across2 ? ROW : |across2 ? COLUMN : "
  "interpolation: weights of the opposite side|include/photongrid/render/pixel_tile.glsl|? 1.0f - x : x)|? x : 1.0f - x)"
  "interpolation: the radius of the last corner|include/photongrid/render/take_estimate.glsl|min(radius2, there.w)|there.w"
  "interpolation: the next pixel's search|include/photongrid/render/search_number.glsl|(1u << pixel % 32u) - 1u|(2u << pixel % 32u) - 1u"
  "guided emission: paths do not make up for their share|include/photongrid/trace/emission_numbers.glsl|e.weight = guide(at).y;|e.weight = 1.0f;|emission_guide"
  "guided emission: numbers are not moved into the box|include/photongrid/trace/emission_numbers.glsl|e.first = in_emission_box(at + 1u, e.first);|e.first = e.first * 1.0f;|emission_guide"
  "guided emission: boxes drawn by chance|include/photongrid/trace/emission_numbers.glsl|float((id * 0x9E3779B1u + scrambled(args.seed)) >> 8u)|float(scrambled(id + args.seed) >> 8u)|emission_guide"
  "guided emission: no floor|include/photongrid/trace/emission_guide.hpp|floor = 0.1;|floor = 0.0;|emission_guide"
  "guided emission: halves without bins|include/photongrid/trace/emission_guide.hpp|most_boxes = 1024, bins = 16;|most_boxes = 1024, bins = 2;|emission_guide"
  "guided emission: splits by chance|include/photongrid/trace/emission_guide.hpp|least_chi2 = 44.3;|least_chi2 = 10;|emission_guide"
  "guided emission: shares by the rate|include/photongrid/trace/emission_guide.hpp|box.volume() * std::sqrt(rate())|box.volume() * rate() * 0.01|emission_guide"
  "a map of caustics: paths go on past the first diffuse surface|include/photongrid/trace/bounce_photon.glsl|(args.ends != NOTHING_ENDS|(args.ends == ROUGH_ENDS"
  "a map of caustics: it is not seen|include/photongrid/render/add_estimate.glsl|irradiance.x + m.x|irradiance.x"
  "a map of caustics: errors are those of the other photons|include/photongrid/render/add_error.glsl|standard_error * standard_error + m * m|standard_error * standard_error|on_serial_pictures"
  "a map of caustics: the others' k|include/photongrid/render/picture_search.hpp|s.estimate.sought(has_caustic_map(s))|s.estimate.sought(false)"
  "a map of caustics: caustics in both maps|include/photongrid/trace/photon_request.hpp|r.kinds = kernels::OTHER_PHOTONS;|r.kinds = kernels::OTHER_PHOTONS \| kernels::CAUSTICS;"
  "a map of caustics: tracing takes long|include/photongrid/trace/photon_request.hpp|most_paths_per_other_photon = 2;|most_paths_per_other_photon = 32;"
  "bias: of another filter|include/photongrid/estimate/filter.hpp|filter_kind::silverman, 3, 1 / 4.0f|filter_kind::silverman, 3, 1 / 3.0f"
  "bias: the difference is not of these filters|include/photongrid/estimate/bias_weights.glsl|2.0f * t - 1.0f|2.0f * t - 0.9f"
  "bias: a slope jumps|include/photongrid/estimate/bias_weights.glsl|inverse - 1.33333333f|inverse - 1.0f"
  "bias: offsets leave the surface|include/photongrid/estimate/gather_bias.glsl|dz - above * n.z|dz"
  "bias: the photon at the radius counts|include/photongrid/estimate/gather_bias.glsl|bool counts = d2 < radius2;|bool counts = d2 <= radius2;"
  "bias: edges are corrected by one filter|include/photongrid/render/correct_bias.glsl|epanechnikov / inside|epanechnikov / whole"
  "bias: all rays of a pixel count whole|include/photongrid/render/shade_bias.glsl|args.share * 3.18309886e-1f|3.18309886e-1f|on_serial_pictures"
  "bias: its noise is bias|include/photongrid/render/pixel_bias.hpp|curve * curve - noise2|curve * curve - 0 * noise2|passes"
  "bias: noise is taken for steps|include/photongrid/render/pixel_bias.hpp|jumps2 > step_bound(passes) * noise2|jumps2 > noise2|passes"
  "bias: a step is as high as its tilt|include/photongrid/render/pixel_bias.hpp|/ (passes * step.tilt)|/ passes|passes"
  "bias: is not in the error|include/photongrid/render/picture_error.hpp|std::abs(sum.bias_of(i))|0 * std::abs(sum.bias_of(i))|passes"
  "bias: counts as noise in the error|include/photongrid/render/picture_error.hpp|(bound - p.bias) * unit|bound / std::hypot(p.bias, p.noise) * std::sqrt(0.5)|passes"
  "bias: pixels of all kinds share bins of the error|include/photongrid/render/picture_error.hpp|parts), parts - 1)|parts), 0 * parts)|passes"
  "forecasts: every error falls as noise does|include/photongrid/render/picture_end.hpp|1 / rate_of_error()|2|passes"
  "bias: of films is not added up|include/photongrid/render/film.hpp|bias_sums_[i].add(other.bias_sums_[i]);|(void)other;|passes"
  "cpu: bias without the surface's normal|backends/cpu/overrides/search.hpp|j.in_plane = s.biases && in.normals != nullptr;|j.in_plane = false;"
  "shrinking radii: they do not|include/photongrid/render/shrinking_radii.hpp|share2 *= (i - 1 + alpha) / i;|share2 *= 1;|passes"
  "shrinking radii: points have the largest one|include/photongrid/estimate/given_radius.glsl|radius2 = own > 0.0f && own < radius2 ? own : radius2;|radius2 = own > 0.0f ? radius2 : own;"
  "shrinking radii: from the map of the pass itself|include/photongrid/render/point_estimates.hpp|*from_.radii.map, points_|*from_.map, points_"
  "shrinking radii: as many are sought in the smaller map|include/photongrid/render/point_estimates.hpp|k.k = from_.radii.k;|"
  "shrinking radii: the map is smaller, k is not|include/photongrid/render/passes.hpp|k = sought;|"
  "cpu: packets have the radius of their first point|backends/cpu/overrides/search_simd.hpp|const float own = j.radii_at_points ? std::sqrt(given_radius2(j, point)) : expected;|const float own = expected;"
  "gather: first hits are not stored|include/photongrid/trace/photon_request.hpp|r.kinds \|= kernels::FIRST_HITS;|r.kinds \|= 0u;|on_serial_pictures"
  "gather: estimates at photons by the settings' filter|include/photongrid/render/final_gather.hpp|search_settings_.filter = filter_kind::constant;|"
  "gather: a surface does not reflect|include/photongrid/render/add_gathered.glsl|weight.x * t.x, weight.y * t.y|weight.x, weight.y|on_serial_pictures"
  "gather: near ends are looked up|include/photongrid/render/final_gather.hpp|is_last ? 0u : 1u|0u"
  "gather: no lamps at near ends|include/photongrid/render/add_near_light.glsl|w.x * (d.x + c.x)|w.x * c.x|on_serial_pictures"
  "gather: directions are not distributed as the cosine|include/photongrid/trace/final_gather_ray.glsl|cosine_direction(normal, u, v)|cosine_direction(normal, u * u, v)|on_serial_pictures"
  "gather: light passes coats whole|include/photongrid/trace/final_gather_ray.glsl|throughput = vec4(passed, passed, passed, 0.0f)|throughput = vec4(1.0f, 1.0f, 1.0f, 0.0f)|on_serial_pictures"
  "power not divided by survival|include/photongrid/trace/bounce_photon.glsl|arrived.x * (colour.x / survival)|arrived.x * (colour.x)"
  "one path forgotten|include/photongrid/trace/trace_photons.hpp|p.emitted = t.emitted;|p.emitted = t.emitted - 1;"
  "Fresnel without polarisation|include/photongrid/trace/optics.glsl|0.5f * (parallel * parallel + perpendicular * perpendicular)|parallel * parallel"
  "ties take one id more|include/photongrid/estimate/kth_tie.glsl|below >= missing|below > missing"
  "ties forget how often a photon is there|include/photongrid/estimate/kth_tie.glsl|missing - ids_below(range) :|NONE :"
  "ties count ids below the bracket twice|include/photongrid/estimate/kth_tie.glsl|missing - ids_below(range) :|missing :"
  "ties ignored|include/photongrid/estimate/kth_result.glsl|bool tie = kth &&|bool tie = !kth &&"
  "exactly k is not enough|include/photongrid/estimate/kth_result.glsl|found >= args.k|found > args.k"
  "grown radius forgets its photon|include/photongrid/estimate/grown_radius.glsl|photons_found(tally) >= args.k|photons_found(tally) > args.k"
  "given radius leaves out its rim|include/photongrid/estimate/given_radius.glsl|0u, NONE, NONE|0u, 0u, NONE"
  "k-th photon is not left out|include/photongrid/estimate/gather_photons.glsl|LEAVE_OUT && excludes_photon|!LEAVE_OUT && excludes_photon"
  "wrong norm of the cone|include/photongrid/estimate/filter.hpp|filter_kind::cone, 3,|filter_kind::cone, 2,"
  "sums without compensation|include/photongrid/estimate/gather_photons.glsl|term = weighted - correction|term = weighted - (correction - correction)"
  "side reversed|include/photongrid/estimate/photon_distance.glsl|!(arrival < 0.0f)|arrival < 0.0f"
  "normals reversed|include/photongrid/estimate/photon_distance.glsl|cosine >= args.leaks.x|cosine <= args.leaks.x"
  "flattening ignored|include/photongrid/estimate/photon_distance.glsl|longer = d2 + args.leaks.y * (h * h)|longer = d2 + 0.0f * args.leaks.y * (h * h)"
  "what lies above or below a surface counts|include/photongrid/estimate/off_surface.glsl|return !(rise2 <= most2)|return !(rise2 <= most2 + d2 * 4.0f)"
  "what a surface bends away is rejected|include/photongrid/estimate/off_surface.glsl|(1.0f - cosine) * (1.0f + cosine) + 0.04f|0.04f"
  "probed discs are not cut down at walls|include/photongrid/render/probe_disc.glsl|border.x > 0.0f && probed.w > LEAST|border.x > 1.0f && probed.w > LEAST"
  "probed discs have no half spaces|include/photongrid/render/probed_point.glsl|normal.w = disc.y|normal.w = 0.0f * disc.y|on_serial_pictures"
  "discs go on below glass|include/photongrid/render/probe_disc.glsl|args.clips != 0u && probed.y == 0.0f && border.y > 0.0f|args.clips > 1u|on_serial_pictures"
  "noise of one neighbour|include/photongrid/render/film.hpp|std::min(e, largest_near)|std::max(e, largest_near)"
  "shares ignore half spaces|include/photongrid/render/probe_disc.glsl|rho = min(rho, plane);|rho = min(rho, 2.0f * plane);"
  "probed discs are not cut down to narrow surfaces|include/photongrid/render/probe_disc.glsl|progress.z >= 3.0f|progress.z >= 5.0f"
  "probed surfaces never end|include/photongrid/render/probe_disc.glsl|met && holds_photons(i, hit, d);|true;"
  "photons keep shading normals|include/photongrid/trace/bounce_photon.glsl|receive(at_base, s.geometric,|receive(at_base, s.shading,|on_serial_pictures"
  "eye rays end with shading normals alone|include/photongrid/trace/eye_bounce.glsl|vec4(s.geometric.x, s.geometric.y, s.geometric.z, direction.w)|vec4(s.shading.x, s.shading.y, s.shading.z, direction.w)|on_serial_pictures"
  "a glance finds every disc whole|include/photongrid/render/glance.glsl|looked = SEARCHED;|looked = KEPT;|on_serial_pictures"
  "a tube is solid|include/photongrid/render/probe_disc.glsl|if (met && dot3(hit.normal, d) > 0.0f)|if (met)|on_serial_pictures"
  "discs that are cut down are not searched again|include/photongrid/render/point_estimates.hpp|cut.count > 0|cut.count > cut.count|on_serial_pictures"
  "probed estimates are not divided|include/photongrid/render/disc_probes.hpp|divide(estimates.irradiance, 1)|divide(estimates.standard_error, 1)"
  "standard error without the spread|include/photongrid/estimate/irradiance_estimate.glsl|terms / float(found - 2u)|terms / terms"
  "standard error of one channel|include/photongrid/estimate/gather_photons.glsl|all * all|weighted.x * weighted.x + 0.0f * all"
  "disc without floor|include/photongrid/estimate/irradiance_estimate.glsl|max(radius2, least2)|radius2"
  "rows without a wider radius|include/photongrid/estimate/search_rows.glsl|sqrt(radius2) * 1.00000095f + 1.1e-19f|sqrt(radius2)"
  "rows of a shorter radius|include/photongrid/estimate/search_rows.glsl|sqrt(radius2) * 1.00000095f|sqrt(radius2) * 0.99999f"
  "packed cells begin late|include/photongrid/map/packed_cell.glsl|sums(i) - count,|sums(i) - count + (count > 3u ? 1u : 0u),"
  "packed photons of the wrong cell|include/photongrid/map/packed_photon.glsl|sums(middle) > i|sums(middle) >= i"
  "running sums skip a step|include/photongrid/map/prefix_sums.hpp|stride *= 4|stride *= 8"
  "parts of the light swapped|include/photongrid/map/grid.glsl|position.w == 1.0f ? 2u : 1u|position.w == 1.0f ? 1u : 2u"
  "photons left out counted wrongly|include/photongrid/map/other_part.glsl|!is_of_parts|is_of_parts"
  "rays start on the surface|include/photongrid/trace/scene_layout.glsl|* 1.9073486328125e-6f + round_share|* 0.0f + 0.0f * round_share"
  "samples not shared out|include/photongrid/render/shade.glsl|light.y * args.share|light.y"
  "NaN pixels shown|include/photongrid/render/film.hpp|finite(p) ? glm::vec3(p) : glm::vec3(0)|glm::vec3(p)"
  "samples to come are dark|include/photongrid/render/progressive_render.hpp|static_cast<float>(settings_.view.spp) / static_cast<float>(samples_shown_)|1.0f"
  "a preview keeps its rays for another|include/photongrid/render/view_pass.hpp|k->direct.size() != canvas_.raster.size()|k->direct.size() > canvas_.raster.size()"
  "a ray is drawn twice|include/photongrid/render/view_pass.hpp|        canvas_ = std::move(c);|        canvas_ = std::move(c); canvas_.rays -= canvas_.rays > 0 ? 1u : 0u;"
  "a moved lamp keeps its map|include/photongrid/scene/scene.hpp| && light_lists(a) == light_lists(b)|"
  "another seed keeps its map|include/photongrid/render/scene_map.hpp|return as.seed == bs.seed && as.map.in_use()|return as.map.in_use()"
  "a moved camera drops the map|include/photongrid/render/progressive_render.hpp|!started_ \|\| !same_light_paths(scene_, s)|!started_ \|\| !same_light_paths(scene_, s) \|\| !(scene_.camera == s.camera)"
  "the early map stays|include/photongrid/render/map_keeper.hpp|return built_ && source_.same(wanted);|return built_ && (source_.same(wanted) \|\| source_.is_preview_of(wanted));"
  "previews are dark|include/photongrid/render/view_pass.hpp|is_preview() ? 1.0f : 1.0f / static_cast<float>(settings_.view.spp);|is_preview() ? 0.8f : 1.0f / static_cast<float>(settings_.view.spp);"
  "ties of the k-th unseen|include/photongrid/estimate/kth_distance.glsl|before > 0u && component(below, before - 1u) == kth ? 1u : 0u|before > 9u ? 1u : 0u"
  "photon at the pivot on the far side|include/photongrid/estimate/kth_distance.glsl|inside && key <= middle ? 1u : 0u|inside && key < middle ? 1u : 0u"
  "photons of a path are all its first|include/photongrid/trace/stored_photon.glsl|rank - sums(low - 1u) : rank|0u : 0u|on_serial_pictures"
  "ended paths are tallied on|include/photongrid/trace/tally_path.glsl|frame < args.frames && end == GOES_ON|frame < args.frames|on_cpu"
  "cpu: paths miss their last bounce|backends/cpu/cpu_by_kernels.hpp|q < most && !done; ++q, at += stride|q + 1 < most \&\& !done; ++q, at += stride"
  "lamps hide nothing of the surface behind|include/photongrid/render/surface_cover.glsl|? -hidden_part(over_radius) : 0.0f;|? 0.0f : 0.0f;"
  "lamps hide what is before them|include/photongrid/render/surface_cover.glsl|return height > error ?|return height != 0.0f ?"
  "lamps hide from any height|include/photongrid/render/surface_cover.glsl|16.0f * (height * height)|0.0f * (height * height)"
  "share of the outer edges added|include/photongrid/render/surface_cover.glsl|d < 0.0f ? -rim : rim|rim"
  "caustics are routed|include/photongrid/render/scene_map.hpp|builder == map_builder::route ? map_builder::sort : builder|builder|on_serial_pictures"
  "bias: a slope at an edge is not reported|include/photongrid/render/correct_bias.glsl|float of_slope = (slope.x|float of_slope = 0.0f * (slope.x"
  "bias: the slope counts in the difference, too|include/photongrid/render/correct_bias.glsl|(of_slope - args.factor * in_difference)|(of_slope - 0.0f * in_difference)"
  "moments: the edge's offset is forgotten|include/photongrid/render/covered_moments.glsl|(way.x * along - d * inward.x * even)|(way.x * along)"
  "moments: of the cone without its logarithm|include/photongrid/estimate/filter.glsl|+ 0.75f * e2 * e2 * logarithm|+ 0.0f * logarithm|on_serial_pictures"
  "passes have the same photons|include/photongrid/render/passes.hpp|if (pass > 0) {|if (pass > 65535) {"
  "a pass is forgotten|include/photongrid/render/film.hpp|add_up(*passes_.begin(), *std::exchange(only_, std::nullopt));|only_.reset();"
  "passes are rounded in turn|include/photongrid/render/exact_sum.hpp|high_ += high + (low_ < low ? 1u : 0u);|high_ += high;"
  "noise of one pass|include/photongrid/render/pass_groups.hpp|(groups_.size() - 1) * passes * steps|(groups_.size() - 1) * steps|passes"
  "noise: a group of one pass counts as much as others|include/photongrid/render/pass_groups.hpp|spread += g.passes * difference|spread += difference|passes"
  "noise: groups of two films differ in size|include/photongrid/render/pass_groups.hpp|while (other.level_ < level_)|while (false)|passes"
  "noise: groups begin anywhere|include/photongrid/render/pass_groups.hpp|join(pairs, key / 2, std::move(g));|join(pairs, (key + 1) / 2, std::move(g));|passes"
  "samples share a stratum|include/photongrid/trace/eye_ray.glsl|(float(column) + x_shifted|(0.0f * float(column) + x_shifted|optics"
  "samples share out a pixel's width in no order|include/photongrid/trace/eye_ray.glsl|x_in_column + float(row) / float(args.strata.y)|x_in_column|optics"
  "samples share out a pixel's height in no order|include/photongrid/trace/eye_ray.glsl|y_in_row + float(column) / float(args.strata.x)|y_in_row|optics"
  "eye rays of all passes are the first's|include/photongrid/trace/eye_rays.hpp|s.pass.number * s.view.spp +|0 * s.view.spp +|optics"
  "strata have the seed of their pass|include/photongrid/trace/eye_rays.hpp|s.seed ^ s.pass.seed_change|s.seed|optics"
  "gather rays of all passes are the first's|include/photongrid/render/final_gather.hpp|settings.pass.seed_change = 0;|settings.pass = {};"
  "sequences lose a matrix|include/photongrid/core/random.glsl|place ^= (place >> 2u) & 0x33333333u;|;|on_serial_algorithms"
  "all sequences have one order|include/photongrid/core/random.glsl|return reversed_bits(nested_scrambled(reversed_bits(nth), seed));|return nth;|on_serial_algorithms"
  "edges of estimates not corrected|include/photongrid/render/point_estimates.hpp|from_.edges == edge_correction::polygons|from_.edges == edge_correction::none"
  "lamp twice as bright|include/photongrid/trace/light_sample.glsl|3.18309886e-1f * seen.share|6.36619772e-1f * seen.share"
  'shafts forget the margin of the light|include/photongrid/trace/intersect/sphere.glsl|precise float both = (s.w + radius) * 1.00001f;|precise float both = s.w * 1.00001f;'
  'shafts look at one corner|include/photongrid/trace/intersect/polygon.glsl|+ (by_u < 0.0f ? by_u : 0.0f) + (by_v < 0.0f ? by_v : 0.0f);|+ 0.0f;'
  "lists forget ties|include/photongrid/estimate/list_neighbours.glsl|list(at) <= last_id|list(at) < last_id"
  "lists end a row early|include/photongrid/estimate/list_neighbours.glsl|next = max(next, at);|next = max(next, end);"
  "lists are not in order|include/photongrid/estimate/sort_neighbours.glsl|(entry & args.run) == 0u|(entry & args.run) == args.run"
  "lists swap neighbours|include/photongrid/estimate/neighbour.glsl|entry * args.points + point|(entry ^ 1u) * args.points + point"
  "cpu: lists are not in order|backends/cpu/overrides/select_simd.hpp|std::sort(keys.begin(), keys.end());|std::sort(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(held / 2));"
  "cpu: the k-th is one further|backends/cpu/overrides/search_simd.hpp|near.of(packet::kept), found.y, j.k - found.x,|near.of(packet::kept), found.y, j.k - found.x + (found.y > j.k - found.x ? 1u : 0u),"
  "cpu: packets are trusted too far|backends/cpu/overrides/search_simd.hpp|(packet_radius - distance_between(q.at, center) * 1.000001f)|(packet_radius - 0.5f * distance_between(q.at, center))"
  "cpu: the band is trusted|backends/cpu/overrides/search_simd.hpp|if (found.x >= j.k \|\| (found.x + found.y < j.k|if ((found.x + found.y < j.k"
  "cpu: ties go by place|backends/cpu/overrides/gather_simd.hpp|j.list[near.index(a)] < j.list[near.index(b)]|near.index(a) < near.index(b)"
  "cpu: the radius grows to the k-th, not the farthest|backends/cpu/overrides/grow_simd.hpp|limit2_ = std::max(limit2_, distance2[i]);|limit2_ = distance2[i];"
  "cpu: growth forgets the farthest|backends/cpu/overrides/grow_simd.hpp|farthest_ = hn::Max(farthest_, hn::IfThenElseZero(within, distances2));|farthest_ = hn::IfThenElseZero(within, distances2);"
  "cpu: rows are asked once|backends/cpu/overrides/grow_simd.hpp|e->has(i) && e->away2[i] <= found.limit2()|e->has(i)"
  "cpu: an end of a row lost|backends/cpu/overrides/grow_simd.hpp|if (has_high)|if (has_high && has_low)"
  "cpu: lanes stored the wrong way round|backends/cpu/overrides/compress_table.hpp|{true, false}|{false, true}"
  "cpu: a packet without its last sentinel|backends/cpu/overrides/packet_simd.hpp|i < k + lanes; i += width) {|i < k; i += width) {"
  "cpu: padding has a distance|backends/cpu/overrides/packet_simd.hpp|hn::StoreU(hn::Set(d, std::numeric_limits<float>::infinity()), d, of(squared_distance) + i);|hn::StoreU(hn::Zero(d), d, of(squared_distance) + i);"
  "cpu: the tree's search visits one block of a group twice|backends/cpu/overrides/tree_simd.hpp|found.visit(s.node - first_block + n);|found.visit(s.node - first_block + lane);"
  "cpu: the tree's search ends after its first group|backends/cpu/overrides/tree_simd.hpp|if (lane == lanes) {|if (lane == lanes \|\| found.visited() > 0) {"
  "cpu: the tree's search keeps any photons at the bound|backends/cpu/overrides/tree_simd.hpp|hn::Or(hn::Lt(d2, within), hn::RebindMask(d, lesser))|hn::Lt(d2, within)"
  "cpu: ties are decided by the greatest ids|backends/cpu/overrides/packet_simd.hpp|std::sort(at_last.begin(), at_last.end());|std::sort(at_last.rbegin(), at_last.rend());"
  "cpu: the nearest of equally far photons goes by place|backends/cpu/overrides/nearest_simd.hpp|if (id < id_) {|if (id_ == no_id) {"
  "cpu: a group has the box of its first point|backends/cpu/overrides/nearest_simd.hpp|box.add(found.at());|if (n == 1) box.add(found.at());"
  "cpu: a group has the bound of its last point|backends/cpu/overrides/nearest_simd.hpp|bound2 = std::max(bound2, found.bound2());|bound2 = found.bound2();"
  "cpu: a group believes that it knows three blocks|backends/cpu/overrides/group_simd.hpp|hn::Set(du, known)), hn::Set(du, 1));|hn::Set(du, known)), hn::Set(du, 2));"
  "cpu: the only photon is always counted|backends/cpu/overrides/gather_simd.hpp|if (j.leave_out && kernels::excludes_photon(r.packed(), least2))|if (j.leave_out && j.k == 0)"
  "cpu: packets hold photons of any number|backends/cpu/overrides/search_simd.hpp|in_tree && exact ? 512 + 16 * std::size_t{j.k} :|j.k == 0 ? 0 :"
  "rays: a surface may be hit again|include/photongrid/trace/trace_ray.glsl| && !is_behind(planes(n), a, b, c, r)||on_serial_pictures"
  "rays: what is before a ray is behind it|include/photongrid/trace/ray_tests.glsl|if (!(height > least_height && slope > least_slope) &&|if (!(height > least_height \|\| slope > least_slope) &&"
  "small shapes have the rounding of coordinates alone|include/photongrid/trace/scene_records.hpp|glm::dvec4(any, 0x1p-20,|glm::dvec4(any, 0.0,|on_serial_pictures"
  "scenes are measured from their middle, whatever is in them|include/photongrid/scene/scene.hpp|e.is_even ? e.all : e.smallest.box|e.all|on_serial_pictures"
  "triangles are as large as they are beside small shapes|include/photongrid/trace/mesh_layout.hpp|return length > 4 * glm::length(a + along * edge) ? length : 0;|return 0;|on_serial_pictures"
  "far meshes are rounded from 0|include/photongrid/scene/mesh.hpp|if (far > 256 &&|if (far > 1e30 \&\&|on_serial_pictures"
  "rays: surfaces of instances may be hit again|include/photongrid/trace/instance_tree.hpp|stretch_of(linear) * 0x1p-18|stretch_of(linear) * 0.0|on_serial_pictures"
  "cpu: a surface may be hit again|backends/cpu/overrides/rays_simd.hpp| && !ray_.leaves(planes[n], block, n)|"
  "rays: a box is not enlarged|include/photongrid/trace/ray_tests.glsl|* 9.5367432e-7f|* 0.0f"
  "rays: a hit may be outside of its box|include/photongrid/trace/ray_tests.glsl|t = t > inside.x ? t : inside.x;|"
  "rays: ties go to the tree|include/photongrid/trace/trace_ray.glsl| \|\| (t == so_far.t && id < so_far.triangle)|"
  "rays: the other child is forgotten|include/photongrid/trace/trace_ray.glsl|v.both = v.next != NO_PAIR;|v.both = v.next != NO_PAIR && pair != 5u;"
  "rays: a tree may become deep|include/photongrid/trace/tree_split.hpp|if (std::max(halves[0].size(), halves[1].size()) <= limits_.most_below(at + 1))|if (halves[0].size() > 0)"
  "rays: slivers that look like lines are missed|include/photongrid/trace/ray_tests.glsl|least_of(x) <= 0.0f && most_of(x)|least_of(x) > 0.0f && most_of(x)"
  "rays: pieces of a tree keep the numbers of their pairs|include/photongrid/trace/triangle_tree.hpp|is_leaf(child) ? child : child + p.first_pair; };|is_leaf(child) ? child : child; };"
  "cpu: pieces of a tree keep the numbers of their nodes|backends/cpu/overrides/wide_tree.hpp|std::bit_cast<float>(id + first)|std::bit_cast<float>(id)"
  "cpu: blocks of triangles lie on one another|backends/cpu/overrides/wide_tree.hpp|first_block += above_instances ? 0 : from.contents_of(c.id).blocks;|"
  "cpu: boxes of rays are not enlarged|backends/cpu/overrides/rays_simd.hpp|0x1p-19f|0.0f"
  "cpu: half of a block's triangles are missed|backends/cpu/overrides/rays_simd.hpp|- kernels::first_of_leaf(leaf))) - 1|- kernels::first_of_leaf(leaf) - 1)) - 1"
  "cpu: a triangle to one side is missed|backends/cpu/overrides/rays_simd.hpp|hn::Not(hn::And(left, right))|hn::Not(hn::Or(left, right))"
  "blocks: a box loses its last photon|include/photongrid/map/block_box.glsl|photon < first + held;|photon + 1u < first + held;"
  "blocks: a walk skips a sibling|include/photongrid/map/block_tree.glsl|uint node = place.x + more;|uint node = place.x + more + (place.x % 7u == 3u ? 1u : 0u);"
  "fitted maps are always grids|include/photongrid/map/fitted_map.hpp|> 200 + 4 * static_cast<double>(k)|> 1e30"
  "blocks: pictures are of every part|include/photongrid/render/scene_map.hpp|return block_map(device_, std::move(p), parts);|return block_map(device_, std::move(p));"
  "cpu: a list ends one late|backends/cpu/overrides/select_simd.hpp|std::fill(j.ids + first + held,|std::fill(j.ids + first + std::min<std::size_t>(held + 1, j.k),"
  "cpu: a photon of a bucket lost|backends/cpu/overrides/map_simd.hpp|next[v] > begin[v] && next[v] % records|next[v] > begin[v] + 1u && next[v] % records"
  "cpu: parts of the light swapped|backends/cpu/overrides/photons_simd.hpp|hn::Eq(w, hn::Set(d, 1.0f))|hn::Ne(w, hn::Set(d, 1.0f))"
  "cpu: the last pair of a digit lost|backends/cpu/overrides/scatter_simd.hpp|p < next[v]; ++p)|p + 1 < next[v]; ++p)"
  "vulkan: groups hear another lane|backends/vulkan/compute_prelude.glsl|#define from_lane(NAME, LANE) subgroupShuffle(NAME, LANE)|#define from_lane(NAME, LANE) subgroupShuffle(NAME, (LANE) & 6u)"
  "vulkan: shared lanes hear another lane|backends/vulkan/compute_prelude.glsl|NAME[first_lane_() + (LANE)]|NAME[first_lane_() + ((LANE) \& 6u)]|vulkan_backend"
  "vulkan: a pass is announced before all workgroups have finished|backends/vulkan/iterate.glsl|+ 1u == gl_NumWorkGroups.x * gl_NumWorkGroups.y|== 0u|vulkan_backend"
  "vulkan: an element left off the list|backends/vulkan/iterate.glsl|keep = more;|keep = more && (i & 1023u) != 1023u;"
  "vulkan: a stride sorts one way|backends/vulkan/overrides/bitonic_strides.glsl|EXCHANGE(p6, p7, rising)|EXCHANGE(p6, p7, true)"
  "vulkan: a pass does not see what the one before wrote|backends/vulkan/recorder.hpp|VK_ACCESS_SHADER_READ_BIT \| VK_ACCESS_SHADER_WRITE_BIT \| VK_ACCESS_TRANSFER_READ_BIT|VK_ACCESS_TRANSFER_READ_BIT|vulkan_backend"
  "vulkan: a pass overtakes a copy|backends/vulkan/barriers.hpp|b.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT \| VK_ACCESS_TRANSFER_WRITE_BIT;|b.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;|vulkan_backend"
  "vulkan: a copy overtakes a pass|backends/vulkan/recorder.hpp|VK_ACCESS_SHADER_WRITE_BIT \| VK_ACCESS_TRANSFER_READ_BIT|VK_ACCESS_SHADER_WRITE_BIT|vulkan_backend"
  "vulkan: an indirect dispatch reads its size too early|backends/vulkan/recorder.hpp|VK_ACCESS_TRANSFER_WRITE_BIT \| VK_ACCESS_INDIRECT_COMMAND_READ_BIT|VK_ACCESS_TRANSFER_WRITE_BIT|vulkan_backend"
  "vulkan: passes are not waited for|backends/vulkan/barriers.hpp|b.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT \| VK_ACCESS_TRANSFER_WRITE_BIT;|b.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;|vulkan_backend"
  "vulkan: results are read before they are there|backends/vulkan/recorder.hpp|finish(); // the copy, too|submit();"
  "vulkan: a batch keeps no buffers|backends/vulkan/batch.hpp|b.kept.push_back(buffers[i]);|(void)buffers[i];"
  "vulkan: a batch has a pass too many|backends/vulkan/recorder.hpp|++now_.passes >= passes_per_batch|++now_.passes > passes_per_batch|vulkan_backend"
  "vulkan: routing forgets draws past the first block|backends/vulkan/routing.hpp|begin < std::min(longest, block)|begin < 0 * std::min(longest, block)"
  "vulkan: routing sorts one digit less|backends/vulkan/routing.hpp|(destinations_ >> shift) != 0|(destinations_ >> shift) > 15"
  "vulkan: routing scans the first digit alone|backends/vulkan/routing.hpp|{16 * chunks}, {counters.held}|{chunks}, {counters.held}"
  "gl: a pass of tiles without a barrier|backends/gl/tiles.hpp|            gl.TextureBarrier(); // states|            // states|gl_callers_context"
  "gl: a pass without a barrier|backends/gl/gl.hpp|device_->call.TextureBarrier();|(void)0;|gl_callers_context"
  "gl: routing has a slot too many|backends/gl/routing.hpp|gl.StencilFunc(GL_EQUAL, static_cast<GLint>(capacity - 1), 0xFFu);|gl.StencilFunc(GL_EQUAL, static_cast<GLint>(capacity), 0xFFu);"
  "gl: routing loses a bit plane|backends/gl/routing.hpp|bit < static_cast<uint>(std::bit_width(largest)); ++bit|bit + 1 < static_cast<uint>(std::bit_width(largest)); ++bit"
  "gl: a full slot takes another|backends/gl/routing.hpp|gl.StencilOp(GL_INCR, GL_INCR, GL_INCR);|gl.StencilOp(GL_INCR, GL_INCR, GL_KEEP);"
  "gl: the stencil is not cleared|backends/gl/routing.hpp|gl.ClearNamedFramebufferiv(framebuffer, GL_STENCIL, 0, &zero);||gl_callers_context"
  "gl: sums of routing replace|backends/gl/routing.hpp|gl.BlendFunci(0, GL_ONE, GL_ONE);|gl.BlendFunci(0, GL_ONE, GL_ZERO);"
  "gl: sums of routing begin anywhere|backends/gl/routing.hpp|on.clear_targets(zero);|"
  "gl: a query is read before it has ended|backends/gl/queries.hpp|GetQueryObjectui64v(query, GL_QUERY_RESULT, &n);|GetQueryObjectui64v(query, GL_QUERY_RESULT_NO_WAIT, &n);"
  "gl: the scissor test stays on|backends/gl/tiles.hpp|gl.Disablei(GL_SCISSOR_TEST, 0);|"
  "gl: the caller's stencil mask is lost|backends/gl/saved_state.hpp|gl.StencilMaskSeparate(s.face, s.write_mask);||gl_callers_context"
  "gl: the caller's query buffer is lost|backends/gl/saved_state.hpp|gl.BindBuffer(GL_QUERY_BUFFER, results_);||gl_callers_context"
  "gl: the caller's blending is lost|backends/gl/saved_state.hpp|gl.BlendFuncSeparatei(0, values_[2], values_[3], values_[4], values_[5]);||gl_callers_context"
  "gl: tiles end with one element left|backends/gl/tiles.hpp|live_[t] = n != 0;|live_[t] = n > 1;"
  "a lamp 5 % off its cosine|include/photongrid/trace/lights/rectangle_light.glsl|cosine_direction(normal, r.x, r.y)|cosine_direction(normal, 0.95f * r.x, r.y)|optics"
  "a lamp with a dark edge|include/photongrid/trace/lights/rectangle_light.glsl|edge_u, r.z)|edge_u, 0.99f * r.z)|optics"
  "a bulb dimmer below|include/photongrid/trace/lights/point_light.glsl|e.direction = uniform_direction(r.x, r.y)|e.direction = uniform_direction(0.98f * r.x, r.y)|optics"
  "a bulb 1 % too bright|include/photongrid/trace/lights/point_light.glsl|    return e;|    e.power = e.power * 1.01f; return e;|optics"
  "a lamp chosen too often|include/photongrid/trace/scene_records.hpp|weight / total, below / total|weight / total, std::min(1.0, 1.01 * below / total)|optics"
  "a batch repeats 64 paths|include/photongrid/trace/trace_photons.hpp|paths, static_cast<uint>(t_.emitted), request_|paths, static_cast<uint>(t_.emitted) - (t_.emitted > 64 ? 64u : 0u), request_|optics"
  "eye rays through the corner|include/photongrid/trace/eye_ray.glsl|float dx = 0.5f;|float dx = 0.0f;|optics"
  "eye rays without the seed|include/photongrid/trace/eye_ray.glsl|1001u, args.seed|1001u, 1u|optics"
  "eye rays alike in all pixels|include/photongrid/trace/eye_ray.glsl|uvec4(pixel, column|uvec4(0u, column|optics"
  "all bands show the first rows|include/photongrid/trace/eye_ray.glsl|uint pixel = i + args.first_pixel;|uint pixel = i + 0u * args.first_pixel;"
  "all bands have the shadow rays of the first|include/photongrid/trace/light_sample.glsl|uvec4(i + args.first_pixel, args.branch|uvec4(i, args.branch"
  "all bands choose branches as the first|include/photongrid/trace/eye_bounce.glsl|uvec4(i + args.first_pixel, args.branch|uvec4(i, args.branch"
  "branches without strata|include/photongrid/trace/eye_bounce.glsl|sequence2(args.nth, uvec4(i + args.first_pixel, args.branch|sequence2(0u, uvec4(i + args.first_pixel, args.branch|optics"
  "faint rays are not corrected|include/photongrid/trace/eye_bounce.glsl|share = corrected;|share = 1.0f;|optics"
  "rare choices stay rare|include/photongrid/trace/eye_bounce.glsl|float least = 0.25f - 0.25f|float least = 0.0f - 0.0f|optics"
  "a branch with light is left out|include/photongrid/trace/eye_bounce.glsl|1u << min(args.branch \| 1u << splits, 31u)|1u << min(args.branch \| 2u << splits, 31u)|optics"
  "shadow rays at lamps of any kind alike for all eye rays|include/photongrid/trace/eye_rays.hpp|.nth = place.nth,|.nth = 0,|optics"
  "one jitter for all strata of a lamp|include/photongrid/trace/light_sample.glsl|args.seed ^ (s * 0x9E3779B1u)|args.seed|optics"
  "one jitter for all lamps|include/photongrid/trace/light_sample.glsl|3000u + number|3000u|optics"
  "shadow rays without the seed|include/photongrid/trace/light_sample.glsl|args.seed ^ (s|1u ^ (s|optics"
  "shadow rays alike for all eye rays|include/photongrid/trace/light_sample.glsl|args.nth, uvec4(i|0u, uvec4(i|optics"
  "a bulb's direct light 1 % too bright|include/photongrid/trace/light_sample.glsl|7.95774715e-2f|8.03732e-2f|optics"
  "tint of glass lost in reflection|include/photongrid/trace/eye_bounce.glsl|vec4(reflected.x * leaving|vec4((s.way == BY_REFLECTION ? throughput.x : reflected.x) * leaving|optics"
  "metal keeps its colour to itself|include/photongrid/trace/bounce_photon.glsl|(colour.y / survival)|(1.0f)|optics"
  "Fresnel 1 % off|include/photongrid/trace/optics.glsl|float reflected = 0.5f|float reflected = 0.505f|optics"
  "glass chooses by another number|include/photongrid/trace/bounce_photon.glsl|r.w < reflected_share(s, facet)));|r.x < reflected_share(s, facet)));|optics"
  "the last edge of a polygon is not asked|include/photongrid/trace/intersect/polygon.glsl|for (uint e = 0u; e <= edges; ++e) {|for (uint e = 0u; e < edges; ++e) {|optics"
  "a quadric open at its lower end|include/photongrid/trace/intersect/quadric.glsl|t0 < nearest && z0 >= 0.0f|t0 < nearest && z0 >= 0.02f * height|optics"
  "a wall 0.5 % too dark|include/photongrid/render/shade.glsl|light.y * args.share|light.y * 0.995f * args.share"
  "ray offsets 32 times too long|include/photongrid/trace/scene_layout.glsl|1.9073486328125e-6f|6.103515625e-5f|optics"
  "a broken library ends the choice of a backend|backends/any/any.cpp|return std::nullopt; // its module cannot be loaded|throw;|program"
  "a lamp's corner may be NaN|include/photongrid/scene/lights.hpp|detail::finite(l.corner) && ||bad_scenes"
  "a setting is unchecked|include/photongrid/scene/setting_table.hpp|v >= least && v <= most|v <= most|bad_scenes"
  "an index of refraction is unchecked|include/photongrid/scene/material.hpp|f.range.check(f.name, v);|(void)v;|bad_scenes"
  "cancelling does nothing|include/photongrid/render/renderer.hpp|stop_asked_ = true;|stop_asked_ = false;|viewer"
  "a change does not cancel the step|examples/photongrid/viewer/render_thread.cpp|if (!waits && cancellable_ != nullptr)|if (waits && cancellable_ != nullptr)|viewer"
  "the window shows no running estimates|examples/photongrid/viewer/render_thread.cpp|.running_estimates = !current_.moving|.running_estimates = false|viewer"
  "the journal forgets how long a change waited|examples/photongrid/viewer/render_thread.cpp|waited_ms|wait_ms|viewer"
  "a file that is being written is read|examples/photongrid/viewer/file_watch.cpp|seen_ != read_ && seen_ == before|seen_ != read_|viewer"
  "a turned camera goes back when the scene changes|examples/photongrid/viewer/document.cpp|made.scene.camera = now.scene.camera;|(void)now;|viewer"
  "files are looked at after they are read|examples/photongrid/viewer/scene_opening.cpp|made.files = files;|for (auto\& f : files) f.second = stamp_of(f.first); made.files = files;|viewer"
  "a view without pixels is drawn|include/photongrid/render/pass_drawing.hpp|        check(settings);|    (void)settings;"
  "a band is left out|include/photongrid/render/pass_drawing.hpp|b.first >= light_.pixels.size()|b.first > light_.pixels.size()"
  "the paper's estimate is not shown|include/photongrid/render/running_search.hpp|return running_estimate_kind::own;|return running_estimate_kind::none;"
  "a resumed picture is not shown|include/photongrid/render/progressive_render.hpp|            ++pictures_;|            (void)0;"
  "a state of more passes goes on|include/photongrid/render/render_state.hpp|if (known != s.film.passes())|if (known > s.film.passes())|passes"
  "a finished pass is drawn again|include/photongrid/render/render_state.hpp|p.number >= passes \|\| s.film.holds(p.number)|p.number >= passes|passes"
  "a state of other bands goes on|include/photongrid/render/render_state.hpp|(next == bands.end() && !drawn)|(next == bands.end() && !drawn && p.rays > 0)|passes"
  "layers may be infinite|include/photongrid/render/film.hpp|!exact_sum::holds(tally.x) \|\| !exact_sum::holds(tally.y)|!exact_sum::holds(tally.x)|passes"
  "channels may cancel|include/photongrid/render/film.hpp|!holds(value.x) \|\| !holds(value.y) \|\| !holds(value.z) \|\| !holds(all)|!holds(all)|passes"
  "any header is a film's|include/photongrid/render/film.hpp|head[0] > 16384 \|\| |head[0] > 0xFFFF0000u \|\| |passes"
  "lamps and backgrounds count as noise|include/photongrid/render/picture_error.hpp|least_spread = 1e-6|least_spread = -1|passes"
  "the almost black decide when a picture ends|include/photongrid/render/picture_error.hpp|dark_share = 0.01|dark_share = 1e-9|passes"
  "errors are bounded as their squares|include/photongrid/render/picture_error.hpp|std::sqrt(0.5)|0.5|passes"
  "two passes tell the error|include/photongrid/render/picture_end.hpp|least_passes = 4|least_passes = 2|passes"
  "a pass begins that ends too late|include/photongrid/render/picture_end.hpp|seconds + pass_seconds_ < output_.seconds|seconds < output_.seconds|passes"
  "a picture that goes on forgets its error|include/photongrid/render/picture_end.hpp|begun_with_ = sum.passes();|return;|passes"
  "a picture of a rule begins with the map that is there|include/photongrid/render/progressive_render.hpp|!settings_.output.has_stop_rule() && |"
  "eye rays of another pass's preview are kept|include/photongrid/render/progressive_render.hpp|            kept_.clear(); // of a preview|            (void)0; //"
  "one eye ray under a rule goes through the middle|include/photongrid/render/passes.hpp|s.output.passes = s.output.passes_at_most();|"
  "an old scene is drawn with automatic numbers|examples/photongrid/io/scene_file.cpp|s = with_numbers(s, {});||scene_file"
  "what is automatic is lost when photons are named|examples/photongrid/io/scene_edit.cpp|(given ? were : unnamed)|were|scene_file"
  "the bias of a step is that at the step|include/photongrid/render/pixel_bias.hpp|step_of_ratio(dot(jump_, tilt_) / tilts2, filter)|step_of_ratio(1, filter)|passes"
  "a pilot's paths end sooner than the picture's|include/photongrid/trace/photon_request.hpp|s.map.caustic_photons > 0 && has_caustics;|s.map.caustic_photons > 0;|on_cpu"
  "a guide to the sky has twice its density|include/photongrid/trace/sky_guide.glsl|7.95774715e-2f * float(SKY_BINS)|1.5915494e-1f * float(SKY_BINS)|on_cpu"
  "no cell has a guide to the sky|include/photongrid/trace/sky_guide.hpp|seen < 0.2|seen < 0.0|on_cpu"
  "an open floor has a guide to the sky|include/photongrid/trace/sky_guide.hpp|seen < 0.2|seen < 2.0|on_cpu"
  "all samples follow the guide to the sky|include/photongrid/trace/sky_guide.glsl|SKY_GUIDED = 0.75f|SKY_GUIDED = 1.0f|on_cpu"
  "cells of the sky are found by the wrong side|include/photongrid/trace/sky_guide.glsl|(x < split.y ? 0u : 1u)|(x < split.y ? 1u : 0u)|on_cpu"
  "estimates of few photons are chosen|include/photongrid/render/chosen_settings.hpp|least_k = 32;|least_k = 8;|passes"
  "a stop rule is given a number of passes|include/photongrid/render/chosen_settings.hpp|s.output.has_stop_rule() ? 1 : |false ? 1 : |passes"
  "a missing comma is not named|examples/photongrid/io/json_tree.cpp|',' or |or |scene_file"
  "parts of no size are read|examples/photongrid/io/scene_file.cpp|least_length(part) < min_length|least_length(part) < 0 * min_length|scene_file"
  "a dark picture is called white|examples/photongrid/advice.cpp|*fitting > *set ?|*fitting < *set ?|program"
  "outputs may be the same file|examples/photongrid/scene_options.cpp|if (f.path == real)|if (f.path == path)|program"
  "another picture is resumed|examples/photongrid/resume_file.cpp|if (file.identity != identity)|if (file.identity.empty() && file.identity != identity)|program"
  "a damaged file is resumed|examples/photongrid/resume_file.cpp|!= number(\"hash\")|== 0|program"
  "auto picks cpu where it was not built|backends/any/any.cpp|any::find(\"cpu\") ? \"cpu\" : \"serial\"|\"cpu\"|program"
  "a missing root is a hit|include/photongrid/trace/intersect/quadric.glsl|float nearest = far;|float nearest = abs(a) > 1e-12f \|\| shift > 0.0f ? far : far + shift;"
  "edges count once for loops|include/photongrid/scene/polygon.hpp|2 * std::uint64_t{p.vertices.size()} + 5|1 * std::uint64_t{p.vertices.size()} + 5|bad_scenes"
  "meshes are behind all shapes|include/photongrid/trace/mesh_hit.glsl|hit.t >= 0.0f && hit.t <= t|hit.t >= 0.0f"
  "points of meshes stay at edges|include/photongrid/trace/mesh_surface.glsl|onto_plane(plane, at.point)|onto_plane(plane, ray_at(vec3(origins(i)), vec3(directions(i)), t))"
  "normals of a mesh are those of its first corner|include/photongrid/trace/mesh_surface.glsl|shading_normal(f, at.weights, vec3(plane))|shading_normal(f, vec3(1.0f, 0.0f, 0.0f), vec3(plane))|validation"
  "photons ignore shading normals where they land|include/photongrid/trace/scatter.glsl|share < 8.0f ? share : 8.0f|1.0f|on_serial_pictures"
  "photons have no adjoint factor|include/photongrid/trace/scatter.glsl|factor < 8.0f ? factor : 8.0f|1.0f|validation"
  "a mesh light sends all light from its last triangle|include/photongrid/trace/lights/mesh_light.glsl|if (shares(middle) > goal)|if (shares(middle) > 0xFFFFFFFFu - (goal - goal))"
  "points of a mesh light crowd at a corner|include/photongrid/trace/lights/mesh_light.glsl|precise float root = sqrt(v);|precise float root = v;"
  "textures are upside down|include/photongrid/trace/mesh_color.glsl|size.w - (coordinates.y|(coordinates.y"
  "clamped textures repeat|include/photongrid/trace/mesh_color.glsl|repeats ? rest : at|rest"
  "textures are not interpolated along rows|include/photongrid/trace/mesh_color.glsl|precise float right_share = u - left;|precise float right_share = 0.0f;"
  "photons forget colours of textures|include/photongrid/trace/color_code.glsl|vec3(1.0f, others.x, others.y)|vec3(1.0f, 1.0f, 1.0f)|validation"
  "the largest channel of a colour is always red|include/photongrid/trace/color_code.glsl|uint which = bits >> 22u;|uint which = 0u * bits;|validation"
  "mirrors have no textures|include/photongrid/trace/met_surface.glsl|precise vec3 colored = m.reflectance * vec3(factors);|precise vec3 colored = m.reflectance * (m.kind == MIRROR_SURFACE ? vec3(1.0f, 1.0f, 1.0f) : vec3(factors));|validation"
  "photons meet clear surfaces half as often|include/photongrid/trace/bounce_photon.glsl|passes = !(chance.x < opacity);|passes = !(chance.x < 0.5f * opacity);|validation"
  "clear surfaces store photons by their opacity|include/photongrid/trace/bounce_photon.glsl|    if (surface < DIFFUSE_SURFACE) {|    if (surface <= BOTH_SURFACES) {|on_serial_pictures"
  "rough surfaces: the other part of a mixture is not asked|include/photongrid/trace/bounce_photon.glsl|material_of(other).alpha > 0.0f|material_of(other).alpha < 0.0f|on_serial_pictures"
  "rough surfaces: photons of all lights|include/photongrid/trace/emit_photon.glsl|args.ends != ROUGH_ENDS|args.ends != 77u|on_serial_pictures"
  "rough surfaces: photons weigh alike|include/photongrid/render/light_of_photons.glsl|return scatter_eval(e, -d);|return 0.318f;|on_serial_pictures"
  "the reference sees nothing on rough surfaces behind glass|include/photongrid/reference/rough_bins.hpp|if (!is_smooth \|\| lights_.empty())|if (is_smooth \|\| lights_.empty())|reference"
  "clear surfaces stop shadow rays|include/photongrid/trace/shadow_through.glsl|precise float clear = 1.0f - opacity;|precise float clear = 0.0f * opacity;"
  "panes reflect as one face does|include/photongrid/trace/scatter.glsl|precise float both = 2.0f * f.reflected / (1.0f + f.reflected);|precise float both = f.reflected;"
  "panes stop shadow rays|include/photongrid/trace/shadow_through.glsl|if (!goes_straight_on(s))|if (goes_straight_on(s))"
  "media: the one of the lowest priority is there|include/photongrid/trace/media.glsl|c.is_real = bit > others;|c.is_real = bit < others;"
  "media: photons lose nothing on their way|include/photongrid/trace/bounce_photon.glsl|if (!(random4(uvec4(photon.id, photon.frame, 1001u, args.seed)).x < survival))|if (!(0.0f < survival))"
  "media: lamps stand in air|include/photongrid/trace/emit_photon.glsl|inside_code(media_around(at), 1.0f)|inside_code(0u, 1.0f)|reference"
  "what a mixture's mirror reflects is not stored in its other part|include/photongrid/trace/bounce_photon.glsl|is_stored ? BOTH_SURFACES : SPECULAR_SURFACE|is_stored ? SPECULAR_SURFACE : SPECULAR_SURFACE"
  "a mixture's parts are swapped for the eye|include/photongrid/trace/eye_bounce.glsl|hit.material = b.first ? parts.second : parts.first;|hit.material = b.first ? parts.first : parts.second;"
  "the share of a mixture has the texture of its opacity|include/photongrid/trace/met_surface.glsl|share * mesh_colors(colors_per_hit() * number + 2u).y|share * mesh_colors(colors_per_hit() * number + 2u).x"
  "textures of roughness are not squared|include/photongrid/trace/met_surface.glsl|m.alpha * (factors.w * factors.w)|m.alpha * factors.w"
  "numbers of textures are red|include/photongrid/trace/mesh_color.glsl|channel == 0u ? all.x : all.y|channel == 0u ? all.x : all.x"
  "all lamps count as if they blocked no light of each other|include/photongrid/scene/lights.hpp|if (found->second - glm::dot(n, lit.corner) > least)|if (found->second - glm::dot(n, lit.corner) > 1e9)|optics"
  "shadow rays to lamps meet nothing|include/photongrid/trace/intersect/tree.glsl|lamps ? tree.count : uint(record.w)|lamps ? tree.count : 0u|optics"
  "a chosen light counts as if all were as likely|include/photongrid/trace/chosen_light.glsl|precise float share = importance / total;|precise float share = 1.0f / float(lights.count);"
  "a light chosen by the tree counts as if both halves were as likely|include/photongrid/trace/chosen_light.glsl|precise float probability = c.probability * share;|precise float probability = c.probability * 0.5f;"
  "glTF: every second triangle of a strip is the wrong way round|examples/photongrid/io/gltf/meshes.cpp|corners[i + 1 + i % 2], corners[i + 2 - i % 2]|corners[i + 1], corners[i + 2]|scene_import"
  "glTF: pictures are upside down|examples/photongrid/io/gltf/meshes.cpp|t.y = 1 - t.y;|t.y = 0 + t.y;|scene_import"
  "glTF: a moved texture moves the other way|examples/photongrid/io/gltf/textures.cpp|1 - transform[1][1] - transform[2][1]|1 - transform[1][1] + transform[2][1]|scene_import"
  "glTF: lamps are in watts|examples/photongrid/io/gltf/materials.cpp|1e15) : 1.0) / luminous_efficacy|1e15) : 1.0) / 1|scene_import"
  "glTF: a node turns its children's places alone|examples/photongrid/io/gltf_file.cpp|nodes_[n].to_scene * nodes_[*c].to_parent|nodes_[*c].to_parent * nodes_[n].to_scene|scene_import"
  "glTF: sparse values are not read|examples/photongrid/io/gltf/accessors.cpp|element(index, numbers.data|element(0 * index, numbers.data|scene_import"
  "plastic of other programs is darkened inside|examples/photongrid/io/import/coat.cpp|return leaves / (1 - t + t * leaves);|return leaves / (1 - 0 * t);|scene_import"
  "the camera of another scene is not taken|examples/photongrid/io/scene_import.cpp|made.scene.camera = from.camera;|made.scene.camera.up = from.camera.up;|scene_import"
  "a tent's slopes are even|include/photongrid/trace/eye_ray.glsl|precise float root = sqrt(twice > 0.0f ? twice : 0.0f);|precise float root = twice;|optics"
  "the tree of lights forgets light from outside of the scene|include/photongrid/trace/chosen_light.glsl|c.probability * (in_tree / total)|c.probability * 1.0f"
  "balls of the tree of lights are too small|include/photongrid/trace/light_tree.hpp|glm::distance(lights_[n].center, ball.center) + lights_[n].radius|glm::distance(lights_[n].center, ball.center)|light_tree"
  "lights around the horizon are never chosen|include/photongrid/trace/lit_point.glsl|(dot3(to, lit.normal) + least) / distance|dot3(to, lit.normal) / distance"
  "spotlights fall off linearly|include/photongrid/trace/lights/spot_light.glsl|axis.w * t * t * (3.0f - 2.0f * t)|axis.w * t"
  "photons of spotlights fall off linearly|include/photongrid/trace/lights/spot_light.glsl|max(min(three.x, three.y), min(max(three.x, three.y), three.z))|three.x"
  "a sphere light's cone is as wide as its radius|include/photongrid/trace/lights/sphere_light.glsl|sine2 / (1.0f + sqrt(1.0f - sine2))|0.5f * sine2"
  "distant light enters by the first face alone|include/photongrid/trace/lights/distant_light.glsl|if (goal < areas.x)|if (goal < 2.0f * areas.x)"
  "the power of environments ignores the box|include/photongrid/trace/lights/environment_light.glsl|(outline_area(at, e.direction) / probability)|(1.0f / probability)"
  "an environment is seen mirrored|include/photongrid/trace/environment.glsl|m.x < 0.0f ? 6.28318531f - half_turn : half_turn|m.x < 0.0f ? half_turn : 6.28318531f - half_turn"
  "texels of an environment are sampled without their solid angle|include/photongrid/trace/lights/environment_light.glsl|precise float scale = sine / texel.w;|precise float scale = 0.6f / texel.w;"
  "samples of a mesh light leave out its parts|include/photongrid/trace/shadow_ray.glsl|(float(args.sample_id) + n.r.x) * share|n.r.x * share"
  "rough facets are chosen as if all faced the eye|include/photongrid/trace/microfacet.glsl|vec3(view.x * alpha, view.y * alpha, view.z)|vec3(view.x, view.y, view.z)|optics"
  "facets hide no light|include/photongrid/trace/microfacet.glsl|return share < 1.0f ? share : 1.0f;|return 1.0f;|optics"
  "rebounds: as much crosses glass from inside as power does|include/photongrid/trace/rebounds.glsl|(index * index * r.inside)|(index * r.inside)|optics"
  "rebounds: metal colours light but once|include/photongrid/trace/rebounds.glsl|if (m.kind != MIRROR_SURFACE)|if (m.kind != GLASS_SURFACE)|optics"
  "rebounds: shares are those of a step|include/photongrid/trace/rebounds.glsl|h.share + (bounded - h.from) * h.slope|h.share|optics"
  "rebounds: light leaves at other cosines than the density says|include/photongrid/trace/rebounds.glsl|goal = u * total;|goal = u * u * total;|optics"
  "rebounds: a photon keeps the colour of one bounce|include/photongrid/trace/bounce_photon.glsl|s.material.reflectance * l.tint;|s.material.reflectance * 1.0f;|optics"
  "light in rough glass is not scaled|include/photongrid/trace/scatter.glsl|(1.0f - share) * eta * eta|(1.0f - share)|optics"
  "hidden photons go on|include/photongrid/trace/bounce_photon.glsl|(is_coated(s) ? 1.0f : l.unhidden)|1.0f|optics"
  "samples of lights on rough surfaces count in full|include/photongrid/trace/scatter_rough.glsl|(light.w / (light.w + s.density))|1.0f|validation"
  "rays off rough surfaces count in full|include/photongrid/trace/eye_bounce.glsl|surface.x / (surface.x + args.light_samples * density)|1.0f|validation"
  "rough glass is lit from the front alone|include/photongrid/trace/eye_rays.hpp|(s.layout.features & has_glass) != 0 ? 2u : 1u|1u|validation"
  "coats reflect what facets hide|include/photongrid/trace/scatter.glsl|share * leave_facet(s, facet, vec4(0.0f, 0.0f, 0.0f, 0.0f)).unhidden|share|optics"
  "photons leave a coat as a bare base|include/photongrid/trace/scatter.glsl|inside = !(r.z < passes_coat(c, dot3(l.direction, s.geometric)));|inside = false;|optics"
  "coats throw nothing back|include/photongrid/trace/coat_layout.hpp|c.thrown_back = 1 - c.mean_passed / (index * index);|c.thrown_back = 0;|optics"
  "coats let all direct light pass|include/photongrid/trace/shadow_ray.glsl|scale * passes_coat(coat_of(uint(surface.w)), dot3(found.direction, lit.normal))|scale|on_serial_pictures"
  "a base under a coat is seen without it|include/photongrid/trace/eye_bounce.glsl|: b.share / coat.mean_passed;|: b.share;|on_serial_pictures"
  "a base under a coat scatters as a bare one|include/photongrid/trace/scatter.glsl|passed * passes_coat(c, -dot3(s.d, s.shading)) / c.mean_passed|even|optics"
  "rays that stay in smooth glass are scaled|include/photongrid/trace/scatter.glsl|turns_back ? 1.0f : g.radiance_scale|facet.f.radiance_scale|optics"
  "the density of a base forgets its coat|include/photongrid/trace/scatter.glsl|even = passing;|even = even * 1.0f;|optics"
  "coats are bright from inside|include/photongrid/trace/scatter.glsl|s.outside \|\| !is_body ? facet : -facet|s.outside ? facet : -facet|optics"
  "shares of a rough coat are those of the next cosine|include/photongrid/trace/coat.glsl|(high - low) * (at - float(step))|(high - low)|optics"
  "instances: triangles keep their surface's numbers|include/photongrid/trace/trace_ray.glsl|uint id = first_id + first.w;|uint id = first.w;"
  "instances: rays are not moved into the surface's space|include/photongrid/trace/trace_ray.glsl|precise vec3 from = o - corner_of(instances(at + 3u));|precise vec3 from = o;"
  "instances: boxes hold only the middles of triangles|include/photongrid/trace/instance_tree.hpp|half = spread * (0.5 * (high - low));|half = spread * (0.0 * (high - low));"
  "instances: a pass goes on in another instance|include/photongrid/trace/trace_ray.glsl|enters = find_instance(args.count, PAIR_OF_INSTANCE, pair);|enters = 0u;"
  "instances: mirrored ones are inside out|include/photongrid/trace/placed_face.glsl|return f.mirrored ? -turned : turned;|return turned;|on_serial_pictures"
  "instances: normals turn as directions do|include/photongrid/trace/placed_face.glsl|dot3(cross3(y, z), n), dot3(cross3(z, x), n), dot3(cross3(x, y), n)|dot3(x, n), dot3(y, n), dot3(z, n)|on_serial_pictures"
  "instances: the first one's material is everyone's|include/photongrid/trace/placed_face.glsl|f.face.w = instances(INSTANCE_RECORDS * f.instance + 5u).w;|f.face.w = instances(14u).w;|on_serial_pictures"
  "instances: lanes do not leave a surface's space|backends/cpu/overrides/rays_simd.hpp|if (instance_ != nowhere && held_ <= above_)|if (instance_ != nowhere && held_ == 0)"
  "of shapes at the same distance any is hit|include/photongrid/trace/intersect/tree.glsl|(t == c.t && n.at < c.at)|false|optics"
  "boxes of shapes are a little too small|include/photongrid/trace/scene_records.hpp|const dvec3 margin(extent_.scale * 0x1p-17)|const dvec3 margin(extent_.scale * -0x1p-12)|optics"
  "paraboloids do not bulge|include/photongrid/scene/paraboloid.hpp|cosine < 0 ?|cosine < -2 ?|optics"
  "lights of meshes are one another|include/photongrid/trace/mesh_hit.glsl|uint(-normal.w) - 1u|uint(-normal.w)"
  "a photon off a mirror may go where no eye ray does|include/photongrid/trace/scatter.glsl|} else if (!by_shading && !by_geometric) {|} else if (!by_shading && !by_geometric && u < -1.0f) {|validation"
  "radiance is not scaled at glass|include/photongrid/trace/eye_bounce.glsl|(branch_share * l.radiance_scale)|branch_share|on_serial_pictures"
  "meshes cast no shadows|include/photongrid/trace/add_unblocked.glsl|triangle_of(mesh_hits(i - args.first)) != NO_TRIANGLE|false"
  "mirrored meshes turn inside out|include/photongrid/trace/mesh_layout.hpp|if (mirrored)|if (mirrored && m.material == 99)|on_serial_pictures"
  "placed meshes turn inside out|include/photongrid/scene/placed_mesh.hpp|return glm::determinant(m.linear) < 0|return false && glm::determinant(m.linear) < 0|scene_file"
  "big-endian files are read as little-endian|examples/photongrid/io/ply_file.cpp|format_ == format::big_endian)|false)|scene_file"
  "faces' indices are not looked at|examples/photongrid/io/ply_file.cpp|>= made_.positions.size())|> made_.positions.size())|scene_file"
  "meshes lie outside the scene's folder|examples/photongrid/io/surface_reader.hpp|!files_.lies_inside(v.text)|false|scene_file"
  "the reference hits the triangle that it leaves|include/photongrid/reference/triangles.hpp|if (order_[i] != from)|if (order_[i] + 1 != 0 && from + 1 >= 0)|reference"
  "loop steps wrap|include/photongrid/trace/device_scene.hpp|return layout.steps_per_ray * lights|return static_cast<uint>(layout.steps_per_ray) * static_cast<uint>(lights)|bad_scenes"
  "shadow rays of the paper wrap|include/photongrid/scene/render_settings.hpp|std::uint64_t{s.view.light_samples} * std::max|s.view.light_samples * std::max|bad_scenes"
  "a star is a polygon|include/photongrid/scene/polygon.hpp|1e-4 * longest) < 9|1e-4 * longest) < 19|bad_scenes"
  "up may lie along the view|include/photongrid/scene/camera.hpp|> 1e-9 * glm::length(c.up)|>= -1e-9 * glm::length(c.up)|bad_scenes"
  "a map replaces a pipe|include/photongrid/core/file_target.hpp|fs::exists(status) && !fs::is_regular_file(status)|fs::exists(status) && fs::is_directory(status)|map_file"
  "a save follows links|include/photongrid/core/file_target.hpp|O_CREAT \| O_EXCL|O_CREAT \| O_TRUNC|map_file"
  "a file's tree has any levels|include/photongrid/map/map_file_format.hpp|header.levels == tree_levels(header.in_blocks)|header.levels > 0|map_file"
  "a file's boxes are not read|include/photongrid/map/map_file_format.hpp|if (low != kernels::low_of_nothing()|if (low.x > high.x && low != kernels::low_of_nothing()|map_file"
  "a failed save leaves its file|include/photongrid/core/file_target.hpp|if (is_left_)|if (is_left_ && error_ == 0)|map_file"
  "strays move the origin|include/photongrid/map/vector_view.hpp|ascending[ascending.size() / 2]|0.5 * ascending.front() + 0.5 * ascending.back()|photon_map"
  "too few photons are an estimate|include/photongrid/estimate/host_search.hpp|e.count < s.k|e.count < 1|photon_map"
  "doubles merge silently|include/photongrid/map/own_photons.hpp|moved * 8 > apart|moved > 8 * apart|own_photons"
  "strays hide merged doubles|include/photongrid/map/own_photons.hpp|strays = sampled / 16|strays = std::min<std::size_t>(sampled / 16, 1)|own_photons"
  "nested searches share a scratch|include/photongrid/estimate/host_search.hpp|query_scratch scratch = std::move(kept_scratch());|query_scratch& scratch = kept_scratch();|photon_map"
  "routing counts past a float|include/photongrid/map/stencil_route.hpp|most = 1u << 24|most = 1u << 25|on_serial_algorithms"
  "includes are found by their last name|include/photongrid/core/kernel_source.hpp|!f.name.ends_with(\"/\" + path)|!f.name.ends_with(\"/\" + path.substr(path.rfind('/') + 1))|kernel_source"
  "vulkan: a pass overtakes the caller's commands|backends/vulkan/recorder.hpp|if (taking_turns_)|if (taking_turns_ && timed_)|vulkan_callers_device"
  "vulkan: the caller's commands overtake a pass|backends/vulkan/recorder.hpp|} else {|} else if (timed_) {|vulkan_callers_device"
  "vulkan: the host reads too early|backends/vulkan/recorder.hpp|barrier(now_.commands, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);|(void)0;|vulkan_callers_device"
  "verbs: an upload beyond the limit|backends/serial/serial.hpp|check_size(data.size());|(void)data.size();"
  "a photon within the least radius is excluded from the error|include/photongrid/estimate/irradiance_estimate.glsl|args.leave_out != 0u && excludes_photon(search_radius, least2)|args.leave_out != 0u"
  "the radius is the k-th visited photon's|include/photongrid/estimate/knn_visit.glsl|if (held < args.k && d2 > radius2)|if (held < args.k)"
)

# The separator is a bar, so bars inside are written \|.
# parse FAULT: sets name, file, from, to and program. Code may have moved: then file is the only one that holds `from`.
parse() {
  local rest=${1//\\|/$'\001'} found
  IFS='|' read -r name file from to program <<<"$rest"
  from=${from//$'\001'/|} to=${to//$'\001'/|}
  if [[ ! -r $file ]] || ! grep -qF -- "$from" "$file"; then
    found=$(grep -rlF --include='*.?pp' --include='*.glsl' -- "$from" include backends examples || true)
    [[ -z $found || $found == *$'\n'* ]] || file=$found
  fi
}
if [[ ${1:-} == --check ]]; then
  stale=0
  for fault in "${faults[@]}"; do
    parse "$fault"
    if [[ ! -r $file ]] || ! grep -qF -- "$from" "$file"; then
      echo "planted_faults: \"$name\": neither $file nor one other file holds: $from; say what took its place" >&2
      stale=1
    fi
  done
  echo "planted_faults: ${#faults[@]} faults looked up"
  exit $stale
fi

generated=no
if [[ ${1:-} == --generated ]]; then
  generated=yes
  mapfile -t faults < <(tests/generated_faults.py "$2" "$3")
  set --
fi

work=$PWD/build-faults
rm -rf "$work"
mkdir "$work"
# Each worker has a copy of the sources and a build of its own, since the tests of one backend are one large file. A run
# ends at the first test that fails.
# tests_of FILE: the program that should see a fault there; of serial's tests the half that has to do with it
tests_of() {
  case $1 in
    backends/cpu/*) echo on_cpu ;;
    backends/gl/*) echo on_gl ;;
    backends/vulkan/*) echo on_vulkan ;;
    */film.hpp | */exact_sum.hpp) echo passes ;;
    */scene/scene.hpp | */render/*.hpp | */eye_ray*| */trace_photons.hpp) echo on_serial_pictures ;;
    */bounce_photon.glsl | */covered_share.glsl | */covered_moments.glsl | */surface_cover.glsl | */probe_disc.glsl | */correct_bias.glsl | */direct_light.glsl | */light_sample.glsl | */mesh_hit.glsl | */mesh_surface.glsl | */scatter.glsl | */shadow_ray.glsl | */lights.glsl | */mesh_light.glsl | */eye_bounce.glsl | */add_unblocked.glsl | */spot_light.glsl | */distant_light.glsl | */environment*.glsl | */lights/*.glsl | */mesh_color.glsl | */chosen_light.glsl | */emit_photon.glsl | */scene_*.glsl | */intersect/*.glsl | */optics.glsl | */shade.glsl | */tally_path.glsl) echo on_serial_pictures ;;
    *) echo on_serial_algorithms ;;
  esac
}
# folder_of PROGRAM: its build, which has no other backend but serial, since a fault may make all of them stale
folder_of() {
  case $1 in
    on_cpu | on_gl | on_vulkan) echo "build-${1#on_}" ;;
    gl_*) echo build-gl ;;
    vulkan_* | program) echo build-vulkan ;; # the program with a module
    *) echo build-serial ;;
  esac
}
configured() { # worker's folder, build's name
  [[ ! -e $1/$2/build.ninja ]] || return 0
  local options=() backend
  for backend in cpu gl vulkan; do
    [[ $2 == "build-$backend" ]] || options+=("-DPHOTONGRID_${backend^^}=OFF")
  done
  cmake -S "$1/tree" -B "$1/$2" -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O1 -DPHOTONGRID_TESTS=ON -DPHOTONGRID_VIEW=OFF "${options[@]}"
}
built() { { configured "$1" "$(folder_of "$2")" && cmake --build "$1/$(folder_of "$2")" --target "$2"; } >"$1/log" 2>&1; }
suite() { RC_PARAMS=seed=20031 NODEVICE_SELECT=1 timeout 900 "$1/$(folder_of "$2")/tests/$2" --gtest_fail_fast --gtest_filter='-*long_*:*scene_files*:GoogleTestVerification*' >"$1/log" 2>&1; }
plant() { # worker's folder, fault
  local name file from to text program
  parse "$2"
  program=${program:-$(tests_of "$file")}
  text=$(cat "$1/tree/$file")
  if [[ $text != *"$from"* ]]; then
    echo "MISSED  $name: $file no longer holds: $from"
    return
  fi
  printf '%s\n' "${text/"$from"/"$to"}" >"$1/tree/$file"
  if ! built "$1" "$program"; then
    echo "MISSED  $name: does not compile: $(grep -m 1 error "$1/log")"
  elif suite "$1" "$program" && { [[ $program != on_serial_* ]] || { built "$1" on_serial && suite "$1" on_serial; }; }; then
    echo "MISSED  $name"
  else
    echo "caught  $name: $(grep -oE '^\[  FAILED  \] [^ ,]+\.[^ ,]+' "$1/log" | sed 's/.*\.//' | sort -u | tr '\n' ' ' | cut -c 1-110)"
    grep -q '\[  FAILED  \]' "$1/log" || tail -n 3 "$1/log" | sed 's/^/        /'
  fi
  printf '%s\n' "$text" >"$1/tree/$file"
}

chosen=()
for fault in "${faults[@]}"; do
  wanted=$(($# == 0))
  for word in "$@"; do
    if [[ ${fault%%|*} == *$word* ]]; then wanted=1; fi
  done
  if ((wanted)); then chosen+=("$fault"); fi
done

workers=$(nproc)
if ((workers > ${#chosen[@]})); then workers=${#chosen[@]}; fi
for ((w = 0; w < workers; ++w)); do
  mkdir "$work/$w" "$work/$w/tree"
  tar -c --exclude='./build*' --exclude=./out --exclude=./.git . | tar -x -C "$work/$w/tree"
done
echo "== no fault"
for program in $(for fault in "${chosen[@]}"; do parse "$fault"; echo "${program:-$(tests_of "$file")}"; done | sort -u); do
  { built "$work/0" "$program" && suite "$work/0" "$program"; } || { tail -n 30 "$work/0/log"; echo "planted_faults: $program fails without any fault" >&2; exit 1; }
done

running=()
for ((w = 0; w < workers; ++w)); do
  for ((f = w; f < ${#chosen[@]}; f += workers)); do
    plant "$work/$w" "${chosen[f]}" | tee -a "$work/$w/results"
  done &
  running+=($!)
done
for job in "${running[@]}"; do wait "$job"; done
caught=$(cat "$work"/*/results | grep -c '^caught' || true)
echo "$caught of ${#chosen[@]} faults caught"
[[ $generated == yes ]] || ((caught == ${#chosen[@]}))
