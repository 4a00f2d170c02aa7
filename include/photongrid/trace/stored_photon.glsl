// Where stored photon i stands in the frames: photons are stored in the order of (path, bounce). Binary search for the path in
// the running sums, then its r-th diffuse hit. Included by kernels after their inputs `sums` and `positions`; args: paths,
// frames, and the photons of earlier batches.
uint stored_photon(uint i)
{
    uint rank = i - args.stored_before;
    uint low = 0u;
    uint high = args.paths - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (sums(middle) > rank)
            high = middle;
        else
            low = middle + 1u;
    }
    // Count down from the path's last photon: sums(low) is one past it.
    uint skip = sums(low) - 1u - rank;
    uint found = low;
    for (uint frame = args.frames - 1u; frame >= 2u; --frame) {
        uint at = frame * args.paths + low;
        if (event_kind(positions(at)) == DIFFUSE_SURFACE) {
            if (skip == 0u) {
                found = at;
                break;
            }
            --skip;
        }
    }
    return found;
}
