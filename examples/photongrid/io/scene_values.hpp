// Reads values of a scene file: numbers in a range, lengths and powers in the file's units, names and words. Each
// function throws scene_error "found …; expected …" with the value's line and column.
#pragma once

#include <photongrid/io/json_tree.hpp>
#include <photongrid/io/scene_keys.hpp>
#include <photongrid/scene/scene.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace photongrid {

/// `"a", "b" or "c"`.
std::string joined(const std::vector<std::string>& words);

/// A unit: a value in SI units is value * multiply / divide. Two whole numbers round better than a factor such as
/// 0.001.
struct unit {
    double multiply = 1, divide = 1;
};

/// A scene file as a tree, and functions that read its values.
class scene_values {
public:
    // Larger values could overflow single precision (squares and cubes of lengths, photons' powers).
    static constexpr double max_length = 1e9, max_power = 1e15;
    // The squares and cubes of smaller lengths underflow, and normals computed from them are not unit vectors.
    static constexpr double min_length = 1e-9;

    scene_values(const std::string& file, std::string text) : tree_(file, std::move(text)) {}

    const json_value& root() const { return tree_.root(); }
    [[noreturn]] void fail(std::size_t place, const std::string& what) const { tree_.fail(place, what); }

    /// Sets the units of lengths and powers to those of `v`.
    void read_units(const json_value& v);

    [[noreturn]] void wrong(const json_value& v, const std::string& expected) const
    {
        fail(v.place, "found " + described(v) + "; expected " + expected);
    }

    static const json_value& at(const json_value& object, std::string_view key) { return *object.find(key); }

    static std::vector<std::string> names(std::span<const scene_key> keys)
    {
        std::vector<std::string> all;
        for (const auto& k : keys)
            all.emplace_back(k.name);
        return all;
    }

    /// Checks the keys of `v` against those of `kind`: all required ones, and no unknown ones.
    void open(const json_value& v, std::string_view kind) const;

    /// The value of "type", one of `types`.
    const std::string& type_of(const json_value& v, const char* what, const std::vector<std::string>& types) const
    {
        if (v.kind != json_kind::object)
            wrong(v, std::string("an object: a ") + what);
        const auto* type = v.find("type");
        if (!type)
            fail(v.place, std::string("a ") + what + " lacks the key \"type\"; expected " + joined(types));
        return one_of(*type, types);
    }

    const std::string& one_of(const json_value& v, const std::vector<std::string>& words) const
    {
        if (v.kind != json_kind::string || std::find(words.begin(), words.end(), v.text) == words.end())
            wrong(v, joined(words));
        return v.text;
    }

    template <class Read>
    void read_list(const json_value& v, std::size_t limit, const char* what, Read&& read) const
    {
        if (v.kind != json_kind::array)
            wrong(v, std::string("an array of ") + what);
        if (v.items.size() > limit)
            fail(v.items[limit].place,
                std::to_string(v.items.size()) + " " + what + "; expected at most " + std::to_string(limit));
        for (const auto& item : v.items)
            read(item);
    }

    // --- numbers ---
    double number(const json_value& v, double low, double high, const std::string& expected) const
    {
        if (v.kind != json_kind::number || !(v.number >= low && v.number <= high))
            wrong(v, expected);
        return v.number;
    }

    double in_range(const json_value& v, const real_range& r, const std::string& what = "a number") const
    {
        return number(v, r.least, r.most, what + " from " + r.ends());
    }

    /// `or_else`: what may be there instead, for the message.
    std::uint32_t whole(
        const json_value& v, std::uint32_t low, std::uint32_t high, const std::string& or_else = "") const
    {
        const auto expected = "a whole number from " + std::to_string(low) + " to " + std::to_string(high) + or_else;
        const double d = number(v, low, high, expected);
        if (d != std::floor(d))
            wrong(v, expected);
        return static_cast<std::uint32_t>(d);
    }

    double in_units(const json_value& v, const unit& u, double low, double high, const std::string& expected) const
    {
        if (v.kind != json_kind::number)
            wrong(v, expected);
        const double d = v.number * u.multiply / u.divide;
        if (!(d >= low && d <= high))
            wrong(v, expected);
        return d;
    }

    double length(const json_value& v) const
    {
        return in_units(v, length_, -max_length, max_length, "a length of at most 1e9 m");
    }
    double radius(const json_value& v, const std::string& or_else = "") const
    {
        return in_units(v, length_, min_length, max_length, "a length from 1e-9 m to 1e9 m" + or_else);
    }

    template <class Element>
    dvec3 three(const json_value& v, const char* expected, Element&& element) const
    {
        if (v.kind != json_kind::array || v.items.size() != 3)
            wrong(v, expected);
        return {element(v.items[0]), element(v.items[1]), element(v.items[2])};
    }

    dvec3 point(const json_value& v) const
    {
        return three(v, "a point: [x, y, z]", [&](const json_value& c) { return length(c); });
    }

    dvec3 direction(const json_value& v) const
    {
        const auto d = three(v, "a direction: [x, y, z]",
            [&](const json_value& c) { return number(c, -1e9, 1e9, "a number from -1e9 to 1e9"); });
        if (glm::length(d) < 1e-9)
            fail(v.place, "found a direction shorter than 1e-9; expected a longer one");
        return d;
    }

    /// Three channels, or one number for all of them.
    template <class Element>
    dvec3 rgb(const json_value& v, const char* expected, Element&& element) const
    {
        return v.kind == json_kind::number ? dvec3(element(v)) : three(v, expected, element);
    }

    dvec3 rgb_in_range(const json_value& v, const real_range& r) const
    {
        return rgb(v, ("[red, green, blue] or one number, each from " + r.ends()).c_str(),
            [&](const json_value& c) { return in_range(c, r); });
    }

    dvec3 power(const json_value& v) const
    {
        return rgb(v, "[red, green, blue] or one number: power",
            [&](const json_value& c) { return in_units(c, power_, 0, max_power, "a power from 0 to 1e15 W"); });
    }

    /// Of distant light, in SI units in every file.
    dvec3 emission(const json_value& v) const
    {
        return rgb(v, "[red, green, blue] or one number: W/m^2 or W/(m^2 sr)",
            [&](const json_value& c) { return number(c, 0, max_power, "a number from 0 to 1e15"); });
    }

    double angle(const json_value& v) const { return number(v, 0, 180, "an angle from 0 to 180 degrees"); }

    /// Names appear in messages, so control characters are not allowed.
    static bool is_name(const std::string& text)
    {
        return !text.empty() && text.size() <= 100 && std::none_of(text.begin(), text.end(), [](char c) {
            return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
        });
    }

    std::string read_name(const json_value& v) const
    {
        if (v.kind != json_kind::string || !is_name(v.text))
            wrong(v, "a name: text of 1 to 100 bytes without control characters");
        return v.text;
    }

protected:
    unit length_, power_; ///< of the file

private:
    json_tree tree_;
};

} // namespace photongrid
