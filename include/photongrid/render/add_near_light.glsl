// Adds the light that falls on near ends of a final gather (add_gathered.glsl) from lights and caustics.
struct Params {
    float share; // 1 / rays per point
};
PARAMS(Params)
INPUT(0, vec4, ends)     // w > 0: a near end
INPUT(1, vec4, weights)  // rgb: of their light at the eye ray's end
INPUT(2, vec4, direct)   // irradiance, W/m^2
INPUT(3, vec4, caustics) // irradiance, W/m^2
STATE(0, vec4, gathered) // irradiance at the eye ray's end, W/m^2

void kernel(uint i)
{
    if (!(ends(i).w > 0.0f))
        return;
    vec4 w = weights(i);
    vec4 d = direct(i);
    vec4 c = caustics(i);
    precise vec4 sum = vec4(gathered.x + w.x * (d.x + c.x) * args.share, gathered.y + w.y * (d.y + c.y) * args.share,
        gathered.z + w.z * (d.z + c.z) * args.share, 0.0f);
    gathered = sum;
}
