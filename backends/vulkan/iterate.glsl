// One pass over the elements that are not yet done (3.3, 4.3), and the list of those for the next one. With LISTING, only
// the list. The order of the list changes from run to run; no result depends on it. Where elements work in groups (LANES > 1),
// a group stays as it is until all of it are done: what it visits together does not depend on that order either.
//
// control_ holds eight words a pass: workgroups in x, y, z for the indirect dispatch, how many places the list has, and how
// many elements are not done. launch_.z: this pass, launch_.w: how much further on its elements are than those
// of the list.
layout(std430, binding = 16) readonly buffer listed_block_ { uint listed_[]; };
layout(std430, binding = 17) buffer next_block_ { uint next_[]; };
layout(std430, binding = 18) buffer control_block_ { uint control_[]; };

const uint words_ = (uint(GROUP) + 31u) / 32u;
const uint NOBODY = 0xFFFFFFFFu; // a place in the list without an element, so that groups stay whole
shared uint kept_[words_];       // a bit an invocation
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
    if (group_() < launch_.z && at < launch_.x) {
        i = launch_.y + at;
        LOAD_ALL(i)
        more = !done();
    }
    bool keep = group_any(more);
#else
    uint target = launch_.z * 8u + 8u;
    bool keep = false;
#if LANES > 1
    // The first of a group is always an element; what empty places and done elements do, for the others
    // to hear of, is dropped.
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
    // One atomic addition a workgroup reserves its places in the next list; neighbours stay neighbours.
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
    }
    barrier();
    if (keep) {
        uint before = uint(bitCount(kept_[mine / 32u] & ((1u << (mine % 32u)) - 1u)));
        for (uint w = 0u; w < mine / 32u; ++w)
            before += uint(bitCount(kept_[w]));
        next_[base_ + before] = i;
    }
}
