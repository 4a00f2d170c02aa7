// render<serial_backend> as a function, compiled once, in serial_pictures.cpp: who needs the picture alone does not
// read how it is made.
#pragma once

#include <photongrid/render/image.hpp>
#include <photongrid/scene/scene.hpp>

namespace photongrid {

image serial_picture(const scene& s, const render_settings& settings);

} // namespace photongrid
