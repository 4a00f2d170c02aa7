// JSON as a small tree in which every value has its position in the file, for messages with a line number. nlohmann's
// own tree has no positions.
#pragma once

#include <photongrid/io/scene_error.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace photongrid {

/// The kind of a value.
enum class json_kind { null, boolean, number, string, array, object };

/// A value. `place` is its offset in the text, `end` that of what follows it.
struct json_value {
    json_kind kind = json_kind::null;
    std::size_t place = 0, end = 0;
    bool truth = false;
    double number = 0;
    std::string text{};              ///< of a string; of a number, its text in the file
    std::vector<json_value> items{}; ///< of an array; of an object, each with its key
    std::string key{};
    std::size_t key_place = 0;

    /// An object's value for `key`, or null.
    const json_value* find(std::string_view key_wanted) const;
};

/// Limits of files; the values that are given are those of scene files.
struct json_limits {
    std::size_t bytes = std::size_t{16} << 20;
    std::size_t depth = 32;
    std::size_t values = 1'000'000;
};

/// A parsed file: its name for messages, its text and its tree.
class json_tree {
public:
    /// Parses `text`. Throws scene_error for a syntax error, a duplicate key, a number beyond double precision, or a
    /// limit exceeded.
    json_tree(std::string file, std::string text, const json_limits& limits = {});

    const json_value& root() const { return root_; }
    const std::string& text() const { return text_; }

    /// Throws scene_error for the value at `place`.
    [[noreturn]] void fail(std::size_t place, const std::string& what) const;

private:
    friend class json_builder;
    std::string file_, text_;
    json_limits limits_;
    json_value root_;
};

/// Describes a value for messages: `the number -1`, `the text "big"`, `an array of 2`.
std::string described(const json_value& v);

/// The candidate that is most similar to `word`, if `word` is probably a misspelling of it; otherwise empty.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// Reads a file's bytes, at most as many as a scene file has. Throws scene_error without a line.
std::string read_scene_text(const std::string& path);

} // namespace photongrid
