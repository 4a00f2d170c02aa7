// What stencil routing left in cell i: its range of slots, and the power that its kept photons must gain so that the flux
// of all photons destined for it is conserved per channel (2.2.2, "redistribute the power of the surplus photons").
struct Params {
    uint capacity; // slots of a cell
    uint sums;    // partial sums of a cell
};
PARAMS(Params)
INPUT(0, vec4, partial_sums) // rgb: flux destined for the cell, W; w: how many photons
INPUT(1, uint, slots)
INPUT(2, vec4, powers)
OUTPUT(0, uvec2, cell)  // x: first slot, y: photons kept
OUTPUT(1, vec4, scale)  // kept photons' flux is multiplied by this ...
OUTPUT(2, vec4, surplus) // ... and this is added, W: a channel that no kept photon carries, spread evenly; w: flux moved, all channels, W
OUTPUT(3, vec4, total)  // all the flux destined for the cell, W; w: how many photons

void kernel(uint i)
{
    precise vec4 all = partial_sums(i * args.sums);
    for (uint p = 1u; p < args.sums; ++p)
        all += partial_sums(i * args.sums + p);
    total = all;
    uint destined = uint(total.w);
    uint kept = min(destined, args.capacity);
    cell = uvec2(i * args.capacity, kept);
    scale = vec4(1.0f, 1.0f, 1.0f, 1.0f);
    surplus = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    if (destined <= args.capacity)
        return;
    vec4 sum = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    for (uint s = 0u; s < kept; ++s)
        sum += powers(slots(cell.x + s));
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
    surplus.w = (total.x - sum.x) + (total.y - sum.y) + (total.z - sum.z);
}
