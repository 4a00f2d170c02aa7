#include "path_tracer.hpp"

#include <atomic>
#include <thread>

namespace host {

namespace {
    /// Light that comes straight from the lamp and leaves the diffuse point `h`, as radiance.
    vec3 direct_light(const scene& s, const hit& h, random_stream& random)
    {
        const vec3 to = s.lamp.point(random) - h.position;
        const double distance2 = dot(to, to);
        const vec3 direction = (1 / std::sqrt(distance2)) * to;
        const double cos_here = dot(direction, h.normal), cos_lamp = -dot(direction, s.lamp.normal());
        if (cos_here <= 0 || cos_lamp <= 0 || !s.sees(h.position, h.position + to))
            return {};
        return (cos_here * cos_lamp * s.lamp.area() / (pi * distance2)) * h.of.colour * s.lamp.of.colour;
    }

    /// The radiance of one path from the eye.
    vec3 trace(const scene& s, ray r, bool keeps_specks, random_stream& random, const irradiance_source& caustics)
    {
        vec3 radiance, throughput{1, 1, 1};
        bool met_diffuse = false, from_specular = false;
        for (int bounce = 0;; ++bounce) {
            const auto h = s.nearest(r);
            if (!h)
                return radiance;
            switch (h->of.kind) {
            case surface::lamp:
                if (h->outside && (!met_diffuse || (from_specular && keeps_specks)))
                    radiance = radiance + throughput * h->of.colour;
                return radiance;
            case surface::mirror:
            case surface::glass:
                r = specular_bounce(r, *h, random);
                from_specular = true;
                break;
            case surface::diffuse:
                radiance = radiance + throughput * direct_light(s, *h, random);
                if (caustics)
                    radiance = radiance + (1 / pi) * throughput * h->of.colour * caustics(h->position, h->normal);
                r = {h->position, cosine_direction(h->normal, random)};
                met_diffuse = true;
                from_specular = false;
                break;
            }
            throughput = throughput * h->of.colour;
            if (bounce >= 3) { // Russian roulette
                const double survival = std::fmin(largest(throughput), 0.95);
                if (random.next() >= survival)
                    return radiance;
                throughput = (1 / survival) * throughput;
            }
        }
    }
} // namespace

void in_parallel(int n, int threads, const std::function<void(int)>& f)
{
    std::atomic<int> next = 0;
    std::vector<std::jthread> workers;
    workers.reserve(static_cast<std::size_t>(threads));
    for (int t = 0; t < threads; ++t)
        workers.emplace_back([&] {
            for (int i = next++; i < n; i = next++)
                f(i);
        });
}

std::vector<vec3> render(const scene& s, const render_settings& settings, const irradiance_source& caustics)
{
    const int size = settings.size;
    const vec3 eye{0, 3, 5.2};
    std::vector<vec3> picture(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
    for (int sample = 0; sample < settings.samples; ++sample) {
        in_parallel(size, settings.threads, [&](int y) {
            for (int x = 0; x < size; ++x) {
                const int pixel = y * size + x;
                random_stream random(
                    settings.seed, static_cast<std::uint64_t>(sample) << 32 | static_cast<std::uint64_t>(pixel));
                // The picture's frame is the box's open front, 2 m wide and high, at z = 1.
                const vec3 through{2 * (x + random.next()) / size - 1, 2 - 2 * (y + random.next()) / size, 1};
                auto& radiance = picture[static_cast<std::size_t>(pixel)];
                radiance
                    = radiance + trace(s, {eye, normalized(through - eye)}, settings.keeps_specks, random, caustics);
            }
        });
    }
    for (auto& radiance : picture)
        radiance = (1.0 / settings.samples) * radiance;
    return picture;
}

} // namespace host
