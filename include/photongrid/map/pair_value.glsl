// The values of sorted (key, value) pairs: the list of photon ids (figure 4, "photon list").
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
