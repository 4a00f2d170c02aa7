// Whether two points with surface normals do not lie on one surface, though the normals may agree: one is on the other
// face of a hollow body, or on the shelf below. Included by kernels.
//
// Along an arc of a circle the way from one point to the other is at right angles to the sum of their normals; across
// an edge between two planes it rises along that sum by the sine of their angle at most. What rises more, by a slope
// above 0.1 of the mean normal, is another surface, whatever the radius. Either point may lie off its surface by what
// rays start off one (ray_offset), four of which are allowed.
//
// dx, dy, dz: the way; d2: its square; n, m: the normals at p, where the way begins, and at its end; cosine: n . m.
bool is_off_surface(float dx, float dy, float dz, float d2, vec4 m, vec4 n, float cosine, vec4 p)
{
    precise float rise = dx * (n.x + m.x) + dy * (n.y + m.y) + dz * (n.z + m.z);
    precise float rounding = (abs(p.x) + abs(p.y) + abs(p.z)) * 7.62939453125e-6f;
    precise float rounding2 = rounding * rounding + 1.17549435e-38f; // what is less counts as 0
    precise float most2 = d2 * ((1.0f - cosine) * (1.0f + cosine) + 0.04f) + rounding2; // (2 x 0.1)^2
    precise float rise2 = rise * rise;
    return !(rise2 <= most2);
}
