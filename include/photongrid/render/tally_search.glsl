// Counts a pixel's search in another map than the one that shade.glsl counts.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, points)      // w > 0: the point has an estimate
INPUT(1, vec4, irradiances) // w: squared radius, m^2
INPUT(2, uvec2, used)       // photons used, photons visited
STATE(0, vec4, searches)    // sums: photons used, radius, photons visited, searches

void kernel(uint i)
{
    vec4 e = irradiances(i);
    uvec2 n = used(i);
    if (points(i).w > 0.0f && e.w > 0.0f)
        searches += vec4(float(n.x), sqrt(e.w), float(n.y), 1.0f);
}
