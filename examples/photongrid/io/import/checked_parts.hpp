// What the parts of scene_builder share.
#pragma once

#include <photongrid/io/import/import_log.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace photongrid::detail {

/// The factor by which a matrix scales all lengths alike, or 0.
inline double even_scale(const glm::dmat3& m)
{
    const double x = glm::length(m[0]), y = glm::length(m[1]), z = glm::length(m[2]);
    constexpr double most = 1e-6;
    const bool even = std::abs(x - y) <= most * x && std::abs(x - z) <= most * x
        && std::abs(glm::dot(m[0], m[1])) <= most * x * y && std::abs(glm::dot(m[0], m[2])) <= most * x * z
        && std::abs(glm::dot(m[1], m[2])) <= most * y * z;
    return even ? x : 0;
}

/// Runs photongrid::check. Its message gets the place and begins with `of`.
template <class Part>
void check_at(const source_place& place, const Part& part, const std::string& of = "")
{
    try {
        check(part);
    } catch (const std::invalid_argument& e) {
        fail_at(place, of + e.what());
    }
}

/// Adds a part to a scene, or throws scene_error for what check() rejects.
template <class List, class Part>
void add_checked(const source_place& place, List& list, Part part)
{
    check_at(place, part);
    list.push_back(std::move(part));
}

} // namespace photongrid::detail
