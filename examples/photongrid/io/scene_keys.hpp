// The keys of the objects in scene files, from the tables of materials, shapes, lights and settings.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace photongrid {

/// A key of an object in a scene file.
struct scene_key {
    const char* name;
    bool required;
};

/// The keys of one kind of object. examples/scenes/photongrid-scene.schema.json defines the same kinds by the same
/// names (a test compares them). Every object may also have "comment".
struct object_keys {
    const char* name;
    std::span<const scene_key> keys;
};

/// In scene files, another name for a polygon with three vertices.
inline constexpr const char* triangle_name = "triangle";

/// Every kind of object.
std::span<const object_keys> known_objects();

std::vector<std::string> material_names(); ///< of all kinds of materials
std::vector<std::string> shape_names();    ///< of all kinds of shapes
std::vector<std::string> light_names();    ///< of all kinds of lights

} // namespace photongrid
