// Reads text word by word, as files of pbrt are, and the spectra in files that other formats use too.
#pragma once

#include <photongrid/io/import/import_log.hpp>
#include <photongrid/io/whole_file.hpp>

#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace photongrid {

/// A word, a text in quotes, or a bracket. "#" begins a comment.
struct token {
    enum class kind { word, quoted, open, close } is = kind::word;
    std::string_view text; ///< of a quoted one without its quotes, with its escapes
    std::size_t line = 0, column = 0;
};

/// Reads a file token by token.
class token_reader {
public:
    token_reader(std::shared_ptr<const std::string> file, std::string_view text) : file_(std::move(file)), text_(text)
    {
        peek_ = read();
    }

    /// The next token, which stays the next one; none at the end.
    const std::optional<token>& peek() const { return peek_; }

    std::optional<token> next()
    {
        auto t = peek_;
        peek_ = read();
        return t;
    }

    source_place place_of(const token& t) const { return {file_, t.line, t.column}; }
    /// That of the next token, or of the end.
    source_place place() const { return peek_ ? place_of(*peek_) : source_place(file_, line_, at_ - line_begin_ + 1); }

    [[noreturn]] void fail_at_next(const std::string& expected) const
    {
        fail_at(place(), "found " + shown(peek_) + "; expected " + expected);
    }

    /// A text in quotes.
    std::string quoted(const char* expected)
    {
        if (!peek_ || peek_->is != token::kind::quoted)
            fail_at_next(expected);
        return unescaped(*next());
    }

    double number(const char* expected)
    {
        const auto value = peek_ && peek_->is == token::kind::word ? number_of(peek_->text) : std::nullopt;
        if (!value)
            fail_at_next(expected);
        next();
        return *value;
    }

    /// The number that a word is; none if it is no finite number.
    static std::optional<double> number_of(std::string_view word)
    {
        if (word.size() > 1 && word[0] == '+' && word[1] != '-')
            word.remove_prefix(1);
        double d = 0;
        const auto [end, wrong] = std::from_chars(word.data(), word.data() + word.size(), d);
        if (end != word.data() + word.size() || wrong == std::errc::invalid_argument)
            return std::nullopt;
        if (wrong == std::errc::result_out_of_range) { // from_chars leaves d as it was: too small, or too large
            const auto exponent = word.find_first_of("eE");
            const bool is_small = exponent != std::string_view::npos && exponent + 1 < word.size()
                ? word[exponent + 1] == '-'
                : word.find_first_of("123456789") > word.find('.');
            return is_small ? std::optional(0.0) : std::nullopt;
        }
        return std::isfinite(d) ? std::optional(d) : std::nullopt;
    }

    std::string unescaped(const token& t) const
    {
        std::string plain;
        for (std::size_t i = 0; i < t.text.size(); ++i) {
            char c = t.text[i];
            if (c == '\\' && i + 1 < t.text.size())
                switch (c = t.text[++i]) {
                case 'b': c = '\b'; break;
                case 'f': c = '\f'; break;
                case 'n': c = '\n'; break;
                case 'r': c = '\r'; break;
                case 't': c = '\t'; break;
                case '"':
                case '\'':
                case '\\': break;
                default: fail_at(place_of(t), "found the escape " + shown_word(t.text.substr(i - 1, 2)));
                }
            plain += c;
        }
        return plain;
    }

private:
    static std::string shown(const std::optional<token>& t)
    {
        return !t                          ? "the end of the file"
            : t->is == token::kind::open   ? "["
            : t->is == token::kind::close  ? "]"
            : t->is == token::kind::quoted ? "the text " + shown_word(t->text)
                                           : shown_word(t->text);
    }
    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

    std::optional<token> read()
    {
        skip_blanks();
        if (at_ >= text_.size())
            return std::nullopt;
        token t{.text = {}, .line = line_, .column = at_ - line_begin_ + 1};
        const auto begin = at_;
        switch (text_[at_]) {
        case '[':
        case ']': t.is = text_[at_++] == '[' ? token::kind::open : token::kind::close; return t;
        case '"':
            t.is = token::kind::quoted;
            for (++at_; at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\n'; ++at_)
                if (text_[at_] == '\\')
                    ++at_;
            if (at_ >= text_.size() || text_[at_] != '"')
                fail_at(place_of(t), "found a text without its second quote on the line");
            t.text = text_.substr(begin + 1, at_ - begin - 1);
            ++at_;
            return t;
        default:
            while (at_ < text_.size() && !is_blank(text_[at_])
                && std::string_view("\"[]#").find(text_[at_]) == std::string_view::npos)
                ++at_;
            t.text = text_.substr(begin, at_ - begin);
            return t;
        }
    }
    void skip_blanks()
    {
        for (; at_ < text_.size(); ++at_)
            if (text_[at_] == '\n') {
                ++line_;
                line_begin_ = at_ + 1;
            } else if (text_[at_] == '#') {
                at_ = std::min(text_.find('\n', at_), text_.size()) - 1;
            } else if (!is_blank(text_[at_])) {
                return;
            }
    }

    std::shared_ptr<const std::string> file_;
    std::string_view text_;
    std::size_t at_ = 0, line_ = 1, line_begin_ = 0;
    std::optional<token> peek_;
};

} // namespace photongrid
