// Scene files: JSON in, a checked photongrid::scene in SI units out. docs/guide/scenes.md describes the format.
#pragma once

#include "json_tree.hpp"

#include <photongrid/scene/scene.hpp>

#include <span>
#include <string>

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

/// Everything the reader knows.
std::span<const object_keys> known_objects();

/// Reads the scene in `text`; `file` is its name in messages. Throws scene_error.
scene parse_scene(const std::string& file, std::string text);

/// Reads a scene file. Throws scene_error.
scene read_scene(const std::string& path);

} // namespace photongrid
