// The file of --journal: what happens in the window, one line of JSON per event.
#pragma once

#include "display.hpp"

#include <cstdint>
#include <fstream>
#include <mutex>
#include <string>

namespace photongrid::viewer {

class journal_file {
public:
    /// An empty path: nothing is written.
    /// \throws file_error if it cannot be written.
    explicit journal_file(const std::string& path);

    bool is_open() const { return out_.is_open(); }
    /// A line of the renderer's, from any thread.
    void note(const std::string& line);
    /// Where the controls are, when that has changed.
    void note(const control_places& places);
    /// Something that has to do with a file or a scene: an event, the name of a detail, and the detail.
    void note(const char* event, const char* name, const std::string& detail);
    /// The window has closed.
    void note_end(std::uint64_t turns, std::uint64_t slow_turns, double slowest_ms);

private:
    std::mutex guard_;
    std::ofstream out_;
    control_places noted_;
};

} // namespace photongrid::viewer
