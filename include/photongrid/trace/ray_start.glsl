// The state in which a ray's search begins (ray_state.glsl). A ray hits nothing if it has no length, or if a coordinate
// or its direction's length is not a number or out of range.
#include <photongrid/backend/vector.glsl>
#include <photongrid/trace/ray_state.glsl>
#include <photongrid/trace/tree_node.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, origins)
INPUT(1, vec4, directions)
OUTPUT(0, uvec4, state)

bool is_up_to(float most, vec3 v)
{
    return abs(v.x) <= most && abs(v.y) <= most && abs(v.z) <= most;
}

void kernel(uint i)
{
    vec4 o = origins(i);
    vec3 d = vec3(directions(i));
    bool searches = is_finite3(vec3(o)) && is_up_to(1.0e18f, vec3(o)) && is_finite3(d) && is_up_to(1.0e18f, d)
        && !is_up_to(1.0e-18f, d) && o.w > 0.0f;
    state = ray_state(searches ? 0u : NO_PAIR, 0u, o.w, NO_TRIANGLE);
}
