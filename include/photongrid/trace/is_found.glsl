// True for element i if i is less than the number of photons that the first `emitted` paths store. A count of this
// predicate returns that number without reading a buffer back.
struct Params {
    uint emitted;
};
PARAMS(Params)
INPUT(0, uint, sums) // storable photons of paths 0 to i

bool holds(uint i)
{
    return i < sums(args.emitted - 1u);
}
