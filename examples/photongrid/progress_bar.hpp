// A line on the terminal that shows the progress of a picture.
#pragma once

#include <photongrid/render/render_state.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
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

    /// A stage that shares no work with others.
    void show(std::string_view stage, double fraction) { show(stage, fraction, ""); }
    /// The whole picture, and how long the rest of it takes; the current stage as long as that is not known.
    void show(const render_progress& now, double error)
    {
        std::string more;
        if (now.passes > 0)
            more += ", passes " + std::to_string(now.passes);
        if (std::isfinite(now.seconds_left))
            more += ", " + duration(now.seconds_left) + " left";
        if (std::isfinite(error))
            more += ", error " + with_digits(error) + foreseen(now, ": ");
        show(now.stage, std::isfinite(now.seconds_left) ? now.whole : now.fraction, more);
    }

    /// ", 0.02 in about 40 s, 0.01 in about 3 min", with `begin` in place of the first comma; "" if nothing is known.
    static std::string foreseen(const render_progress& now, const char* begin)
    {
        std::string text;
        for (const auto& e : now.errors)
            text += (text.empty() ? begin : ", ") + with_digits(e.error) + " in about " + duration(e.seconds);
        return text;
    }
    /// "4 s", "2 min 5 s", "3 h 20 min"
    static std::string duration(double seconds)
    {
        if (!(seconds < 1e9))
            return "years";
        const auto s = static_cast<std::uint64_t>(std::ceil(seconds));
        if (s < 60)
            return std::to_string(s) + " s";
        if (s < 3600)
            return std::to_string(s / 60) + " min " + std::to_string(s % 60) + " s";
        return std::to_string(s / 3600) + " h " + std::to_string(s / 60 % 60) + " min";
    }
    static std::string with_digits(double x)
    {
        char text[32];
        std::snprintf(text, sizeof text, "%.2g", x);
        return text;
    }

    void clear()
    {
        if (drawn_)
            std::fputs("\r\033[K", stderr);
        drawn_ = false;
    }

private:
    void show(std::string_view stage, double fraction, const std::string& more)
    {
        const auto now = std::chrono::steady_clock::now();
        if (!on_ || (stage == stage_ && now - last_ < std::chrono::milliseconds(50)))
            return;
        stage_ = stage;
        last_ = now;
        const double part = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
        const auto done = static_cast<std::size_t>(part * width);
        const std::string bar = std::string(done, '#') + std::string(width - done, ' ');
        std::fprintf(stderr, "\r[%s] %3.0f %% %s%s\033[K", bar.c_str(), 100 * part, stage_.c_str(), more.c_str());
        std::fflush(stderr);
        drawn_ = true;
    }

    static constexpr std::size_t width = 40;
    bool on_ = false, drawn_ = false;
    std::string stage_;
    std::chrono::steady_clock::time_point last_;
};

} // namespace photongrid
