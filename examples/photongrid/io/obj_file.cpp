// The reader is our own: tinyobjloader takes what is no number for 0 and says nothing.
#include <photongrid/io/obj/surface.hpp>
#include <photongrid/io/obj_file.hpp>
#include <photongrid/io/whole_file.hpp>

namespace photongrid {

mesh parse_obj(const std::string& file, std::string_view text)
{
    const auto s = obj::parse(file, text);
    const obj::face_range all{0, static_cast<std::uint32_t>(s.face_starts.size())};
    return obj::mesh_of(s, {&all, 1}, nullptr);
}

mesh read_obj(const std::string& path) { return parse_obj(path, whole_file(path)); }

} // namespace photongrid
