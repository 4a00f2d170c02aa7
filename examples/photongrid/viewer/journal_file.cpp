#include "journal_file.hpp"

#include <photongrid/io/files.hpp>

#include <nlohmann/json.hpp>

namespace photongrid::viewer {

journal_file::journal_file(const std::string& path)
{
    if (path.empty())
        return;
    out_.open(path);
    if (!out_.is_open())
        throw file_error(path + ": cannot be written");
}

void journal_file::note(const std::string& line)
{
    const std::lock_guard lock(guard_);
    if (is_open())
        out_ << line << std::endl; // whole lines, at once: a test reads along
}

void journal_file::note(const control_places& places)
{
    if (!is_open() || places == noted_)
        return;
    noted_ = places;
    std::string all;
    for (const auto& [label, c] : places)
        all += (all.empty() ? "\"" : ", \"") + label + "\": [" + std::to_string(c.x) + ", " + std::to_string(c.y) + ", "
            + std::to_string(c.width) + ", " + std::to_string(c.height) + "]";
    note("{\"event\": \"controls\", \"places\": {" + all + "}}");
}

void journal_file::note(const char* event, const char* name, const std::string& detail)
{
    const nlohmann::json line{{"event", event}, {name, detail}};
    note(line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)); // paths may be no UTF-8
}

void journal_file::note_end(std::uint64_t turns, std::uint64_t slow_turns, double slowest_ms)
{
    note("{\"event\": \"closed\", \"turns\": " + std::to_string(turns) + ", \"turns_above_33_ms\": "
        + std::to_string(slow_turns) + ", \"slowest_turn_ms\": " + std::to_string(slowest_ms) + "}");
}

} // namespace photongrid::viewer
