// Adds the radiance along an eye ray to its pixel (2.4): emission if it hit a light; otherwise direct light and the
// photon map's irradiance, reflected by a diffuse surface: radiance = reflectance / pi x irradiance.
struct Params {
    float share; // 1 / eye rays per pixel
};
PARAMS(Params)
INPUT(0, vec4, points)
INPUT(1, vec4, throughputs) // with the reflectance of the surface
INPUT(2, vec4, emissions)
INPUT(3, vec4, direct)    // irradiance, W/m^2
INPUT(4, vec4, indirect)  // irradiance, W/m^2; w: squared radius, m^2
INPUT(5, uvec2, used)     // photons used, photons visited
STATE(0, vec4, pixel)     // radiance, W/(m^2 sr)
STATE(1, vec4, searches)  // sums over the searches of this pixel: photons used, radius, photons visited, searches

void kernel(uint i)
{
    vec4 light = emissions(i);
    if (points(i).w > 0.0f) {
        vec4 w = throughputs(i);
        vec4 d = direct(i);
        vec4 e = indirect(i);
        uvec2 n = used(i);
        light.x += w.x * (d.x + e.x) * 3.18309886e-1f;
        light.y += w.y * (d.y + e.y) * 3.18309886e-1f;
        light.z += w.z * (d.z + e.z) * 3.18309886e-1f;
        if (e.w > 0.0f)
            searches += vec4(float(n.x), sqrt(e.w), float(n.y), 1.0f);
    }
    pixel = vec4(pixel.x + light.x * args.share, pixel.y + light.y * args.share, pixel.z + light.z * args.share, 0.0f);
}
