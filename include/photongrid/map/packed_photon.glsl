// Entry i of a routed list without gaps: a binary search in the prefix sums finds the cell, and thereby the slot.
#include <photongrid/backend/none.glsl>

struct Params {
    uint cells;
};
PARAMS(Params)
INPUT(0, uint, sums)       // photons of cells 0 to i
INPUT(1, uvec2, slots)     // x: first slot, y: photons kept
INPUT(2, uint, slot_list)  // photon ids by slot
OUTPUT(0, uint, photon)    // NONE past the last photon kept

void kernel(uint i)
{
    photon = NONE;
    if (i >= sums(args.cells - 1u))
        return;
    uint low = 0u;
    uint high = args.cells - 1u;
    while (low < high) {
        uint middle = low + (high - low) / 2u;
        if (sums(middle) > i)
            high = middle;
        else
            low = middle + 1u;
    }
    uvec2 cell = slots(low);
    photon = slot_list(cell.x + i - (sums(low) - cell.y));
}
