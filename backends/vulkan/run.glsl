// One pass over all elements.
void main()
{
    uint at = element_();
#if LANES > 1
    // All lanes of a group must run. Those past the last element repeat its work, and their results are discarded.
    uint end = group_() < launch_.z ? launch_.x : 0u;
    if (at - group_lane() < end) {
        uint element = min(at, end - 1u);
        LOAD_ALL(launch_.w + element)
        kernel(launch_.y + element);
        if (at < end) {
            STORE_ALL(launch_.w + at)
        }
    }
#else
    if (group_() < launch_.z && at < launch_.x) {
        uint where = launch_.w + at;
        LOAD_ALL(where)
        kernel(launch_.y + at);
        STORE_ALL(where)
    }
#endif
}
