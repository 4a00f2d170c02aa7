#include <photongrid/io/export/gltf_buffer.hpp>

#include <glm/geometric.hpp>

#include <bit>

namespace photongrid::gltf_export {

namespace {
    using json = nlohmann::ordered_json;
    constexpr unsigned floats = 5126, whole_numbers = 5125, vertices = 34962, indices = 34963; // of the specification

    static_assert(
        std::endian::native == std::endian::little, "glTF's buffers are written as the machine's own numbers");

    /// Unit vectors. One of length 0 becomes that of a triangle of the vertex, since glTF has none.
    std::vector<glm::vec3> unit_normals(const mesh& m)
    {
        std::vector<glm::vec3> all;
        for (const auto& n : m.normals) {
            const glm::dvec3 d(n);
            all.emplace_back(glm::length(d) > 0 ? glm::normalize(d) : glm::dvec3(0));
        }
        for (const auto& t : m.triangles)
            for (int c = 0; c < 3; ++c)
                if (all[t[c]] == glm::vec3(0)) {
                    const glm::dvec3 a(m.positions[t.x]), b(m.positions[t.y]), d(m.positions[t.z]);
                    const auto n = glm::cross(b - a, d - a);
                    all[t[c]] = glm::length(n) > 0 ? glm::vec3(glm::normalize(n)) : glm::vec3(0, 0, 1);
                }
        for (auto& n : all)
            if (n == glm::vec3(0)) // of no triangle
                n = {0, 0, 1};
        return all;
    }
} // namespace

std::size_t buffer_writer::add_bytes(const std::string& bytes)
{
    while (bytes_.size() % 4 != 0)
        bytes_ += '\0';
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}});
    bytes_ += bytes;
    return views_.size() - 1;
}

template <class Element>
std::size_t buffer_writer::add_accessor(
    const std::vector<Element>& all, const char* type, unsigned component, unsigned target)
{
    const auto view = add_bytes({reinterpret_cast<const char*>(all.data()), all.size() * sizeof(Element)});
    views_[view]["target"] = target;
    accessors_.push_back({{"bufferView", view}, {"componentType", component}, {"count", all.size()}, {"type", type}});
    return accessors_.size() - 1;
}

json buffer_writer::add(const mesh& m)
{
    const auto positions = add_accessor(m.positions, "VEC3", floats, vertices);
    glm::vec3 low = m.positions[0], high = low;
    for (const auto& p : m.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    accessors_[positions]["min"] = {low.x, low.y, low.z};
    accessors_[positions]["max"] = {high.x, high.y, high.z};
    json attributes = {{"POSITION", positions}};
    if (!m.normals.empty())
        attributes["NORMAL"] = add_accessor(unit_normals(m), "VEC3", floats, vertices);
    if (!m.texture_coordinates.empty()) {
        auto coordinates = m.texture_coordinates;
        for (auto& c : coordinates)
            c.y = 1 - c.y;
        attributes["TEXCOORD_0"] = add_accessor(coordinates, "VEC2", floats, vertices);
    }
    if (!m.colors.empty())
        attributes["COLOR_0"] = add_accessor(m.colors, "VEC3", floats, vertices);
    std::vector<std::uint32_t> corners;
    for (const auto& t : m.triangles)
        corners.insert(corners.end(), {t.x, t.y, t.z});
    return {{"attributes", attributes}, {"indices", add_accessor(corners, "SCALAR", whole_numbers, indices)}};
}

} // namespace photongrid::gltf_export
