// Runs one pass over the elements that are not done (3.3, 4.3), and lists those that are not done after it. With
// LISTING it only makes the list. The order of the list varies between runs; no result depends on it. If elements run
// in groups (LANES > 1), a group stays together until all its elements are done, so that its common work does not
// depend on that order either.
//
// control_ has eight words per pass: workgroups in x, y, z for its indirect dispatch, the length of its list, the
// number of elements that are not done, and the number of workgroups that have finished the pass; the first pass has
// one more, the workgroups that have finished its list. The last workgroup to finish writes the workgroups of the next
// pass.
// launch_.z: this pass; launch_.w: offset of its elements from those of the list.
layout(std430, binding = FIRST_OWN) readonly buffer listed_block_ { uint listed_[]; };
layout(std430, binding = FIRST_OWN + 1) buffer next_block_ { uint next_[]; };
layout(std430, binding = FIRST_OWN + 2) buffer control_block_ { uint control_[]; };

const uint words_ = (uint(GROUP) + 31u) / 32u;
const uint NOBODY = 0xFFFFFFFFu; // an entry without an element, so that groups stay together
shared uint kept_[words_];       // a bit per invocation
shared uint unfinished_;
shared uint base_;

void main()
{
    uint mine = gl_LocalInvocationIndex;
    if (mine < words_)
        kept_[mine] = 0u;
    if (mine == 0u)
        unfinished_ = 0u;
    barrier();

    uint at = element_();
    uint i = NOBODY;
    bool more = false;
#if LISTING
    uint target = 0u;
    uint finished = 6u;
    if (group_() < launch_.z && at < launch_.x) {
        i = launch_.y + at;
        LOAD_ALL(i)
        more = !done();
    }
    bool keep = group_any(more);
#else
    uint target = launch_.z * 8u + 8u;
    uint finished = launch_.z * 8u + 5u;
    bool keep = false;
#if LANES > 1
    // The first entry of a group is always an element. Lanes without an element, and elements that are done, take part
    // for the others' sake; their results are discarded.
    if (at < control_[launch_.z * 8u + 3u]) {
        i = listed_[at];
        uint first = lane_value(i, 0u);
        uint which = (i != NOBODY ? i : first) + launch_.w;
        LOAD_ALL(which)
        bool works = i != NOBODY && !done();
        kernel(which);
        if (works) {
            STORE_ALL(which)
            more = !done();
        }
        keep = group_any(more);
    }
#else
    if (at < control_[launch_.z * 8u + 3u]) {
        i = listed_[at];
        uint which = i + launch_.w;
        LOAD_ALL(which)
        kernel(which);
        STORE_ALL(which)
        more = !done();
        keep = more;
    }
#endif
#endif
    // One atomic addition per workgroup reserves a range of the next list, so that neighbours stay together.
    if (keep)
        atomicOr(kept_[mine / 32u], 1u << (mine % 32u));
    if (more)
        atomicAdd(unfinished_, 1u);
    barrier();
    if (mine == 0u) {
        uint all = 0u;
        for (uint w = 0u; w < words_; ++w)
            all += uint(bitCount(kept_[w]));
        base_ = 0u;
        if (all != 0u) {
            base_ = atomicAdd(control_[target + 3u], all);
            atomicAdd(control_[target + 4u], unfinished_);
        }
        memoryBarrierBuffer();
        if (atomicAdd(control_[finished], 1u) + 1u == gl_NumWorkGroups.x * gl_NumWorkGroups.y) {
            memoryBarrierBuffer();
            uint groups = (atomicAdd(control_[target + 3u], 0u) + uint(GROUP) - 1u) / uint(GROUP);
            uint rows = (groups + MOST_GROUPS - 1u) / MOST_GROUPS;
            control_[target] = rows == 0u ? 0u : (groups + rows - 1u) / rows;
            control_[target + 1u] = rows;
            control_[target + 2u] = 1u;
        }
    }
    barrier();
    if (keep) {
        uint before = uint(bitCount(kept_[mine / 32u] & ((1u << (mine % 32u)) - 1u)));
        for (uint w = 0u; w < mine / 32u; ++w)
            before += uint(bitCount(kept_[w]));
        next_[base_ + before] = i;
    }
}
