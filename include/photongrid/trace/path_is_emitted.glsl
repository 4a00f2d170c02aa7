// True for a path that is needed: paths are emitted in id order until the requested number of photons is stored.
struct Params {
    uint photons; // requested
};
PARAMS(Params)
INPUT(0, uint, sums)     // storable photons of paths 0 to i
INPUT(1, uint, storable) // of path i

bool holds(uint i)
{
    return sums(i) - storable(i) < args.photons;
}
