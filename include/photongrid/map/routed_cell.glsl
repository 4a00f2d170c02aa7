// Cell i after stencil routing: its range of slots, and the scale and the surplus by which the kept photons stand for
// the others. With CONSERVES they receive their power, per channel (2.2.2, "redistribute the power of the surplus
// photons"). Without it each counts N/K times, of N that arrived and K kept, whatever its power: for buckets where
// photons of several cells meet (hashed_route.hpp).
struct Params {
    uint capacity; // slots per cell
    uint sums;     // partial sums per cell
};
PARAMS(Params)
SWITCH(0, CONSERVES)
INPUT(0, vec4, partial_sums) // rgb: power destined for the cell, W; w: number of photons
INPUT(1, uint, slots)
INPUT(2, vec4, powers)
OUTPUT(0, uvec2, cell)  // x: first slot, y: photons kept
OUTPUT(1, vec4, scale)  // the power of each kept photon is multiplied by this ...
OUTPUT(2, vec4, surplus) // ... and this is added, W, in channels that no kept photon has; w: power of the others, W
OUTPUT(3, vec4, total)  // rgb: power destined for the cell, W; w: number of photons
OUTPUT(4, uint, arrived) // number of photons destined for the cell

void kernel(uint i)
{
    precise vec4 all = partial_sums(i * args.sums);
    uint destined = uint(all.w); // exact for each partial sum (stencil_route), but not for their sum
    for (uint p = 1u; p < args.sums; ++p) {
        all += partial_sums(i * args.sums + p);
        destined += uint(partial_sums(i * args.sums + p).w);
    }
    total = all;
    arrived = destined;
    uint kept = min(destined, args.capacity);
    cell = uvec2(i * args.capacity, kept);
    scale = vec4(1.0f, 1.0f, 1.0f, 1.0f);
    surplus = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    if (destined <= args.capacity)
        return;
    vec4 sum = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    for (uint s = 0u; s < kept; ++s)
        sum += powers(slots(cell.x + s));
    surplus.w = (total.x - sum.x) + (total.y - sum.y) + (total.z - sum.z);
    if (!CONSERVES) {
        float weight = float(destined) / float(kept);
        scale = vec4(weight, weight, weight, 1.0f);
        return;
    }
    float share = 1.0f / float(kept);
    if (sum.x > 0.0f)
        scale.x = total.x / sum.x;
    else
        surplus.x = total.x * share;
    if (sum.y > 0.0f)
        scale.y = total.y / sum.y;
    else
        surplus.y = total.y * share;
    if (sum.z > 0.0f)
        scale.z = total.z / sum.z;
    else
        surplus.z = total.z * share;
}
