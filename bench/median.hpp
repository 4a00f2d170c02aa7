// What measurements report.
#pragma once

#include <algorithm>
#include <vector>

namespace photongrid::bench {

/// The upper of the middle two where there are two; v is not empty.
inline double median(std::vector<double> v)
{
    std::sort(v.begin(), v.end());
    return v[v.size() / 2];
}

} // namespace photongrid::bench
