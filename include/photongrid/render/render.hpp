// Draws a whole picture: the mean of passes over one world, each of which is figure 1 of the paper.
//
// The loop over passes is that of progressive_render, which the program, the window and photongrid::renderer run.
#pragma once

#include <photongrid/render/draw.hpp>
#include <photongrid/render/progressive_render.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Draws a picture with the scene's own camera: the mean of output.passes passes, each with its own photons, eye rays
/// and shadow rays, or of as many as a stop rule asks for (picture_end.hpp); at least one is whole.
/// \throws what progressive_render throws, render_cancelled.
/// \snippet snippets.cpp render
template <backend B>
[[nodiscard]] rendered render(
    B& device, const scene& s, const render_settings& settings, const render_observer& observer = {})
{
    progressive_render<B> drawing(device);
    return render(static_cast<renderer&>(drawing), s, settings, observer);
}
/// The same with the scene's own settings.
template <backend B>
[[nodiscard]] rendered render(B& device, const scene& s)
{
    return render(device, s, s.render);
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
