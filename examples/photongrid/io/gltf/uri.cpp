#include <photongrid/io/gltf/uri.hpp>

#include <cstdint>

namespace photongrid::gltf {

namespace {
    /// The value of a character of base64 (RFC 4648), or -1.
    int base64_value(char c)
    {
        if (c >= 'A' && c <= 'Z')
            return c - 'A';
        if (c >= 'a' && c <= 'z')
            return c - 'a' + 26;
        if (c >= '0' && c <= '9')
            return c - '0' + 52;
        return c == '+' ? 62 : c == '/' ? 63 : -1;
    }
} // namespace

std::optional<std::string> data_of(const part& p, std::string_view uri)
{
    if (!uri.starts_with("data:"))
        return std::nullopt;
    const auto comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64"))
        p.fail("found data that is not in base64");
    uri.remove_prefix(comma + 1);
    while (uri.ends_with('='))
        uri.remove_suffix(1);
    std::string made;
    made.reserve(uri.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int held = 0;
    for (const char c : uri) {
        const int value = base64_value(c);
        if (value < 0)
            p.fail("found a character in its data that base64 does not have");
        bits = (bits & 0xFFFu) << 6 | static_cast<std::uint32_t>(value);
        held += 6;
        if (held >= 8) {
            held -= 8;
            made += static_cast<char>(bits >> held & 0xFFu);
        }
    }
    return made;
}

std::string file_name(std::string_view uri)
{
    const auto digit = [](char c) {
        return c >= '0' && c <= '9' ? c - '0'
            : c >= 'a' && c <= 'f'  ? c - 'a' + 10
            : c >= 'A' && c <= 'F'  ? c - 'A' + 10
                                    : -1;
    };
    std::string made;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0) {
            made += static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2]));
            i += 2;
        } else {
            made += uri[i];
        }
    }
    return made;
}

} // namespace photongrid::gltf
