#include <photongrid/io/obj_scene.hpp>

namespace photongrid {

imported_scene parse_obj_scene(const std::string& file, std::string_view, const import_settings&)
{
    throw scene_error(file, 0, 0, "not read yet");
}
imported_scene read_obj_scene(const std::string& path, const import_settings&)
{
    throw scene_error(path, 0, 0, "not read yet");
}
imported_scene parse_ply_scene(const std::string& file, std::string_view, const import_settings&)
{
    throw scene_error(file, 0, 0, "not read yet");
}
imported_scene read_ply_scene(const std::string& path, const import_settings&)
{
    throw scene_error(path, 0, 0, "not read yet");
}
} // namespace photongrid
