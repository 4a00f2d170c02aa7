// A job on one backend: the two steps of figure 1. Included once per backend; slow to compile.
#pragma once

#include "backends.hpp"

#include <photongrid/render.hpp>

namespace photongrid {

template <backend B>
render_result render_on(B& b, const render_job& job)
{
    render_result r;
    const auto map = build_map(b, job.scene, job.settings, job.observer, r.stats);
    r.picture = draw(b, map, job.scene.camera, job.settings, job.observer, r.stats);
    r.caps = b.caps();
    r.costs = b.costs();
    return r;
}

} // namespace photongrid
