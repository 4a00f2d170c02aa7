// Where things stand in files that are read, and notes on them.
#pragma once

#include <photongrid/io/imported_scene.hpp>

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace photongrid {

/// A place in a file that is read. Lines and columns count from 1. Line 0: the file as a whole.
struct source_place {
    std::shared_ptr<const std::string> file; ///< its name in messages; not null
    std::size_t line = 0, column = 0;

    explicit source_place(const std::string& name) : file(std::make_shared<const std::string>(name)) {}
    source_place(std::shared_ptr<const std::string> name, std::size_t line_, std::size_t column_)
        : file(std::move(name)), line(line_), column(column_)
    {
    }
};

/// \throws scene_error.
[[noreturn]] inline void fail_at(const source_place& place, const std::string& what)
{
    throw scene_error(*place.file, place.line, place.column, what);
}

/// Collects notes on what is replaced or left out.
class import_log {
public:
    explicit import_log(bool strict) : strict_(strict) {}

    /// \throws scene_error in place of a note if notes are not allowed.
    void add(const source_place& place, const std::string& what)
    {
        if (strict_)
            fail_at(place, what + " (refused, since nothing may be replaced or left out)");
        say(place, what);
    }

    /// Adds what is neither replaced nor left out, such as a camera for a file that has none.
    void say(const source_place& place, const std::string& what)
    {
        if (notes_.size() < max_notes)
            notes_.push_back({*place.file, place.line, place.column, what});
        else if (notes_.size() == max_notes)
            notes_.push_back({*place.file, place.line, place.column, "more notes follow, which are not listed"});
    }

    /// The notes, which are no longer here then.
    std::vector<import_note> take() { return std::move(notes_); }

private:
    static constexpr std::size_t max_notes = 10'000;
    bool strict_;
    std::vector<import_note> notes_;
};

/// How the files of a scene are read: with notes in a log, which must outlive it.
inline file_reading file_reading_of(const import_settings& settings, import_log& log)
{
    return {.before_reading = settings.before_reading,
        .note = [&log](const std::string& path, const std::string& what) { log.add(source_place(path), what); },
        .max_pixels = settings.max_pixels};
}

} // namespace photongrid
