// The ring and the glass ball in POV-Ray's language, and how far POV-Ray's caustic in the ring lies over ours. Run by
// bench/sections.py.
#include "verbs.hpp"

#include <photongrid/reference/reference.hpp>

#include <photongrid/io/image_file.hpp>
#include <photongrid/io/scene_file.hpp>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <numeric>

namespace {

using namespace photongrid;

std::string vec(const dvec3& v)
{
    char text[100];
    std::snprintf(text, sizeof text, "<%.9g, %.9g, %.9g>", v.x, v.y, v.z);
    return text;
}

/// What those two are made of and no more: polygons, open cylinders and spheres, matte, metal or glass, under point
/// lights and rectangles. POV-Ray's own brightness has other units; only shapes are compared. POV-Ray's axes are
/// left-handed: a negative `right` mirrors them back.
void print_pov(const scene& s, long photons)
{
    if (count_shapes(s) != s.spheres.size() + s.polygons.size() + s.cylinders.size())
        throw std::invalid_argument("povray: only polygons, cylinders and spheres are exported");
    const auto surface = [&](std::uint32_t id) {
        const auto& m = s.materials[id];
        if (m.kind == material_kind::glass)
            std::cout << "  pigment { rgb " << vec(m.reflectance)
                      << " transmit 1 } finish { ambient 0 diffuse 0 specular 0 reflection { 0, 1 fresnel } "
                         "conserve_energy }\n  interior { ior "
                      << m.index_of_refraction << " }\n  photons { target reflection on refraction on collect off }\n";
        else if (m.kind == material_kind::lambertian)
            std::cout << "  pigment { rgb " << vec(m.reflectance) << " } finish { ambient 0 diffuse 1 }\n";
        else // reflects photons, keeps none
            std::cout << "  pigment { rgb 0 } finish { ambient 0 diffuse 0 specular 0 reflection { rgb "
                      << vec(m.reflectance) << " } }\n  photons { target reflection on collect off }\n";
    };
    std::cout << "#version 3.7;\nglobal_settings { assumed_gamma 1 max_trace_level 8";
    if (photons > 0)
        std::cout << " photons { count " << photons << " max_trace_level 8 gather 20, 100 autostop 0 }";
    const auto& c = s.camera;
    const double aspect = static_cast<double>(s.render.output.width) / s.render.output.height,
                 half = std::tan(glm::radians(0.5 * c.vertical_fov));
    std::cout << " }\ncamera { perspective location " << vec(c.position) << " up y right " << -aspect << "*x angle "
              << 2 * glm::degrees(std::atan(half * aspect)) << " sky " << vec(c.up) << " look_at " << vec(c.look_at)
              << " }\n";
    for (const auto& l : s.point_lights)
        std::cout << "light_source { " << vec(l.position) << " rgb 1 }\n";
    const auto side = static_cast<int>(std::lround(std::sqrt(with_numbers(s.render, {}).view.light_samples)));
    for (const auto& l : s.rectangle_lights)
        std::cout << "light_source { " << vec(l.corner + 0.5 * (l.edge_u + l.edge_v)) << " rgb 1 area_light "
                  << vec(l.edge_u) << ", " << vec(l.edge_v) << ", " << side << ", " << side << " jitter }\n";
    for (const auto& x : s.spheres) {
        std::cout << "sphere { " << vec(x.center) << ", " << x.radius << "\n";
        surface(x.material);
        std::cout << "}\n";
    }
    for (const auto& p : s.polygons) {
        std::cout << "polygon { " << p.vertices.size() + 1 << "\n";
        for (std::size_t i = 0; i <= p.vertices.size(); ++i)
            std::cout << "  " << vec(p.vertices[i % p.vertices.size()]) << "\n";
        surface(p.material);
        std::cout << "}\n";
    }
    for (const auto& x : s.cylinders) {
        std::cout << "cylinder { " << vec(x.base) << ", " << vec(x.top) << ", " << x.radius << " open\n";
        surface(x.material);
        std::cout << "}\n";
    }
}

/// Marks the brightest share of the pixels listed.
std::vector<bool> brightest(const std::vector<double>& light, const std::vector<std::size_t>& pixels, double share)
{
    auto order = pixels;
    const auto n = static_cast<std::ptrdiff_t>(share * static_cast<double>(order.size()));
    std::nth_element(order.begin(), order.begin() + n, order.end(),
        [&](std::size_t a, std::size_t b) { return light[a] > light[b]; });
    std::vector<bool> out(light.size(), false);
    for (std::ptrdiff_t i = 0; i < n; ++i)
        out[order[static_cast<std::size_t>(i)]] = true;
    return out;
}

double overlap(
    const std::vector<bool>& a, const std::vector<bool>& b, const std::vector<std::size_t>& pixels, std::size_t shift)
{
    std::size_t both = 0, any = 0;
    for (const auto i : pixels) {
        const bool y = i + shift < b.size() && b[i + shift];
        both += a[i] && y ? 1 : 0;
        any += a[i] || y ? 1 : 0;
    }
    return static_cast<double>(both) / static_cast<double>(std::max<std::size_t>(any, 1));
}

int compare(const scene& s, const image& ours, const image& pov, const image& without)
{
    if (ours.width != pov.width || ours.height != pov.height || pov.width != without.width
        || pov.height != without.height)
        throw std::invalid_argument("povray: the pictures differ in size");
    const reference::geometry shapes(s);
    const auto& c = s.camera;
    const dvec3 forward = glm::normalize(c.look_at - c.position), right = glm::normalize(glm::cross(forward, c.up)),
                up = glm::cross(right, forward);
    const double pixel = 2 * std::tan(glm::radians(0.5 * c.vertical_fov)) / ours.height;
    const auto& ring = s.cylinders.at(0);
    const dvec3 reflectance = s.materials[s.polygons.at(0).material].reflectance;
    std::vector<std::size_t> floor; // pixels that show the table inside the ring
    std::vector<double> mine(ours.pixels.size()), theirs(ours.pixels.size());
    for (std::uint32_t y = 0; y < ours.height; ++y)
        for (std::uint32_t x = 0; x < ours.width; ++x) {
            const std::size_t i = std::size_t{y} * ours.width + x;
            const dvec3 d = glm::normalize(
                forward + (x + 0.5 - 0.5 * ours.width) * pixel * right + (0.5 * ours.height - (y + 0.5)) * pixel * up);
            const dvec3 at = c.position - c.position.y / d.y * d; // on the table, y = 0
            const auto hit = shapes.nearest({c.position, d, reference::nothing});
            if (d.y >= 0 || std::hypot(at.x, at.z) > 0.97 * ring.radius
                || std::abs(hit.t - glm::length(at - c.position)) > 1e-6)
                continue;
            floor.push_back(i);
            // Ours less the lamp's direct light, Phi cos / (4 pi d^2); POV-Ray's with photons less without.
            const auto& lamp = s.point_lights.at(0);
            const dvec3 to = lamp.position - at;
            const double far = glm::length(to);
            const auto shadow = shapes.nearest({at + 1e-7 * to, to / far, reference::nothing});
            const double direct = shadow.t < far * (1 - 1e-6)
                ? 0
                : lamp.power.y / (4 * M_PI) * to.y / (far * far * far) * reflectance.y / M_PI;
            mine[i] = static_cast<double>(ours.pixels[i].y) - direct;
            theirs[i] = static_cast<double>(pov.pixels[i].y) - static_cast<double>(without.pixels[i].y);
        }
    double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    const double n = static_cast<double>(floor.size());
    for (const auto i : floor) {
        a += mine[i] / n, b += theirs[i] / n;
        aa += mine[i] * mine[i] / n, bb += theirs[i] * theirs[i] / n, ab += mine[i] * theirs[i] / n;
    }
    std::printf("%zu pixels of the table inside the ring; correlation of the caustics' light %.4f\n\n", floor.size(),
        (ab - a * b) / std::sqrt((aa - a * a) * (bb - b * b)));
    std::printf("| brightest | intersection over union | moved by 8 pixels |\n|---|---|---|\n");
    for (const double share : {0.05, 0.1, 0.2, 0.3}) {
        const auto p = brightest(mine, floor, share), q = brightest(theirs, floor, share);
        std::printf("| %.0f %% | %.3f | %.3f |\n", 100 * share, overlap(p, q, floor, 0), overlap(p, q, floor, 8));
    }
    const auto p = brightest(mine, floor, 0.1), q = brightest(theirs, floor, 0.1);
    return overlap(p, q, floor, 0) < 0.7 ? 1 : 0; // of the brightest tenth
}

} // namespace

photongrid::bench::verb_run photongrid::bench::add_povray(CLI::App& verb)
{
    struct arguments {
        std::string scene;
        long photons = 0;
        std::vector<std::string> pictures;
    };
    const auto a = std::make_shared<arguments>();
    verb.add_option("scene", a->scene)->required();
    verb.add_option("--photons", a->photons, "prints a .pov file with so many; 0: none")->check(CLI::NonNegativeNumber);
    verb.add_option("--compare", a->pictures, "photongrid's, POV-Ray's with photons, and without")->expected(3);
    return [a] {
        const auto s = read_scene(a->scene);
        if (!a->pictures.empty())
            return compare(s, read_image(a->pictures[0]), read_image(a->pictures[1]), read_image(a->pictures[2]));
        print_pov(s, a->photons);
        return 0;
    };
}
