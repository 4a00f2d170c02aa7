// The triangle that a ray hit, where it is in the scene. Included by kernels after core/vector.glsl, their INPUTs
// faces (trace/mesh_surface.glsl), vertices and instances (trace/instance.glsl); args: count, of instances.
#include <photongrid/trace/find_instance.glsl>
SWITCH(20, INSTANCES)

struct PlacedFace {
    uvec4 face;    // as in `faces`
    uint number;   // of the face
    uint instance; // NO_INSTANCE: the surface stands once, and is in place
    bool mirrored;
    vec3 a;        // corners, m
    vec3 b;
    vec3 c;
};

// A vertex of the surface in the scene.
vec3 vertex_in_scene(uint instance, uint vertex)
{
    vec3 v = vec3(vertices(vertex));
    if (!INSTANCES || instance == NO_INSTANCE)
        return v;
    uint at = INSTANCE_RECORDS * instance;
    precise vec3 moved = by_matrix(at + 6u, v) + corner_of(instances(at + 3u));
    return moved;
}

// A normal of the surface in the scene; unit. It turns by the cofactors of the matrix, divided by the sign of its
// determinant.
vec3 normal_in_scene(PlacedFace f, vec3 n)
{
    if (!INSTANCES || f.instance == NO_INSTANCE)
        return n;
    uint at = INSTANCE_RECORDS * f.instance + 6u;
    vec3 x = corner_of(instances(at));
    vec3 y = corner_of(instances(at + 1u));
    vec3 z = corner_of(instances(at + 2u));
    vec3 turned = normalized3(vec3(dot3(cross3(y, z), n), dot3(cross3(z, x), n), dot3(cross3(x, y), n)));
    return f.mirrored ? -turned : turned;
}

// `id`: the triangle's number among those of all instances.
PlacedFace placed_face(uint id)
{
    PlacedFace f;
    f.number = id;
    f.instance = NO_INSTANCE;
    f.mirrored = false;
    if (INSTANCES) {
        uint instance = find_instance(args.count, ID_OF_INSTANCE, id);
        uint at = INSTANCE_RECORDS * instance;
        uint how = instances(at + 6u).w;
        f.number = id - instances(at + ID_OF_INSTANCE).w + instances(at + 4u).w;
        f.instance = how == IN_PLACE ? NO_INSTANCE : instance;
        f.mirrored = how == MIRRORED;
    }
    f.face = faces(f.number);
    if (INSTANCES && f.instance != NO_INSTANCE)
        f.face.w = instances(INSTANCE_RECORDS * f.instance + 5u).w;
    if (f.mirrored) // counterclockwise as seen from outside
        f.face = uvec4(f.face.x, f.face.z, f.face.y, f.face.w);
    f.a = vertex_in_scene(f.instance, f.face.x);
    f.b = vertex_in_scene(f.instance, f.face.y);
    f.c = vertex_in_scene(f.instance, f.face.z);
    return f;
}
