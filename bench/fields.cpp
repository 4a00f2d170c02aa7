// How wrong density estimates are and how long they take, on fields of light with a known answer: every search, filter,
// k and number of photons, on every backend. Prints CSV; bench/sections.py error draws it.
#include "backends.hpp"
#include "stopwatch.hpp"
#include "verbs.hpp"

#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/map/fitting_grid.hpp>
#include <photongrid/map/map_builders.hpp>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <random>

namespace {

using namespace photongrid;
using glm::vec4;

/// Irradiance on the plane y = 0, W/m^2; photons fall on [-margin, 1 + margin]^2, points lie in the unit square.
struct field {
    const char* name;
    double most; ///< W/m^2
    std::function<double(double, double)> irradiance;
};
constexpr double margin = 0.25;
constexpr int points_per_side = 64;

std::vector<field> fields()
{
    constexpr double turn = 6.283185307179586;
    return {{"even", 1, [](double, double) { return 1.0; }},
        {"ramp", 2.05, [](double x, double) { return 0.4 + 1.3 * std::clamp(x, -0.25, 1.25); }},
        {"waves", 1.8, [=](double x, double z) { return 1 + 0.8 * std::sin(3 * turn * x) * std::sin(3 * turn * z); }},
        {"disc", 2,
            [](double x, double z) { return (x - 0.5) * (x - 0.5) + (z - 0.5) * (z - 0.5) < 0.09 ? 2.0 : 0.25; }}};
}

struct sample {
    std::vector<vec4> positions, powers, points;
    std::vector<double> exact;
};

sample sampled(const field& f, uint photons)
{
    sample s;
    std::mt19937_64 engine(photons);
    std::uniform_real_distribution<double> u;
    const double side = 1 + 2 * margin;
    double mean = 0; // by the midpoint rule
    constexpr int steps = 1000;
    for (int i = 0; i < steps; ++i)
        for (int k = 0; k < steps; ++k)
            mean += f.irradiance((i + 0.5) / steps * side - margin, (k + 0.5) / steps * side - margin) / steps / steps;
    const auto power = static_cast<float>(mean * side * side / photons);
    while (s.positions.size() < photons) {
        const double x = u(engine) * side - margin, z = u(engine) * side - margin;
        if (u(engine) * f.most <= f.irradiance(x, z))
            s.positions.emplace_back(static_cast<float>(x), 0.0f, static_cast<float>(z), 0.0f);
    }
    s.powers.assign(photons, vec4(power, power, power, 0));
    for (int i = 0; i < points_per_side; ++i)
        for (int k = 0; k < points_per_side; ++k) {
            const double x = (k + 0.5) / points_per_side, z = (i + 0.5) / points_per_side;
            s.points.emplace_back(static_cast<float>(x), 0.0f, static_cast<float>(z), 1.0f);
            s.exact.push_back(f.irradiance(x, z));
        }
    return s;
}

template <class Setting>
struct choice {
    const char* name;
    Setting value;
};
constexpr choice<search_kind> searches[] = {{"at_least_k", search_kind::at_least_k}, {"exact_k", search_kind::exact_k},
    {"fixed_radius", search_kind::fixed_radius}};

/// Prints a row for each way to estimate `s` on backend b. Times are medians of three, with building the map apart.
template <backend B>
void measure(B& b, const std::string& name, const field& f, const sample& s, const std::vector<uint>& ks)
{
    const auto n = static_cast<uint>(s.positions.size());
    const auto seconds = [&](const auto& work) {
        return bench::median_seconds_of([&] {
            work();
            b.finish();
        });
    };
    const auto upload = [&] {
        return photons<B>{
            b.upload(std::span<const vec4>(s.positions)), b.upload(std::span<const vec4>(s.powers)), {}, {}};
    };
    const auto points = b.upload(std::span<const vec4>(s.points));
    for (const uint k : ks) {
        const auto g = fitting_grid(b, upload(), k);
        auto map = sorted_map(b, upload(), g); // kernels compile here
        const double build = seconds([&] { map = sorted_map(b, upload(), g); });
        for (const auto& search : searches)
            for (const auto& filter : filters) {
                const double area = (1 + 2 * margin) * (1 + 2 * margin);
                knn_settings settings{.k = k, .max_radius = 1.0f, .search = search.value, .filter = filter.kind};
                if (search.value == search_kind::fixed_radius)
                    settings.max_radius = static_cast<float>(std::sqrt(k * area / (n * 3.14159265358979)));
                std::vector<vec4> irradiance;
                const auto estimate
                    = [&] { irradiance = b.download(knn_grid_estimate(b, map, points, settings).irradiance); };
                estimate(); // kernels compile here
                const double search_seconds = seconds(estimate);
                double error = 0;
                for (std::size_t i = 0; i < s.exact.size(); ++i) {
                    const double e = (static_cast<double>(irradiance[i].x) - s.exact[i]) / (s.exact[i] + 0.01);
                    error += e * e / static_cast<double>(s.exact.size());
                }
                std::printf("%s,%s,sort,%s,%s,%u,%u,%.6f,%.6f,%.6g\n", f.name, name.c_str(), search.name, filter.name,
                    k, n, build, search_seconds, error);
            }
    }
    std::fflush(stdout);
}

int run_fields(const std::vector<std::string>& backends, bool quick)
{
    const auto wanted
        = [&](const char* name) { return std::find(backends.begin(), backends.end(), name) != backends.end(); };
    const std::vector<uint> numbers = quick ? std::vector<uint>{4096} : std::vector<uint>{4096, 16384, 65536, 262144};
    const std::vector<uint> ks = quick ? std::vector<uint>{16} : std::vector<uint>{16, 64, 256};
    std::printf("field,backend,map,search,filter,k,photons,build_seconds,seconds,relmse\n");
    cpu_backend cpu;
    std::optional<serial_backend> serial;
    std::optional<gl_backend> gl;
    std::optional<vulkan_backend> vulkan;
    if (wanted("serial"))
        serial.emplace();
    if (wanted("gl"))
        gl.emplace();
    if (wanted("vulkan"))
        vulkan.emplace();
    for (const auto& f : fields())
        for (const uint n : numbers) {
            const auto s = sampled(f, n);
            measure(cpu, "cpu", f, s, ks);
            if (serial)
                measure(*serial, "serial", f, s, ks);
            if (gl && (n <= 65536 || !gl->caps().software))
                measure(*gl, "gl", f, s, ks);
            if (vulkan && (n <= 65536 || !vulkan->caps().software))
                measure(*vulkan, "vulkan", f, s, ks);
        }
    return 0;
}

} // namespace

photongrid::bench::verb_run photongrid::bench::add_fields(CLI::App& verb)
{
    struct arguments {
        std::vector<std::string> backends{"serial", "gl", "vulkan"};
        bool quick = false;
    };
    const auto a = std::make_shared<arguments>();
    verb.add_option("backends", a->backends, "beside cpu")->check(CLI::IsMember(backend_names));
    verb.add_flag("--quick", a->quick, "few rows, to see that it runs");
    return [a] { return run_fields(a->backends, a->quick); };
}
