// The orthonormal basis about a normal, and directions sampled with it, for tests.
#include <photongrid/core/vector.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, normals)
INPUT(1, vec4, numbers)   // xy: random numbers
OUTPUT(0, vec4, first)    // xyz: first axis
OUTPUT(1, vec4, second)   // xyz: second axis
OUTPUT(2, vec4, diffuse)  // xyz: direction with density cos / pi about the normal
OUTPUT(3, vec4, anywhere) // xyz: direction with uniform density

void kernel(uint i)
{
    vec3 n = vec3(normals(i));
    vec4 r = numbers(i);
    vec3 a = from_basis(vec3(1.0f, 0.0f, 0.0f), n);
    vec3 b = from_basis(vec3(0.0f, 1.0f, 0.0f), n);
    vec3 c = cosine_direction(n, r.x, r.y);
    vec3 u = uniform_direction(r.x, r.y);
    first = vec4(a.x, a.y, a.z, 0.0f);
    second = vec4(b.x, b.y, b.z, 0.0f);
    diffuse = vec4(c.x, c.y, c.z, 0.0f);
    anywhere = vec4(u.x, u.y, u.z, 0.0f);
}
