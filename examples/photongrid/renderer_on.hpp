// A renderer on one backend. Included once per backend; slow to compile.
#pragma once

#include "backends.hpp"

#include <photongrid/render/progressive_render.hpp>

namespace photongrid {

template <backend B>
class renderer_on final : public renderer {
public:
    template <class... Arguments>
    explicit renderer_on(Arguments&&... arguments) : backend_(std::forward<Arguments>(arguments)...), drawing_(backend_)
    {
    }

    void start(const scene& s, const render_settings& settings, const preview_settings& previews) override
    {
        drawing_.start(s, settings, previews);
    }
    void resume(render_state state) override { drawing_.resume(std::move(state)); }
    render_state state() override { return drawing_.state(); }
    bool step(double budget_ms) override { return drawing_.step(std::chrono::duration<double, std::milli>(budget_ms)); }
    void cancel() override { drawing_.cancel(); }
    bool finished() const override { return drawing_.finished(); }
    std::uint64_t pictures() const override { return drawing_.pictures(); }
    image picture() override { return drawing_.picture(); }
    render_progress progress() const override { return drawing_.progress(); }
    const render_stats& stats() const override { return drawing_.stats(); }
    std::uint64_t maps() const override { return drawing_.maps(); }
    const capabilities& caps() const override { return backend_.caps(); }
    const std::map<std::string, kernel_cost>& costs() const override { return backend_.costs(); }

private:
    B backend_;
    progressive_render<B> drawing_;
};

} // namespace photongrid
