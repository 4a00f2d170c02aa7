// Kernel texts as GPUs need them: a prelude and a kernel file spliced into one source, and a compiler's messages
// translated back to the kernel's own file and line.
#pragma once

#include <photongrid/kernel_text.hpp>

#include <regex>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace photongrid {

/// A source text made of several files. Line L of file F is numbered (F + 1) * 100000 + L by `#line`, in one integer,
/// because drivers lose the file number of `#line` with two (docs/design.md, "Errors that point home").
struct spliced_source {
    std::string text;               ///< what the compiler is given
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
            const auto line_directive = [&](std::size_t line) { out_.text += "#line " + std::to_string((file + 1) * lines_per_file + line) + "\n"; };
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
                } else if (row.starts_with("#include \"")) {
                    include(row.substr(10, row.find('"', 10) - 10), name, line - 1);
                    line_directive(line);
                } else {
                    out_.text += std::string(row) + "\n";
                }
            }
        }
        spliced_source take() { return std::move(out_); }

    private:
        void include(std::string_view wanted, std::string_view from, std::size_t line)
        {
            for (const auto& f : library_) {
                if (f.name.substr(f.name.rfind('/') + 1) != wanted)
                    continue;
                if (once_.insert(f.name).second)
                    append(f);
                return;
            }
            throw std::runtime_error(std::string(from) + ":" + std::to_string(line) + ": error: no kernel file named \"" + std::string(wanted) + "\"");
        }
        std::span<const text_file> library_;
        std::set<std::string_view> once_;
        spliced_source out_;
    };
} // namespace detail

/// Puts `prelude` before `kernel`, then `epilogue` (a wrapper's main), with every `#include "x.glsl"` replaced by that
/// file of `library`, each once. Defines go after the prelude's `#version` line as they are.
/// \throws std::runtime_error that names file and line, where an included file is not in `library`.
inline spliced_source splice(const text_file& prelude, std::string_view defines, const text_file& kernel, const text_file& epilogue, std::span<const text_file> library = kernel_texts)
{
    detail::splicer s(library);
    s.append(prelude, defines);
    s.append(kernel);
    s.append(epilogue);
    return s.take();
}

/// The embedded text of a kernel by the path that its C++ struct carries.
/// \throws std::runtime_error when no such text was embedded.
inline const text_file& find_kernel_text(std::string_view path, std::span<const text_file> library = kernel_texts)
{
    const auto base = path.substr(path.find_last_of("/\\") + 1);
    for (const auto& f : library)
        if (f.name.substr(f.name.rfind('/') + 1) == base)
            return f;
    throw std::runtime_error("kernel text '" + std::string(path) + "' was not embedded; name it in photongrid_embed() in CMake");
}

/// The texts that kernel K can be made of: those that it brings along, which photongrid_add_kernels() gives it, before `library`.
template <class K>
std::vector<text_file> texts_of(std::span<const text_file> library)
{
    std::vector<text_file> texts;
    if constexpr (requires { K::own_texts(); })
        texts.assign(K::own_texts().begin(), K::own_texts().end());
    texts.insert(texts.end(), library.begin(), library.end());
    return texts;
}

/// Rewrites a compiler's log so that each message reads `kernel.glsl:line: error: …` with the source line quoted below it.
/// Understands Mesa's, glslang's and NVIDIA's forms; what matches none is kept as it is.
inline std::string translate_log(std::string_view log, const spliced_source& source)
{
    static const std::regex mesa(R"((\d+):(\d+)\((\d+)\): (?:preprocessor )?(error|warning): (.*))");
    static const std::regex glslang(R"((ERROR|WARNING): [^:]*:(\d+): (.*))");
    static const std::regex nvidia(R"((\d+)\((\d+)\) : (error|warning) (.*))");
    std::istringstream in{std::string(log)};
    std::string out;
    for (std::string row; std::getline(in, row);) {
        std::smatch m;
        unsigned long number = 0;
        std::string kind, message;
        if (std::regex_search(row, m, mesa)) {
            number = std::stoul(m[2]);
            kind = m[4];
            message = m[5];
        } else if (std::regex_search(row, m, glslang)) {
            number = std::stoul(m[2]);
            kind = m[1] == "ERROR" ? "error" : "warning";
            message = m[3];
        } else if (std::regex_search(row, m, nvidia)) {
            number = std::stoul(m[2]);
            kind = m[3];
            message = m[4];
        }
        const auto file = number / detail::lines_per_file;
        const auto line = number % detail::lines_per_file;
        if (file < 1 || file > source.files.size()) {
            out += row + "\n";
            continue;
        }
        out += source.files[file - 1] + ":" + std::to_string(line) + ": " + kind + ": " + message + "\n";
        std::istringstream text(source.texts[file - 1]);
        std::string quoted;
        for (unsigned long l = 0; l < line && std::getline(text, quoted); ++l) { }
        out += "    " + quoted + "\n";
    }
    return out;
}

} // namespace photongrid
