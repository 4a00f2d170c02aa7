// The state in which a ray's search begins (ray_state.glsl).
#include <photongrid/core/vector.glsl>
#include <photongrid/trace/ray_state.glsl>
#include <photongrid/trace/tree_node.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, origins)
INPUT(1, vec4, directions)
OUTPUT(0, uvec4, state)

void kernel(uint i)
{
    vec4 o = origins(i);
    vec3 d = vec3(directions(i));
    bool searches = is_finite3(vec3(o)) && is_finite3(d) && is_in_range(vec3(o), o.w, d);
    state = ray_state(searches ? 0u : NO_PAIR, 0u, o.w, NO_TRIANGLE);
}
