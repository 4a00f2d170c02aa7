// Distributes jobs over threads, and reports progress to an observer.
#pragma once

#include <photongrid/render/render_stats.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <string_view>
#include <thread>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// Progress of the jobs of `share_out`. A job calls goes_on(n) when n more units of work are done; the result says
/// whether to continue. Only the calling thread calls the observer.
class watch {
public:
    /// For a stage with `units` of work. The thread that constructs it is the one that calls the observer.
    watch(const render_observer& observer, std::string_view stage, double units)
        : observer_(observer), stage_(stage), units_(units)
    {
    }

    /// Adds `done` units. Returns false if the job must stop.
    bool goes_on(std::uint64_t done)
    {
        done_ += done;
        if (std::this_thread::get_id() == caller_)
            report();
        return !stop_;
    }
    /// Reports progress to the observer and asks whether to cancel. Only in the calling thread.
    void report()
    {
        if (observer_.progress)
            observer_.progress(stage_, static_cast<double>(done_) / units_);
        if (observer_.cancelled && observer_.cancelled())
            stop_ = cancelled_ = true;
    }
    /// Makes goes_on() return false from now on, in every thread.
    void stop() { stop_ = true; }
    /// Whether the observer cancelled the work.
    bool was_cancelled() const { return cancelled_; }

private:
    const render_observer& observer_;
    std::string_view stage_;
    double units_;
    std::thread::id caller_ = std::this_thread::get_id();
    std::atomic<std::uint64_t> done_{0};
    std::atomic<bool> stop_{false}, cancelled_{false};
};

/// `asked` or, if it is 0, the machine's number of threads; at least 1.
inline std::uint32_t threads_for(std::uint32_t asked)
{
    return asked > 0 ? asked : std::max(1u, std::thread::hardware_concurrency());
}

/// Runs job(i, watch) for i = 0 … n-1, in any order, on `threads` threads including the caller's. `units` is the work
/// of all jobs together.
/// \throws render_cancelled, or what a job throws.
template <class Job>
void share_out(std::uint32_t n, std::uint32_t threads, std::string_view stage, double units,
    const render_observer& observer, Job job)
{
    watch w(observer, stage, units);
    std::atomic<std::uint32_t> next{0}, at_work{0};
    std::exception_ptr failure;
    std::mutex failing;
    const auto work = [&] {
        try {
            for (std::uint32_t i = next++; i < n && w.goes_on(0); i = next++)
                job(i, w);
        } catch (...) {
            const std::lock_guard lock(failing);
            failure = std::current_exception();
            w.stop();
        }
    };
    {
        std::vector<std::jthread> others;
        try {
            for (std::uint32_t t = 1; t < std::min(threads, n); ++t) {
                ++at_work;
                others.emplace_back([&] {
                    work();
                    --at_work;
                });
            }
        } catch (const std::system_error&) {
            --at_work; // no more threads available: the others do all the work
        }
        work();
        while (at_work > 0) {
            try {
                w.report();
            } catch (...) {
                const std::lock_guard lock(failing);
                failure = std::current_exception();
                w.stop();
                break;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
    }
    if (failure)
        std::rethrow_exception(failure);
    if (w.was_cancelled())
        throw render_cancelled();
}

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
