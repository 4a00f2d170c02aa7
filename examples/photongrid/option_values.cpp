#include "option_values.hpp"

#include <algorithm>
#include <vector>

namespace photongrid {

double parsed_number(const std::string& option, const std::string& text, const char* expected)
{
    const auto value = parsed<double>(option, text, expected);
    if (!std::isfinite(value))
        throw CLI::ValidationError(option, "\"" + text + "\" given; expected " + expected);
    return value;
}

namespace {
    // Defaults of --leaks min_cosine and flattening if given without a value: 60 degrees, and a disc four times as wide
    // as high.
    constexpr float usual_cosine = 0.5f, usual_flattening = 4;

    /// Whole numbers with `separator` between them.
    template <glm::length_t N>
    glm::vec<N, glm::uint> parsed_list(
        const std::string& option, std::string_view text, char separator, const char* expected)
    {
        const auto wrong = [&, whole = std::string(text)] {
            throw CLI::ValidationError(option, "\"" + whole + "\" given; expected " + expected);
        };
        glm::vec<N, glm::uint> v(0);
        for (glm::length_t i = 0; i < N; ++i) {
            const auto end = i + 1 < N ? text.find(separator) : text.size();
            if (end == std::string_view::npos)
                wrong();
            try {
                v[i] = parsed<glm::uint>(option, text.substr(0, end), expected);
            } catch (const CLI::ValidationError&) { // which quotes a part
                wrong();
            }
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        return v;
    }

    /// A number at or between two limits, as single precision holds it.
    float parsed_from(const std::string& option, const std::string& text, double low, double high, const char* expected)
    {
        const double value = parsed_number(option, text, expected);
        if (value < low || value > high)
            throw CLI::ValidationError(option, "\"" + text + "\" given; expected " + expected);
        return static_cast<float>(value);
    }

    /// Policies with commas between them, each at most once; or `none`.
    leak_policy parsed_leaks(const std::string& option, const std::string& text)
    {
        if (text == "none")
            return {};
        leak_policy leaks;
        std::vector<std::string> given;
        for (std::size_t at = 0; at <= text.size();) {
            const auto end = std::min(text.find(',', at), text.size());
            const auto policy = text.substr(at, end - at);
            const auto name = policy.substr(0, policy.find('='));
            const bool with_value = name.size() < policy.size();
            const auto value = with_value ? policy.substr(name.size() + 1) : "";
            if (std::find(given.begin(), given.end(), name) != given.end())
                throw CLI::ValidationError(
                    option, ('"' + text).append("\" has ").append(name).append(" twice; expected each policy once"));
            given.push_back(name);
            if (policy == "side")
                leaks.side = true;
            else if (name == "min_cosine")
                leaks.min_cosine = with_value
                    ? parsed_from(option, value, -1, 1, "min_cosine=COS, a cosine from -1 to 1")
                    : usual_cosine;
            else if (name == "flattening")
                leaks.flattening = with_value
                    ? parsed_from(option, value, 1, 1e6, "flattening=F, a ratio from 1 to 1e6")
                    : usual_flattening;
            else if (policy == "none")
                throw CLI::ValidationError(option, "\"" + text + "\" given; expected none alone, or a list without it");
            else
                throw CLI::ValidationError(option,
                    "\"" + policy
                        + "\" given; expected none, or some of side, min_cosine, min_cosine=COS, flattening, "
                          "flattening=F with commas "
                          "between them");
            at = end + 1;
        }
        return leaks;
    }
} // namespace

glm::uvec2 parsed_size(const std::string& option, const std::string& text)
{
    return parsed_list<2>(option, text, 'x', "width and height: WxH");
}

crop parsed_crop(const std::string& option, const std::string& text)
{
    const char* const expected = "a part of the picture, WxH+X+Y, with at least one pixel";
    const auto plus = text.find('+');
    if (plus == std::string::npos)
        throw CLI::ValidationError(option, "\"" + text + "\" given; expected " + expected);
    const auto size = parsed_list<2>(option, std::string_view(text).substr(0, plus), 'x', expected);
    const auto corner = parsed_list<2>(option, std::string_view(text).substr(plus + 1), '+', expected);
    if (size.x < 1 || size.y < 1)
        throw CLI::ValidationError(option, "\"" + text + "\" given; expected " + expected);
    return {corner.x, corner.y, size.x, size.y};
}

void add_whole(
    CLI::App& to, const std::string& option, std::optional<std::uint32_t>& target, const std::string& description)
{
    to.add_option_function<std::string>(
          option,
          [&target, option](
              const std::string& text) { target = parsed<std::uint32_t>(option, text, "a whole number"); },
          description)
        ->type_name("N");
}

void add_number(CLI::App& to, const std::string& option, std::optional<double>& target, const std::string& description,
    const char* type)
{
    to.add_option_function<std::string>(
          option, [&target, option](const std::string& text) { target = parsed_number(option, text, "a number"); },
          description)
        ->type_name(type);
}

std::uint32_t parsed_setting(const std::string& option, const std::string& text, const setting_table::whole_range&)
{
    return parsed<std::uint32_t>(option, text, "a whole number");
}
namespace {
    /// `given`, unless it is the number that means auto.
    template <class Values, class Value>
    Value checked(const std::string& option, const std::string& text, const Values& values, Value given)
    {
        if (given == values.automatic)
            throw CLI::ValidationError(option, "\"" + text + "\" given; it is out of range");
        return given;
    }
} // namespace
std::uint32_t parsed_setting(const std::string& option, const std::string& text, const setting_table::whole_or_auto& r)
{
    return text == "auto" ? r.automatic
                          : checked(option, text, r, parsed<std::uint32_t>(option, text, "a whole number, or auto"));
}
double parsed_setting(const std::string& option, const std::string& text, const setting_table::length_or_auto& r)
{
    return text == "auto" ? r.automatic : checked(option, text, r, parsed_number(option, text, "a number, or auto"));
}
double parsed_setting(const std::string& option, const std::string& text, const real_range&)
{
    return parsed_number(option, text, "a number");
}
std::optional<double> parsed_setting(
    const std::string& option, const std::string& text, const setting_table::real_or_auto&)
{
    return text == "auto" ? std::nullopt : std::optional(parsed_number(option, text, "a number, or auto"));
}
glm::uvec2 parsed_setting(const std::string& option, const std::string& text, const setting_table::pixels&)
{
    return parsed_size(option, text);
}
glm::uvec3 parsed_setting(const std::string& option, const std::string& text, const setting_table::cells&)
{
    if (text == "auto")
        return glm::uvec3(0);
    const auto grid = parsed_list<3>(option, text, ',', "three whole numbers, X,Y,Z, or auto");
    if (grid.x < 1 || grid.y < 1 || grid.z < 1)
        throw CLI::ValidationError(option, "\"" + text + "\" given; each axis needs at least one cell");
    return grid;
}

leak_policy parsed_setting(const std::string& option, const std::string& text, const setting_table::policies&)
{
    return parsed_leaks(option, text);
}

} // namespace photongrid
