// A line on the terminal that shows the current stage and its progress.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>

#include <unistd.h>

namespace photongrid {

class progress_bar {
public:
    /// Draws on stderr if that is a terminal and not `quiet`.
    explicit progress_bar(bool quiet) : on_(!quiet && ::isatty(STDERR_FILENO) == 1) {}
    progress_bar(const progress_bar&) = delete;
    progress_bar& operator=(const progress_bar&) = delete;
    ~progress_bar() { clear(); }

    void show(std::string_view stage, double fraction)
    {
        const auto now = std::chrono::steady_clock::now();
        if (!on_ || (stage == stage_ && now - last_ < std::chrono::milliseconds(50)))
            return;
        stage_ = stage;
        last_ = now;
        const double part = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
        const auto done = static_cast<std::size_t>(part * width);
        const std::string bar = std::string(done, '#') + std::string(width - done, ' ');
        std::fprintf(stderr, "\r[%s] %3.0f %% %-17s", bar.c_str(), 100 * part, stage_.c_str());
        std::fflush(stderr);
        drawn_ = true;
    }

    void clear()
    {
        if (drawn_)
            std::fputs("\r\033[K", stderr);
        drawn_ = false;
    }

private:
    static constexpr std::size_t width = 40;
    bool on_ = false, drawn_ = false;
    std::string stage_;
    std::chrono::steady_clock::time_point last_;
};

} // namespace photongrid
