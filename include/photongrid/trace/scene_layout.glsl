// The layout of the scene buffer, which trace/scene_records.hpp writes. It begins with SCENE_TABLES records. Each kind
// of shape has a number below that: its SWITCH in kernels, the record of its table, and Closest::kind.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

const uint SCENE_TABLES = 32u;
// No kind of shape has the numbers 4 to 7, 9 to 23 or 25, other SWITCHes (scene_feature).
const uint MATERIAL_TABLE = 4u;
// What ray_offset adds, m. x: at any hit; y: for each metre of the size with which rounding at a hit grows, in scenes
// where x is not enough for all shapes, else 0; z: at the ends of eye rays on rough surfaces.
const uint SCENE_SIZES = 5u;
const uint LIGHT_TABLE = 6u;    // see trace/light_record.glsl
const uint TEXTURE_TABLE = 7u; // of the materials that have one; see trace/mesh_color.glsl
// Two records per node (trace/light_tree.hpp): its ball; power, left, right. w of the table's record: how many lights
// are in the tree; they come first among all lights.
const uint LIGHT_TREE = 12u;
// Two records per node (trace/shape_tree.hpp). Corners of its box, m; w of the first: the number of the node after all
// that are below it, or of a leaf -1 - the number of its shape's kind; w of the second: of a leaf, its shape's record.
// w of the table's record: the node after all that shadow rays to rectangle lights can meet. If that is not the last
// one, the root is left out, too.
const uint SHAPE_TREE = 13u;
// How samples of a light differ: not at all; by points that are even over its area; by directions that are even over
// the solid angle of a ball (trace/light_record.glsl); else.
const uint SAMPLED_ONCE = 0u;
const uint SAMPLED_BY_AREA = 1u;
const uint SAMPLED_BY_SOLID_ANGLE = 2u;
const uint SAMPLED_BY_DIRECTION = 3u;
const uint MEDIA_TABLE = 25u; // see trace/media.glsl
const uint FIRST_MATERIAL = SCENE_TABLES; // materials come first, so that kernels need not look their table up
const uint MATERIAL_RECORDS = 4u; // trace/material_layout.hpp
const uint TEXTURE_RECORDS = 3u;

// Consecutive shapes of one kind, materials, or lights.
struct Table {
    uint first;  // record
    uint count;
    uint stride; // records per item; 0: lengths differ
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
const uint MIRROR_SURFACE = 1u; // of all kinds that only reflect
const uint GLASS_SURFACE = 2u;
const uint COATED_SURFACE = 3u;
const uint MIXED_SURFACE = 4u; // of two other materials (trace/mixture.glsl)
const uint THIN_SURFACE = 5u;  // a pane of glass

// Ways by which light leaves surfaces (trace/scatter.glsl).
const uint BY_BASE = 0u; // scattered by a matte surface, bare or below a coat
const uint BY_REFLECTION = 1u;
const uint BY_REFRACTION = 2u;

const uint COAT_STEPS = 64u; // of the shares that pass a rough coat (trace/coat.glsl)

// Of the shares of light that facets hide, by the cosine (trace/rebounds.glsl).
const uint REBOUND_STEPS = 23u;
const float REBOUND_SPREAD = 4.0f; // of the steps, in alphas

const uint NO_MATERIAL = 0xFFFFFFFFu; // of a light's surface
const uint NO_SHAPE = 0xFFFFFFFFu;
// Of a triangle's face: the others are the number of the light that it belongs to.
const uint FACE_OF_LIGHT = 0x80000000u;

// The closest shape so far.
struct Closest {
    float t;   // along the ray
    uint kind; // number of its kind, or NO_SHAPE
    uint at;   // its first record
};

struct Hit {
    float t;        // along the ray; negative: nothing hit
    uint material;  // NO_MATERIAL: surface of a light
    uint light;     // number of that light
    vec3 position;
    vec3 normal;    // geometric, unit; outward, or as the shape defines it
    vec3 shading;   // of a mesh with vertex normals (SMOOTH): the interpolated normal, unit, on the side of `normal`
    float round_share; // of rays that leave it: see ray_offset
};

// What ray_offset adds at a hit whose rounding grows with `size`, m. `sizes`: the record SCENE_SIZES.
inline float round_share_of(vec4 sizes, float size)
{
    precise float share = sizes.x + sizes.y * size;
    return share;
}

// The distance by which a ray's origin is offset from its surface: a bound on the rounding error of their distance. It
// is 32 units in the last place of the sum of the coordinates, plus `round_share`: 32 units of the size of the scene's
// largest curved shape, or, in scenes of very different sizes, of the one that is hit (SCENE_SIZES).
inline float ray_offset(vec3 p, float round_share)
{
    precise float bound = (abs(p.x) + abs(p.y) + abs(p.z)) * 1.9073486328125e-6f + round_share;
    return bound;
}

#endif
