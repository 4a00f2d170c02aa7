// Adds the bias of an eye ray's radiance to its pixel, as shade.glsl adds the radiance.
struct Params {
    float share; // 1 / eye rays per pixel
};
PARAMS(Params)
INPUT(0, vec4, points)
INPUT(1, vec4, throughputs) // with the reflectance of the surface
INPUT(2, vec4, biases)      // rgb: of the irradiance, W/m^2
INPUT(3, vec4, tilts)       // xyz, W/m^2, mean of the channels
INPUT(4, vec4, jumps)       // the same
STATE(0, vec4, bias)        // rgb, W/(m^2 sr)
STATE(1, vec4, tilt)        // xyz, W/(m^2 sr)
STATE(2, vec4, jump)

void kernel(uint i)
{
    if (!(points(i).w > 0.0f))
        return;
    vec4 w = throughputs(i);
    float share = args.share * 3.18309886e-1f;
    float mean = (w.x + w.y + w.z) * 0.333333333f * share;
    vec4 b = biases(i);
    bias += vec4(b.x * w.x * share, b.y * w.y * share, b.z * w.z * share, 0.0f);
    tilt += tilts(i) * mean;
    jump += jumps(i) * mean;
}
