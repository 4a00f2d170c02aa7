// Where things stand in the scene buffer, which trace/device_scene.hpp writes. It begins with SCENE_TABLES records.
// A kind of shape has a number below that: its SWITCH in kernels, the record of its table, and its name in Closest.
#ifndef PHOTONGRID_SHARED_IS_READ // backend/begin.hpp

const uint SCENE_TABLES = 16u;
const uint MATERIAL_TABLE = 4u; // no kind of shape has the numbers 4 to 7, the SWITCHes of materials and lights
const uint SCENE_SIZES = 5u;    // x: what ray_offset adds for round shapes, m
const uint LIGHT_TABLE = 6u;
const uint FIRST_MATERIAL = SCENE_TABLES; // materials come first, so that kernels need not look their table up
const uint MATERIAL_RECORDS = 2u;

// Shapes of one kind, or materials, or lights: they follow each other.
struct Table {
    uint first;  // record
    uint count;
    uint stride; // records of each; 0: they differ in length
};

inline Table table_of(vec4 record)
{
    Table t;
    t.first = uint(record.x);
    t.count = uint(record.y);
    t.stride = uint(record.z);
    return t;
}

// Kinds of materials.
const uint LAMBERTIAN_SURFACE = 0u;
const uint MIRROR_SURFACE = 1u; // metals too
const uint GLASS_SURFACE = 2u;

const uint NO_MATERIAL = 0xFFFFFFFFu; // of a light's surface
const uint NO_SHAPE = 0xFFFFFFFFu;

// The nearest shape so far.
struct Closest {
    float t;   // along the ray
    uint kind; // number of its kind, or NO_SHAPE
    uint at;   // its first record
};

struct Hit {
    float t;        // along the ray; negative: nothing hit
    uint material;  // NO_MATERIAL: a light's surface
    uint light;     // which light, if so
    vec3 position;
    vec3 normal;    // geometric, unit, outward or as the shape was given
};

// How far off a surface a ray starts, so that the surface is behind it: a bound on what rounding makes of the distance
// between them. 32 units in the last place of the coordinates' sum, and `round_share`, 32 of the size of the scene's
// largest round shape (SCENE_SIZES).
inline float ray_offset(vec3 p, float round_share)
{
    precise float bound = (abs(p.x) + abs(p.y) + abs(p.z)) * 1.9073486328125e-6f + round_share;
    return bound;
}

#endif
