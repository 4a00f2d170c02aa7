// The manual's snippets of the OpenGL backend, run and checked.
#include "expect.hpp"

#include <photongrid/backends/gl/gl.hpp>
#include <photongrid/map/prefix_sums.hpp>

#include <iostream>

namespace {

/// Why no context can be had; "": one can.
std::string refusal()
{
    try {
        const photongrid::gl_backend any({.context = photongrid::gl_context_kind::egl});
        return {};
    } catch (const photongrid::backend_error& e) {
        return e.what();
    }
}

void snippets(photongrid::gl_backend& device)
{
    const auto terms = photongrid::upload(device, std::vector<photongrid::uint>{1, 2, 3, 4});
    auto sums = photongrid::prefix_sums(device, terms);
    const std::vector<photongrid::uint> expected{1, 3, 6, 10};

    //! [texture_of]
    const photongrid::gl_texture t
        = device.texture_of(sums); // t.name for glBindTextureUnit(); the buffer still owns it
    //! [texture_of]
    expect(t.name != 0 && t.width == 4 && t.height == 1 && t.internal_format == GL_R32UI, "texture_of");

    //! [release]
    const photongrid::gl_texture mine = device.release(std::move(sums)); // to be deleted by glDeleteTextures() one day
    //! [release]
    // NOLINTNEXTLINE(bugprone-use-after-move): a released buffer is empty
    expect(mine.name == t.name && sums.size() == 0, "release");

    //! [adopt]
    const auto again
        = device.adopt<photongrid::uint>(mine.name, 4); // a buffer over a texture of the caller's, without a copy
    //! [adopt]
    expect(device.download(again) == expected && device.texture_of(again).name == mine.name, "adopt");
} // the backend destroys its context, and the context the texture

} // namespace

int main()
try {
    if (const std::string why = refusal(); !why.empty()) {
        std::cerr << why << '\n';
        return 77; // ctest: skipped
    }
    //! [gl_backend]
    photongrid::gl_backend device(
        {.context = photongrid::gl_context_kind::egl}); // current: in the context that you have current
    const std::string name = device.caps().device;      // the driver's words
    //! [gl_backend]
    expect(name.find("OpenGL") != std::string::npos, "gl_backend");
    snippets(device);
} catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 1;
}
