// How long the searches take on S3, the faces of a room with two boxes, k = 500: docs/measures.md. Every backend in one run,
// searches alternating; the estimates are compared with brute force (float distances, sums in double).
#include <photongrid/backends/gl/gl.hpp>
#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/backends/vulkan/vulkan.hpp>
#include <photongrid/build_map.hpp>
#include <photongrid/knn_grid_estimate.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <random>

namespace {

using namespace photongrid;
using glm::vec3;
using glm::vec4;

constexpr float max_radius = 0.5f; // m
constexpr uint k = 500;

struct data_set {
    std::vector<vec4> positions, powers, points;
};

/// 65,000 photons spread evenly over five faces of the unit box and the upper five of two boxes in it; query points on the
/// same surfaces, in coherent order.
data_set s3(uint photons, uint points)
{
    struct face {
        vec3 corner, u, v;
    };
    const auto add_box = [](std::vector<face>& to, vec3 low, float size) {
        const vec3 x(size, 0, 0), y(0, size, 0), z(0, 0, size);
        to.insert(to.end(), {{low + y, x, z}, {low, x, y}, {low + z, x, y}, {low, y, z}, {low + x, y, z}});
    };
    std::vector<face> faces;
    const vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    faces.insert(faces.end(), {{vec3(0), x, z}, {y, x, z}, {vec3(0), y, z}, {x, y, z}, {z, x, y}});
    add_box(faces, {0.15f, 0, 0.2f}, 0.3f);
    add_box(faces, {0.55f, 0, 0.5f}, 0.3f);
    const auto area_of = [](const face& f) { return static_cast<double>(glm::length(glm::cross(f.u, f.v))); };
    double area = 0;
    for (const auto& f : faces)
        area += area_of(f);
    std::mt19937 engine(1);
    const auto random = [&] { return static_cast<float>(engine() >> 8) * 0x1p-24f; };
    data_set s;
    for (uint i = 0; i < photons; ++i) {
        double left = static_cast<double>(random()) * area;
        std::size_t which = 0;
        for (; which + 1 < faces.size() && left > area_of(faces[which]); ++which)
            left -= area_of(faces[which]);
        const face& f = faces[which];
        const float u = random(), v = random();
        s.positions.emplace_back(f.corner + u * f.u + v * f.v, 0.0f);
        s.powers.emplace_back(random(), random(), random(), 0.0f);
    }
    // Rows of each face, as eye rays would meet it.
    const auto rows = static_cast<uint>(std::sqrt(static_cast<double>(points) / static_cast<double>(faces.size())));
    for (const auto& f : faces)
        for (uint r = 0; r < rows; ++r)
            for (uint c = 0; c < rows; ++c)
                s.points.emplace_back(f.corner + (static_cast<float>(r) + 0.5f) / static_cast<float>(rows) * f.u + (static_cast<float>(c) + 0.5f) / static_cast<float>(rows) * f.v, 1.0f);
    return s;
}

/// relMSE of the red channel against brute force, over some of the points.
double error(const data_set& s, const std::vector<vec4>& irradiance)
{
    double sum = 0;
    int n = 0;
    for (std::size_t q = 0; q < s.points.size(); q += s.points.size() / 200) {
        std::vector<std::pair<float, uint>> near;
        for (uint i = 0; i < s.positions.size(); ++i) {
            const vec4 p = s.positions[i], at = s.points[q];
            const float dx = p.x - at.x, dy = p.y - at.y, dz = p.z - at.z;
            near.emplace_back(dx * dx + dy * dy + dz * dz, i);
        }
        std::nth_element(near.begin(), near.begin() + (k - 1), near.end());
        double flux = 0;
        for (uint i = 0; i + 1 < k; ++i) // unbiased: without the k-th
            flux += static_cast<double>(s.powers[near[i].second].x);
        const double exact = flux / (M_PI * static_cast<double>(near[k - 1].first));
        const double off = static_cast<double>(irradiance[q].x) / exact - 1;
        sum += off * off;
        ++n;
    }
    return sum / n;
}

template <backend B>
void measure(B&& b, const data_set& s, uint repetitions)
{
    for (const auto resolution : {glm::uvec3(25, 25, 50), glm::uvec3(16, 16, 16), glm::uvec3(25, 25, 25), glm::uvec3(32, 32, 32), glm::uvec3(40, 40, 40), glm::uvec3(56, 56, 56)}) {
        const auto g = make_grid(vec3(0), vec3(1), resolution);
        const auto map = sorted_map(b, {b.upload(std::span<const vec4>(s.positions)), b.upload(std::span<const vec4>(s.powers))}, g);
        const auto points = b.upload(std::span<const vec4>(s.points));
        knn_settings paper = as_paper(knn_settings{.k = k, .max_radius = max_radius}), exact{.k = k, .max_radius = max_radius};
        std::vector<double> times[2];
        double used[2] = {}, visited[2] = {}, relmse[2] = {};
        for (uint i = 0; i <= repetitions; ++i)
            for (int which = 0; which < 2; ++which) {
                b.finish();
                const auto start = std::chrono::steady_clock::now();
                const auto e = knn_grid_estimate(b, map, points, which == 0 ? paper : exact);
                b.finish();
                if (i > 0) // kernels compile the first time
                    times[which].push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
                if (i == repetitions) {
                    for (const auto& u : b.download(e.used)) {
                        used[which] += u.x;
                        visited[which] += u.y;
                    }
                    relmse[which] = error(s, b.download(e.irradiance));
                }
            }
        const auto n = static_cast<double>(s.points.size());
        for (auto& t : times)
            std::sort(t.begin(), t.end());
        const double paper_rate = n / times[0][repetitions / 2], exact_rate = n / times[1][repetitions / 2];
        std::printf("| %s | %u x %u x %u | %.1f | %.1f | %.2f | %.0f | %.0f | %.0f | %.0f | %.1e | %.1e |\n", b.caps().backend.c_str(), resolution.x, resolution.y, resolution.z, paper_rate / 1000, exact_rate / 1000,
            exact_rate / paper_rate, used[0] / n, visited[0] / n, used[1] / n, visited[1] / n, relmse[0], relmse[1]);
        std::fflush(stdout);
    }
}

} // namespace

// search_times [repetitions [backend]]
int main(int argc, char** argv)
{
    const uint repetitions = argc > 1 ? static_cast<uint>(std::max(1, std::atoi(argv[1]))) : 3;
    const auto s = s3(65000, 32768);
    std::printf("S3: %zu photons, %zu points, k = %u, maximum radius %.2f m\n", s.positions.size(), s.points.size(), k, static_cast<double>(max_radius));
    std::printf("| backend | grid | at_least_k, 1000/s | exact_k, 1000/s | ratio | used | visited | used | visited | relMSE | relMSE |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
    const auto wanted = [&](const char* name) { return argc < 3 || std::strcmp(argv[2], name) == 0; };
    if (wanted("serial"))
        measure(serial_backend(), s, repetitions);
    if (wanted("vulkan"))
        measure(vulkan_backend(), s, repetitions);
    if (wanted("gl"))
        measure(gl_backend(), s, repetitions);
}
