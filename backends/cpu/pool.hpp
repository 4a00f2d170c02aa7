// The thread pool of the cpu backend: distributes blocks of a fixed size over threads (oneTBB).
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::cpu {

/// A thread pool. Blocks, and so results per block, do not depend on the number of threads. With one thread everything
/// runs in the caller's thread.
class pool {
public:
    /// `threads`: 0 for as many as the machine has.
    /// \throws std::invalid_argument for more than 4,096.
    explicit pool(unsigned threads)
        : threads_(threads != 0 ? threads : static_cast<unsigned>(std::max(1, tbb::info::default_concurrency())))
    {
        if (threads_ > 4096)
            throw std::invalid_argument("cpu: threads: " + std::to_string(threads_)
                + "; it must be from 1 to 4,096, or 0 for as many as the machine has");
        if (threads_ > static_cast<unsigned>(tbb::info::default_concurrency()))
            more_.emplace(tbb::global_control::max_allowed_parallelism, threads_); // more threads than cores
        if (threads_ > 1)
            arena_.emplace(static_cast<int>(threads_));
    }

    unsigned threads() const { return threads_; }

    /// Calls f(first, past) for every block of [0, n), in any order, and waits for all. Blocks have `block` elements,
    /// the last one possibly fewer.
    template <class F>
    void for_blocks(std::size_t n, std::size_t block, const F& f)
    {
        run_blocks(n, block, &f, [](const void* called, std::size_t first, std::size_t past) {
            (*static_cast<const F*>(called))(first, past);
        });
    }

private:
    /// No template, and not inlined, so that the compiler makes oneTBB's code once and not for each kernel.
    [[gnu::noinline]] void run_blocks(
        std::size_t n, std::size_t block, const void* called, void (*call)(const void*, std::size_t, std::size_t))
    {
        const std::size_t blocks = n / block + (n % block != 0 ? 1 : 0);
        const auto one = [&](std::size_t i) { call(called, i * block, std::min(n, (i + 1) * block)); };
        if (!arena_ || blocks < 2) {
            for (std::size_t i = 0; i < blocks; ++i)
                one(i);
            return;
        }
        arena_->execute([&] {
            tbb::parallel_for(
                tbb::blocked_range<std::size_t>(0, blocks, 1),
                [&](const tbb::blocked_range<std::size_t>& r) {
                    for (std::size_t i = r.begin(); i != r.end(); ++i)
                        one(i);
                },
                tbb::simple_partitioner());
        });
    }

    unsigned threads_;
    std::optional<tbb::global_control> more_;
    std::optional<tbb::task_arena> arena_;
};

} // namespace photongrid::cpu

#include <photongrid/core/exact_end.hpp>
