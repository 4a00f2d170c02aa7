#include <photongrid/io/pbrt/transformations.hpp>

#include <photongrid/scene/check.hpp>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

namespace photongrid::pbrt {

glm::dmat4 read_matrix(token_reader& t)
{
    const bool in_brackets = t.peek() && t.peek()->is == token::kind::open;
    if (in_brackets)
        t.next();
    const auto all = read_numbers<16>(t);
    if (in_brackets && (!t.peek() || t.peek()->is != token::kind::close))
        t.fail_at_next("], since a matrix has 16 numbers");
    if (in_brackets)
        t.next();
    return glm::make_mat4(all.data()); // both column by column
}

glm::dmat4 read_translation(token_reader& t)
{
    const auto v = read_numbers<3>(t);
    return glm::translate(glm::dmat4(1), dvec3(v[0], v[1], v[2]));
}

glm::dmat4 read_scaling(token_reader& t)
{
    const auto v = read_numbers<3>(t);
    return glm::scale(glm::dmat4(1), dvec3(v[0], v[1], v[2]));
}

glm::dmat4 read_rotation(token_reader& t, const source_place& place)
{
    const auto v = read_numbers<4>(t);
    const dvec3 axis(v[1], v[2], v[3]);
    if (!(glm::length(axis) > 0))
        fail_at(place, "Rotate about an axis of length 0");
    return glm::rotate(glm::dmat4(1), glm::radians(v[0]), axis);
}

glm::dmat4 read_view(token_reader& t, const source_place& place)
{
    const auto v = read_numbers<9>(t);
    const dvec3 eye(v[0], v[1], v[2]), at(v[3], v[4], v[5]), up(v[6], v[7], v[8]);
    const dvec3 forward = at - eye, right = glm::cross(up, forward);
    if (!(glm::length(right) > 0))
        fail_at(place, "LookAt: the direction of view is parallel to the upward one, or 0");
    const dvec3 z = glm::normalize(forward), x = glm::normalize(right);
    const glm::dmat4 camera_to_world(
        glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), glm::dvec4(eye, 1));
    return glm::inverse(camera_to_world);
}

} // namespace photongrid::pbrt
