// Text in pbrt-v4's language.
#pragma once

#include <photongrid/scene/check.hpp>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <charconv>
#include <span>
#include <string>
#include <string_view>

namespace photongrid::pbrt_export {

/// A text that grows. Numbers are the shortest that read as the same ones.
class text_writer {
public:
    text_writer& word(std::string_view w)
    {
        text_ += w;
        return *this;
    }
    text_writer& line(std::string_view w = "")
    {
        text_ += w;
        text_ += '\n';
        return *this;
    }
    text_writer& quoted(std::string_view w)
    {
        text_ += '"';
        for (const char c : w) {
            if (c == '"' || c == '\\')
                text_ += '\\';
            text_ += static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? '?' : c;
        }
        text_ += '"';
        return *this;
    }
    template <class Number>
    text_writer& number(Number n)
    {
        char digits[40];
        text_.append(digits, std::to_chars(digits, digits + sizeof digits, n).ptr);
        return *this;
    }
    template <int N, class Number>
    text_writer& numbers(const glm::vec<N, Number>& v)
    {
        for (int i = 0; i < N; ++i)
            word(i > 0 ? " " : "").number(v[i]);
        return *this;
    }

    /// A parameter: ` "rgb L" [ 1 2 3 ]`.
    text_writer& parameter(std::string_view declaration, const dvec3& v)
    {
        return word(" ").quoted(declaration).word(" [ ").numbers(v).word(" ]");
    }
    text_writer& parameter(std::string_view declaration, double v)
    {
        return word(" ").quoted(declaration).word(" ").number(v);
    }
    text_writer& parameter(std::string_view declaration, std::uint64_t v)
    {
        return word(" ").quoted(declaration).word(" ").number(v);
    }
    text_writer& parameter(std::string_view declaration, std::string_view text)
    {
        return word(" ").quoted(declaration).word(" ").quoted(text);
    }
    template <int N, class Number>
    text_writer& parameter(std::string_view declaration, std::span<const glm::vec<N, Number>> all)
    {
        word(" ").quoted(declaration).word(" [");
        for (const auto& v : all)
            word("  ").numbers(v);
        return word(" ]");
    }

    /// Transform, from a shape's space to the scene's.
    text_writer& transform(const glm::dmat3& linear, const dvec3& offset)
    {
        word("  Transform [ ");
        for (int column = 0; column < 3; ++column)
            numbers(linear[column]).word(" 0  ");
        return numbers(offset).line(" 1 ]");
    }

    std::string take() { return std::move(text_); }

private:
    std::string text_;
};

} // namespace photongrid::pbrt_export
