#include "smoke.hpp"

#include <photongrid/backends/gl/gl.hpp>

int main()
{
    photongrid::gl_backend b;
    return photongrid::testing::smoke(b);
}
