// Rewrites kernels for devices whose division and square root round loosely (self_test.hpp finds out): Vulkan and GL
// allow an error of 2.5 units in the last place.
#pragma once

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string>
#include <string_view>

namespace photongrid {

namespace detail {
    /// Copies GLSL and replaces quotients and square roots. It knows as much of the grammar as that needs: operands are
    /// names, numbers and brackets with what follows them (calls, subscripts, members), and `*`, `/` and `%` bind more
    /// tightly than all other operators between operands, and from left to right.
    class arithmetic_writer {
    public:
        explicit arithmetic_writer(std::string_view text) : text_(text) {}

        std::string all()
        {
            std::string out;
            while (at_ < text_.size()) { // a closing bracket of nothing is copied
                out += sequence(true);
                if (at_ < text_.size())
                    out += text_[at_++];
            }
            return out;
        }

    private:
        bool starts(std::string_view s) const { return text_.substr(at_).starts_with(s); }
        static bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
        static bool is_digit(char c) { return c >= '0' && c <= '9'; }
        static bool is_number(std::string_view s)
        {
            return !s.empty() && (is_digit(s[0]) || s[0] == '.') && s.find_first_of("*/%(") == s.npos;
        }
        char peek(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
        bool at_line_start() const
        {
            const auto before = text_.substr(0, at_).find_last_not_of(" \t");
            return before == text_.npos || text_[before] == '\n';
        }

        /// White space, comments and the preprocessor's lines.
        std::string_view blanks()
        {
            const auto begin = at_;
            while (at_ < text_.size()) {
                if (std::isspace(static_cast<unsigned char>(text_[at_])))
                    ++at_;
                else if (starts("//"))
                    at_ = std::min(text_.find('\n', at_), text_.size());
                else if (starts("/*"))
                    at_ = text_.find("*/", at_ + 2) == text_.npos ? text_.size() : text_.find("*/", at_ + 2) + 2;
                else if (text_[at_] == '#' && at_line_start())
                    for (bool more = true; more && at_ < text_.size();) { // a backslash continues the line
                        const auto end = std::min(text_.find('\n', at_), text_.size());
                        more = end > at_ && text_[end - 1] == '\\';
                        at_ = std::min(end + 1, text_.size());
                    }
                else
                    break;
            }
            return text_.substr(begin, at_ - begin);
        }

        std::string_view word_or_number()
        {
            const auto begin = at_;
            const bool number = !std::isalpha(static_cast<unsigned char>(peek())) && peek() != '_';
            while (is_word(peek()) || (number && peek() == '.')
                || (number && (peek() == '-' || peek() == '+') && (text_[at_ - 1] == 'e' || text_[at_ - 1] == 'E')
                    && !text_.substr(begin).starts_with("0x")))
                ++at_;
            return text_.substr(begin, at_ - begin);
        }

        /// What stands in brackets, which are consumed. Subscripts and sizes of arrays are integers: left alone.
        std::string bracketed(bool rewrite)
        {
            const char open = text_[at_++];
            std::string out(1, open);
            ++depth_;
            out += sequence(rewrite && open != '[');
            --depth_;
            if (at_ < text_.size())
                out += text_[at_++];
            return out;
        }

        /// An operand with its calls, subscripts and members.
        std::string operand(bool rewrite)
        {
            std::string out;
            if (peek() == '(') {
                out = bracketed(rewrite);
            } else {
                const auto word = word_or_number();
                out = word;
                constexpr std::string_view keywords[]
                    = {"return", "else", "case", "const", "if", "for", "while", "switch", "do"};
                if (is_number(word) || std::ranges::find(keywords, word) != std::end(keywords))
                    return out;
                const auto end = at_;
                const auto blank = blanks();
                if (peek() != '(' && peek() != '[')
                    at_ = end;
                else
                    out = (rewrite && word == "sqrt" && peek() == '(' ? "exact_root" : out) + std::string(blank);
            }
            while (true) {
                if (peek() == '(' || peek() == '[')
                    out += bracketed(rewrite);
                else if (peek() == '.' && (std::isalpha(static_cast<unsigned char>(peek(1))) || peek(1) == '_'))
                    (out += '.') += (++at_, word_or_number());
                else
                    return out;
            }
        }

        static void divide_exactly(std::string& product, const std::string& divisor)
        {
            product = "exact_quotient(" + product + "," + divisor + ")";
        }

        /// Up to a closing bracket.
        std::string sequence(bool rewrite)
        {
            std::string out, product; // a product or quotient so far
            char pending = '\0';      // the operator that awaits its right operand
            bool constant = false;    // in a global declaration with `const`, whose value is a constant expression
            const auto flush = [&] {
                out += product;
                product.clear();
                if (pending != '\0')
                    out += pending;
                pending = '\0';
            };
            while (true) {
                const std::string blank(blanks());
                const char c = peek();
                const bool ends = at_ >= text_.size() || c == ')' || c == ']' || c == '}';
                const bool is_operand = !ends && (is_word(c) || c == '(' || (c == '.' && is_digit(peek(1))));
                if (is_operand || (pending != '\0' && (c == '-' || c == '+' || c == '~' || c == '!'))) {
                    std::string right;
                    while (peek() == '-' || peek() == '+' || peek() == '~' || peek() == '!')
                        (right += text_[at_++]) += blanks();
                    right += operand(rewrite);
                    if (pending == '/' && rewrite && !constant && !(is_number(product) && is_number(right))) {
                        divide_exactly(product, blank + right);
                    } else if (pending != '\0') {
                        (product += pending) += blank + right;
                    } else {
                        flush();
                        out += blank;
                        product = right;
                        constant = constant || (right == "const" && depth_ == 0);
                    }
                    pending = '\0';
                    continue;
                }
                if (!product.empty() && pending == '\0' && (c == '*' || c == '/' || c == '%') && peek(1) != '=') {
                    product += blank;
                    pending = text_[at_++];
                    continue;
                }
                flush();
                out += blank;
                if (ends)
                    return out;
                if (c == ';')
                    constant = false;
                out += c == '{' || c == '[' ? bracketed(rewrite) : std::string(1, text_[at_++]);
            }
        }

        std::string_view text_;
        std::size_t at_ = 0;
        unsigned depth_ = 0; // brackets around
    };
} // namespace detail

/// How a backend on a GPU computes quotients and square roots.
enum class arithmetic_kind {
    automatic, ///< the device's, unless they round loosely and rewritten ones do not
    of_device, ///< the device's
    rewritten, ///< by exact_arithmetic.glsl
};

/// A kernel's GLSL with `a / b` replaced by `exact_quotient(a, b)`, and `sqrt(x)` by `exact_root(x)`, which
/// exact_arithmetic.glsl defines. Lines stay where they are. Quotients of two literals, in subscripts and in
/// global declarations with `const` are left to the compiler.
inline std::string with_exact_arithmetic(std::string_view glsl) { return detail::arithmetic_writer(glsl).all(); }

} // namespace photongrid
