// True for as many elements as the first `emitted` paths store photons.
struct Params {
    uint emitted;
};
PARAMS(Params)
INPUT(0, uint, sums) // storable photons of paths 0 to i

bool holds(uint i)
{
    return i < sums(args.emitted - 1u);
}
