// Splices a prelude and a kernel file into one GLSL source for a GPU's compiler, and translates the compiler's messages
// back to the kernel's own file and line.
#pragma once

#include <photongrid/core/exact_arithmetic.hpp>
#include <photongrid/core/text_file.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace photongrid {

/// A source text made of several files. Line L of file F is numbered (F + 1) * 100000 + L by `#line`, in one integer,
/// because drivers lose the file number of `#line` with two (docs/design/design.md, "Error messages give the kernel's
/// own line").
struct spliced_source {
    std::string text;               ///< the source for the compiler
    std::vector<std::string> files; ///< F -> name
    std::vector<std::string> texts; ///< F -> the file's own text, for quoting
};

namespace detail {
    inline constexpr unsigned lines_per_file = 100000;

    class splicer {
    public:
        explicit splicer(std::span<const text_file> library) : library_(library) {}

        void append(const text_file& source, std::string_view defines = "")
        {
            const auto file = out_.files.size();
            const std::string_view name = source.name;
            std::string_view text = source.text;
            out_.files.emplace_back(name);
            out_.texts.emplace_back(text);
            const auto line_directive = [&](std::size_t line) {
                out_.text += "#line " + std::to_string((file + 1) * lines_per_file + line) + "\n";
            };
            std::size_t line = 1;
            if (!text.starts_with("#version"))
                line_directive(1);
            while (!text.empty()) {
                const auto end = std::min(text.find('\n'), text.size());
                const auto row = text.substr(0, end);
                text.remove_prefix(std::min(end + 1, text.size()));
                ++line;
                if (row.starts_with("#version")) {
                    out_.text += std::string(row) + "\n" + std::string(defines);
                    line_directive(line);
                } else if (row.starts_with("#include \"") || row.starts_with("#include <")) {
                    const std::string path(row.substr(10, row.find_first_of("\">", 10) - 10));
                    include(path, row[9] == '"', name, line - 1);
                    line_directive(line);
                } else {
                    out_.text += std::string(row) + "\n";
                }
            }
        }
        /// What is appended after this call goes through with_exact_arithmetic().
        void rewrite_from_here() { rewritten_ = out_.text.size(); }
        spliced_source take()
        {
            if (rewritten_ < out_.text.size()) {
                const auto exact = with_exact_arithmetic(std::string_view(out_.text).substr(rewritten_));
                out_.text.resize(rewritten_);
                out_.text += exact;
            }
            return std::move(out_);
        }

    private:
        /// Where C++ finds a file, finds the same: for "path" first the one beside the including file, then, as for
        /// <path>, one whose name ends with the whole path.
        void include(const std::string& path, bool quoted, std::string_view from, std::size_t line)
        {
            const auto error = [&](const std::string& what) {
                return std::runtime_error(std::string(from) + ":" + std::to_string(line) + ": error: " + what);
            };
            if (quoted) {
                const auto beside = (std::filesystem::path(from).parent_path() / path).lexically_normal();
                const auto at = std::ranges::find(library_, beside.generic_string(), &text_file::name);
                if (at != library_.end())
                    return append_once(*at);
            }
            const text_file* found = nullptr;
            for (const auto& f : library_) {
                if (f.name != path && !f.name.ends_with("/" + path))
                    continue;
                if (found && found->text != f.text)
                    throw error("\"" + path + "\" may be " + std::string(found->name) + " or " + std::string(f.name));
                found = found ? found : &f;
            }
            if (!found)
                throw error("no kernel file named \"" + path + "\"");
            append_once(*found);
        }
        void append_once(const text_file& f)
        {
            if (once_.insert(f.name).second)
                append(f);
        }
        std::span<const text_file> library_;
        std::set<std::string_view> once_;
        spliced_source out_;
        std::size_t rewritten_ = std::string::npos;
    };
} // namespace detail

/// Joins `prelude`, `kernel` and `epilogue` (which has main), and replaces each `#include` of an x.glsl by that file of
/// `library`, once per file. `defines` are inserted unchanged after the prelude's `#version` line.
/// With `exact_arithmetic`, the text of exact_arithmetic.glsl, quotients and square roots of the kernel are that
/// file's.
/// \throws std::runtime_error, with file and line, if an included file is not in `library`, or if its path may mean two.
inline spliced_source splice(const text_file& prelude, std::string_view defines, const text_file& kernel,
    const text_file& epilogue, std::span<const text_file> library, const text_file* exact_arithmetic = nullptr)
{
    detail::splicer s(library);
    s.append(prelude, defines);
    if (exact_arithmetic != nullptr) {
        s.append(*exact_arithmetic);
        s.rewrite_from_here();
    }
    s.append(kernel);
    s.append(epilogue);
    return s.take();
}

namespace detail {
    /// Removes the last component from `path` and returns it. Compilers give paths with either separator.
    inline std::string_view take_last_component(std::string_view& path)
    {
        const auto at = path.find_last_of("/\\");
        const auto last = path.substr(at + 1); // npos + 1 is 0
        path = path.substr(0, at == path.npos ? 0 : at);
        return last;
    }

    /// How well `name`, relative to some folder, fits a file's `path`: 0 if the files' own names differ, else more for
    /// each folder that agrees, and for a name that agrees as a whole.
    inline unsigned fit(std::string_view name, std::string_view path)
    {
        unsigned agree = 0;
        while (name.starts_with("../"))
            name.remove_prefix(3);
        while (!name.empty() && !path.empty()) {
            if (take_last_component(name) != take_last_component(path))
                return 2 * agree;
            ++agree;
        }
        return 2 * agree + (name.empty() ? 1 : 0);
    }
} // namespace detail

/// Finds the embedded text of a kernel by the `path` of its C++ struct. Several may have its file's name: the best is
/// the one whose folders agree too, and among equals the first.
/// \throws std::runtime_error if no such text was embedded.
inline const text_file& find_kernel_text(std::string_view path, std::span<const text_file> library)
{
    const auto fits = [&](const text_file& f) { return detail::fit(f.name, path); };
    const auto best = std::ranges::max_element(library, {}, fits);
    if (best == library.end() || fits(*best) == 0)
        throw std::runtime_error(
            "kernel text '" + std::string(path) + "' was not embedded; give it to photongrid_add_kernels() in CMake");
    return *best;
}

/// The texts that kernel K may include: its own texts first, then `library`, which is the backend's.
template <class K>
std::vector<text_file> texts_of(std::span<const text_file> library)
{
    std::vector<text_file> texts;
    if constexpr (requires { K::own_texts(); })
        texts.assign(K::own_texts().begin(), K::own_texts().end());
    texts.insert(texts.end(), library.begin(), library.end());
    return texts;
}

namespace detail {
    /// One parsed row of a compiler's log.
    struct log_row {
        unsigned long number = 0; ///< the line number, as numbered by #line
        std::string_view kind, message;
    };

    /// Parses the number that ends just before `end`, and moves `end` to its first digit. Empty if there is no digit.
    inline std::optional<unsigned long> number_before(std::string_view text, std::size_t& end)
    {
        std::size_t begin = end;
        while (begin > 0 && text[begin - 1] >= '0' && text[begin - 1] <= '9')
            --begin;
        unsigned long number = 0;
        const auto result = std::from_chars(text.data() + begin, text.data() + end, number);
        if (begin == end || result.ec != std::errc())
            return {};
        end = begin;
        return number;
    }

    /// Parses rows of Mesa (`0:300010(5): error: ...`), NVIDIA (`0(300010) : error ...`) and glslang (`ERROR:
    /// name:300010: ...`). It does not use <regex>, which adds three seconds to the compilation of every file.
    inline std::optional<log_row> parse_log_row(std::string_view row)
    {
        for (const std::string_view kind : {"error", "warning"}) {
            for (const std::string_view stage : {"", "preprocessor "}) {
                const std::string words = "): " + std::string(stage) + std::string(kind) + ": ";
                std::size_t at = row.find(words);
                if (at == row.npos)
                    continue;
                const auto message = row.substr(at + words.size());
                if (number_before(row, at) && at > 0 && row[--at] == '(') // the column
                    if (const auto line = number_before(row, at); line && at > 0 && row[at - 1] == ':')
                        return log_row{*line, kind, message};
            }
            const std::string words = ") : " + std::string(kind) + " ";
            if (std::size_t at = row.find(words); at != row.npos) {
                const auto message = row.substr(at + words.size());
                if (const auto line = number_before(row, at); line && at > 0 && row[at - 1] == '(')
                    return log_row{*line, kind, message};
            }
            const std::string_view loud = kind == "error" ? "ERROR: " : "WARNING: ";
            if (const std::size_t begin = row.find(loud); begin != row.npos) {
                const std::size_t name_end = row.find(':', begin + loud.size());
                const std::size_t line_end = name_end == row.npos ? row.npos : row.find(": ", name_end + 1);
                if (line_end != row.npos)
                    if (std::size_t at = line_end; const auto line = number_before(row, at))
                        if (at == name_end + 1)
                            return log_row{*line, kind, row.substr(line_end + 2)};
            }
        }
        return {};
    }

    /// Removes the first line from `text` and returns it; empty at the end of the text.
    inline std::optional<std::string_view> next_line(std::string_view& text)
    {
        if (text.empty())
            return {};
        const auto line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        return line;
    }
} // namespace detail

/// Rewrites a compiler's log: each message becomes `kernel.glsl:line: error: …`, followed by the source line. It knows
/// the formats of Mesa, glslang and NVIDIA; other lines stay unchanged.
inline std::string translate_log(std::string_view log, const spliced_source& source)
{
    std::string out;
    while (const auto row = detail::next_line(log)) {
        const auto said = detail::parse_log_row(*row);
        const auto file = said ? said->number / detail::lines_per_file : 0;
        if (file < 1 || file > source.files.size()) {
            out += std::string(*row) + "\n";
            continue;
        }
        const auto line = said->number % detail::lines_per_file;
        out += source.files[file - 1] + ":" + std::to_string(line) + ": " + std::string(said->kind) + ": "
            + std::string(said->message) + "\n";
        std::string_view text = source.texts[file - 1], quoted;
        for (unsigned long l = 0; l < line; ++l)
            quoted = detail::next_line(text).value_or("");
        out += "    " + std::string(quoted) + "\n";
    }
    return out;
}

} // namespace photongrid
