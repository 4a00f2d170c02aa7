// The index in the frames of stored photon i. Photons are stored in the order of (path, bounce): a binary search in the
// prefix sums finds the path, a loop its r-th diffuse hit. Included by kernels after their inputs `sums` and
// `positions`; args: paths, frames, stored_before, kinds.
#include <photongrid/map/first_sum_above.glsl>

uint stored_photon(uint i)
{
    uint rank = i - args.stored_before;
    uint low = first_sum_above(rank, args.paths);
    uint skip = low > 0u ? rank - sums(low - 1u) : rank; // the path's photons before this one
    uint found = low;
    for (uint frame = 1u; frame < args.frames; ++frame) {
        uint at = frame * args.paths + low;
        if (event_is_stored(positions(at), args.kinds)) {
            if (skip == 0u) {
                found = at;
                break;
            }
            --skip;
        }
    }
    return found;
}
