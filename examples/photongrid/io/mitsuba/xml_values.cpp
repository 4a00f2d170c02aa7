#include <photongrid/io/import/token_reader.hpp>
#include <photongrid/io/mitsuba/xml_values.hpp>

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace photongrid::mitsuba {

namespace {
    bool is_large(char c) { return c >= 'A' && c <= 'Z'; }
    char small(char c) { return is_large(c) ? static_cast<char>(c + ('a' - 'A')) : c; }

    double decoded(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); } // IEC 61966-2-1

    std::optional<std::vector<double>> hexadecimal(std::string_view word)
    {
        unsigned value = 0;
        if (word.size() != 7 || word[0] != '#')
            return std::nullopt;
        const auto [end, wrong] = std::from_chars(word.data() + 1, word.data() + word.size(), value, 16);
        if (wrong != std::errc() || end != word.data() + word.size())
            return std::nullopt;
        return std::vector<double>{(value >> 16) / 255.0, (value >> 8 & 255) / 255.0, (value & 255) / 255.0};
    }

    glm::dmat4 look_at(const element& e)
    {
        const auto triple = [&](const char* name) {
            const auto numbers = numbers_of(e.place, e.attribute(name));
            if (numbers.size() != 3)
                fail_at(
                    e.place, std::string("the attribute \"") + name + "\" of <" + e.tag + "> must be three numbers");
            return dvec3(numbers[0], numbers[1], numbers[2]);
        };
        const dvec3 origin = triple("origin"), way = triple("target") - origin;
        const double length = glm::length(way);
        if (!(length > 0) || !std::isfinite(length))
            fail_at(e.place, "the origin and the target of <" + e.tag + "> are the same point");
        const dvec3 forward = way / length;
        auto up = e.attribute("up").empty() ? dvec3(0) : triple("up");
        if (up == dvec3(0))
            up = beside(forward);
        const dvec3 left = glm::cross(up, forward);
        if (!(glm::length(left) > 1e-12 * glm::length(up)) || !std::isfinite(glm::length(left)))
            fail_at(e.place, "<" + e.tag + "> looks along its \"up\"");
        const dvec3 x = glm::normalize(left);
        return {glm::dvec4(x, 0), glm::dvec4(glm::cross(forward, x), 0), glm::dvec4(forward, 0), glm::dvec4(origin, 1)};
    }

    /// Mitsuba writes matrices row by row.
    glm::dmat4 matrix_of(const element& e)
    {
        const auto numbers = numbers_of(e.place, e.attribute("value"));
        if (numbers.size() != 16 && numbers.size() != 9)
            fail_at(e.place,
                "found a matrix of " + std::to_string(numbers.size())
                    + " numbers; expected 16, or 9 without "
                      "a translation");
        const int n = numbers.size() == 16 ? 4 : 3;
        glm::dmat4 m(1);
        auto number = numbers.begin();
        for (int row = 0; row < n; ++row)
            for (int column = 0; column < n; ++column)
                m[column][row] = *number++;
        return m;
    }
} // namespace

std::string snake_case(std::string_view name)
{
    std::string made;
    for (std::size_t i = 0; i < name.size(); ++i) {
        if (i > 0 && is_large(name[i]) && !is_large(name[i - 1]) && name[i - 1] != '_')
            made += '_';
        made += small(name[i]);
    }
    return made;
}

std::vector<std::string_view> words_of(std::string_view text)
{
    constexpr std::string_view between = " \t\r\n,;";
    std::vector<std::string_view> words;
    for (auto begin = text.find_first_not_of(between); begin != text.npos;) {
        const auto end = std::min(text.find_first_of(between, begin), text.size());
        words.push_back(text.substr(begin, end - begin));
        begin = text.find_first_not_of(between, end);
    }
    return words;
}

std::vector<double> numbers_of(const source_place& place, std::string_view text)
{
    std::vector<double> all;
    for (const auto& word : words_of(text)) {
        const auto number = token_reader::number_of(word);
        if (!number)
            fail_at(place, "found " + shown_word(word) + "; expected a number");
        all.push_back(*number);
    }
    return all;
}

std::vector<double> color_of(const element& e)
{
    const auto text = e.attribute("value");
    const auto words = words_of(text);
    auto color = words.size() == 1 ? hexadecimal(words[0]) : std::nullopt;
    if (!color)
        color = numbers_of(e.place, text);
    if (color->size() == 1)
        color->resize(3, color->front());
    if (color->size() != 3)
        fail_at(e.place,
            "found a colour of " + std::to_string(color->size()) + " numbers; expected one, three, or #rrggbb");
    if (e.tag == "srgb")
        std::transform(color->begin(), color->end(), color->begin(), decoded);
    return *color;
}

sampled_spectrum samples_of(const source_place& place, std::vector<double> wavelengths, std::vector<double> values)
{
    if (wavelengths.empty() || wavelengths.size() != values.size())
        fail_at(place, "a spectrum has as many values as wavelengths, at least one");
    if (std::adjacent_find(wavelengths.begin(), wavelengths.end(), std::greater_equal<>()) != wavelengths.end())
        fail_at(place, "the wavelengths of a spectrum do not ascend");
    return {std::move(wavelengths), std::move(values)};
}

sampled_spectrum samples_of(const source_place& place, std::string_view text)
{
    std::vector<double> wavelengths, values;
    for (const auto& word : words_of(text)) {
        const auto colon = word.find(':');
        const auto wavelength = token_reader::number_of(word.substr(0, colon)),
                   value = colon == word.npos ? std::nullopt : token_reader::number_of(word.substr(colon + 1));
        if (!wavelength || !value)
            fail_at(place, "found " + shown_word(word) + "; expected a wavelength, nm, and a value, as 500:0.6");
        wavelengths.push_back(*wavelength);
        values.push_back(*value);
    }
    return samples_of(place, std::move(wavelengths), std::move(values));
}

dvec3 vector_of(const element& e, std::optional<double> if_absent)
{
    const char* const names[] = {"x", "y", "z"};
    if (const auto text = e.attribute("value"); !text.empty()) {
        for (const auto* name : names)
            if (!e.attribute(name).empty())
                fail_at(e.place, "<" + e.tag + "> has \"value\" and \"" + name + "\"; expected one of both");
        const auto numbers = numbers_of(e.place, text);
        if (numbers.size() == 1)
            return dvec3(numbers[0]);
        if (numbers.size() != 3)
            fail_at(e.place,
                "found a vector of " + std::to_string(numbers.size()) + " numbers; expected three, or one for all");
        return {numbers[0], numbers[1], numbers[2]};
    }
    dvec3 made;
    for (int axis = 0; axis < 3; ++axis) {
        const auto numbers = numbers_of(e.place, e.attribute(names[axis]));
        if (numbers.size() > 1 || (numbers.empty() && !if_absent))
            fail_at(e.place, "<" + e.tag + "> lacks one number \"" + names[axis] + "\"");
        made[axis] = numbers.empty() ? *if_absent : numbers[0];
    }
    return made;
}

glm::dmat4 transformation_of(const element& e)
{
    if (e.tag == "translate")
        return glm::translate(glm::dmat4(1), vector_of(e, 0));
    if (e.tag == "scale")
        return glm::scale(glm::dmat4(1), vector_of(e, 1));
    if (e.tag == "rotate") {
        const auto axis = vector_of(e, 0);
        const auto angle = numbers_of(e.place, e.attribute("angle"));
        if (angle.size() != 1)
            fail_at(e.place, "<rotate> lacks one number \"angle\", in degrees");
        if (!(glm::length(axis) > 0) || !std::isfinite(glm::length(axis)))
            fail_at(e.place, "<rotate> about an axis of length 0");
        return glm::rotate(glm::dmat4(1), glm::radians(angle[0]), axis);
    }
    return e.tag == "matrix" ? matrix_of(e) : look_at(e);
}

dvec3 beside(const dvec3& n)
{
    const double sign = std::copysign(1.0, n.z), a = -1 / (sign + n.z);
    return {1 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

} // namespace photongrid::mitsuba
