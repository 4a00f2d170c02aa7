// A tree of boxes over all shapes but meshes, in scenes of many (trace/shape_tree.hpp). Included by
// trace/intersect.glsl after hit_shape.
SWITCH(18, TREE_OF_SHAPES)

// hit_shape, clamped to where the ray is inside the shape's box, so that the ray enters no box around it later, and the
// tree finds what a loop over its leaves would.
float hit_in_box(uint kind, uint at, vec3 o, vec3 d, vec2 inside)
{
    float t = hit_shape(kind, at, o, d);
    if (!(t < 3.0e38f))
        return t;
    t = t > inside.x ? t : inside.x;
    t = t < inside.y ? t : inside.y;
    return t > 0.0f ? t : 3.0e38f;
}

// The closest hit: the least of (t, the shape's record).
Closest closest_in_tree(vec3 o, vec3 d, Closest c)
{
    Table tree = table_of(scene(SHAPE_TREE));
    Ray r = ray_of(o, d);
    uint node = 0u;
    while (node < tree.count) {
        vec4 low = scene(tree.first + 2u * node);
        vec4 high = scene(tree.first + 2u * node + 1u);
        vec2 inside = inside_box(vec3(low), vec3(high), r);
        bool meets = meets_box(inside, c.t);
        bool leaf = low.w < 0.0f;
        if (meets && leaf) {
            uint kind = uint(-1.0f - low.w);
            uint at = uint(high.w);
            float t = hit_in_box(kind, at, o, d, inside);
            if (t < c.t || (t == c.t && at < c.at)) {
                c.t = t;
                c.kind = kind;
                c.at = at;
            }
        }
        node = meets || leaf ? node + 1u : uint(low.w);
    }
    return c;
}

bool tree_blocks(vec3 o, vec3 d, float far)
{
    Table tree = table_of(scene(SHAPE_TREE));
    Ray r = ray_of(o, d);
    uint node = 0u;
    while (node < tree.count) {
        vec4 low = scene(tree.first + 2u * node);
        vec4 high = scene(tree.first + 2u * node + 1u);
        vec2 inside = inside_box(vec3(low), vec3(high), r);
        bool meets = meets_box(inside, far);
        bool leaf = low.w < 0.0f;
        if (meets && leaf && hit_in_box(uint(-1.0f - low.w), uint(high.w), o, d, inside) < far)
            return true;
        node = meets || leaf ? node + 1u : uint(low.w);
    }
    return false;
}
