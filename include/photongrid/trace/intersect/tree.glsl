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

// A node as a ray of length `far` meets it.
struct ShapeNode {
    vec2 inside; // where the ray is inside its box
    bool found;  // it is a leaf, and the ray meets its box
    uint kind;   // of a leaf's shape
    uint at;     // the shape's record
    uint next;   // the node where the walk goes on
};

ShapeNode shape_node(Table tree, uint node, Ray r, float far)
{
    vec4 low = scene(tree.first + 2u * node);
    vec4 high = scene(tree.first + 2u * node + 1u);
    bool leaf = low.w < 0.0f;
    ShapeNode n;
    n.inside = inside_box(vec3(low), vec3(high), r);
    bool meets = meets_box(n.inside, far);
    n.found = meets && leaf;
    n.kind = leaf ? uint(-1.0f - low.w) : NO_SHAPE;
    n.at = uint(high.w);
    n.next = meets || leaf ? node + 1u : uint(low.w);
    return n;
}

// The closest hit: the least of (t, the shape's record).
Closest closest_in_tree(vec3 o, vec3 d, Closest c)
{
    Table tree = table_of(scene(SHAPE_TREE));
    Ray r = ray_of(o, d);
    uint node = 0u;
    while (node < tree.count) {
        ShapeNode n = shape_node(tree, node, r, c.t);
        if (n.found) {
            float t = hit_in_box(n.kind, n.at, o, d, n.inside);
            if (t < c.t || (t == c.t && n.at < c.at)) {
                c.t = t;
                c.kind = n.kind;
                c.at = n.at;
            }
        }
        node = n.next;
    }
    return c;
}

// `lamps`: the surfaces of rectangle lights, too, where they are apart.
bool tree_blocks(vec3 o, vec3 d, float far, bool lamps)
{
    vec4 record = scene(SHAPE_TREE);
    Table tree = table_of(record);
    uint past = lamps ? tree.count : uint(record.w);
    uint node = past < tree.count ? 1u : 0u;
    Ray r = ray_of(o, d);
    while (node < past) {
        ShapeNode n = shape_node(tree, node, r, far);
        if (n.found && hit_in_box(n.kind, n.at, o, d, n.inside) < far)
            return true;
        node = n.next;
    }
    return false;
}
