// Counts the elements for which `holds` is true: a sum per workgroup, then one atomic addition.
layout(std430, binding = FIRST_OWN) buffer held_block_ { uint held_; };
shared uint group_held_;

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        group_held_ = 0u;
    barrier();
    uint at = element_();
    if (group_() < launch_.z && at < launch_.x) {
        if (holds(launch_.y + at))
            atomicAdd(group_held_, 1u);
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u && group_held_ != 0u)
        atomicAdd(held_, group_held_);
}
