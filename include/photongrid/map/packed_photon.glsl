// Entry i of a routed list without gaps: a binary search in the prefix sums finds the cell, and thereby the slot. A
// cell that has more entries than photons kept repeats them in turn, as often as its number of entries asks for.
#include <photongrid/core/none.glsl>

struct Params {
    uint cells;
};
PARAMS(Params)
INPUT(0, uint, sums)       // entries of cells 0 to i
INPUT(1, uvec2, slots)     // x: first slot, y: photons kept
INPUT(2, uint, slot_list)  // photon ids by slot
OUTPUT(0, uint, photon)    // NONE past the last entry
OUTPUT(1, uint, entries)   // of this photon

void kernel(uint i)
{
    photon = NONE;
    entries = 1u;
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
    uint before = low > 0u ? sums(low - 1u) : 0u;
    uint all = sums(low) - before;
    uint kept = max(cell.y, 1u);
    uint slot = (i - before) % kept;
    photon = slot_list(cell.x + slot);
    entries = all / kept + (slot < all % kept ? 1u : 0u);
}
