// render<serial_backend> as a function, for tests that need the picture alone.
#pragma once

#include <photongrid/render/image.hpp>
#include <photongrid/scene/scene.hpp>

namespace photongrid {

image serial_picture(const scene& s, const render_settings& settings);

} // namespace photongrid
