#include <photongrid/io/ply_writer.hpp>

#include <bit>
#include <cstdint>
#include <type_traits>

namespace photongrid {

static_assert(std::endian::native == std::endian::little, "PLY files are written as the machine's own numbers");

std::string ply_bytes(const mesh& m)
{
    check(m);
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(m.positions.size());
    const auto declare = [&](bool has, std::initializer_list<const char*> names, const char* type = "float") {
        if (has)
            for (const auto* name : names)
                bytes += std::string("\nproperty ") + type + " " + name;
    };
    const bool is_far = m.origin != glm::dvec3(0);
    declare(true, {"x", "y", "z"}, is_far ? "double" : "float");
    declare(!m.normals.empty(), {"nx", "ny", "nz"});
    declare(!m.texture_coordinates.empty(), {"u", "v"});
    declare(!m.colors.empty(), {"red", "green", "blue"});
    bytes += "\nelement face " + std::to_string(m.triangles.size())
        + "\nproperty list uchar int vertex_indices\nend_header\n";
    const auto append = [&](const auto& value) {
        static_assert(std::is_trivially_copyable_v<std::remove_reference_t<decltype(value)>>);
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    for (std::size_t v = 0; v < m.positions.size(); ++v) {
        if (is_far)
            append(m.origin + glm::dvec3(m.positions[v]));
        else
            append(m.positions[v]);
        if (!m.normals.empty())
            append(m.normals[v]);
        if (!m.texture_coordinates.empty())
            append(m.texture_coordinates[v]);
        if (!m.colors.empty())
            append(m.colors[v]);
    }
    for (const auto& t : m.triangles) {
        append(std::uint8_t{3});
        append(t);
    }
    return bytes;
}

} // namespace photongrid
