// Sums the relative standard errors of a pixel's estimates, for the picture's layers.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, points)         // w > 0: the point has an estimate
INPUT(1, vec4, irradiances)    // rgb, W/m^2
INPUT(2, vec4, standard_error) // w: of the sum of the channels
STATE(0, vec4, errors)         // x: sum of relative standard errors

void kernel(uint i)
{
    vec4 e = irradiances(i);
    float all = e.x + e.y + e.z;
    if (points(i).w > 0.0f && all > 0.0f && all <= 3.4028234e38f) // infinite pixels are made black
        errors.x += standard_error(i).w / all;
}
