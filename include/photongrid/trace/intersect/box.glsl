// Closed boxes in any orientation. Records: u, v, w: orthogonal unit axes, each with half the box's length along it;
// center, material.
SWITCH(8, BOXES)
const uint BOX = 8u;

// The interval in which a ray is between the planes of all three pairs of faces: enter to leave; empty if enter >
// leave.
struct Passage {
    float enter; // distance along the ray; through a face of this axis ...
    float leave;
    uint enter_axis;
    uint leave_axis; // ... and this one
};

// Slabs (Kay and Kajiya, Ray Tracing Complex Scenes, 1986). From inside, every interval contains 0, so the intersection
// does too and the ray always leaves. Near an edge both faces use the same numbers, so no ray slips through.
Passage box_passage(uint at, vec3 o, vec3 d)
{
    precise vec3 f = o - vec3(scene(at + 3u));
    Passage p;
    p.enter = -3.0e38f;
    p.leave = 3.0e38f;
    p.enter_axis = 0u;
    p.leave_axis = 0u;
    for (uint axis = 0u; axis < 3u; ++axis) {
        vec4 a = scene(at + axis);
        float coordinate = dot3(f, vec3(a));
        float slope = dot3(d, vec3(a));
        // A ray parallel to the faces is between them everywhere or nowhere.
        float begins = abs(coordinate) <= a.w ? -3.0e38f : 3.0e38f;
        float ends = -begins;
        if (slope != 0.0f) {
            precise float low = (-a.w - coordinate) / slope;
            precise float high = (a.w - coordinate) / slope;
            begins = slope > 0.0f ? low : high;
            ends = slope > 0.0f ? high : low;
        }
        if (begins > p.enter) {
            p.enter = begins;
            p.enter_axis = axis;
        }
        if (ends < p.leave) {
            p.leave = ends;
            p.leave_axis = axis;
        }
    }
    return p;
}

float hit_box(uint at, vec3 o, vec3 d, float far)
{
    Passage p = box_passage(at, o, d);
    float t = p.enter > 0.0f ? p.enter : p.leave;
    return p.enter <= p.leave && t > 0.0f && t < far ? t : far;
}

Closest closest_box(vec3 o, vec3 d, Closest c)
{
    Table boxes = table_of(scene(BOX));
    uint at = boxes.first;
    for (uint n = 0u; n < boxes.count; ++n) {
        float t = hit_box(at, o, d, c.t);
        if (t < c.t) {
            c.t = t;
            c.kind = BOX;
            c.at = at;
        }
        at += boxes.stride;
    }
    return c;
}

// Chooses the face that the ray passes through, even if by rounding the point is closer to another: only for that face
// the normal is sure to point against a ray from outside, and along a ray from inside. The point is moved onto that
// face and away from the others, so that rays from it start on the right side of all faces.
Hit box_surface(uint at, vec3 o, vec3 d, Hit hit)
{
    Passage p = box_passage(at, o, d);
    bool enters = p.enter > 0.0f;
    uint face = enters ? p.enter_axis : p.leave_axis;
    vec4 middle = scene(at + 3u);
    precise vec3 from_middle = abs(hit.position - vec3(middle));
    precise float size = from_middle.x + from_middle.y + from_middle.z;
    hit.round_share = round_share_of(scene(SCENE_SIZES), size);
    float off = ray_offset(hit.position, hit.round_share);
    for (uint axis = 0u; axis < 3u; ++axis) {
        vec4 a = scene(at + axis);
        precise vec3 f = hit.position - vec3(middle);
        float coordinate = dot3(f, vec3(a));
        precise float inner = a.w > off ? a.w - off : 0.0f;
        float target = coordinate < -inner ? -inner : coordinate > inner ? inner : coordinate;
        if (axis == face) {
            bool same_way = dot3(d, vec3(a)) > 0.0f;
            hit.normal = same_way == enters ? -vec3(a) : vec3(a);
            target = same_way == enters ? -a.w : a.w;
        }
        precise float by = target - coordinate;
        hit.position = ray_at(hit.position, vec3(a), by);
    }
    hit.material = uint(middle.w);
    return hit;
}

bool boxes_block(vec3 o, vec3 d, float far)
{
    Table boxes = table_of(scene(BOX));
    uint at = boxes.first;
    for (uint n = 0u; n < boxes.count; ++n) {
        if (hit_box(at, o, d, far) < far)
            return true;
        at += boxes.stride;
    }
    return false;
}
