// The reader is our own: tinyobjloader takes what is no number for 0 and says nothing.
#include <photongrid/io/obj/surface.hpp>
#include <photongrid/io/obj_file.hpp>
#include <photongrid/io/whole_file.hpp>

namespace photongrid {

mesh parse_obj(const std::string& file, std::string_view text, std::vector<std::string>* left_out)
{
    const auto s = obj::parse(file, text);
    const obj::face_range all{0, static_cast<std::uint32_t>(s.face_starts.size())};
    polygon_cutter cutter;
    auto made = obj::mesh_of(s, {&all, 1}, cutter);
    if (left_out != nullptr && s.flat.count > 0)
        left_out->push_back(text_of_flat_faces(s.flat.count));
    if (left_out != nullptr && cutter.not_cut() > 0)
        left_out->push_back(text_of_crossed_faces(cutter.not_cut()));
    return made;
}

mesh read_obj(const std::string& path) { return parse_obj(path, whole_file(path)); }

} // namespace photongrid
