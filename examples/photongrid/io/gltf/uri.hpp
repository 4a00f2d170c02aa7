// The names of files in glTF, which can also hold the files' bytes.
#pragma once

#include <photongrid/io/gltf/document.hpp>

#include <optional>
#include <string>
#include <string_view>

namespace photongrid::gltf {

/// The bytes of a text "data:…;base64,…" (RFC 2397); none if it is no such text.
/// \throws scene_error at `p`, whose text it is, for other data than base64.
std::optional<std::string> data_of(const part& p, std::string_view uri);

/// The name of a file: "%20" is a space (RFC 3986).
std::string file_name(std::string_view uri);

} // namespace photongrid::gltf
