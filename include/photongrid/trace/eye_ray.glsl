// The ray from the camera through a pixel (2.4): through the pixel's centre if it is the only one, else through a
// random point of the ray's own stratum of the pixel or of the filter's area. Of the n eye rays of a pass no two are in
// the same n-th of its width, nor of its height, so edges along rows and columns are smooth (Chiu, Shirley and Wang,
// Multi-Jittered Sampling, 1994). From pass to pass the points of a stratum follow a (0,2)-sequence.
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>

struct Params {
    vec4 position;  // of the camera, m; w: the media that it is in (trace/media.glsl)
    vec4 corner;    // direction to the picture's top left corner ...
    vec4 right;     // ... and the step from pixel to pixel along a row ...
    vec4 down;      // ... and along a column
    uvec2 strata;   // columns and rows of a pixel; 0, 0: one ray through its middle
    uint width;     // pixels in a row
    uint stratum;   // of this ray, row by row
    uint nth;       // of the rays in that stratum, in all passes
    uint branch;    // Fresnel branch (eye_bounce.glsl)
    uint seed;
    uint first_pixel; // pixel of element 0
    uint tent;        // 1: places are distributed as a tent over two pixels; 0: evenly over one
};
PARAMS(Params)
// Bit b: branch b must be traced for this pixel. Branch 0 is traced first and sets the other bits.
STATE(5, uint, branches)
OUTPUT(0, vec4, point)      // xyz: origin, m; w: 0 in flight, -1 not traced
OUTPUT(1, vec4, direction)  // xyz: unit vector; w: surfaces hit
OUTPUT(2, vec4, throughput) // rgb: factor between radiance here and at the eye; w: splits so far
OUTPUT(3, vec4, surface)    // xyz: normal towards the eye; w: material
OUTPUT(4, vec4, emitted)    // rgb: radiance of the light that the ray ended on, times throughput

// The place, in pixels, up to which a tent about 0.5 has the share u of its area.
float under_tent(float u)
{
    bool rises = u < 0.5f;
    precise float twice = rises ? 2.0f * u : 2.0f - 2.0f * u; // an exact difference of at least 0
    precise float root = sqrt(twice > 0.0f ? twice : 0.0f);
    precise float place = rises ? root - 0.5f : 1.5f - root;
    return place;
}

void kernel(uint i)
{
    point = vec4(0.0f, 0.0f, 0.0f, -1.0f);
    direction = vec4(0.0f, 0.0f, 1.0f, 0.0f);
    throughput = vec4(1.0f, 1.0f, 1.0f, 0.0f);
    surface = vec4(0.0f, 0.0f, 1.0f, 0.0f);
    emitted = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    if (args.branch == 0u)
        branches = 1u;
    if ((branches >> args.branch & 1u) == 0u)
        return;
    uint pixel = i + args.first_pixel;
    uint y = pixel / args.width;
    uint x = pixel - y * args.width;
    float dx = 0.5f;
    float dy = 0.5f;
    if (args.strata.x > 0u) {
        uint row = args.stratum / args.strata.x;
        uint column = args.stratum - row * args.strata.x;
        uint place = place_in_sequence(args.nth, hash4(uvec4(pixel, 0u, 1000u, args.seed)).x);
        float x_in_column = sequence_x(place, hash4(uvec4(pixel, column, 1001u, args.seed)).x);
        float y_in_row = sequence_y(place, hash4(uvec4(pixel, row, 1002u, args.seed)).x);
        // Strata in one column have x at equal intervals, cyclically; strata in one row have y so.
        precise float x_shifted = x_in_column + float(row) / float(args.strata.y);
        precise float y_shifted = y_in_row + float(column) / float(args.strata.x);
        precise float across = (float(column) + x_shifted - floor(x_shifted)) / float(args.strata.x);
        precise float along_column = (float(row) + y_shifted - floor(y_shifted)) / float(args.strata.y);
        dx = args.tent != 0u ? under_tent(across) : across;
        dy = args.tent != 0u ? under_tent(along_column) : along_column;
    }
    precise vec3 d = vec3(args.corner) + vec3(args.right) * (float(x) + dx) + vec3(args.down) * (float(y) + dy);
    vec3 n = normalized3(d);
    point = vec4(args.position.x, args.position.y, args.position.z, 0.0f);
    surface = vec4(0.0f, 0.0f, 1.0f, args.position.w);
    direction = vec4(n.x, n.y, n.z, 0.0f);
}
