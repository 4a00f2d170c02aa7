#include <photongrid/io/obj/statement_reader.hpp>
#include <photongrid/io/obj/surface.hpp>

#include <algorithm>
#include <unordered_map>

namespace photongrid::obj {

namespace {
    /// What else a file may say: of no meaning here, ...
    constexpr std::string_view names_of_parts[] = {"g", "o", "mg", "bevel", "c_interp", "d_interp", "lod"};
    /// ... or not in photongrid.
    constexpr std::string_view not_drawn[]
        = {"l", "p", "usemap", "maplib", "vp", "deg", "bmat", "step", "cstype", "curv", "curv2", "surf", "parm", "trim",
            "hole", "scrv", "sp", "end", "con", "shadow_obj", "trace_obj", "ctech", "stech"};
    constexpr std::size_t max_materials = std::size_t{1} << 16;

    template <std::size_t N>
    bool is_one_of(const std::string_view (&words)[N], std::string_view word)
    {
        return std::find(std::begin(words), std::end(words), word) != std::end(words);
    }

    class surface_parser {
    public:
        surface_parser(const std::string& file, std::string_view text) : at_(std::make_shared<std::string>(file), text)
        {
        }

        surface read()
        {
            while (at_.next_line())
                read_statement();
            for (std::size_t kind = 0; kind < 3; ++kind) { // faces may come before what they name
                const auto& l = last_[kind];
                if (l.index != absent && l.index >= count_of(kind))
                    at_.fail(l.place,
                        "found " + std::string(names[kind]) + " " + std::to_string(l.index + std::uint64_t{1})
                            + "; there are " + std::to_string(count_of(kind)));
            }
            return std::move(made_);
        }

    private:
        static constexpr std::array names{"vertex", "texture coordinates", "normal"};

        /// The largest index of each kind, and where it stands.
        struct index_place {
            std::uint32_t index = absent;
            statement_reader::mark place;
        };

        float any_number(const char* expected) { return static_cast<float>(at_.any_number(expected)); }
        glm::vec3 three(const char* expected)
        {
            const float x = any_number(expected), y = any_number(expected), z = any_number(expected);
            return {x, y, z};
        }

        void read_statement()
        {
            if (!at_.find_word())
                return;
            const auto place = at_.here();
            const auto statement = at_.word();
            if (statement == "v")
                read_position();
            else if (statement == "vt")
                read_coordinates();
            else if (statement == "vn")
                made_.normals.push_back(three("a number: normals have three"));
            else if (statement == "f")
                read_face(place);
            else if (statement == "usemtl")
                use_material(place);
            else if (statement == "mtllib")
                made_.libraries.push_back({at_.rest(), at_.place_of(place)});
            else if (statement == "s")
                read_smoothing(place);
            else if (is_one_of(names_of_parts, statement))
                at_.skip();
            else if (is_one_of(not_drawn, statement))
                skip_statement(statement, place);
            else
                at_.fail(place,
                    "found " + shown_word(statement) + "; expected a statement of an OBJ file, such as v, vt, vn or f");
            at_.expect_end();
        }
        void read_position()
        {
            constexpr auto expected = "a number: vertices have three, then perhaps a colour";
            const double x = at_.any_number(expected), y = at_.any_number(expected), z = at_.any_number(expected);
            made_.positions.emplace_back(x, y, z);
            std::array<float, 4> more{};
            std::size_t n = 0;
            for (; n < more.size() && at_.find_word(); ++n)
                more[n] = any_number(expected);
            if (n == 2)
                at_.fail_at_word(expected);
            if (n < 3) // nothing, or a weight, which has no meaning for triangles
                return;
            const std::size_t first = n - 3; // after a weight
            const glm::vec3 color(more[first], more[first + 1], more[first + 2]);
            made_.colors.resize(made_.positions.size() - 1, glm::vec3(1));
            made_.colors.push_back(color);
        }
        void read_coordinates()
        {
            constexpr auto expected = "a number: texture coordinates have one to three";
            glm::vec2 at(any_number(expected), 0.0f);
            if (at_.find_word())
                at.y = any_number(expected);
            if (at_.find_word())
                any_number(expected);
            made_.coordinates.push_back(at);
        }

        // --- materials, and what makes no triangles ---
        void use_material(const statement_reader::mark& place)
        {
            auto name = at_.rest();
            const auto [found, is_new] = numbers_.try_emplace(name, static_cast<std::uint32_t>(made_.materials.size()));
            if (is_new && made_.materials.size() == max_materials)
                at_.fail(place, "more than 2^16 materials");
            if (is_new)
                made_.materials.push_back({std::move(name), at_.place_of(place)});
            const auto face = static_cast<std::uint32_t>(made_.face_starts.size());
            if (!made_.changes.empty() && made_.changes.back().face == face)
                made_.changes.pop_back();
            made_.changes.push_back({face, found->second});
        }
        void read_smoothing(const statement_reader::mark& place)
        {
            const auto group = at_.find_word() ? at_.word() : "off";
            is_smooth_ = group != "off" && group != "0";
            smoothing_ = place;
            at_.skip();
        }
        void skip_statement(std::string_view statement, const statement_reader::mark& place)
        {
            auto same = std::find_if(made_.skipped.begin(), made_.skipped.end(),
                [&](const skipped_statements& s) { return s.statement == statement; });
            if (same == made_.skipped.end())
                same = made_.skipped.insert(same, {std::string(statement), at_.place_of(place)});
            ++same->count;
            at_.skip();
        }

        // --- faces ---
        std::uint64_t count_of(std::size_t kind) const
        {
            return kind == 0 ? made_.positions.size() : kind == 1 ? made_.coordinates.size() : made_.normals.size();
        }
        void read_face(const statement_reader::mark& place)
        {
            auto& corners = made_.corners;
            made_.face_starts.push_back(static_cast<std::uint32_t>(corners.size()));
            std::size_t n = 0;
            for (; at_.find_word(); ++n) {
                corners.push_back(read_corner());
                if (is_smooth_ && corners.back()[2] == absent && !made_.smooth_without_normals)
                    made_.smooth_without_normals = at_.place_of(smoothing_);
            }
            if (n < 3) { // no triangle
                if (made_.flat.count++ == 0)
                    made_.flat.place = at_.place_of(place);
                corners.resize(made_.face_starts.back());
                made_.face_starts.pop_back();
            }
            if (corners.size() >= absent)
                at_.fail(place, "the faces have more than 2^32 - 2 corners");
        }
        corner read_corner()
        {
            const auto begin = at_.here();
            const auto w = at_.word();
            corner c{absent, absent, absent};
            std::size_t from = 0;
            for (std::size_t kind = 0; kind < 3; ++kind) {
                const auto slash = std::min(w.find('/', from), w.size());
                const auto part = w.substr(from, slash - from);
                if (!part.empty() || kind == 0)
                    c[kind] = index_in(part, kind, w.size() - from);
                if (slash == w.size())
                    return c;
                from = slash + 1;
            }
            at_.go_back(begin);
            at_.fail_at_word("a corner: up to three indices with \"/\" between them");
        }
        /// `back`: how many bytes before the end of the word it begins.
        std::uint32_t index_in(std::string_view part, std::size_t kind, std::size_t back)
        {
            const auto place = [&] {
                auto m = at_.here();
                m.at -= back;
                return m;
            };
            std::int64_t i = 0;
            const auto [past, wrong] = std::from_chars(part.data(), part.data() + part.size(), i);
            if (wrong != std::errc() || past != part.data() + part.size() || i == 0 || i >= std::int64_t{absent})
                at_.fail(place(),
                    "found " + shown_word(part) + "; expected the number of a " + names[kind]
                        + ", counted from 1, or with a sign from the last one back");
            if (i < 0)
                i += static_cast<std::int64_t>(count_of(kind)) + 1;
            if (i < 1)
                at_.fail(
                    place(), "found " + shown_word(part) + "; there are " + std::to_string(count_of(kind)) + " so far");
            const auto index = static_cast<std::uint32_t>(i - 1);
            if (auto& l = last_[kind]; l.index == absent || index > l.index)
                l = {index, place()};
            return index;
        }

        statement_reader at_;
        surface made_;
        std::unordered_map<std::string, std::uint32_t> numbers_; ///< of the names of materials
        bool is_smooth_ = false;
        statement_reader::mark smoothing_;
        std::array<index_place, 3> last_;
    };
} // namespace

std::string_view as_utf8(std::string_view text, std::string& converted)
{
    if (text.starts_with("\xEF\xBB\xBF"))
        return text.substr(3);
    const bool is_big = text.starts_with("\xFE\xFF");
    if (!is_big && !text.starts_with("\xFF\xFE"))
        return text;
    const auto unit = [&](std::size_t at) {
        const auto first = static_cast<unsigned char>(text[at]), second = static_cast<unsigned char>(text[at + 1]);
        return static_cast<std::uint32_t>(is_big ? first << 8 | second : second << 8 | first);
    };
    const auto add = [&](std::uint32_t bits, std::uint32_t lead) { converted += static_cast<char>(bits | lead); };
    converted.reserve(text.size() / 2);
    for (std::size_t at = 2; at + 1 < text.size(); at += 2) {
        auto c = unit(at);
        if (c >= 0xD800 && c < 0xDC00 && at + 3 < text.size() && (unit(at + 2) & 0xFC00) == 0xDC00) {
            c = 0x10000 + ((c & 0x3FF) << 10) + (unit(at + 2) & 0x3FF);
            at += 2;
        }
        if (c < 0x80) {
            add(c, 0);
        } else if (c < 0x800) {
            add(c >> 6, 0xC0);
            add(c & 0x3F, 0x80);
        } else {
            if (c < 0x10000) {
                add(c >> 12, 0xE0);
            } else {
                add(c >> 18, 0xF0);
                add(c >> 12 & 0x3F, 0x80);
            }
            add(c >> 6 & 0x3F, 0x80);
            add(c & 0x3F, 0x80);
        }
    }
    return converted;
}

surface parse(const std::string& file, std::string_view text)
{
    std::string converted;
    return surface_parser(file, as_utf8(text, converted)).read();
}

} // namespace photongrid::obj
