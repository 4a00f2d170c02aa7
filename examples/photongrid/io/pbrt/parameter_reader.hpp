// The parameters of pbrt's directives, as `"float radius" [ 2 ]`.
#pragma once

#include <photongrid/io/import/token_reader.hpp>
#include <photongrid/io/pbrt/description.hpp>

#include <initializer_list>
#include <string_view>

namespace photongrid::pbrt {

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words);

/// The next parameter. \throws scene_error.
parameter read_parameter(token_reader& t);

/// Those that follow; none is an empty list. \throws scene_error.
parameter_list read_parameters(token_reader& t);

} // namespace photongrid::pbrt
