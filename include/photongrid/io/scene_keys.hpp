// The keys that objects of a scene file may have, from the tables of shapes, lights and settings.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace photongrid {

/// A key that an object of a scene file may have.
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

/// In scene files a polygon of three vertices may be called this.
inline constexpr const char* triangle_name = "triangle";

/// Every kind of object.
std::span<const object_keys> known_objects();

/// The names of all kinds of shapes; of all kinds of lights.
std::vector<std::string> shape_names();
std::vector<std::string> light_names();

} // namespace photongrid
