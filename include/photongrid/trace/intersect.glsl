// Ray-scene intersection (3.1): tests every shape, as the paper does, or in scenes of many those that a tree finds.
// Included by kernels after the SWITCHes of lights and the scene buffer. Only the kinds of shapes that the scene has
// are compiled. A kind of shape is a file of intersect/ and a line in each of the functions below.
//
// hit_x returns the distance along the ray, or `far` if shape x is not hit before that. closest_x tests all shapes x,
// x_surface computes the hit point's position, normal and material, and x_block says whether any shape x occludes a
// ray.
#include <photongrid/core/vector.glsl>
#include <photongrid/trace/ray_tests.glsl>
#include <photongrid/trace/scene_layout.glsl>

// The bit of the n-th polygon or sphere of the scene. All from the 32nd on share one bit.
uint bit_of(uint n)
{
    return 1u << (n < 31u ? n : 31u);
}

#include <photongrid/trace/intersect/plane.glsl>
#include <photongrid/trace/polygon_record.glsl>

#include <photongrid/trace/intersect/sphere.glsl>
#include <photongrid/trace/intersect/quadric.glsl>
#include <photongrid/trace/intersect/disk.glsl>
#include <photongrid/trace/intersect/box.glsl>
#include <photongrid/trace/intersect/polygon.glsl>

// The distance at which a ray hits a shape of any kind, or 3.0e38; `at`: its first record.
float hit_shape(uint kind, uint at, vec3 o, vec3 d)
{
    if (SPHERES && kind == SPHERE)
        return hit_sphere(at, o, d, 3.0e38f);
    if (QUADRICS && kind == QUADRIC)
        return hit_quadric(at, o, d, 3.0e38f);
    if (DISKS && kind == DISK)
        return hit_disk(at, o, d, 3.0e38f);
    if (BOXES && kind == BOX)
        return hit_box(at, o, d, 3.0e38f);
    if (POLYGONS && kind == POLYGON)
        return hit_polygon(at, polygon_edges(at), o, d, 3.0e38f);
    return 3.0e38f;
}

#include <photongrid/trace/intersect/tree.glsl>

// The closest hit of the ray from o in direction d, if it is nearer than `far`.
Hit intersect_before(vec3 o, vec3 d, float far)
{
    Closest c;
    c.t = far;
    c.kind = NO_SHAPE;
    c.at = 0u;
    if (TREE_OF_SHAPES) {
        c = closest_in_tree(o, d, c);
    } else {
        if (SPHERES)
            c = closest_sphere(o, d, c);
        if (QUADRICS)
            c = closest_quadric(o, d, c);
        if (DISKS)
            c = closest_disk(o, d, c);
        if (BOXES)
            c = closest_box(o, d, c);
        if (POLYGONS)
            c = closest_polygon(o, d, c);
    }

    Hit hit;
    hit.t = c.kind == NO_SHAPE ? -1.0f : c.t;
    hit.material = 0u;
    hit.light = 0u;
    hit.position = ray_at(o, d, c.t);
    hit.normal = vec3(0.0f, 0.0f, 1.0f);
    hit.shading = hit.normal;
    hit.round_share = scene(SCENE_SIZES).x;
    if (SPHERES && c.kind == SPHERE)
        hit = sphere_surface(c.at, hit);
    if (QUADRICS && c.kind == QUADRIC)
        hit = quadric_surface(c.at, hit);
    if (DISKS && c.kind == DISK)
        hit = disk_surface(c.at, hit);
    if (BOXES && c.kind == BOX)
        hit = box_surface(c.at, o, d, hit);
    if (POLYGONS && c.kind == POLYGON)
        hit = polygon_surface(c.at, hit);
    hit.shading = hit.normal;
    return hit;
}

Hit intersect_closest(vec3 o, vec3 d)
{
    return intersect_before(o, d, 3.0e38f);
}

// A set of polygons and spheres, as bits (bit_of). In a tree: without polygons the surfaces of rectangle lights are
// left out, if they are apart (detail::lamps_block_none).
struct Candidates {
    uint polygons;
    uint spheres;
};

// Shaft culling (Haines and Wallace, Shaft Culling for Efficient Ray-Traced Radiosity, 1991): the polygons and
// spheres that can occlude a parallelogram, seen from a point.
Candidates shaft(vec3 from, vec3 corner, vec3 edge_u, vec3 edge_v)
{
    Candidates c;
    c.polygons = 0u;
    c.spheres = 0u;
    if (POLYGONS && !TREE_OF_SHAPES)
        c.polygons = polygons_in_shaft(from, corner, edge_u, edge_v);
    if (SPHERES && !TREE_OF_SHAPES)
        c.spheres = spheres_in_shaft(from, corner, edge_u, edge_v);
    return c;
}

Candidates everything()
{
    Candidates c;
    c.polygons = 0xFFFFFFFFu;
    c.spheres = 0xFFFFFFFFu;
    return c;
}

// What can occlude a rectangle light.
Candidates all_before_rectangles()
{
    Candidates c = everything();
    if (TREE_OF_SHAPES)
        c.polygons = 0u;
    return c;
}

// Any-hit query up to distance `far`. Of polygons and spheres only the candidates are tested, unless there is a tree.
bool occluded(vec3 o, vec3 d, float far, Candidates c)
{
    if (TREE_OF_SHAPES)
        return tree_blocks(o, d, far, c.polygons != 0u);
    if (POLYGONS && c.polygons != 0u && polygons_block(o, d, far, c.polygons))
        return true;
    if (SPHERES && c.spheres != 0u && spheres_block(o, d, far, c.spheres))
        return true;
    if (QUADRICS && quadrics_block(o, d, far))
        return true;
    if (DISKS && disks_block(o, d, far))
        return true;
    if (BOXES && boxes_block(o, d, far))
        return true;
    return false;
}

// The origin of a ray that leaves a hit in direction d: offset from the surface to the side of d.
vec3 ray_start(Hit hit, vec3 d)
{
    float off = ray_offset(hit.position, hit.round_share);
    return ray_at(hit.position, hit.normal, dot3(hit.normal, d) >= 0.0f ? off : -off);
}
