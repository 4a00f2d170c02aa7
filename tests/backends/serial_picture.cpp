#include "serial_picture.hpp"

#include "serial_pictures.hpp"

photongrid::image photongrid::serial_picture(const scene& s, const render_settings& settings)
{
    serial_backend b;
    return render(b, s, settings).picture;
}
