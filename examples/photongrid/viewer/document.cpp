#include "document.hpp"

#include <photongrid/scene/setting_table.hpp>

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace photongrid::viewer {

namespace {
    constexpr std::size_t most_steps = 200;
    constexpr double nearest_to_pole = 2; // degrees between line of sight and up
} // namespace

version read_again(const version& now, const version& was, const version& is)
{
    auto made = is;
    made.backend = now.backend;
    if (now.scene.camera != was.scene.camera)
        made.scene.camera = now.scene.camera;
    for_each_setting([&](const auto& row) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(row.values)>, setting_table::pixels>) // never changed here
            if (row.of(now.settings) != row.of(was.settings))
                row.of(made.settings) = row.of(now.settings);
    });
    return made;
}

bool moves_parts(const version& now, const version& was)
{
    auto with_its_camera = was.scene;
    with_its_camera.camera = now.scene.camera;
    return now.scene != with_its_camera;
}

void document::begin(const std::string& name)
{
    if (!past_.empty() && past_.back().before == now_) // the last step changed nothing
        past_.pop_back();
    past_.push_back({now_, name});
    if (past_.size() > most_steps)
        past_.erase(past_.begin());
    future_.clear();
}

std::string document::undo()
{
    while (!past_.empty() && past_.back().before == now_)
        past_.pop_back();
    if (past_.empty())
        return "";
    auto last = std::move(past_.back());
    past_.pop_back();
    std::swap(last.before, now_);
    future_.push_back(last); // `before` is what redo restores
    return last.name;
}

std::string document::redo()
{
    if (future_.empty())
        return "";
    auto next = std::move(future_.back());
    future_.pop_back();
    std::swap(next.before, now_);
    past_.push_back(next);
    return next.name;
}

void document::orbit(double across, double upward)
{
    auto& c = now_.scene.camera;
    const dvec3 up = glm::normalize(c.up);
    dvec3 back = c.position - c.look_at;
    back = dvec3(glm::rotate(glm::dmat4(1), glm::radians(-across), up) * glm::dvec4(back, 0));
    const double from_pole = glm::degrees(std::acos(std::clamp(glm::dot(glm::normalize(back), up), -1.0, 1.0)));
    const double angle = std::clamp(from_pole - upward, nearest_to_pole, 180 - nearest_to_pole);
    const dvec3 axis = glm::normalize(glm::cross(up, back));
    back = dvec3(glm::rotate(glm::dmat4(1), glm::radians(angle - from_pole), axis) * glm::dvec4(back, 0));
    c.position = c.look_at + back;
}

void document::pan(double right, double up)
{
    auto& c = now_.scene.camera;
    const photongrid::detail::camera_axes axes(c);
    const double height = 2 * glm::distance(c.position, c.look_at) * std::tan(glm::radians(c.vertical_fov) / 2);
    const dvec3 by = height * (right * axes.right + up * axes.up);
    c.position += by;
    c.look_at += by;
}

void document::zoom(double factor)
{
    auto& c = now_.scene.camera;
    c.position = c.look_at + (c.position - c.look_at) / factor;
}

} // namespace photongrid::viewer
