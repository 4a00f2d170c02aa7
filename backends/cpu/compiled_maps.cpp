// photongrid::cpu_compiled: what compiled.hpp declares.
#include <photongrid/backends/cpu/compiled.hpp>

namespace photongrid {

template class photon_map<cpu_backend>;
template class point_index<cpu_backend>;

} // namespace photongrid
