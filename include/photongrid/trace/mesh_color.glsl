// What textures and the colours of vertices say at a ray's hit on a triangle: factors on what the material says.
// Element i is of hit i / colors_per_hit(). Only in scenes with textures or colours of vertices.
//
// Records of TEXTURE_TABLE: first texel in two parts (high and low 16 bits), width, height; scale and offset of
// coordinates; x: 1: the texture repeats; y: of a number, its channel.
#include <photongrid/core/vector.glsl>
#include <photongrid/trace/instance.glsl>
#include <photongrid/trace/ray_state.glsl>
#include <photongrid/trace/scene_layout.glsl>
#include <photongrid/trace/tree_node.glsl>

struct Params {
    uint count; // of instances
};
PARAMS(Params)
INPUT(0, vec4, scene)
INPUT(1, uvec4, hits)       // see ray_state.glsl
INPUT(2, vec4, places)      // these two: see mesh_surface.glsl
INPUT(3, vec4, normals)
INPUT(4, uvec4, faces)      // see mesh_surface.glsl
INPUT(5, vec4, vertices)    // xyz, m
INPUT(6, vec4, attributes)  // of each vertex, two: xy: texture coordinates; rgb
INPUT(7, uvec2, texels)     // 16 bits each: red | green << 16, blue | alpha << 16; of a colour linear
INPUT(8, uvec4, instances)  // see instance.glsl; only with INSTANCES
// Of a hit, the first one is for its material, or for the first part of a mixture, the second one for the second part.
// rgb: factor on the reflectance; w: on the roughness. The third one, x: on the opacity; y: on the share of the second
// part.
OUTPUT(0, vec4, color)

#include <photongrid/trace/materials.glsl>
#include <photongrid/trace/mixture.glsl>
#include <photongrid/trace/placed_face.glsl>
#include <photongrid/trace/triangle_weights.glsl>

// A texel's place along an edge of `size` texels, for a whole number.
uint wrapped(float at, float size, bool repeats)
{
    precise float turns = floor(at / size);
    precise float rest = at - turns * size;
    float inside = repeats ? rest : at;
    inside = inside > 0.0f ? inside : 0.0f;
    precise float last = size - 1.0f;
    return uint(inside < last ? inside : last);
}

vec4 texel(uint first, uint width, uint column, uint row)
{
    uvec2 t = texels(first + row * width + column);
    precise vec4 channels
        = vec4(float(t.x & 0xFFFFu), float(t.x >> 16u), float(t.y & 0xFFFFu), float(t.y >> 16u)) * 1.52590219e-5f;
    return channels;
}

// The colour of texture `number` of a material, counted from 1, at texture coordinates; bilinear.
vec4 texture_color(uint number, vec4 coordinates)
{
    Table table = table_of(scene(TEXTURE_TABLE));
    uint at = table.first + table.stride * (number - 1u);
    vec4 size = scene(at);
    vec4 moved = scene(at + 1u);
    bool repeats = scene(at + 2u).x > 0.0f;
    uint first = uint(size.x) * 65536u + uint(size.y);
    uint width = uint(size.z);
    // Texels' middles are at whole numbers; rows go down.
    precise float u = (coordinates.x * moved.x + moved.z) * size.z - 0.5f;
    precise float v = size.w - (coordinates.y * moved.y + moved.w) * size.w - 0.5f;
    float left = floor(u);
    float upper = floor(v);
    precise float right_share = u - left;
    precise float lower_share = v - upper;
    uint column = wrapped(left, size.z, repeats);
    uint next_column = wrapped(left + 1.0f, size.z, repeats);
    uint row = wrapped(upper, size.w, repeats);
    uint next_row = wrapped(upper + 1.0f, size.w, repeats);
    precise vec4 above = texel(first, width, column, row) * (1.0f - right_share)
        + texel(first, width, next_column, row) * right_share;
    precise vec4 below = texel(first, width, column, next_row) * (1.0f - right_share)
        + texel(first, width, next_column, next_row) * right_share;
    precise vec4 all = above * (1.0f - lower_share) + below * lower_share;
    return all;
}

// The number of texture `number` of a material; 1 if `number` is 0, none.
float texture_number(uint number, vec4 coordinates)
{
    if (number == 0u)
        return 1.0f;
    vec4 all = texture_color(number, coordinates);
    Table table = table_of(scene(TEXTURE_TABLE));
    uint channel = uint(scene(table.first + table.stride * (number - 1u) + 2u).y);
    return channel < 2u ? (channel == 0u ? all.x : all.y) : (channel == 2u ? all.z : all.w);
}

void kernel(uint i)
{
    color = vec4(1.0f, 1.0f, 1.0f, 1.0f);
    uint hit = i / colors_per_hit();
    uint part = i - hit * colors_per_hit();
    uint triangle = triangle_of(hits(hit));
    vec4 normal = normals(hit);
    if (triangle == NO_TRIANGLE || normal.w < 0.0f)
        return; // nothing, or a light
    uint material = uint(normal.w);
    bool mixed = MIXTURES && is_mixture(material);
    if (part == 1u && !mixed)
        return;
    PlacedFace f = placed_face(triangle);
    uvec4 face = f.face;
    vec3 w = triangle_weights(vec3(places(hit)), f.a, f.b, f.c, vec3(normal));
    precise float sum = w.x + w.y + w.z;
    if (!(sum > 0.0f)) {
        w = vec3(1.0f, 1.0f, 1.0f); // a line or a point
        sum = 3.0f;
    }
    precise vec4 coordinates = (attributes(2u * face.x) * w.x + attributes(2u * face.y) * w.y
                                   + attributes(2u * face.z) * w.z)
        / sum;
    vec4 numbers = scene(FIRST_MATERIAL + MATERIAL_RECORDS * material + 3u);
    if (part == 2u) {
        color.x = texture_number(uint(numbers.x), coordinates);
        color.y = texture_number(uint(numbers.z), coordinates);
        return;
    }
    if (mixed) {
        Parts parts = parts_of(material);
        material = part == 0u ? parts.first : parts.second;
        numbers = scene(FIRST_MATERIAL + MATERIAL_RECORDS * material + 3u);
    }
    precise vec4 of_vertices = (attributes(2u * face.x + 1u) * w.x + attributes(2u * face.y + 1u) * w.y
                                   + attributes(2u * face.z + 1u) * w.z)
        / sum;
    vec3 found = vec3(of_vertices);
    uint number = texture_of(material);
    if (number > 0u) {
        precise vec3 both = found * vec3(texture_color(number, coordinates));
        found = both;
    }
    color = vec4(found.x, found.y, found.z, texture_number(uint(numbers.y), coordinates));
}
