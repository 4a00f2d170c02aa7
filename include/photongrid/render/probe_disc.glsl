// Probes the surface about a point by short rays, to find how much of an estimate's disc lies on it, where a glance
// (glance.glsl) has not seen that it is whole. In each of eight directions, one after the other:
//
//     slanted, as at a glance: the same surface at the rim, and nothing before it? Then that is all
//     along the surface, a little above it, or as high as that ray met something: a wall?
//     if there is one, from there on: its far side? It is solid up to there if the ray enters at a front and leaves at
//     a back, and so does one from inside it upwards: a tube that stands on the surface is not solid
//     if it is of glass, light passes it, and another light is behind it: the disc ends at its plane, as below
//     down from beyond it: a surface there, whose photons would count? Then the disc ends at the wall's plane
//     (half_space.glsl), and it is probed again. Where there are photons before the plane, but behind another wall,
//     the disc is cut down to where they begin; behind a sheet, which has no far side, as if there were no wall
//     without a wall, down from the rim, else from before the wall: still the same surface? If not, halfway, until it
//     is known where it ends
//
// The share is the mean over the directions of the filter's mass up to there. They are even, and turned by a random
// angle for each point: at straight edges and in right corners the mean has a deviation of 0.02 to 0.035 and next to no
// bias, nor has its inverse. Where the surface is much smaller than the disc, as a box in a room with few photons, the
// disc is cut down to it, since ends are known to a share of the radius. Where it is much narrower, as a table's leg,
// most directions miss its length, so the disc is cut down to its width.
//
// Distances are those through space, as a search measures them: then the part of a ball's surface within a distance is
// as large as a disc.
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/estimate/half_space.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uint filter_number; // of the estimate
    float min_cosine;   // of normals on the same surface (leak_policy)
};
PARAMS(Params)
SWITCH(5, GLASS)
SWITCH(7, AREA_LIGHTS)
INPUT(0, vec4, scene)
INPUT(1, vec4, mesh_places) // these three: see mesh_surface.glsl
INPUT(2, vec4, mesh_normals)
INPUT(3, vec4, mesh_shadings)
INPUT(4, vec4, points)      // xyz, m; w: squared radius of the disc, m^2; 0 or less: no estimate
INPUT(5, vec4, normals)
STATE(0, vec4, origin)    // of the ray in flight; w: its length, 0: there is none
STATE(1, vec4, direction) // xyz: unit vector; w: how far the ray along the surface had come before, m
STATE(2, vec4, probed)    // x: share of the disc so far; y: its half space (half_space.glsl); z: how far the surface
                          // goes, in radii; w: the disc's radius over that of `points`
STATE(3, vec4, border)    // zw: bounds of where the surface ends in this direction, along the plane, over the radius;
                          // y: distance over that, of what was last found of it; at a wall the half space before it;
                          // x: 1: the wall was met at a front; after that, that its far side is in the disc
STATE(4, vec4, firsts)    // where it ends in the first four directions
STATE(5, vec4, progress)  // x: number of the direction; y: what the ray looks for; z: how many of four directions and
                          // their opposites are narrow together; w: the least width, in radii

#include <photongrid/trace/intersect.glsl>
#include <photongrid/trace/mesh_hit.glsl>
#include <photongrid/trace/materials.glsl>
#include <photongrid/render/probed_surface.glsl>
#include <photongrid/render/surface_way.glsl>

const float BEGINS = 0.0f; // as states begin
const float WALL = 1.0f;
const float FAR_SIDE = 2.0f;
const float BEYOND = 3.0f;
const float RIM = 4.0f;
const float END = 5.0f;
const float FINISHED = 6.0f;
const float GLANCE = 7.0f;
const float INSIDE = 8.0f;
const float FOOT = 9.0f;

const float DIRECTIONS = 8.0f;
const float WHOLE = 1.0f;      // where the surface ends if it does not within the radius
const float DEPTH = 0.6f;      // to which the surface may fall, in radii
const float ASLANT = 0.92f;    // cosine of half the angle between directions: a wall may be nearer between them
const float LEAST = 0.0625f;   // the least share of the radius that a disc is cut down to
const float NARROW = 0.75f;    // a surface that is no wider, in radii, in three of four directions is narrow
const float SMALL = 0.8f;      // a surface that is nowhere farther, in radii, is small
const float PRECISION = 0.07f; // to which the end of the surface is found, in radii

bool done()
{
    return progress.y == FINISHED;
}

float radius_of(uint i)
{
    precise float radius = sqrt(points(i).w) * probed.w;
    return radius;
}

// The part of the filter's mass within a distance, in radii.
float mass_within(float rho)
{
    float within = rho < 1.0f ? rho : 1.0f;
    precise float t = within * within;
    precise float outside = 1.0f - t;
    precise float mass = t;
    if (args.filter_number == 1u) {
        precise float cone = t * (3.0f - 2.0f * within);
        mass = cone;
    }
    if (args.filter_number == 2u) {
        precise float epanechnikov = 1.0f - outside * outside;
        mass = epanechnikov;
    }
    if (args.filter_number == 3u) {
        precise float silverman = 1.0f - outside * outside * outside;
        mass = silverman;
    }
    return mass;
}

void send(vec3 from, vec3 d, float far, float come, float what)
{
    origin = vec4(from.x, from.y, from.z, far > 0.0f ? far : 0.0f);
    direction = vec4(d.x, d.y, d.z, come);
    progress.y = what;
}

// Over the surface, m.
float height_of(uint i, vec3 there)
{
    precise vec3 way = there - vec3(points(i));
    return dot3(way, vec3(normals(i)));
}

void glance_along(uint i)
{
    Slanted s = slanted_ray(i, progress.x, DIRECTIONS, radius_of(i));
    send(s.from, s.d, s.far, 0.0f, GLANCE);
}

// A little above the surface at distance rho, in radii.
vec3 above_surface(uint i, float rho)
{
    vec3 p = vec3(points(i));
    float radius = radius_of(i);
    precise float along = rho * radius;
    return ray_at(ray_at(p, vec3(normals(i)), height_at(p, radius)), way_along(i, progress.x, DIRECTIONS), along);
}

// `met`: the height at which the slanted ray met something, m, which may hover as a glass that stands on a table, or 0.
void send_along(uint i, float met)
{
    vec3 p = vec3(points(i));
    float radius = radius_of(i);
    vec3 from = ray_at(p, vec3(normals(i)), max(met, height_at(p, radius)));
    send(from, way_along(i, progress.x, DIRECTIONS), radius, 0.0f, WALL);
}

// Down from there to the surface.
void send_down(uint i, float rho, float what)
{
    float radius = radius_of(i);
    precise float depth = height_at(vec3(points(i)), radius) + DEPTH * radius;
    send(above_surface(i, rho), -vec3(normals(i)), depth, 0.0f, what);
}

void send_up(uint i, float rho)
{
    send(above_surface(i, rho), vec3(normals(i)), 3.0e38f, 0.0f, INSIDE);
}

HalfSpace half_space(uint i)
{
    vec3 n = vec3(normals(i));
    return half_space_of(vec4(n.x, n.y, n.z, probed.y), radius_of(i));
}

// `code`: of the half space.
void begin(uint i, float share_of_radius, float code)
{
    probed = vec4(0.0f, code, 0.0f, share_of_radius);
    border = vec4(0.0f, 1.0f, 0.0f, 1.0f);
    firsts = border;
    progress = vec4(0.0f, GLANCE, 0.0f, 2.0f);
    glance_along(i);
}

// The surface ends at distance `far` in this direction, in radii: on to the next one.
void end_direction(uint i, float far)
{
    float number = progress.x;
    float rho = far;
    if (probed.y > 0.0f) {
        HalfSpace before = half_space(i);
        float towards = dot3(before.way, way_along(i, number, DIRECTIONS));
        precise float plane = before.far / (max(towards, 1.0e-6f) * radius_of(i));
        rho = min(rho, plane);
    }
    precise float share = probed.x + 0.125f * mass_within(rho);
    probed.z = max(probed.z, rho);
    if (number == 0.0f)
        firsts.x = rho;
    if (number == 1.0f)
        firsts.y = rho;
    if (number == 2.0f)
        firsts.z = rho;
    if (number == 3.0f)
        firsts.w = rho;
    if (number >= 4.0f) {
        float opposite = number == 4.0f ? firsts.x
            : number == 5.0f            ? firsts.y
            : number == 6.0f            ? firsts.z
                                        : firsts.w;
        precise float width = rho + opposite;
        progress.z = progress.z + (width < NARROW ? 1.0f : 0.0f);
        progress.w = min(progress.w, width);
    }
    border = vec4(0.0f, 1.0f, 0.0f, 1.0f);
    probed.x = share;
    if (number + 1.0f < DIRECTIONS) {
        progress.x = number + 1.0f;
        glance_along(i);
        return;
    }
    bool is_narrow = progress.z >= 3.0f;
    bool is_small = probed.z < SMALL;
    precise float cut_down = probed.w * (is_narrow ? progress.w : 1.1f * probed.z + 0.5f * PRECISION);
    if ((is_narrow || is_small) && probed.w > LEAST) {
        begin(i, max(cut_down, LEAST), 0.0f);
        return;
    }
    origin.w = 0.0f;
    progress.y = FINISHED;
}

// There is a wall at distance `far` in this direction, in radii: the surface ends there, unless it ends before.
void end_at_wall(uint i, float far)
{
    if (far < 0.25f) { // little light is before it
        end_direction(i, far);
        return;
    }
    border = vec4(0.0f, 1.0f, far, max(far - 0.5f * PRECISION, 0.5f * far));
    send_down(i, border.w, FOOT);
}

// The half space before a wall that has this normal, at a point in this way; 0: the wall is no wall.
float half_space_before(uint i, vec3 m, vec3 way, float radius)
{
    vec3 n = vec3(normals(i));
    float rise = dot3(m, n);
    precise vec3 along = n * rise - m;
    float length2 = dot3(along, along);
    if (!(length2 > 1.0e-4f))
        return 0.0f;
    precise float length = sqrt(length2);
    precise float share = dot3(along, way) / (length * radius);
    return half_space_code(n, along, share);
}

// There is a surface with photons beyond the wall.
void meet_leak(uint i, vec3 there)
{
    precise vec3 way = there - vec3(points(i));
    precise float cut_down = probed.w * border.w * ASLANT;
    if (probed.y > 0.0f && is_beyond(half_space(i), way.x, way.y, way.z))
        end_at_wall(i, border.z);
    else if (probed.y == 0.0f && border.y > 0.0f)
        begin(i, probed.w, border.y);
    else if (border.x > 0.0f && probed.w > LEAST)
        begin(i, max(cut_down, LEAST), 0.0f);
    else
        end_direction(i, WHOLE); // as if there were no wall
}

// The ray along the surface has met something or nothing.
void meet_wall(uint i, bool met, Hit hit)
{
    vec3 d = vec3(direction);
    float radius = radius_of(i);
    if (!met) {
        send_down(i, 1.0f, RIM);
        return;
    }
    precise float come = direction.w + hit.t;
    precise float rho = come / radius;
    vec3 m = dot3(hit.normal, d) < 0.0f ? hit.normal : -hit.normal;
    if (dot3(m, vec3(normals(i))) >= args.min_cosine) {
        end_direction(i, WHOLE); // the surface rises
        return;
    }
    precise vec3 way = hit.position - vec3(points(i));
    precise float slack = HEIGHT * radius;
    HalfSpace before = half_space(i);
    if (probed.y > 0.0f && is_beyond(before, way.x + slack * before.way.x, way.y + slack * before.way.y,
            way.z + slack * before.way.z)) {
        end_at_wall(i, rho); // all that follows is beyond the plane
        return;
    }
    border.y = half_space_before(i, m, way, radius);
    if (GLASS && hit.material != NO_MATERIAL && is_glass(material_of(hit.material))) { // there is light behind it
        if (probed.y == 0.0f && border.y > 0.0f)
            begin(i, probed.w, border.y);
        else
            send(ray_start(hit, d), d, radius - come, come, WALL);
        return;
    }
    border.x = dot3(hit.normal, d) < 0.0f ? 1.0f : 0.0f;
    border.z = rho;
    send(ray_start(hit, d), d, 3.0e38f, come, FAR_SIDE);
}

void kernel(uint i)
{
    if (progress.y == BEGINS) {
        if (points(i).w > 1.2e-38f) // what shrunk_radius.glsl makes of 0 is no radius
            begin(i, 1.0f, 0.0f);
        else
            progress.y = FINISHED;
        return;
    }
    vec3 d = vec3(direction);
    Hit hit = intersect_before(vec3(origin), d, origin.w);
    if (MESHES && mesh_is_closer(hit, i))
        hit = mesh_hit(i);
    bool met = hit.t >= 0.0f;
    if (progress.y == GLANCE) {
        if (met && is_at_rim(i, hit.position, radius_of(i)) && holds_photons(i, hit, d))
            end_direction(i, WHOLE);
        else
            send_along(i, met ? height_of(i, hit.position) : 0.0f);
    } else if (progress.y == WALL) {
        meet_wall(i, met, hit);
    } else if (progress.y == FAR_SIDE) {
        precise float rho = (direction.w + hit.t) / radius_of(i);
        precise float nearest = rho * ASLANT;
        bool in_disc = met && nearest < 0.98f; // not just within the rim
        bool may_be_solid = !in_disc && met && border.x > 0.0f && dot3(hit.normal, d) > 0.0f;
        border.x = in_disc ? 1.0f : 0.0f;
        border.w = in_disc ? rho : border.z;
        if (may_be_solid)
            send_up(i, border.z + 0.1f);
        else
            send_down(i, border.w + 0.1f, BEYOND);
    } else if (progress.y == INSIDE) {
        if (met && dot3(hit.normal, d) > 0.0f)
            end_at_wall(i, border.z); // the rest of the disc is in a solid
        else
            send_down(i, border.w + 0.1f, BEYOND);
    } else if (progress.y == BEYOND) {
        if (met && holds_photons(i, hit, d))
            meet_leak(i, hit.position);
        else
            end_at_wall(i, border.z);
    } else {
        bool holds = met && holds_photons(i, hit, d);
        if (progress.y == RIM) {
            if (holds)
                end_direction(i, WHOLE);
        } else if (progress.y == FOOT) {
            if (holds)
                end_direction(i, border.z);
            else
                border.z = 0.0f;
        } else if (holds) {
            precise vec3 way = hit.position - vec3(points(i));
            border.z = 0.5f * (border.z + border.w);
            precise float stretch = sqrt(dot3(way, way)) / (border.z * radius_of(i));
            border.y = max(stretch, 1.0f);
        } else {
            border.w = 0.5f * (border.z + border.w);
        }
        if (progress.y == END || !holds) {
            if (border.w - border.z > PRECISION)
                send_down(i, 0.5f * (border.z + border.w), END);
            else
                end_direction(i, 0.5f * (border.z + border.w) * border.y);
        }
    }
}
