// The reader is our own: tinyobjloader takes what is no number for 0 and says nothing.
#include <photongrid/io/obj_file.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <optional>
#include <unordered_map>
#include <vector>

namespace photongrid {

namespace {
    /// Indices of a corner's position, texture coordinates and normal, counted from 0.
    using corner = std::array<std::uint32_t, 3>;
    constexpr std::uint32_t absent = 0xFFFFFFFFu;

    struct hash_of_corner {
        std::size_t operator()(const corner& c) const
        {
            std::uint64_t h = 0;
            for (const auto n : c) {
                h = (h ^ n) * 0x9E3779B97F4A7C15u;
                h ^= h >> 29;
            }
            return static_cast<std::size_t>(h);
        }
    };

    class obj_reader {
    public:
        obj_reader(const std::string& file, std::string_view text) : file_(file), text_(text) {}

        mesh read()
        {
            while (next_line())
                read_statement();
            for (std::size_t kind = 0; kind < 3; ++kind) { // faces may come before what they name
                const auto& l = last_[kind];
                if (l.index != absent && l.index >= count_of(kind))
                    throw scene_error(file_, l.line, l.column,
                        "found " + std::string(names[kind]) + " " + std::to_string(l.index + std::uint64_t{1})
                            + "; there are " + std::to_string(count_of(kind)));
            }
            return assembled();
        }

    private:
        static constexpr std::array names{"vertex", "texture coordinates", "normal"};
        /// What else a file may say.
        static constexpr std::string_view skipped[] = {"g", "o", "s", "mg", "l", "p", "usemtl", "mtllib", "usemap",
            "maplib", "vp", "deg", "bmat", "step", "cstype", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv",
            "sp", "end", "con", "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", "ctech", "stech"};

        /// The largest index of each kind, and where it stands.
        struct index_place {
            std::uint32_t index = absent;
            std::size_t line = 0, column = 0;
        };

        [[noreturn]] void fail(std::size_t at, const std::string& what) const
        {
            throw scene_error(file_, line_, at - begin_ + 1, what);
        }

        // --- lines and words; a line ends with a backslash where it goes on in the next one ---
        bool next_line()
        {
            if (end_ >= text_.size() && line_ > 0)
                return false;
            begin_ = line_ > 0 ? end_ + 1 : 0;
            ++line_;
            end_ = std::min(text_.find('\n', begin_), text_.size());
            at_ = begin_;
            return begin_ < text_.size();
        }
        bool is_blank_at(std::size_t at) const { return text_[at] == ' ' || text_[at] == '\t' || text_[at] == '\r'; }
        /// Goes to the next word of the statement. Returns whether there is one.
        bool find_word()
        {
            for (;;) {
                while (at_ < end_ && is_blank_at(at_))
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
            while (at_ < end_ && !is_blank_at(at_))
                ++at_;
            return text_.substr(from, at_ - from);
        }
        [[noreturn]] void fail_at_word(const std::string& expected)
        {
            const auto place = at_;
            fail(place,
                "found " + (find_word() ? shown_word(word()) : "the end of the line") + "; expected " + expected);
        }

        // --- numbers ---
        float number(double most, const char* expected)
        {
            if (!find_word())
                fail_at_word(expected);
            const auto place = at_;
            auto w = word();
            if (w.size() > 1 && w[0] == '+' && w[1] != '-')
                w.remove_prefix(1);
            double d = 0;
            const auto [past, wrong] = std::from_chars(w.data(), w.data() + w.size(), d);
            // from_chars leaves d as it was where the number is too small, or too large
            const bool is_number = past == w.data() + w.size()
                && (wrong == std::errc() || (wrong == std::errc::result_out_of_range && is_small(w)));
            if (!is_number || !(std::abs(d) <= most)) {
                at_ = place;
                fail_at_word(expected);
            }
            return static_cast<float>(d);
        }
        static bool is_small(std::string_view w)
        {
            const auto e = w.find_first_of("eE");
            return e != std::string_view::npos && e + 1 < w.size() && w[e + 1] == '-';
        }
        glm::vec3 three(double most, const char* expected)
        {
            const float x = number(most, expected), y = number(most, expected), z = number(most, expected);
            return {x, y, z};
        }

        void read_statement()
        {
            if (!find_word())
                return;
            const auto place = at_;
            const auto statement = word();
            if (statement == "v")
                read_position();
            else if (statement == "vt")
                read_coordinates();
            else if (statement == "vn")
                normals_.push_back(three(1e18, "a number: normals have three, up to 10^18"));
            else if (statement == "f")
                read_face(place);
            else if (std::find(std::begin(skipped), std::end(skipped), statement) == std::end(skipped))
                fail(place,
                    "found " + shown_word(statement) + "; expected a statement of an OBJ file, such as v, vt, vn or f");
            else // with all lines that it goes on in
                while (find_word())
                    word();
            if (find_word())
                fail_at_word("the end of the line");
        }
        void read_position()
        {
            constexpr auto expected = "a number: vertices have three, up to 10^18, then perhaps a colour";
            positions_.push_back(three(1e18, expected));
            std::array<float, 4> more{};
            std::size_t n = 0;
            for (; n < more.size() && find_word(); ++n)
                more[n] = number(1e18, expected);
            if (n == 2)
                fail_at_word(expected);
            if (n < 3) // nothing, or a weight, which has no meaning for triangles
                return;
            const std::size_t first = n - 3; // after a weight
            const glm::vec3 color(more[first], more[first + 1], more[first + 2]);
            for (int c = 0; c < 3; ++c)
                if (!(color[c] >= 0 && color[c] <= 1))
                    fail(at_, "found a colour that is not from 0 to 1");
            colors_.resize(positions_.size() - 1, glm::vec3(1));
            colors_.push_back(color);
        }
        void read_coordinates()
        {
            constexpr auto expected = "a number: texture coordinates have one to three, up to 10^6";
            glm::vec2 at(number(1e6, expected), 0.0f);
            if (find_word())
                at.y = number(1e6, expected);
            if (find_word())
                number(1e6, expected);
            coordinates_.push_back(at);
        }

        // --- faces ---
        std::uint64_t count_of(std::size_t kind) const
        {
            return kind == 0 ? positions_.size() : kind == 1 ? coordinates_.size() : normals_.size();
        }
        void read_face(std::size_t place)
        {
            const std::size_t line = line_, column = place - begin_ + 1;
            face_starts_.push_back(static_cast<std::uint32_t>(corners_.size()));
            std::size_t n = 0;
            for (; find_word(); ++n)
                corners_.push_back(read_corner());
            if (n < 3)
                throw scene_error(
                    file_, line, column, "found a face of " + std::to_string(n) + " corners; expected three or more");
            if (corners_.size() >= absent)
                throw scene_error(file_, line, column, "the faces have more than 2^32 - 2 corners");
        }
        corner read_corner()
        {
            const auto place = at_;
            const auto w = word();
            corner c{absent, absent, absent};
            std::size_t from = 0;
            for (std::size_t kind = 0; kind < 3; ++kind) {
                const auto slash = std::min(w.find('/', from), w.size());
                const auto part = w.substr(from, slash - from);
                if (!part.empty() || kind == 0)
                    c[kind] = index_in(part, kind, place + from);
                if (slash == w.size())
                    return c;
                from = slash + 1;
            }
            at_ = place;
            fail_at_word("a corner: up to three indices with \"/\" between them");
        }
        std::uint32_t index_in(std::string_view part, std::size_t kind, std::size_t place)
        {
            std::int64_t i = 0;
            const auto [past, wrong] = std::from_chars(part.data(), part.data() + part.size(), i);
            if (wrong != std::errc() || past != part.data() + part.size() || i == 0 || i >= std::int64_t{absent})
                fail(place,
                    "found " + shown_word(part) + "; expected the number of a " + names[kind]
                        + ", counted from 1, or with a sign from the last one back");
            if (i < 0)
                i += static_cast<std::int64_t>(count_of(kind)) + 1;
            if (i < 1)
                fail(place, "found " + shown_word(part) + "; there are " + std::to_string(count_of(kind)) + " so far");
            const auto index = static_cast<std::uint32_t>(i - 1);
            if (auto& l = last_[kind]; l.index == absent || index > l.index)
                l = {index, line_, place - begin_ + 1};
            return index;
        }

        // --- the mesh ---
        /// Newell's method: of any length.
        glm::vec3 normal_of_face(std::size_t first, std::size_t past) const
        {
            glm::dvec3 sum(0);
            for (std::size_t i = first; i < past; ++i) {
                const glm::dvec3 a(positions_[corners_[first][0]]), b(positions_[corners_[i][0]]),
                    c(positions_[corners_[i + 1 < past ? i + 1 : first][0]]);
                sum += glm::cross(b - a, c - a);
            }
            const double length = glm::length(sum);
            return length > 0 && std::isfinite(length) ? glm::vec3(sum / length) : glm::vec3(0, 0, 1);
        }

        mesh assembled() const
        {
            mesh made;
            const bool has_coordinates = last_[1].index != absent, has_normals = last_[2].index != absent;
            std::unordered_map<corner, std::uint32_t, hash_of_corner> vertices;
            vertices.reserve(positions_.size());
            const auto add = [&](const corner& c, const glm::vec3& normal) {
                made.positions.push_back(positions_[c[0]]);
                if (has_coordinates)
                    made.texture_coordinates.push_back(c[1] == absent ? glm::vec2(0) : coordinates_[c[1]]);
                if (has_normals)
                    made.normals.push_back(normal);
                if (!colors_.empty())
                    made.colors.push_back(c[0] < colors_.size() ? colors_[c[0]] : glm::vec3(1));
                return static_cast<std::uint32_t>(made.positions.size() - 1);
            };
            std::vector<std::uint32_t> face;
            for (std::size_t f = 0; f < face_starts_.size(); ++f) {
                const std::size_t first = face_starts_[f],
                                  past = f + 1 < face_starts_.size() ? face_starts_[f + 1] : corners_.size();
                face.clear();
                std::optional<glm::vec3> of_plane; // which corners without a normal have, and share with no other face
                for (std::size_t i = first; i < past; ++i) {
                    const auto& c = corners_[i];
                    if (has_normals && c[2] == absent) {
                        if (!of_plane)
                            of_plane = normal_of_face(first, past);
                        face.push_back(add(c, *of_plane));
                        continue;
                    }
                    const auto [found, is_new] = vertices.try_emplace(c, 0u);
                    if (is_new)
                        found->second = add(c, has_normals ? normals_[c[2]] : glm::vec3(0));
                    face.push_back(found->second);
                }
                for (std::size_t i = 2; i < face.size(); ++i)
                    made.triangles.emplace_back(face[0], face[i - 1], face[i]);
            }
            return made;
        }

        std::string file_;
        std::string_view text_;
        std::size_t begin_ = 0, end_ = 0, at_ = 0, line_ = 0; ///< of the line that is read
        std::vector<glm::vec3> positions_, colors_, normals_;
        std::vector<glm::vec2> coordinates_;
        std::vector<corner> corners_;
        std::vector<std::uint32_t> face_starts_; ///< the first corner of each face
        std::array<index_place, 3> last_;
    };
} // namespace

mesh parse_obj(const std::string& file, std::string_view text) { return obj_reader(file, text).read(); }

mesh read_obj(const std::string& path) { return parse_obj(path, whole_file(path)); }

} // namespace photongrid
