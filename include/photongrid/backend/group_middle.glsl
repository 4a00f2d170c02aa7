// Place in its group (IN_GROUPS, backend/begin.hpp) of the one nearest to the middle for which `which` holds; for one it must.
uint group_middle(bool which)
{
    uint half_way = GROUP_LANES / 2u;
    return group_min(which ? group_lane() ^ half_way : 0xFFFFFFFFu) ^ half_way;
}
