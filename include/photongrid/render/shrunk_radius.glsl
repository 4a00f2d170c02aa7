// Points with radii of their own (knn_settings::radii_at_points) in a pass of shrinking radii: the radius that a search
// in the first map found, made smaller.
struct Params {
    float share2;      // of the first squared radius
    float max_radius2; // m^2
};
PARAMS(Params)
INPUT(0, vec4, points) // w > 0: estimate here
INPUT(1, vec4, firsts) // w: squared radius in the first map, m^2
OUTPUT(0, vec4, point) // w: squared radius in this pass, m^2

void kernel(uint i)
{
    vec4 p = points(i);
    precise float radius2 = min(firsts(i).w, args.max_radius2) * args.share2;
    // Coincident photons have a radius of 0, at which there is no estimate.
    float w = radius2 > 1.17549435e-38f ? radius2 : 1.17549435e-38f;
    point = vec4(p.x, p.y, p.z, p.w > 0.0f ? w : -1.0f);
}
