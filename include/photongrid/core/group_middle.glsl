// Lane index (IN_GROUPS, core/begin.hpp) of the lane closest to the subgroup's centre for which `which` is true. It
// must be true in at least one lane.
uint group_middle(bool which)
{
    uint half_way = GROUP_LANES / 2u;
    return group_min(which ? group_lane() ^ half_way : 0xFFFFFFFFu) ^ half_way;
}
