// XML files of Mitsuba: places, attributes, and the parameters in them.
#pragma once

#include <photongrid/io/import/import_log.hpp>
#include <photongrid/io/json_tree.hpp>
#include <photongrid/io/whole_file.hpp>

#include <pugixml.hpp>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace photongrid::mitsuba {

template <class Words>
bool is_one_of(std::string_view word, const Words& words)
{
    return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

inline std::string in_brackets(std::string_view tag) { return "<" + printable(tag, 40) + ">"; }

/// ", perhaps ..." of the word that is nearest to `word`, or "".
template <class Words>
std::string perhaps(std::string_view word, const Words& words, const std::string& before, const std::string& after)
{
    const auto near = nearest(word, std::vector<std::string>(std::begin(words), std::end(words)));
    return near.empty() ? "" : ", perhaps " + before + printable(near, 40) + after;
}

/// A file that is being read.
struct source_file {
    std::shared_ptr<const std::string> name;
    std::vector<std::size_t> lines{0}; ///< where they begin
    std::size_t include_depth = 0;
    bool is_old = false; ///< of Mitsuba 0.5 or 0.6

    source_file(std::shared_ptr<const std::string> name_, std::string_view text, std::size_t depth)
        : name(std::move(name_)), include_depth(depth)
    {
        for (auto at = text.find('\n'); at != text.npos; at = text.find('\n', at + 1))
            lines.push_back(at + 1);
    }
    source_place place_at(std::ptrdiff_t offset) const
    {
        if (offset < 0)
            return {name, 0, 0};
        const auto at = static_cast<std::size_t>(offset);
        const auto line = std::upper_bound(lines.begin(), lines.end(), at) - 1;
        return {name, static_cast<std::size_t>(line - lines.begin()) + 1, at - *line + 1};
    }
    source_place place_of(const pugi::xml_node& node) const
    {
        // Names of elements stand behind "<".
        return place_at(node.offset_debug() - (node.type() == pugi::node_element ? 1 : 0));
    }
};

/// \throws scene_error for an attribute that is not among `names`, or that is there twice.
inline void check_attributes(
    const source_file& f, const pugi::xml_node& node, std::initializer_list<std::string_view> names)
{
    std::vector<std::string_view> seen;
    for (const auto& a : node.attributes()) {
        if (!is_one_of(a.name(), names))
            fail_at(f.place_of(node),
                in_brackets(node.name()) + " has no attribute " + shown_word(a.name())
                    + perhaps(a.name(), names, "\"", "\""));
        if (is_one_of(a.name(), seen))
            fail_at(f.place_of(node), in_brackets(node.name()) + " has " + shown_word(a.name()) + " twice");
        seen.emplace_back(a.name());
    }
}

/// The parameters of a scene: what `<default>` says `$name` stands for.
class parameter_table {
public:
    static constexpr std::size_t max_bytes = 1'000; ///< of a value, so that values within each other stay bounded

    /// The first value of a name is valid.
    void define(const source_place& place, const std::string& name, const std::string& value)
    {
        if (name.empty() || name.size() > 100)
            fail_at(place, "the name of a parameter must have 1 to 100 bytes");
        if (value.size() > max_bytes)
            fail_at(place, "the value of a parameter has more than 1,000 bytes");
        values_.try_emplace(name, value);
    }

    /// A text with the values of its parameters.
    /// \throws scene_error for one that is not defined.
    std::string replaced(const source_place& place, std::string_view text) const
    {
        if (text.find('$') == text.npos)
            return std::string(text);
        std::string made;
        for (std::size_t at = 0; at < text.size();) {
            if (text[at] != '$') {
                made += text[at++];
                continue;
            }
            const auto& [name, value] = longest(place, text.substr(at + 1));
            made += value;
            at += 1 + name.size();
            if (made.size() > max_bytes)
                fail_at(place, "a value has more than 1,000 bytes with what its parameters stand for");
        }
        return made;
    }

private:
    /// The longest name with which a text begins: "$size2" may be $size with a 2 behind it.
    const std::pair<const std::string, std::string>& longest(const source_place& place, std::string_view text) const
    {
        const auto is_in_name = [](char c) {
            return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
        };
        const auto word = text.substr(
            0, static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_in_name) - text.begin()));
        for (std::size_t length = std::min<std::size_t>(word.size(), 100); length > 0; --length)
            if (const auto found = values_.find(word.substr(0, length)); found != values_.end())
                return *found;
        fail_at(place, "the parameter " + shown_word(word) + " is not defined; expected a <default> of it before this");
    }

    std::map<std::string, std::string, std::less<>> values_;
};

} // namespace photongrid::mitsuba
