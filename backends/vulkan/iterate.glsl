// One pass over the elements that are not yet done (3.3, 4.3), and the list of those for the next one. With LISTING, only
// the list. The order of the list changes from run to run; no result depends on it.
//
// control_ holds four words a pass: workgroups in x, y, z for the indirect dispatch, and how many elements there are.
// launch_.z: this pass.
layout(std430, binding = 16) readonly buffer listed_block_ { uint listed_[]; };
layout(std430, binding = 17) buffer next_block_ { uint next_[]; };
layout(std430, binding = 18) buffer control_block_ { uint control_[]; };

const uint words_ = (uint(GROUP) + 31u) / 32u;
shared uint unfinished_[words_]; // a bit an invocation
shared uint base_;

void main()
{
    uint mine = gl_LocalInvocationIndex;
    if (mine < words_)
        unfinished_[mine] = 0u;
    barrier();

    uint at = element_();
    uint i = 0u;
    bool more = false;
#if LISTING
    uint target = 3u;
    if (group_() < launch_.z && at < launch_.x) {
        i = launch_.y + at;
        LOAD_ALL(i)
        more = !done();
    }
#else
    uint target = launch_.z * 4u + 7u;
    if (at < control_[launch_.z * 4u + 3u]) {
        i = listed_[at];
        LOAD_ALL(i)
        kernel(i);
        STORE_ALL(i)
        more = !done();
    }
#endif
    // One atomic addition a workgroup reserves its places in the next list; neighbours stay neighbours.
    if (more)
        atomicOr(unfinished_[mine / 32u], 1u << (mine % 32u));
    barrier();
    if (mine == 0u) {
        uint all = 0u;
        for (uint w = 0u; w < words_; ++w)
            all += uint(bitCount(unfinished_[w]));
        base_ = 0u;
        if (all != 0u)
            base_ = atomicAdd(control_[target], all);
    }
    barrier();
    if (more) {
        uint before = uint(bitCount(unfinished_[mine / 32u] & ((1u << (mine % 32u)) - 1u)));
        for (uint w = 0u; w < mine / 32u; ++w)
            before += uint(bitCount(unfinished_[w]));
        next_[base_ + before] = i;
    }
}
