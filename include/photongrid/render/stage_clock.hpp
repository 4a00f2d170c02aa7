// Measures the stages of the paper's Table 1 on the device.
#pragma once

#include <photongrid/core/backend.hpp>
#include <photongrid/render/render_stats.hpp>

#include <algorithm>
#include <chrono>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

/// Adds a stage's time and passes to its statistics. It waits for the device at the beginning and the end.
template <backend B>
class stage_clock {
public:
    stage_clock(B& device, stage_stats& out) : device_(device), out_(out)
    {
        device_.finish();
        before_ = total_cost(device_.costs());
        start_ = std::chrono::steady_clock::now();
    }
    stage_clock(const stage_clock&) = delete;
    stage_clock& operator=(const stage_clock&) = delete;
    /// Ends the stage. Call it while the stage's buffers still exist.
    void stop()
    {
        device_.finish();
        const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
        const auto now = total_cost(device_.costs());
        out_.compile_ms += now.compile_ms - before_.compile_ms;
        out_.ms += ms - (now.compile_ms - before_.compile_ms);
        out_.passes += now.passes - before_.passes;
        out_.device_bytes = std::max(out_.device_bytes, device_.bytes());
    }

private:
    B& device_;
    stage_stats& out_;
    kernel_cost before_;
    std::chrono::steady_clock::time_point start_;
};

/// Runs `work` and adds its time to `out`.
template <backend B, class Work>
void time_stage(B& device, stage_stats& out, const Work& work)
{
    stage_clock<B> clock(device, out);
    work();
    clock.stop();
}

} // namespace photongrid::detail

#include <photongrid/core/exact_end.hpp>
