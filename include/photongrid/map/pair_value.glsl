// The second number of each pair: the id of sorted (cell, id) pairs, which gives the photon list (figure 4), or the count
// of cells.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uvec2, pairs)
OUTPUT(0, uint, value)

void kernel(uint i)
{
    value = pairs(i).y;
}
