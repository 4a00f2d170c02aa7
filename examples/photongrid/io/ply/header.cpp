#include <photongrid/io/ply/header.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace photongrid::ply {

namespace {
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

    std::vector<std::string_view> words_of(std::string_view line)
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
} // namespace

void header_reader::fail(const std::string& what) const
{
    if (!in_header_ && format_ != format::ascii)
        throw scene_error(file_, 0, 0, "byte " + std::to_string(at_) + ": " + what);
    const auto before = bytes_.substr(0, at_);
    const auto line = static_cast<std::size_t>(std::count(before.begin(), before.end(), end_of_line_)) + 1;
    const auto begin = before.rfind(end_of_line_) + 1; // npos + 1 is 0
    throw scene_error(file_, line, at_ - begin + 1, what);
}

bool header_reader::has(role use) const
{
    return std::any_of(elements_.begin(), elements_.end(), [&](const element& e) {
        return std::any_of(
            e.properties.begin(), e.properties.end(), [&](const property& p) { return p.use == use && e.count > 0; });
    });
}

bool header_reader::is_read(role use) const
{
    switch (use) {
    case role::x:
    case role::y:
    case role::z:
    case role::corners:
    case role::strips: return true;
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

void header_reader::tell_what_is_left_out() const
{
    if (rest_ == nullptr)
        return;
    for (const auto& e : elements_) {
        if (e.count == 0)
            continue;
        if (e.name != "vertex" && e.name != "face" && e.name != "tristrips") {
            rest_->left_out.push_back({e.line, "the elements " + shown_word(e.name) + " are left out"});
            continue;
        }
        for (const auto& p : e.properties)
            if (!is_read(p.use))
                rest_->left_out.push_back(
                    {p.line, "the property " + shown_word(p.name) + " of each " + e.name + " is left out"});
    }
}

std::string_view header_reader::next_line() const
{
    const auto end = bytes_.find(end_of_line_, at_);
    if (end == std::string_view::npos || end - at_ > 4096)
        fail("the header does not end; expected \"end_header\"");
    auto line = bytes_.substr(at_, end - at_);
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ' || line.back() == '\t'))
        line.remove_suffix(1);
    return line;
}

void header_reader::to_next_line() { at_ = bytes_.find(end_of_line_, at_) + 1; }

scalar header_reader::scalar_of(std::string_view name) const
{
    for (const auto& s : scalar_names)
        if (s.name == name)
            return s.type;
    fail("found " + shown_word(name) + "; expected a type such as float or uchar");
}

format header_reader::format_of(std::string_view word) const
{
    if (word == "ascii")
        return format::ascii;
    if (word == "binary_little_endian")
        return format::little_endian;
    if (word == "binary_big_endian")
        return format::big_endian;
    fail("found the format " + shown_word(word) + "; expected ascii, binary_little_endian or binary_big_endian");
}

void header_reader::read_header()
{
    if (const auto first = bytes_.find_first_of("\r\n");
        first != std::string_view::npos && bytes_[first] == '\r' && bytes_.substr(first + 1, 1) != "\n")
        end_of_line_ = '\r';
    if (next_line() != "ply")
        fail("this is no PLY file: its first line is not \"ply\"");
    bool has_format = false;
    for (bool ends = false; !ends;) {
        to_next_line();
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
            format_ = format_of(w[1]);
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
    to_next_line();
    in_header_ = false;
    if (!has(role::x) || !has(role::y) || !has(role::z))
        fail("the header declares no vertex with the properties x, y and z");
    if (!has(role::corners) && !has(role::strips))
        fail(
            "the header declares neither faces with the list vertex_indices nor strips of triangles; a cloud of points "
            "has no surface");
    tell_what_is_left_out();
}

void header_reader::read_property(const std::vector<std::string_view>& w)
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
        if (e.name == "tristrips" && (name == "vertex_indices" || name == "vertex_index"))
            p.use = role::strips;
    } else if (e.name == "vertex") {
        for (const auto& r : role_names)
            if (r.name == name)
                p.use = r.use;
    }
    e.properties.push_back(p);
}

} // namespace photongrid::ply
