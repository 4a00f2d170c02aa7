// Scene files and pictures; no header of JSON, EXR or PNG is read.
#include <photongrid/io/image_file.hpp>
#include <photongrid/io/scene_file.hpp>
#include <photongrid/io/scene_writer.hpp>

#include <cstdio>
#include <iostream>

int main()
{
    photongrid::scene s;
    s.materials = {{"white", photongrid::material_kind::lambertian, photongrid::dvec3(0.7)}};
    s.spheres = {{{0, 0, 0}, 1, 0}};
    s.point_lights = {{"lamp", {0, 3, 0}, photongrid::dvec3(10)}};
    s.camera = {{0, 1, 4}, {0, 0, 0}, {0, 1, 0}, 40};
    s.name = "ball";
    const bool same = photongrid::parse_scene("ball.json", photongrid::scene_text(s, s.render)) == s;

    const photongrid::image picture{.width = 2, .height = 1, .pixels = {{1, 2, 3}, {4, 5, 6}}};
    photongrid::write_image("consumer.exr", picture);
    const bool same_picture = photongrid::read_image("consumer.exr").pixels == picture.pixels;
    std::remove("consumer.exr");
    std::cout << "the same scene: " << same << ", the same picture: " << same_picture << '\n';
    return same && same_picture ? 0 : 1;
}
