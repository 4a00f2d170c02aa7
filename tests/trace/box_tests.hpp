// Boxes (scene/box.hpp) on any backend: rays against long double arithmetic, closed boxes that nothing leaves, and
// pictures of boxes against those of their six faces. Included by each on_<backend>.cpp.
#pragma once

#include "hard_cases.hpp"

#include <photongrid/reference/shapes.hpp>

namespace photongrid::testing {

template <class Tag>
class boxes : public hard_cases<Tag> {
};
TYPED_TEST_SUITE_P(boxes);

/// A box of any position, `size` m or some thousandths of it along each edge.
inline box random_box(random_source& u, double size, std::uint32_t material)
{
    const dvec3 x(random_direction(u)), y = glm::normalize(glm::cross(x, dvec3(random_direction(u)))),
                                        z = glm::cross(x, y);
    const auto length = [&] { return size * std::pow(10.0, -3 * static_cast<double>(u())); };
    return {dvec3(random_direction(u)), length() * x, length() * y, -length() * z, material};
}

/// A box as its records have it, in long double.
struct exact_box {
    vec3l axes[3], middle;
    real half[3];

    explicit exact_box(const scene_layout& layout)
    {
        const auto* r = &layout.records[layout.table(shape_kind<box>::number).first];
        for (int i = 0; i < 3; ++i) {
            axes[i] = vec3l(r[i]);
            half[i] = static_cast<real>(r[i].w);
        }
        middle = vec3l(r[3]);
    }
    real place(int axis, const vec3l& p) const { return dot(p - middle, axes[axis]); }
    /// How far p is outside of the faces of `axis`, m; below 0 inside.
    real outside(int axis, const vec3l& p) const { return std::abs(place(axis, p)) - half[axis]; }
    /// The same box with faces farther out by `margin`, m.
    exact_box grown(real margin) const
    {
        auto g = *this;
        for (auto& h : g.half)
            h += margin;
        return g;
    }
    /// Where a ray enters and leaves it; entering comes later for a miss.
    std::pair<real, real> passage(const vec3l& o, const vec3l& d) const
    {
        real enter = -1e30L, leave = 1e30L;
        for (int i = 0; i < 3; ++i) {
            const real slope = dot(d, axes[i]), p = place(i, o), far_side = slope > 0 ? half[i] : -half[i];
            if (slope == 0 && std::abs(p) > half[i])
                return {1, 0};
            if (slope == 0)
                continue;
            enter = std::max(enter, (-far_side - p) / slope);
            leave = std::min(leave, (far_side - p) / slope);
        }
        return {enter, leave};
    }
};

/// Rays at a box's faces, edges and corners, and along its faces; from outside, from far away and from inside.
inline rays rays_at(const box& b, const dvec3& center, random_source& u)
{
    rays r;
    for (int i = 0; i < 6000; ++i) {
        const auto part = [&] { return i % 3 == 0 ? static_cast<double>(u.below(2)) : static_cast<double>(u()); };
        const double last = i % 3 == 1 ? static_cast<double>(u.below(2)) : part();
        const dvec3 at = b.corner + part() * b.edge_u + part() * b.edge_v + last * b.edge_w - center;
        const dvec3 inside
            = b.corner - center + (0.1 + 0.8 * static_cast<double>(u())) * (b.edge_u + b.edge_v + b.edge_w);
        if (i % 2 == 0)
            r.aim(glm::vec3(at + std::pow(10.0, 3 * static_cast<double>(u()) - 1) * dvec3(random_direction(u))), at);
        else if (i % 5 == 0)
            r.add(glm::vec3(at - 3.0 * b.edge_u), glm::vec3(glm::normalize(b.edge_u)));
        else
            r.aim(glm::vec3(inside), at);
    }
    return r;
}

TYPED_TEST_P(boxes, rays_hit_them_where_long_double_says)
{
    // A ray may slide along a face, where rounding decides by which face it enters. So what is asked for is the exact
    // answer for a box whose faces are off by no more than 8 units in the last place: it is met between the hits of
    // the box grown and shrunk by that.
    random_source u(81);
    double off = 0;
    std::size_t hit = 0, wrong = 0;
    for (int variant = 0; variant < 12; ++variant) {
        auto s = empty_scene({3, 0.5, 1});
        s.boxes = {random_box(u, 2, 0)};
        const auto layout = lay_out(s);
        const exact_box e(layout);
        const rays r = rays_at(s.boxes[0], layout.center, u);
        const auto hits = this->trace(s, r);
        for (std::size_t i = 0; i < r.size(); ++i) {
            const vec3l o(r.origins[i]), d(r.directions[i]);
            const double size = static_cast<double>(length(o)) + 4;
            const real margin = 8 * static_cast<real>(ulp(size));
            const auto [enter, leave] = e.grown(margin).passage(o, d);
            const auto [surely_enter, surely_leave] = e.grown(-margin).passage(o, d);
            const bool may = enter <= leave && leave > 0, must = surely_enter <= surely_leave && surely_leave > 0;
            if (!hits.hit(i)) {
                wrong += must ? 1 : 0;
                continue;
            }
            ++hit;
            const vec3l p(hits.places[i]), n(hits.facings[i]);
            const real t = static_cast<real>(hits.places[i].w);
            const bool enters = dot(n, d) < 0; // outwards: against a ray that enters, along one that leaves
            // Rays that only touch it are met anywhere between.
            const real first = enters ? enter
                : must                ? surely_leave
                                      : enter,
                       last = enters && must ? surely_enter : leave;
            if (!may || t < first - margin || t > last + margin || !(dot(n, p - e.middle) > 0)
                || std::abs(length(n) - 1) > 1e-6L)
                ++wrong;
            if (e.grown(-margin).outside(0, o) < 0 && e.grown(-margin).outside(1, o) < 0
                && e.grown(-margin).outside(2, o) < 0)
                wrong += enters ? 1 : 0;
            const real farthest = std::max({e.outside(0, p), e.outside(1, p), e.outside(2, p)});
            off = std::max(off, static_cast<double>(std::abs(farthest)) / ulp(size));
        }
    }
    EXPECT_GT(hit, 40000u);
    this->report("B10", "rays at boxes that long double says otherwise of, of 72,000:", static_cast<double>(wrong));
    this->report("B10", "largest distance of a hit from its box, units in the last place:", off);
    EXPECT_EQ(wrong, 0u);
    EXPECT_LE(off, 8.0);
}

TYPED_TEST_P(boxes, no_ray_escapes_a_closed_one)
{
    // From face to face, on and on, beginning at edges and corners: what leaves a face inwards starts inside of all.
    random_source u(82);
    std::size_t escaped = 0, cast = 0;
    for (int variant = 0; variant < 6; ++variant) {
        auto s = empty_scene(variant == 1 || variant == 3 ? dvec3(30, 0, 0) : dvec3(0, 3, 0));
        s.boxes = {random_box(u, variant < 4 ? 1 : 0.1, 0)};
        const auto layout = lay_out(s);
        const auto& b = s.boxes[0];
        rays r;
        for (int i = 0; i < 4000; ++i) {
            const auto end = [&] { return static_cast<double>(u.below(2)); };
            const dvec3 middle = b.corner + 0.5 * (b.edge_u + b.edge_v + b.edge_w) - layout.center,
                        target = b.corner + end() * b.edge_u + end() * b.edge_v
                + (i % 2 == 0 ? end() : static_cast<double>(u())) * b.edge_w - layout.center;
            r.aim(glm::vec3(middle), target);
            r.leavings.back() = glm::vec4(random_direction(u), 0.0f);
        }
        for (int bounce = 0; bounce < 8; ++bounce) {
            auto hits = this->trace(s, r);
            escaped += hits.misses();
            cast += r.size();
            // Those that leave go inwards.
            for (std::size_t i = 0; i < r.size(); ++i)
                if (glm::dot(glm::vec3(r.leavings[i]), glm::vec3(hits.facings[i])) > 0)
                    r.leavings[i] *= -1.0f;
            hits = this->trace(s, r);
            rays next;
            for (std::size_t i = 0; i < r.size(); ++i)
                if (hits.hit(i))
                    next.add(glm::vec3(hits.starts[i]), glm::vec3(r.leavings[i]), random_direction(u));
            r = next;
        }
    }
    this->report("B10", "rays that left a closed box, of 192,000:", static_cast<double>(escaped));
    EXPECT_EQ(escaped, 0u);
    EXPECT_EQ(cast, 192000u);
}

/// A closed room, one box, with a lamp in it and a small box of glass; walls reflect half.
inline scene room_of_boxes()
{
    scene s;
    s.name = "boxes";
    s.materials = {{"grey", material_kind::lambertian, dvec3(0.5)}, {"glass", material_kind::glass, dvec3(1), 1.5},
        {"mirror", material_kind::mirror, dvec3(1)}};
    s.boxes = {{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 1.5}, 0},
        {{0.5, 0.2, 0.4}, {0.2, 0.1, 0}, {-0.1, 0.2, 0}, {0, 0, 0.3}, 1},
        {{1.4, 0.3, 0.6}, {0.1, 0, 0.1}, {0, 0.4, 0}, {-0.1, 0, 0.1}, 2}};
    s.point_lights = {{"bulb", {1, 0.7, 0.7}, dvec3(3, 2, 1)}};
    s.camera = {{1.9, 0.5, 1.4}, {0.8, 0.4, 0.5}, {0, 1, 0}, 60};
    s.render = {.map = {.photons = 30000, .photon_depth = 64, .grid = {20, 10, 15}},
        .estimate = {.k = 100, .max_radius = 0.3},
        .view = {.spp = 1, .light_samples = 4},
        .output = {.width = 40, .height = 30}};
    return s;
}

TYPED_TEST_P(boxes, a_closed_room_keeps_its_energy)
{
    const auto s = room_of_boxes();
    auto& b = this->b();
    const auto device = upload_scene(b, s);
    const auto t = trace_photons(b, device, s.render);
    const auto stats = count_photons(b, t);
    EXPECT_EQ(stats.escaped, 0u);
    EXPECT_EQ(stats.invalid, 0u);
    EXPECT_EQ(stats.emitted, stats.absorbed + stats.cut_off);
    // All light ends on the walls, half of it at each hit: 1 + 1/2 + 1/4 + ... hits of each path, those cut off apart
    // (photons caught in the glass).
    const double hits = static_cast<double>(stats.diffuse_hits) / static_cast<double>(stats.emitted - stats.cut_off);
    this->report("B10", "hits per path in a room that reflects half, less 2:", hits - 2);
    EXPECT_NEAR(hits, 2.0, 5 * std::sqrt(2.0 / static_cast<double>(stats.emitted)));
}

TYPED_TEST_P(boxes, pictures_are_those_of_their_six_faces)
{
    auto s = room_of_boxes();
    for (const auto kind :
        {material_kind::lambertian, material_kind::mirror, material_kind::metal, material_kind::glass}) {
        s.materials[1].kind = kind;
        auto faces = s;
        faces.boxes.clear();
        for (const auto& b : s.boxes)
            for (const auto& f : faces_of(b))
                faces.polygons.push_back(f);
        auto& b = this->b();
        const auto mine = render(b, s).picture, theirs = render(b, faces).picture;
        const double error = relative_mse(mine, theirs);
        this->report("B10", "relative mean square difference of a box and its six faces:", error);
        EXPECT_LE(error, 1e-3) << static_cast<int>(kind); // few paths part ways by rounding
    }
}

TEST(boxes_in_scenes, are_checked)
{
    const auto refused = [](const box& b, const char* why) {
        try {
            check(b);
            FAIL() << why;
        } catch (const std::invalid_argument& e) {
            EXPECT_NE(std::string(e.what()).find(why), std::string::npos) << e.what();
        }
    };
    EXPECT_NO_THROW(check(box{}));
    EXPECT_NO_THROW(check(box{dvec3(1), {0, 2, 0}, {1, 0, 0}, {0, 0, 1}, 0})) << "left-handed";
    refused({dvec3(std::numeric_limits<double>::quiet_NaN()), {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 0},
        "corner: must be finite");
    refused({dvec3(0), {1, 0, 0}, {0, 0, 0}, {0, 0, 1}, 0}, "edge_v: must be finite and not zero");
    refused({dvec3(0), {1, 0, 0}, {0, 1, 0}, {0, 0.1, 1}, 0}, "right angles");
    refused({dvec3(0), {1, 0, 0.1}, {0, 1, 0}, {0, 0, 1}, 0}, "right angles");

    auto s = room_of_boxes();
    EXPECT_NO_THROW(check(s));
    s.spheres = {{s.boxes[1].corner - dvec3(0.1, 0, 0), 0.08, 1}};
    EXPECT_NO_THROW(check(s));
    s.spheres[0].radius = 0.15;
    EXPECT_THROW(check(s), std::invalid_argument) << "a ball of glass reaches into a box of glass";
    s.spheres.clear();
    auto second = s.boxes[1];
    second.corner += s.boxes[1].edge_u;
    s.boxes.push_back(second);
    EXPECT_NO_THROW(check(s)) << "they touch";
    s.boxes.back().corner -= 0.01 * s.boxes[1].edge_u;
    EXPECT_THROW(check(s), std::invalid_argument);
    s.boxes.back() = {{0.5, 0.26, 0.5}, {0.1, 0, 0.1}, {0, 1, 0}, {-0.1, 0, 0.1}, 1}; // edge through face
    EXPECT_THROW(check(s), std::invalid_argument);
    s.boxes.back().material = 0;
    EXPECT_NO_THROW(check(s)) << "one of them is not of glass";
}

TEST(boxes_in_scenes, faces_look_outwards)
{
    random_source u(83);
    for (int i = 0; i < 20; ++i) {
        auto b = random_box(u, 1, 0);
        if (i % 2 == 0)
            std::swap(b.edge_u, b.edge_v);
        const dvec3 middle = b.corner + 0.5 * (b.edge_u + b.edge_v + b.edge_w);
        double area = 0;
        for (const auto& f : faces_of(b)) {
            EXPECT_NO_THROW(check(f));
            EXPECT_GT(glm::dot(area_vector(f), f.vertices[0] - middle), 0);
            area += glm::length(area_vector(f));
        }
        EXPECT_NEAR(area / reference::surface_area(b), 1.0, 1e-12);
    }
}

REGISTER_TYPED_TEST_SUITE_P(boxes, rays_hit_them_where_long_double_says, no_ray_escapes_a_closed_one,
    a_closed_room_keeps_its_energy, pictures_are_those_of_their_six_faces);

} // namespace photongrid::testing
