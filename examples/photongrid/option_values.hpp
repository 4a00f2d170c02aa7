// Values of the command line, from text. Each throws CLI::ValidationError, which names the option.
#pragma once

#include "picture_series.hpp"

#include <photongrid/scene/setting_table.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace photongrid {

// By std::from_chars, so that "010" is ten and "1e9x" is an error. Whole numbers may have exponents, as 1e6 has, and no
// sign.
template <class T>
T parsed(const std::string& option, std::string_view text, const char* expected)
{
    const auto* const last = text.data() + text.size();
    T value{};
    auto result = std::from_chars(text.data(), last, value);
    if constexpr (std::is_integral_v<T>)
        if (result.ec == std::errc() && result.ptr != last) {
            double number = 0;
            result = std::from_chars(text.data(), last, number);
            // Beyond 2^53 a double cannot tell whole numbers apart.
            if (number != std::floor(number)
                || number > std::min(0x1p53, static_cast<double>(std::numeric_limits<T>::max())))
                result.ec = std::errc::result_out_of_range;
            else
                value = static_cast<T>(number);
        }
    if (result.ec != std::errc() || result.ptr != last)
        throw CLI::ValidationError(option, "\"" + std::string(text) + "\" given; expected " + expected);
    return value;
}

/// A finite number.
double parsed_number(const std::string& option, const std::string& text, const char* expected);
/// Width and height: WxH.
glm::uvec2 parsed_size(const std::string& option, const std::string& text);
/// Part of a picture, as X11 writes it: WxH+X+Y.
crop parsed_crop(const std::string& option, const std::string& text);

void add_whole(
    CLI::App& to, const std::string& option, std::optional<std::uint32_t>& target, const std::string& description);
void add_number(CLI::App& to, const std::string& option, std::optional<double>& target, const std::string& description,
    const char* type);

// A setting's value, and the type that --help shows for it.
std::uint32_t parsed_setting(const std::string& option, const std::string& text, const setting_table::whole_range&);
std::uint32_t parsed_setting(const std::string& option, const std::string& text, const setting_table::whole_or_auto&);
double parsed_setting(const std::string& option, const std::string& text, const setting_table::length_or_auto&);
double parsed_setting(const std::string& option, const std::string& text, const real_range&);
std::optional<double> parsed_setting(
    const std::string& option, const std::string& text, const setting_table::real_or_auto&);
/// Default settings with this width and height.
glm::uvec2 parsed_setting(const std::string& option, const std::string& text, const setting_table::pixels&);
glm::uvec3 parsed_setting(const std::string& option, const std::string& text, const setting_table::cells&);
leak_policy parsed_setting(const std::string& option, const std::string& text, const setting_table::policies&);
inline std::string type_of(const setting_table::whole_range&) { return "N"; }
inline std::string type_of(const setting_table::real_or_auto& r) { return std::string(r.range.unit + 1) + "|auto"; }
inline std::string type_of(const setting_table::whole_or_auto&) { return "N|auto"; }
inline std::string type_of(const setting_table::length_or_auto&) { return "METRES|auto"; }
inline std::string type_of(const real_range& r) { return r.unit[0] == ' ' ? r.unit + 1 : "NUMBER"; }
inline std::string type_of(const setting_table::pixels&) { return "WxH"; }
inline std::string type_of(const setting_table::cells&) { return "X,Y,Z|auto"; }
inline std::string type_of(const setting_table::policies&) { return "LIST"; }
template <class Value, std::size_t N>
std::string type_of(const setting_table::one_of<Value, N>& words)
{
    std::string all;
    for (const auto& n : words.values)
        all += (all.empty() ? "" : "|") + std::string(n.name);
    return all;
}

template <class Value, std::size_t N>
Value parsed_setting(const std::string& option, const std::string& text, const setting_table::one_of<Value, N>& words)
{
    if (const auto* value = words.find(text))
        return *value;
    throw CLI::ValidationError(option, "\"" + text + "\" given; expected " + type_of(words));
}

/// What --help adds about how a value is written.
template <class Values>
std::string syntax_of(const Values&)
{
    return "";
}
inline std::string syntax_of(const setting_table::policies&)
{
    return "; none, or comma-separated: side, min_cosine=C (without C 0.5), flattening=F (without F 4)";
}

/// --exposure of commands that take no other settings.
template <class Exposure>
void add_exposure(CLI::App& to, Exposure& target, const std::string& description)
{
    to.add_option_function<std::string>(
          "--exposure",
          [&target](
              const std::string& text) { target = parsed_setting("--exposure", text, setting_table::exposure.values); },
          description)
        ->type_name(type_of(setting_table::exposure.values));
}

} // namespace photongrid
