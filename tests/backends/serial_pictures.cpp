#define PHOTONGRID_PICTURES_COMPILED_HERE
#include "serial_pictures.hpp"

#include "serial_picture.hpp"

photongrid::image photongrid::serial_picture(const scene& s, const render_settings& settings)
{
    serial_backend b;
    return render(b, s, settings).picture;
}
