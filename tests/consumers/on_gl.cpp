#include <photongrid/backends/gl/gl.hpp>

#include "nearest.hpp"

int main()
{
    photongrid::gl_backend device;
    return consumer::nearest(device);
}
