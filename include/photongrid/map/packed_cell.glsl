// The index of cell i's first photon after the gaps between cells have been removed.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uint, sums)   // photons of cells 0 to i
INPUT(1, uvec2, slots) // x: first slot, y: photons kept
OUTPUT(0, uvec2, cell) // x: first, y: count

void kernel(uint i)
{
    uint count = slots(i).y;
    cell = uvec2(sums(i) - count, count);
}
