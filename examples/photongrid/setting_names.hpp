// The words for settings: the same on the command line, in scene files and in statistics.
#pragma once

#include <photongrid/scene/scene.hpp>

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace photongrid {

/// A value of a setting and the word for it.
template <class Setting>
struct named {
    const char* name;
    Setting value;
};

inline constexpr named<map_builder> map_names[] = {{"sort", map_builder::sort}, {"route", map_builder::route}};
inline constexpr named<search_kind> search_names[] = {{"at_least_k", search_kind::at_least_k},
    {"exact_k", search_kind::exact_k}, {"fixed_radius", search_kind::fixed_radius}};
inline constexpr named<filter_kernel> kernel_names[]
    = {{"constant", filter_kernel::constant}, {"cone", filter_kernel::cone},
        {"epanechnikov", filter_kernel::epanechnikov}, {"silverman", filter_kernel::silverman}};
inline constexpr named<bias_kind> bias_names[] = {{"paper", bias_kind::paper}, {"unbiased", bias_kind::unbiased}};
inline constexpr named<edge_correction> edge_names[]
    = {{"none", edge_correction::none}, {"polygons", edge_correction::polygons}};
inline constexpr named<light_part> part_names[] = {{"all", light_part::all}, {"direct", light_part::direct},
    {"caustic", light_part::caustic}, {"indirect", light_part::indirect}};

template <class Setting, std::size_t N>
std::vector<std::string> words(const named<Setting> (&names)[N])
{
    std::vector<std::string> all;
    for (const auto& n : names)
        all.emplace_back(n.name);
    return all;
}

/// The value called `word`, which is one of words(names).
template <class Setting, std::size_t N>
Setting value_of(const named<Setting> (&names)[N], std::string_view word)
{
    for (const auto& n : names)
        if (n.name == word)
            return n.value;
    throw std::logic_error("no setting is called \"" + std::string(word) + "\"");
}

template <class Setting, std::size_t N>
const char* name_of(const named<Setting> (&names)[N], Setting value)
{
    for (const auto& n : names)
        if (n.value == value)
            return n.name;
    throw std::logic_error("a setting without a name");
}

} // namespace photongrid
