// The header of PLY files: their format, their elements, and what these are for.
#pragma once

#include <photongrid/io/ply_file.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace photongrid::ply {

/// The types of numbers.
enum class scalar { i8, u8, i16, u16, i32, u32, f32, f64 };

constexpr std::size_t size_of(scalar s)
{
    return s == scalar::i8 || s == scalar::u8 ? 1 : s == scalar::i16 || s == scalar::u16 ? 2 : s == scalar::f64 ? 8 : 4;
}

/// What a property is for.
enum class role { x, y, z, nx, ny, nz, u, v, red, green, blue, corners, strips, none };

/// A number or a list that each of an element's things has.
struct property {
    role use = role::none;
    scalar type = scalar::f32;
    std::optional<scalar> count{}; ///< of a list: the type of its length
    std::string name{};
    std::size_t line = 0;
};

/// A kind of things, such as vertices.
struct element {
    std::string name;
    std::uint64_t count = 0;
    std::size_t line = 0;
    std::vector<property> properties{};
};

enum class format { ascii, little_endian, big_endian };

/// Reads the header, and knows how far a file is read.
class header_reader {
public:
    /// `rest` may be null.
    header_reader(const std::string& file, std::string_view bytes, ply_rest* rest)
        : file_(file), rest_(rest), bytes_(bytes)
    {
    }

protected:
    /// \throws scene_error for a header that is wrong, or describes no surface.
    void read_header();
    /// Says where reading has come: the line of a text, else the byte.
    [[noreturn]] void fail(const std::string& what) const;

    /// Whether there are such numbers.
    bool has(role use) const;
    bool is_smooth() const { return has(role::nx) && has(role::ny) && has(role::nz); }
    bool is_mapped() const { return has(role::u) && has(role::v); }
    bool is_colored() const { return has(role::red) && has(role::green) && has(role::blue); }

    std::string file_;
    ply_rest* rest_;
    std::string_view bytes_;
    std::size_t at_ = 0;
    format format_ = format::ascii;
    std::vector<element> elements_;

private:
    std::string_view next_line() const;
    void to_next_line();
    scalar scalar_of(std::string_view name) const;
    format format_of(std::string_view word) const;
    void read_property(const std::vector<std::string_view>& words);
    bool is_read(role use) const;
    void tell_what_is_left_out() const;

    char end_of_line_ = '\n'; ///< of the header
    std::size_t line_ = 1;    ///< of the header
    bool in_header_ = true;
};

} // namespace photongrid::ply
