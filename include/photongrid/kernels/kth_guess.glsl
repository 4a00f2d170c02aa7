// A first guess at the squared distance of the k-th nearest photon, from cell counts alone: boxes of cells about the query
// point, each about twice as wide as the last, until one holds k photons. A guess costs time when it is wrong, never truth.
#include "grid.glsl"

struct Params {
    Grid grid;
    uint wanted;       // k
    float max_radius2; // m^2
    uint rows;         // rows of cells in a box at most
    uint searching;    // 0: no search can find anything (no photons, none wanted, no radius)
};
PARAMS(Params)
INPUT(0, vec4, points) // xyz: query point, m; w > 0: wanted
INPUT(1, uvec2, cells)
OUTPUT(0, vec4, pivots)   // see kth_distance.glsl, whose states these are
OUTPUT(1, uvec4, inner)
OUTPUT(2, uvec4, outer)
OUTPUT(3, uvec4, bracket)
OUTPUT(4, uvec4, cursor)
OUTPUT(5, uvec4, tally)

void kernel(uint i)
{
    vec4 p = points(i);
    pivots = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    inner = uvec4(0u, 0u, 0u, 0u);
    outer = uvec4(0u, 0u, 0u, 0u);
    bracket = uvec4(0u, 0u, 0u, 0xFFFFFFFFu);
    cursor = uvec4(0u, 0u, 0u, 0u);
    tally = uvec4(0u, 0u, 0u, 3u); // found: nothing
    if (args.searching == 0u || !(p.w > 0.0f) || !is_finite(p))
        return;
    tally.w = 0u; // counting

    uvec4 c = cell_coordinates(args.grid, p);
    float guess = args.max_radius2;
    uint half_width = 1u;
    uint inside = 0u; // photons of the last box, and its area
    float inside_area = 0.0f;
    bool looking = true;
    while (looking) {
        uint low_x = c.x > half_width ? c.x - half_width : 0u;
        uint low_y = c.y > half_width ? c.y - half_width : 0u;
        uint low_z = c.z > half_width ? c.z - half_width : 0u;
        uint high_x = min(c.x + half_width, args.grid.resolution.x - 1u);
        uint high_y = min(c.y + half_width, args.grid.resolution.y - 1u);
        uint high_z = min(c.z + half_width, args.grid.resolution.z - 1u);
        uint rows = high_y - low_y + 1u;
        rows = rows > args.rows ? rows : rows * (high_z - low_z + 1u);
        looking = rows <= args.rows;
        if (looking) {
            uint held = 0u;
            for (uint z = low_z; z <= high_z; ++z)
                for (uint y = low_y; y <= high_y; ++y) {
                    uint row = cell_number(args.grid, 0u, y, z);
                    uvec2 last = cells(row + high_x);
                    held += last.x + last.y - cells(row + low_x).x;
                }
            // Photons lie on surfaces: as many as the largest section of the box shows area, and between two boxes evenly. A
            // square with 4/pi k photons has a disc with k inside it, whose squared radius is a quarter of the square.
            float x = float(high_x - low_x + 1u) * args.grid.cell.x;
            float y = float(high_y - low_y + 1u) * args.grid.cell.y;
            float z = float(high_z - low_z + 1u) * args.grid.cell.z;
            precise float area = max(x * y, max(y * z, z * x));
            if (held > inside) {
                precise float share = (1.2732395f * float(args.wanted) - float(inside)) / float(held - inside);
                precise float radius2 = 0.25f * (inside_area + (area - inside_area) * share);
                guess = max(radius2, 1e-30f);
            }
            inside = held;
            inside_area = area;
            bool everything = low_x == 0u && low_y == 0u && low_z == 0u && high_x + 1u == args.grid.resolution.x && high_y + 1u == args.grid.resolution.y && high_z + 1u == args.grid.resolution.z;
            looking = float(held) < 1.2732395f * float(args.wanted) && !everything;
            half_width *= 2u;
        }
    }
    pivots = vec4(0.0f, min(guess, args.max_radius2), 0.0f, 0.0f);
}
