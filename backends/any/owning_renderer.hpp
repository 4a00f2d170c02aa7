// A renderer that owns its backend. Included once per backend; slow to compile.
#pragma once

#include <photongrid/backends/any/backend_entry.hpp>
#include <photongrid/render/progressive_render.hpp>

#include <utility>

namespace photongrid::any {

/// A base class, so that the backend is constructed before the renderer that refers to it.
template <class B>
struct backend_holder {
    B held;
};

/// A renderer and its backend, made from the backend's arguments.
template <class B>
struct owning_renderer final : private backend_holder<B>, public progressive_render<B> {
    template <class... Arguments>
    explicit owning_renderer(Arguments&&... arguments)
        : backend_holder<B>{B(std::forward<Arguments>(arguments)...)}, progressive_render<B>(backend_holder<B>::held)
    {
    }
};

} // namespace photongrid::any
