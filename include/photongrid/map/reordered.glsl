// The order of photons after another sort: the photon at the place that the sorted pair names.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uvec2, pairs)
INPUT(1, uint, order)
OUTPUT(0, uint, photon)

void kernel(uint i)
{
    photon = order(pairs(i).y);
}
