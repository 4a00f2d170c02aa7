// True for a path that begins before the photons asked for are stored: paths are emitted in id order until then.
struct Params {
    uint photons;
};
PARAMS(Params)
INPUT(0, uint, sums)     // storable photons of paths 0 to i
INPUT(1, uint, storable) // of path i

bool holds(uint i)
{
    return sums(i) - storable(i) < args.photons;
}
