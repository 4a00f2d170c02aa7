#include <photongrid/io/obj/surface.hpp>

#include <optional>

namespace photongrid::obj {

namespace {
    /// The numbers of corners: a table with open addressing, which takes a third of the memory of a standard one.
    class corner_numbers {
    public:
        explicit corner_numbers(std::size_t corners)
        {
            std::size_t size = 64;
            while (size / 4 * 3 < corners)
                size *= 2;
            table_.assign(size, absent);
        }
        /// The number of a corner; if it has none, `next`, which it then has.
        std::uint32_t number_of(const corner& c, std::uint32_t next)
        {
            if (numbered_.size() * 4 > table_.size() * 3)
                grow();
            auto& place = place_of(c);
            if (place == absent) {
                place = static_cast<std::uint32_t>(numbered_.size());
                numbered_.push_back({c, next});
            }
            return numbered_[place].number;
        }

    private:
        struct numbered {
            corner of;
            std::uint32_t number;
        };
        std::uint32_t& place_of(const corner& c)
        {
            std::uint64_t h = 0;
            for (const auto n : c) {
                h = (h ^ n) * 0x9E3779B97F4A7C15u;
                h ^= h >> 29;
            }
            auto at = static_cast<std::size_t>(h) & (table_.size() - 1);
            while (table_[at] != absent && numbered_[table_[at]].of != c)
                at = (at + 1) & (table_.size() - 1);
            return table_[at];
        }
        void grow()
        {
            table_.assign(table_.size() * 2, absent);
            for (std::uint32_t i = 0; i < numbered_.size(); ++i)
                place_of(numbered_[i].of) = i;
        }

        std::vector<numbered> numbered_;
        std::vector<std::uint32_t> table_; ///< indices into numbered_, or absent; a power of two
    };
} // namespace

mesh mesh_of(const surface& s, std::span<const face_range> faces, polygon_cutter& cutter)
{
    const auto first_corner = [&](std::uint32_t face) {
        return face < s.face_starts.size() ? s.face_starts[face] : static_cast<std::uint32_t>(s.corners.size());
    };
    bool has_coordinates = false, has_normals = false;
    std::size_t corners = 0, triangles = 0;
    for (const auto& r : faces) {
        const auto begin = first_corner(r.first), end = first_corner(r.past);
        for (auto i = begin; i < end; ++i) {
            has_coordinates = has_coordinates || s.corners[i][1] != absent;
            has_normals = has_normals || s.corners[i][2] != absent;
        }
        corners += end - begin;
        triangles += end - begin - 2 * (r.past - r.first);
    }
    mesh made;
    std::vector<glm::dvec3> places;
    made.triangles.reserve(triangles);
    const auto add = [&](const corner& c, const glm::vec3& normal) {
        places.push_back(s.positions[c[0]]);
        if (has_coordinates)
            made.texture_coordinates.push_back(c[1] == absent ? glm::vec2(0) : s.coordinates[c[1]]);
        if (has_normals)
            made.normals.push_back(normal);
        if (!s.colors.empty())
            made.colors.push_back(c[0] < s.colors.size() ? s.colors[c[0]] : glm::vec3(1));
    };
    corner_numbers numbers(std::min(corners, s.positions.size()));
    std::vector<std::uint32_t> face;
    std::vector<glm::dvec3> outline;
    for (const auto& r : faces)
        for (auto f = r.first; f < r.past; ++f) {
            const std::size_t begin = first_corner(f), end = first_corner(f + 1);
            face.clear();
            outline.clear();
            for (std::size_t i = begin; i < end; ++i)
                outline.emplace_back(s.positions[s.corners[i][0]]);
            std::optional<glm::vec3> of_plane; // which corners without a normal have, and share with no other face
            for (std::size_t i = begin; i < end; ++i) {
                const auto& c = s.corners[i];
                const auto next = static_cast<std::uint32_t>(places.size());
                if (has_normals && c[2] == absent) {
                    if (!of_plane)
                        of_plane = glm::vec3(normal_of_polygon(outline));
                    add(c, *of_plane);
                    face.push_back(next);
                    continue;
                }
                face.push_back(numbers.number_of(c, next));
                if (face.back() == next)
                    add(c, has_normals ? s.normals[c[2]] : glm::vec3(0));
            }
            if (face.size() == 3)
                made.triangles.emplace_back(face[0], face[1], face[2]);
            else
                for (const auto& t : cutter.triangles_of(outline, normal_of_polygon(outline)))
                    made.triangles.emplace_back(face[t.x], face[t.y], face[t.z]);
        }
    set_positions(made, places);
    return made;
}

} // namespace photongrid::obj
