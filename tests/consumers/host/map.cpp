#include "host.hpp"

host::map host::map_of_photons(device& d) { return consumer::make_map(d); }
