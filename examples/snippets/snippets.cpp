// The manual's snippets, run and checked. The parts between "//! [name]" are those that the headers' comments name.
// They are in one file since these comments name the file as well.
#include "expect.hpp"

#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/estimate/knn_neighbours.hpp>
#include <photongrid/map/block_map.hpp>
#include <photongrid/map/hashed_route.hpp>
#include <photongrid/map/map_file.hpp>
#include <photongrid/map/own_photons.hpp>
#include <photongrid/photon_map.hpp>
#include <photongrid/point_index.hpp>
#include <photongrid/reference/reference.hpp>
#include <photongrid/render/progressive_render.hpp>
#include <photongrid/render/render.hpp>
#include <photongrid/trace/ray_search.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <random>

using device_type = photongrid::serial_backend; // or gl_backend, vulkan_backend, cpu_backend
using vectors = std::vector<glm::vec4>;

/// A photon as a program may have it.
struct photon {
    glm::vec3 position; // m
    glm::vec3 power;    // W
};

//! [photon_reader]
struct particle {
    double where[3];
    float mass;
};
template <>
struct photongrid::photon_reader<particle> {
    static auto position(const particle& p) { return std::span(p.where); }
    static float power(const particle& p) { return p.mass; }
};
//! [photon_reader]

namespace {

bool is_near(float value, double expected, double tolerance)
{
    return std::abs(static_cast<double>(value) - expected) <= tolerance * expected;
}

/// 1 W on a square of 1 m about the origin: 1 W/m^2 everywhere. Spread by multiples of irrational numbers.
std::vector<photon> photons_on_a_square()
{
    std::vector<photon> all;
    for (int i = 1; i <= 10000; ++i)
        all.push_back(
            {{std::fmod(i * 0.7548776662, 1.0) - 0.5, 0, std::fmod(i * 0.5698402910, 1.0) - 0.5}, glm::vec3(1e-4f)});
    return all;
}

void buffers()
{
    //! [serial_backend]
    photongrid::serial_backend device;
    const std::vector<float> heights{3, 1, 2};
    auto buffer = device.upload(std::span(heights));
    const std::vector<float> back = device.download(buffer);
    //! [serial_backend]
    expect(back == heights, "serial_backend");

    //! [upload]
    const auto ids = photongrid::upload(device, std::array<photongrid::uint, 3>{7, 8, 9}); // any contiguous range
    //! [upload]
    expect(device.download(ids) == std::vector<photongrid::uint>{7, 8, 9}, "upload");
}

void algorithms(device_type& device)
{
    //! [bitonic_sort]
    auto pairs = photongrid::upload(device, std::vector<glm::uvec2>{{30, 0}, {10, 1}, {20, 2}, {10, 3}});
    photongrid::bitonic_sort(device, pairs); // (10, 1) (10, 3) (20, 2) (30, 0)
    //! [bitonic_sort]
    expect(device.download(pairs) == std::vector<glm::uvec2>{{10, 1}, {10, 3}, {20, 2}, {30, 0}}, "bitonic_sort");

    //! [grid_index]
    const auto first_and_count = photongrid::grid_index(device, pairs, 40); // of the keys 0 to 39
    const glm::uvec2 tens = device.download(first_and_count)[10];           // (0, 2): two pairs, the first at 0
    //! [grid_index]
    expect(tens == glm::uvec2(0, 2), "grid_index");

    //! [prefix_sums]
    const auto terms = photongrid::upload(device, std::vector<photongrid::uint>{1, 2, 3, 4});
    const auto sums = photongrid::prefix_sums(device, terms); // 1, 3, 6, 10
    //! [prefix_sums]
    expect(device.download(sums) == std::vector<photongrid::uint>{1, 3, 6, 10}, "prefix_sums");
}

void maps(device_type& device)
{
    const std::vector<photon> mine = photons_on_a_square();

    //! [make_grid]
    // 20 x 1 x 20 cells over a square of 1 m: each is 5 cm wide, and as flat as the photons.
    const photongrid::grid cells = photongrid::make_grid({-0.5f, 0, -0.5f}, {0.5f, 0, 0.5f}, {20, 1, 20});
    const photongrid::uint n = photongrid::cell_count(cells); // 400
    //! [make_grid]
    expect(n == 400, "make_grid");

    //! [upload_photons]
    photongrid::photons<device_type> p
        = photongrid::upload_photons(device, mine); // a vector of { vec3 position; vec3 power; }
    //! [upload_photons]
    expect(
        p.size() == mine.size() && device.download(p.powers)[0] == glm::vec4(1e-4f, 1e-4f, 1e-4f, 0), "upload_photons");

    const auto particles = photongrid::upload_photons(device, std::vector<particle>{{{1, 2, 3}, 5}});
    expect(device.download(particles.positions)[0] == glm::vec4(1, 2, 3, 0)
            && device.download(particles.powers)[0] == glm::vec4(5, 5, 5, 0),
        "photon_reader");

    //! [fitting_grid]
    const photongrid::grid fitted
        = photongrid::fitting_grid(device, p, 50, device.caps().cells_per_radius); // for the 50 nearest
    //! [fitting_grid]
    expect(photongrid::cell_count(fitted) > 100 && photongrid::cell_count(fitted) <= 12500, "fitting_grid");

    //! [sorted_map]
    const auto map = photongrid::sorted_map(device, std::move(p), cells);
    const glm::uvec2 range = device.download(map.cells)[0]; // cell 0 has the photons range.x to range.x + range.y - 1
    const photongrid::uint id
        = device.download(map.list)[range.x]; // the first of them is photon `id` of those uploaded
    //! [sorted_map]
    expect(range.y > 0 && mine[id].position.x < -0.45f && mine[id].position.z < -0.45f, "sorted_map");

    //! [block_map]
    const auto blocks = photongrid::block_map(device, photongrid::upload_photons(device, mine)); // no grid to choose
    //! [block_map]
    expect(blocks.has_blocks() && blocks.in_blocks == mine.size(), "block_map");

    //! [fitted_map]
    const auto ready
        = photongrid::fitted_map(device, photongrid::upload_photons(device, mine), 50); // for the 50 nearest
    //! [fitted_map]
    expect(ready.photons.size() == mine.size() && ready.invalid == 0, "fitted_map");
}

void routed_maps(device_type& device)
{
    const std::vector<photon> mine = photons_on_a_square();
    const photongrid::grid cells = photongrid::make_grid({-0.5f, 0, -0.5f}, {0.5f, 0, 0.5f}, {20, 1, 20});
    const photongrid::photons<device_type> p = photongrid::upload_photons(device, mine);

    //! [stencil_route]
    const auto routed = photongrid::stencil_route(device, p, cells, 4); // 4 x 4 slots per cell
    const std::vector<photongrid::uint> slots
        = device.download(routed.list); // 16 ids per cell, 0xFFFFFFFF where there are no more
    const glm::uvec2 first_cell = device.download(routed.cells)[0]; // (0, 16): it is full
    //! [stencil_route]
    expect(
        slots.size() == 6400 && first_cell == glm::uvec2(0, 16) && slots[0] < p.size() && routed.overflowing_cells > 0,
        "stencil_route");

    //! [routed_map]
    const auto approximate
        = photongrid::routed_map(device, photongrid::upload_photons(device, mine), cells, 4); // 4 x 4 slots per cell
    //! [routed_map]
    expect(approximate.overflowing_cells > 0 && device.download(approximate.cells)[0].y > 16, "routed_map");

    //! [redistributed_power]
    const double moved = photongrid::redistributed_power(device, approximate); // W, of 3 W in three channels
    //! [redistributed_power]
    const auto exact = photongrid::sorted_map(device, photongrid::upload_photons(device, mine), cells);
    expect(moved > 0.5 && moved < 3 && photongrid::redistributed_power(device, exact) == 0, "redistributed_power");
}

void hashed_maps(device_type& device)
{
    const std::vector<photon> mine = photons_on_a_square();

    //! [make_virtual_grid]
    // Cells of 1 mm in a cube of 1 m: a billion, none of which is stored.
    const photongrid::virtual_grid cells
        = photongrid::make_virtual_grid(glm::vec3(-0.5f), glm::vec3(0.5f), glm::uvec3(1000));
    const std::uint64_t n = photongrid::cell_count(cells); // 1000000000
    //! [make_virtual_grid]
    expect(n == 1000000000 && photongrid::cell_number(cells, glm::vec3(-0.5f)) == 0, "make_virtual_grid");

    //! [hashed_route]
    auto routed = photongrid::hashed_route(device, photongrid::upload_photons(device, mine), cells,
        {.kind = photongrid::bucket_kind::hash, .m = 4, .buckets = 300});      // 4 x 4 slots per bucket
    const photongrid::uint dropped = routed.dropped;                           // at least 10000 - 300 x 16
    const auto map = photongrid::block_map(device, std::move(routed.photons)); // what survives, as any photons
    //! [hashed_route]
    expect(dropped >= 5200 && map.photons.size() == 10000 - dropped, "hashed_route");

    //! [dropped_power]
    const double power = photongrid::redistributed_power(device, routed); // W, of 3 W in three channels
    //! [dropped_power]
    expect(is_near(static_cast<float>(power), 3e-4 * dropped, 1e-3), "dropped_power");
}

void estimates(device_type& device, const photongrid::map_buffers<device_type>& map)
{
    //! [upload_points]
    const std::vector<glm::vec3> queries{{0, 0, 0}, {0.1f, 0, 0.2f}}; // m
    const auto points = photongrid::upload_points(device, queries);
    //! [upload_points]
    expect(device.download(points)[1] == glm::vec4(0.1f, 0, 0.2f, 1), "upload_points");

    //! [knn_grid_estimate]
    const auto found = photongrid::knn_grid_estimate(device, map, points,
        {.k = 50, .max_radius = 0.2f, .filter = photongrid::filter_kind::silverman, .errors = true});
    const glm::vec4 light = device.download(found.irradiance)[0];     // rgb: W/m^2, w: squared radius, m^2
    const glm::vec4 error = device.download(found.standard_error)[0]; // rgb: W/m^2
    //! [knn_grid_estimate]
    expect(is_near(light.x, 1, 0.1) && is_near(light.w, 50 / (10000 * M_PI), 0.1) && error.x > 0 && error.x < 0.5f,
        "knn_grid_estimate");

    //! [upload_normals]
    const auto normals = photongrid::upload_normals(device, std::vector<glm::vec3>(2, {0, 1, 0}));
    photongrid::knn_settings flat{.k = 50, .max_radius = 0.2f};
    flat.leaks.flattening = 4; // distances along the normal count four times
    const auto in_discs = photongrid::knn_grid_estimate(device, map, points, normals, flat);
    //! [upload_normals]
    expect(is_near(device.download(in_discs.irradiance)[0].x, 1, 0.1), "upload_normals");

    //! [as_paper]
    const photongrid::knn_settings paper = photongrid::as_paper({.k = 50, .max_radius = 0.2f, .visits_per_pass = 16});
    //! [as_paper]
    expect(
        paper.search == photongrid::search_kind::at_least_k && paper.bias == photongrid::bias_kind::paper, "as_paper");

    std::vector<vectors> shown;
    const auto show = [&](const vectors& irradiances) { shown.push_back(irradiances); };
    //! [knn_search]
    photongrid::knn_search search(device, map, points, paper);
    while (!search.advance(1).finished)                       // one pass more
        show(device.download(search.estimates().irradiance)); // the running estimates (section 3.4)
    const auto last = device.download(search.estimates().irradiance);
    //! [knn_search]
    expect(shown.size() > 1 && shown.front() != last && is_near(last[0].x, 1, 0.1), "knn_search");

    //! [knn_neighbours]
    const auto lists = photongrid::knn_neighbours(device, map, points, {.k = 8});
    const auto ids = device.download(lists.ids);            // those of point 1 are ids[8] to ids[15], nearest first
    const auto squared = device.download(lists.distances2); // m^2
    //! [knn_neighbours]
    const auto offset = photons_on_a_square()[ids[8]].position - queries[1];
    expect(ids.size() == 16 && is_near(squared[8], static_cast<double>(glm::dot(offset, offset)), 1e-4)
            && std::is_sorted(squared.begin() + 8, squared.end()),
        "knn_neighbours");
}

void rays(device_type& device)
{
    //! [trace_rays]
    const photongrid::mesh square{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    const auto triangles = photongrid::upload_triangles(device, photongrid::build_triangle_tree(square));
    constexpr float no_end = std::numeric_limits<float>::infinity();
    const auto origins = photongrid::upload(device, vectors{{0.5f, 0, 3, no_end}, {2, 0, 3, no_end}});
    const auto directions = photongrid::upload(device, vectors{{0, 0, -2, 0}, {0, 0, -2, 0}});
    const auto hits = photongrid::trace_rays(device, triangles, origins, directions);
    //! [trace_rays]
    expect(hits[0] == photongrid::ray_hit{1.5f, 0} && hits[1].triangle == photongrid::no_id, "trace_rays");
}

void files(device_type& device, const photongrid::map_buffers<device_type>& map)
{
    const std::filesystem::path file = std::filesystem::temp_directory_path()
        / ("photongrid-snippets-" + std::to_string(std::random_device()()) + ".map");
    //! [save_map]
    photongrid::save_map(device, map, file, "a square, 10000 photons"); // whole, or not there
    //! [save_map]

    //! [load_map]
    std::string note;
    const auto again = photongrid::load_map(device, file, &note); // on any backend; map_file_error where it is damaged
    //! [load_map]
    std::filesystem::remove(file);
    expect(note == "a square, 10000 photons" && device.download(again.list) == device.download(map.list), "load_map");
}

/// A floor of 1 m about the origin, a wall behind it, a lamp.
photongrid::scene a_corner()
{
    photongrid::scene s;
    s.camera = {{0, 0.8, 2}, {0, 0.2, 0}, {0, 1, 0}, 45};
    s.materials = {{.name = "white", .reflectance = glm::dvec3(0.7)}};
    s.polygons = {{{{-0.5, 0, -0.5}, {-0.5, 0, 0.5}, {0.5, 0, 0.5}, {0.5, 0, -0.5}}, 0},
        {{{-0.5, 0, -0.5}, {0.5, 0, -0.5}, {0.5, 1, -0.5}, {-0.5, 1, -0.5}}, 0}};
    s.point_lights = {{.name = "lamp", .position = {0, 0.6, 0}, .power = glm::dvec3(10)}};
    return s;
}

void edges(device_type& device)
{
    const photongrid::scene room = a_corner();
    //! [upload_scene]
    const auto scene = photongrid::upload_scene(device, room);
    const glm::vec3 center(scene.layout.center); // the origin on the device, m: photons and points are relative to it
    //! [upload_scene]
    auto mine = photons_on_a_square();
    for (auto& p : mine)
        p.position -= center;
    const auto map = photongrid::fitted_map(device, photongrid::upload_photons(device, mine), 50);
    const auto points = photongrid::upload_points(device, std::vector<glm::vec3>{glm::vec3(0.5f, 0, 0) - center});
    const auto normals = photongrid::upload_normals(device, std::vector<glm::vec3>{{0, 1, 0}});
    const photongrid::knn_settings settings{.k = 50};
    auto found = photongrid::knn_grid_estimate(device, map, points, settings);
    const float before = device.download(found.irradiance)[0].x;
    //! [correct_edges]
    // A point on the floor's edge, where half of the disc hangs over: the estimate is half of the irradiance until
    // this is called.
    photongrid::correct_edges(device, scene, points, normals, found, settings.filter);
    //! [correct_edges]
    expect(is_near(before, 0.5, 0.15) && is_near(device.download(found.irradiance)[0].x, 1, 0.15), "correct_edges");
}

void progressive_pictures(
    device_type& device, const photongrid::scene& room, const photongrid::render_settings& settings)
{
    using namespace std::chrono_literals;
    photongrid::scene edited = room;
    std::vector<photongrid::image> window;
    const auto show = [&](const photongrid::image& shown) { window.push_back(shown); };

    //! [progressive_render]
    photongrid::progressive_render drawing(device);
    drawing.start(room, settings);
    while (!drawing.step(16ms))     // about 16 ms, but at least one pass
        if (drawing.pictures() > 0) // complete: at first few photons and large pixels
            show(drawing.picture());
    show(drawing.picture()); // the bytes of photongrid::render

    edited.camera.position.x += 0.1; // move the camera: the photon map is kept ...
    drawing.start(edited, settings);
    while (drawing.pictures() == 0)
        drawing.step(0ms);
    show(drawing.picture()); // ... and the first preview needs no new photons

    edited.point_lights[0].position.x += 0.1; // move the light: photons are traced again
    drawing.start(edited, settings);
    //! [progressive_render]
    expect(drawing.step() && drawing.maps() >= 2, "progressive_render");
    expect(window.size() >= 2
            && window[window.size() - 2].pixels == photongrid::render(device, room, settings).picture.pixels,
        "its last picture");
}

void pictures(device_type& device)
{
    const photongrid::scene room = a_corner();
    photongrid::render_settings settings = room.render;
    settings.output.width = 16;
    settings.output.height = 12;
    settings.map.photons = 1000;
    settings.estimate.k = 50;
    settings.estimate.max_radius = 0.5;
    settings.map.grid = glm::uvec3(0);

    //! [build_map]
    const auto built = photongrid::build_map(device, room, settings); // again only when the scene changes
    //! [build_map]
    expect(built.stats.map.cells > 0 && built.map().photons.size() == 1000, "build_map");

    //! [draw]
    const photongrid::camera from_above{.position = {0, 2, 0.5}, .look_at = {0, 0, 0}};
    const auto [above, stats] = photongrid::draw(device, built, from_above, settings); // no photon is traced
    const glm::vec3 radiance = above.pixels[6 * 16 + 8];                               // W/(m^2 sr)
    //! [draw]
    expect(radiance.x > 0 && stats.invalid_pixels == 0 && above.pixels.size() == std::size_t{16} * 12, "draw");

    //! [render]
    const photongrid::image picture = photongrid::render(device, room, settings).picture; // by the scene's own camera
    //! [render]
    expect(picture.pixels == photongrid::draw(device, built, room.camera, settings).picture.pixels, "render");
    progressive_pictures(device, room, settings);

    //! [prepare]
    const auto world = photongrid::prepare(device, room); // laid out and uploaded once, for any number of passes
    //! [prepare]
    //! [draw_pass]
    auto sum = photongrid::film_for(room, world->scene.layout, settings);
    sum.add(0, photongrid::draw_pass(device, world, room.camera, settings, 0)); // and so on, in any order
    const photongrid::image mean = sum.picture().picture;
    //! [draw_pass]
    expect(mean.pixels == picture.pixels, "draw_pass");

    //! [render_reference]
    const auto drawn = photongrid::render_reference(room, room.camera, {.width = 16, .height = 12, .spp = 64});
    const glm::vec3 value = drawn.mean.pixels[7 * 16 + 8],
                    error = drawn.standard_error.pixels[7 * 16 + 8]; // W/(m^2 sr)
    //! [render_reference]
    expect(error.x > 0 && std::abs(value.x - picture.pixels[7 * 16 + 8].x) < 0.2f * value.x, "render_reference");
}

void host_maps(device_type& device)
{
    const std::vector<glm::vec3> queries{{0, 0, 0}, {0.2f, 0, -0.1f}};
    {
        const auto photons = photons_on_a_square();
        //! [photon_map]
        const photongrid::photon_map map(device, photons, {.k = 400});
        for (const auto& e : map.irradiance(queries, {.standard_error = true}))
            std::cout << e.value.r << " +- " << e.error.r << " W/m^2 within " << e.radius << " m\n";
        photongrid::query_scratch scratch; // of this thread
        const auto here = map.irradiance(glm::vec3(0.1f, 0, 0.1f), glm::vec3(0, 1, 0), scratch);
        //! [photon_map]
        expect(is_near(here.value.r, 1, 0.1), "photon_map");
    }
    {
        const std::vector<glm::dvec3> points{{500000, 5400000, 300}, {500000.1, 5400000, 300}, {500001, 5400000, 300}};
        //! [point_index]
        const photongrid::point_index index(device, points);
        const auto nearest = index.nearest(points, 2); // of every point: itself, and the next one
        for (const auto& n : nearest[0])
            std::cout << "point " << n.id << " at " << std::sqrt(n.distance2) << " m\n";
        //! [point_index]
        expect(nearest[0].size() == 2 && nearest[0][1].id == 1, "point_index");
    }
}

} // namespace

int main()
try {
    buffers();
    device_type device;
    host_maps(device);
    algorithms(device);
    maps(device);
    routed_maps(device);
    hashed_maps(device);
    const auto map = photongrid::fitted_map(device, photongrid::upload_photons(device, photons_on_a_square()), 50);
    estimates(device, map);
    files(device, map);
    rays(device);
    edges(device);
    pictures(device);
} catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 1;
}
