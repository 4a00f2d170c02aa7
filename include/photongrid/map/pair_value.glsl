// The value of a (key, value) pair: the sorted list of photon ids (figure 4, "photon list").
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
