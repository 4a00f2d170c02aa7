// The index of cell i's first photon after the gaps between cells have been removed.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uint, sums)   // photons of cells 0 to i
INPUT(1, uint, counts) // photons of cell i
OUTPUT(0, uvec2, cell) // x: first, y: count

void kernel(uint i)
{
    uint count = counts(i);
    cell = uvec2(sums(i) - count, count);
}
