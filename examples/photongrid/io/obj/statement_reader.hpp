// The statements of OBJ and MTL files: lines, the words and numbers on them, and where they stand.
#pragma once

#include <photongrid/io/import/import_log.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace photongrid::obj {

/// `text` in UTF-8 without a byte order mark. `converted` gets the characters of a text in UTF-16.
std::string_view as_utf8(std::string_view text, std::string& converted);

/// Goes through a text by lines and words. A line ends with a backslash where it goes on in the next one.
class statement_reader {
public:
    /// `file`: the text's name in messages. `text` must be in UTF-8, and outlive the reader.
    statement_reader(std::shared_ptr<const std::string> file, std::string_view text)
        : file_(std::move(file)), text_(text),
          end_of_line_(text.find('\n') == text.npos && text.find('\r') != text.npos ? '\r' : '\n')
    {
    }

    /// A place in the text. What makes a line and a column of it counts characters, so that it takes longer.
    struct mark {
        std::size_t line = 0, begin = 0, at = 0;
    };
    mark here() const { return {line_, begin_, at_}; }
    source_place place_of(const mark& m) const
    {
        const auto before = text_.substr(m.begin, m.at - m.begin);
        const auto characters
            = std::count_if(before.begin(), before.end(), [](char c) { return (c & 0xC0) != 0x80; }); // UTF-8
        return {file_, m.line, static_cast<std::size_t>(characters) + 1};
    }
    /// Goes back to a place on this line.
    void go_back(const mark& m) { at_ = m.at; }
    [[noreturn]] void fail(const mark& m, const std::string& what) const { fail_at(place_of(m), what); }

    /// Goes to the next line. Returns whether there is one.
    bool next_line()
    {
        if (end_ >= text_.size() && line_ > 0)
            return false;
        begin_ = line_ > 0 ? end_ + 1 : 0;
        ++line_;
        end_ = std::min(text_.find(end_of_line_, begin_), text_.size());
        at_ = begin_;
        return begin_ < text_.size();
    }
    /// Goes to the next word of the statement. Returns whether there is one.
    bool find_word()
    {
        for (;;) {
            while (at_ < end_ && is_blank(text_[at_]))
                ++at_;
            if (at_ < end_ && text_[at_] == '\\' && text_.find_first_not_of(" \t\r", at_ + 1) >= end_) {
                if (!next_line())
                    return false;
                continue;
            }
            return at_ < end_ && text_[at_] != '#';
        }
    }
    std::string_view word()
    {
        const auto from = at_;
        while (at_ < end_ && !is_blank(text_[at_]))
            ++at_;
        return text_.substr(from, at_ - from);
    }
    /// Goes past all words of the statement.
    void skip()
    {
        while (find_word())
            word();
    }
    /// All that is left of the statement, for names with blanks and with "#" in them; without blanks around it.
    std::string rest()
    {
        std::string all;
        for (;;) {
            auto piece = trimmed(text_.substr(at_, end_ - at_));
            at_ = end_;
            if (!piece.ends_with('\\'))
                return all += piece;
            piece.remove_suffix(1);
            all.append(trimmed(piece)) += ' ';
            if (!next_line())
                return std::string(trimmed(all));
        }
    }
    [[noreturn]] void fail_at_word(const std::string& expected)
    {
        const auto place = here();
        fail(place, "found " + (find_word() ? shown_word(word()) : "the end of the line") + "; expected " + expected);
    }
    void expect_end()
    {
        if (find_word())
            fail_at_word("the end of the line");
    }

    /// A number whose size is at most `most`.
    double number(double most, const char* expected)
    {
        if (!find_word())
            fail_at_word(expected);
        const auto place = at_;
        double d = 0;
        if (!is_number(word(), d) || !(std::abs(d) <= most)) {
            at_ = place;
            fail_at_word(expected);
        }
        return d;
    }
    /// Whether a number is next; it is not read.
    bool sees_number()
    {
        if (!find_word())
            return false;
        const auto place = at_;
        double d = 0;
        const bool is_one = is_number(word(), d) && std::isfinite(d);
        at_ = place;
        return is_one;
    }

    /// A number, or NaN for one that is not finite, such as "-nan(ind)" or 1e400: it is the mesh's reader that knows
    /// what to do without it.
    double any_number(const char* expected)
    {
        if (!find_word())
            fail_at_word(expected);
        const auto place = at_;
        double d = 0;
        const auto w = word();
        if (is_number(w, d) && std::abs(d) <= 1e18)
            return d;
        const auto [past, wrong] = std::from_chars(w.data() + (w.starts_with('+') ? 1 : 0), w.data() + w.size(), d);
        if (past == w.data() + w.size() && wrong != std::errc::invalid_argument)
            return std::numeric_limits<double>::quiet_NaN();
        at_ = place;
        fail_at_word(expected);
    }

    static std::string_view trimmed(std::string_view s)
    {
        while (!s.empty() && is_blank(s.front()))
            s.remove_prefix(1);
        while (!s.empty() && is_blank(s.back()))
            s.remove_suffix(1);
        return s;
    }

private:
    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
    static bool is_number(std::string_view w, double& d)
    {
        if (w.size() > 1 && w[0] == '+' && w[1] != '-')
            w.remove_prefix(1);
        const auto [past, wrong] = std::from_chars(w.data(), w.data() + w.size(), d);
        // from_chars leaves d as it was where the number is too small, or too large
        return past == w.data() + w.size()
            && (wrong == std::errc() || (wrong == std::errc::result_out_of_range && is_small(w)));
    }
    static bool is_small(std::string_view w)
    {
        const auto e = w.find_first_of("eE");
        return e != std::string_view::npos && e + 1 < w.size() && w[e + 1] == '-';
    }

    std::shared_ptr<const std::string> file_;
    std::string_view text_;
    char end_of_line_;
    std::size_t begin_ = 0, end_ = 0, at_ = 0, line_ = 0; ///< of the line that is read
};

} // namespace photongrid::obj
