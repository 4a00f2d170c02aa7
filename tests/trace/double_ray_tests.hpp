// Rays and photons in double.
#pragma once

#include "double_kernels.hpp"

namespace photongrid::testing {

TEST(double_oracle, hits_of_rays)
{
    const auto s = all_shapes();
    const auto layout = lay_out(s);
    const double_scene wide(layout);
    random_source u(61);
    rays r;
    for (int i = 0; i < 100000; ++i)
        r.add(glm::vec3(1.5f * random_direction(u)), random_direction(u), random_direction(u));
    serial_backend b;
    const auto device = upload_scene(b, s);
    auto place = b.make<glm::vec4>(r.size()), facing = b.make<glm::vec4>(r.size()), start = b.make<glm::vec4>(r.size());
    b.run<probes::ray_probe>({static_cast<uint>(r.size()), 0u, layout.features}, {},
        reads(device.records, b.upload(std::span<const glm::vec4>(r.origins)),
            b.upload(std::span<const glm::vec4>(r.directions)), b.upload(std::span<const glm::vec4>(r.leavings))),
        writes(place, facing, start));
    const auto places = b.download(place), facings = b.download(facing);

    const auto o = widened(r.origins), d = widened(r.directions), l = widened(r.leavings);
    double_kernels::ray_probe k;
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

/// Positions of photons traced in double, frame by frame.
inline std::vector<glm::dvec4> photons_in_double(const double_scene& wide, uint paths, uint frames, uint seed)
{
    std::vector<glm::dvec4> p(std::size_t{paths} * frames), power(p), direction(p), origin(p), next(p);
    const auto store = [&](std::size_t i, const auto& k) {
        p[i] = k.position;
        power[i] = k.power;
        direction[i] = k.direction;
        origin[i] = k.next_origin;
        next[i] = k.next_direction;
    };
    double_kernels::emit_photon emit;
    emit.args.first_path = 0;
    emit.args.seed = seed;
    emit.args.boxes = 0;
    emit.args.ends = kernels::NOTHING_ENDS;
    turn_switches(emit, wide.features);
    emit.scene_data = wide.records;
    for (uint i = 0; i < paths; ++i) {
        emit.kernel(i);
        store(i, emit);
    }
    double_kernels::bounce_photon bounce;
    bounce.args.paths = paths;
    bounce.args.first_path = 0;
    bounce.args.last_frame = frames - 1;
    bounce.args.seed = seed;
    bounce.args.ends = kernels::NOTHING_ENDS;
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
    return p;
}

TEST(double_oracle, photons_after_eight_bounces)
{
    auto s = small_cornell();
    s.render.map.photon_depth = 8;
    const uint paths = 16384, frames = 9;
    serial_backend b;
    const auto device = upload_scene(b, s);
    detail::photon_frames<serial_backend> f(b, std::size_t{paths} * frames);
    trace_batch(b, device, f, {paths}, s.render);
    const auto positions = b.download(f.positions);
    const auto layout = lay_out(s);
    const auto p = photons_in_double(double_scene(layout), paths, frames, s.render.seed);

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

} // namespace photongrid::testing
