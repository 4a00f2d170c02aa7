#include <photongrid/io/ply_file.hpp>
#include <photongrid/io/tone_map.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <vector>

namespace photongrid {

namespace {
    enum class scalar { i8, u8, i16, u16, i32, u32, f32, f64 };

    struct scalar_name {
        std::string_view name;
        scalar type;
    };
    constexpr std::array scalar_names{scalar_name{"char", scalar::i8}, scalar_name{"int8", scalar::i8},
        scalar_name{"uchar", scalar::u8}, scalar_name{"uint8", scalar::u8}, scalar_name{"short", scalar::i16},
        scalar_name{"int16", scalar::i16}, scalar_name{"ushort", scalar::u16}, scalar_name{"uint16", scalar::u16},
        scalar_name{"int", scalar::i32}, scalar_name{"int32", scalar::i32}, scalar_name{"uint", scalar::u32},
        scalar_name{"uint32", scalar::u32}, scalar_name{"float", scalar::f32}, scalar_name{"float32", scalar::f32},
        scalar_name{"double", scalar::f64}, scalar_name{"float64", scalar::f64}};

    constexpr std::size_t size_of(scalar s)
    {
        return s == scalar::i8 || s == scalar::u8  ? 1
            : s == scalar::i16 || s == scalar::u16 ? 2
            : s == scalar::f64                     ? 8
                                                   : 4;
    }

    /// What a property is for.
    enum class role { x, y, z, nx, ny, nz, u, v, red, green, blue, corners, none };
    /// The names of numbers of a vertex.
    struct role_name {
        std::string_view name;
        role use;
    };
    constexpr std::array role_names{role_name{"x", role::x}, role_name{"y", role::y}, role_name{"z", role::z},
        role_name{"nx", role::nx}, role_name{"ny", role::ny}, role_name{"nz", role::nz}, role_name{"u", role::u},
        role_name{"v", role::v}, role_name{"s", role::u}, role_name{"t", role::v}, role_name{"texture_u", role::u},
        role_name{"texture_v", role::v}, role_name{"red", role::red}, role_name{"green", role::green},
        role_name{"blue", role::blue}};

    struct property {
        role use = role::none;
        scalar type = scalar::f32;
        std::optional<scalar> count{}; ///< of a list: the type of its length
        std::string name{};
        std::size_t line = 0;
    };
    struct element {
        std::string name;
        std::uint64_t count = 0;
        std::size_t line = 0;
        std::vector<property> properties{};
    };
    enum class format { ascii, little_endian, big_endian };

    class ply_reader {
    public:
        ply_reader(const std::string& file, std::string_view bytes, ply_rest* rest)
            : file_(file), bytes_(bytes), rest_(rest)
        {
        }

        mesh read()
        {
            read_header();
            if (!has(role::x) || !has(role::y) || !has(role::z))
                fail("the header declares no vertex with the properties x, y and z");
            if (!has(role::corners))
                fail("the header declares no face with the list vertex_indices; a cloud of points has no surface");
            tell_what_is_left_out();
            for (const auto& e : elements_)
                read_element(e);
            for (std::size_t t = 0; t < made_.triangles.size(); ++t) // faces may come before vertices
                for (int c = 0; c < 3; ++c)
                    if (made_.triangles[t][c] >= made_.positions.size())
                        throw scene_error(file_, 0, 0,
                            "triangle " + std::to_string(t) + ": its corner " + std::to_string(c) + " is vertex "
                                + std::to_string(made_.triangles[t][c]) + "; there are "
                                + std::to_string(made_.positions.size()));
            return std::move(made_);
        }

    private:
        /// Says where reading has come: the line of a text, else the byte.
        [[noreturn]] void fail(const std::string& what) const
        {
            if (!in_header_ && format_ != format::ascii)
                throw scene_error(file_, 0, 0, "byte " + std::to_string(at_) + ": " + what);
            const auto before = bytes_.substr(0, at_);
            const auto line = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')) + 1;
            const auto begin = before.rfind('\n') + 1; // npos + 1 is 0
            throw scene_error(file_, line, at_ - begin + 1, what);
        }
        bool has(role use) const
        {
            return std::any_of(elements_.begin(), elements_.end(), [&](const element& e) {
                return std::any_of(e.properties.begin(), e.properties.end(),
                    [&](const property& p) { return p.use == use && e.count > 0; });
            });
        }

        bool is_smooth() const { return has(role::nx) && has(role::ny) && has(role::nz); }
        bool is_mapped() const { return has(role::u) && has(role::v); }
        bool is_colored() const { return has(role::red) && has(role::green) && has(role::blue); }
        bool is_read(role use) const
        {
            switch (use) {
            case role::x:
            case role::y:
            case role::z:
            case role::corners: return true;
            case role::nx:
            case role::ny:
            case role::nz: return is_smooth();
            case role::u:
            case role::v: return is_mapped();
            case role::red:
            case role::green:
            case role::blue: return is_colored();
            case role::none: break;
            }
            return false;
        }
        void tell_what_is_left_out()
        {
            if (rest_ == nullptr)
                return;
            for (const auto& e : elements_) {
                if (e.count == 0)
                    continue;
                if (e.name != "vertex" && e.name != "face") {
                    rest_->left_out.push_back({e.line, "the elements " + shown_word(e.name) + " are left out"});
                    continue;
                }
                for (const auto& p : e.properties)
                    if (!is_read(p.use))
                        rest_->left_out.push_back(
                            {p.line, "the property " + shown_word(p.name) + " of each " + e.name + " is left out"});
            }
        }

        // --- the header ---
        std::string_view next_line()
        {
            const auto end = bytes_.find('\n', at_);
            if (end == std::string_view::npos || end - at_ > 4096)
                fail("the header does not end; expected \"end_header\"");
            auto line = bytes_.substr(at_, end - at_);
            while (!line.empty() && (line.back() == '\r' || line.back() == ' ' || line.back() == '\t'))
                line.remove_suffix(1);
            return line;
        }
        static std::vector<std::string_view> words_of(std::string_view line)
        {
            std::vector<std::string_view> words;
            while (!line.empty()) {
                const auto begin = std::min(line.find_first_not_of(" \t"), line.size());
                line.remove_prefix(begin);
                const auto end = std::min(line.find_first_of(" \t"), line.size());
                if (end > 0)
                    words.push_back(line.substr(0, end));
                line.remove_prefix(end);
            }
            return words;
        }
        scalar scalar_of(std::string_view name) const
        {
            for (const auto& s : scalar_names)
                if (s.name == name)
                    return s.type;
            fail("found " + shown_word(name) + "; expected a type such as float or uchar");
        }
        void read_header()
        {
            if (next_line() != "ply")
                fail("this is no PLY file: its first line is not \"ply\"");
            bool has_format = false;
            for (bool ends = false; !ends;) {
                at_ = bytes_.find('\n', at_) + 1;
                ++line_;
                const auto line = next_line();
                const auto w = words_of(line);
                const auto expect = [&](std::size_t n, const char* form) {
                    if (w.size() != n)
                        fail(std::string("expected \"") + form + "\"");
                };
                if (rest_ != nullptr && w.size() > 2 && w[0] == "comment" && w[1] == "TextureFile") { // as of MeshLab
                    rest_->texture = line.substr(static_cast<std::size_t>(w[2].data() - line.data()));
                    rest_->texture_line = line_;
                }
                if (w.empty() || w[0] == "comment" || w[0] == "obj_info")
                    continue;
                if (w[0] == "end_header") {
                    ends = true;
                } else if (w[0] == "format") {
                    expect(3, "format ascii 1.0");
                    format_ = w[1] == "ascii"            ? format::ascii
                        : w[1] == "binary_little_endian" ? format::little_endian
                        : w[1] == "binary_big_endian"    ? format::big_endian
                                                         : throw_format(w[1]);
                    has_format = true;
                } else if (w[0] == "element") {
                    expect(3, "element NAME COUNT");
                    element e{.name = std::string(w[1]), .line = line_};
                    const auto [end, wrong] = std::from_chars(w[2].data(), w[2].data() + w[2].size(), e.count);
                    if (wrong != std::errc() || end != w[2].data() + w[2].size())
                        fail("found " + shown_word(w[2]) + "; expected how many elements there are");
                    elements_.push_back(std::move(e));
                } else if (w[0] == "property") {
                    read_property(w);
                } else {
                    fail("found " + shown_word(w[0]) + "; expected format, comment, element, property or end_header");
                }
            }
            if (!has_format)
                fail("the header lacks a line \"format\"");
            at_ = bytes_.find('\n', at_) + 1;
            in_header_ = false;
        }
        [[noreturn]] format throw_format(std::string_view word) const
        {
            fail(
                "found the format " + shown_word(word) + "; expected ascii, binary_little_endian or binary_big_endian");
        }
        void read_property(const std::vector<std::string_view>& w)
        {
            if (elements_.empty())
                fail("a property before the first element");
            const bool is_list = w.size() > 1 && w[1] == "list";
            if (w.size() != (is_list ? 5u : 3u))
                fail("expected \"property TYPE NAME\" or \"property list TYPE TYPE NAME\"");
            auto& e = elements_.back();
            property p;
            const auto name = w.back();
            p.name = name;
            p.line = line_;
            p.type = scalar_of(w[w.size() - 2]);
            if (is_list) {
                p.count = scalar_of(w[2]);
                if (*p.count == scalar::f32 || *p.count == scalar::f64)
                    fail("the length of a list is of the type " + shown_word(w[2]) + "; expected a whole number");
                if (e.name == "face" && (name == "vertex_indices" || name == "vertex_index"))
                    p.use = role::corners;
            } else if (e.name == "vertex") {
                for (const auto& r : role_names)
                    if (r.name == name)
                        p.use = r.use;
            }
            e.properties.push_back(p);
        }

        // --- the elements ---
        void read_element(const element& e)
        {
            std::uint64_t least = 0; // bytes of one
            for (const auto& p : e.properties) {
                const bool is_ascii = format_ == format::ascii;
                least += is_ascii ? 2 : size_of(p.count.value_or(p.type));
                if (p.use == role::corners)
                    least += 3 * (is_ascii ? 2 : size_of(p.type));
            }
            // The last number of a text needs no blank behind it.
            if (e.count > 0 && least > 0 && e.count - 1 > (bytes_.size() - at_) / least)
                fail("the header declares " + std::to_string(e.count) + " elements " + shown_word(e.name)
                    + ", which need more bytes than the file has");
            if (least == 0)
                return;
            const bool is_vertex = e.name == "vertex", has_normals = is_smooth(), has_coordinates = is_mapped(),
                       has_colors = is_colored();
            if (is_vertex)
                made_.positions.reserve(made_.positions.size() + e.count);
            for (const auto& p : e.properties)
                if (p.use == role::corners) // most files have triangles alone
                    made_.triangles.reserve(made_.triangles.size() + e.count);
            std::array<float, static_cast<std::size_t>(role::corners)> v{};
            for (std::uint64_t i = 0; i < e.count; ++i) {
                for (const auto& p : e.properties) {
                    if (p.use == role::corners && read_corners_of_32_bits(p))
                        continue;
                    if (p.count)
                        read_list(p);
                    else if (p.use == role::none)
                        (void)next(p.type);
                    else
                        v[static_cast<std::size_t>(p.use)] = number_for(p);
                }
                if (is_vertex)
                    made_.positions.emplace_back(v[0], v[1], v[2]);
                if (is_vertex && has_normals)
                    made_.normals.emplace_back(v[3], v[4], v[5]);
                if (is_vertex && has_coordinates)
                    made_.texture_coordinates.emplace_back(v[6], v[7]);
                if (is_vertex && has_colors)
                    made_.colors.emplace_back(v[8], v[9], v[10]);
            }
        }
        float number_for(const property& p)
        {
            switch (p.use) {
            case role::u:
            case role::v: return limited(p.type, -1e6, 1e6, "a texture coordinate that is not from -10^6 to 10^6");
            case role::red:
            case role::green:
            case role::blue:
                if (p.type == scalar::u8) {
                    const auto code = limited(p.type, 0, 255, "a colour that is not from 0 to 255");
                    return linear_value(static_cast<unsigned char>(code));
                }
                return limited(p.type, 0, 1, "a colour that is neither a byte nor a number from 0 to 1");
            default: return coordinate(p.type);
            }
        }
        float limited(scalar type, double least, double most, const char* otherwise)
        {
            const double d = next(type);
            if (!(d >= least && d <= most))
                fail(otherwise);
            return static_cast<float>(d);
        }
        float coordinate(scalar type)
        {
            const double d = type == scalar::f32 && format_ == format::little_endian && bytes_.size() - at_ >= 4
                ? binary_as<float>() // as nearly all files have them
                : next(type);
            if (!(std::abs(d) <= 1e18))
                fail("a coordinate that is not finite or above 10^18");
            return static_cast<float>(d);
        }
        void read_list(const property& p)
        {
            const double length = next(*p.count);
            if (!(length >= 0 && length == std::floor(length)))
                fail("the length of a list is not a whole number");
            if (length * (format_ == format::ascii ? 2 : static_cast<double>(size_of(p.type)))
                > static_cast<double>(bytes_.size() - at_) + 1)
                fail("a list of " + std::to_string(static_cast<std::uint64_t>(length))
                    + " needs more bytes than the file has");
            if (p.use == role::corners && length < 3)
                fail("a face with " + std::to_string(static_cast<int>(length)) + " corners; expected at least 3");
            std::uint32_t first = 0, before = 0;
            for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(length); ++i) {
                const double d = next(p.type);
                if (p.use != role::corners)
                    continue;
                if (!(d >= 0 && d <= 4294967295.0 && d == std::floor(d)))
                    fail("an index that is not a whole number from 0 to 2^32 - 1");
                const auto index = static_cast<std::uint32_t>(d);
                if (i == 0)
                    first = index;
                else if (i >= 2)
                    made_.triangles.push_back({first, before, index});
                before = index;
            }
        }

        /// Reads a face as nearly all files have them, without doubles, and with one look for the end of the file. Does
        /// nothing and returns false for others, which read_list reads or refuses.
        bool read_corners_of_32_bits(const property& p)
        {
            if (format_ == format::ascii || *p.count != scalar::u8 || (p.type != scalar::i32 && p.type != scalar::u32)
                || at_ >= bytes_.size())
                return false;
            const std::size_t length = static_cast<unsigned char>(bytes_[at_]);
            if (length < 3 || bytes_.size() - at_ < 1 + 4 * length)
                return false;
            const bool is_reversed = (format_ == format::big_endian) != (std::endian::native == std::endian::big);
            const auto index = [&](std::size_t i) {
                std::uint32_t n;
                std::memcpy(&n, bytes_.data() + at_ + 1 + 4 * i, sizeof n);
                return is_reversed ? n >> 24 | (n >> 8 & 0xFF00u) | (n << 8 & 0xFF0000u) | n << 24 : n;
            };
            if (p.type == scalar::i32)
                for (std::size_t i = 0; i < length; ++i)
                    if (index(i) > 0x7FFFFFFFu)
                        return false;
            for (std::size_t i = 2; i < length; ++i)
                made_.triangles.push_back({index(0), index(i - 1), index(i)});
            at_ += 1 + 4 * length;
            return true;
        }

        double next(scalar type) { return format_ == format::ascii ? next_in_text() : next_in_binary(type); }
        double next_in_text()
        {
            while (at_ < bytes_.size() && is_blank(bytes_[at_]))
                ++at_;
            const char* begin = bytes_.data() + at_;
            const char* end = bytes_.data() + bytes_.size();
            if (begin == end)
                fail("the file ends; expected a number");
            double d = 0;
            const auto [past, wrong] = std::from_chars(*begin == '+' ? begin + 1 : begin, end, d);
            if (wrong == std::errc::result_out_of_range) // from_chars leaves d as it was
                d = std::strtod(std::string(begin, past).c_str(), nullptr);
            else if (wrong != std::errc() || (past != end && !is_blank(*past)))
                fail("found "
                    + shown_word(
                        std::string_view(begin, static_cast<std::size_t>(std::find_if(begin, end, is_blank) - begin)))
                    + "; expected a number");
            at_ = static_cast<std::size_t>(past - bytes_.data());
            return d;
        }
        static bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

        template <class T>
        double binary_as()
        {
            std::array<char, sizeof(T)> b;
            std::memcpy(b.data(), bytes_.data() + at_, sizeof(T));
            if ((format_ == format::big_endian) != (std::endian::native == std::endian::big))
                std::reverse(b.begin(), b.end());
            at_ += sizeof(T);
            return static_cast<double>(std::bit_cast<T>(b));
        }
        double next_in_binary(scalar type)
        {
            if (bytes_.size() - at_ < size_of(type))
                fail("the file ends; expected a number");
            switch (type) {
            case scalar::i8: return binary_as<std::int8_t>();
            case scalar::u8: return binary_as<std::uint8_t>();
            case scalar::i16: return binary_as<std::int16_t>();
            case scalar::u16: return binary_as<std::uint16_t>();
            case scalar::i32: return binary_as<std::int32_t>();
            case scalar::u32: return binary_as<std::uint32_t>();
            case scalar::f32: return binary_as<float>();
            case scalar::f64: return binary_as<double>();
            }
            return 0;
        }

        std::string file_;
        std::string_view bytes_;
        ply_rest* rest_;
        std::size_t at_ = 0, line_ = 1; ///< the line of the header
        bool in_header_ = true;
        format format_ = format::ascii;
        std::vector<element> elements_;
        mesh made_;
    };
} // namespace

mesh parse_ply(const std::string& file, std::string_view bytes, ply_rest* rest)
{
    return ply_reader(file, bytes, rest).read();
}

mesh read_ply(const std::string& path) { return parse_ply(path, whole_file(path)); }

} // namespace photongrid
