#include "shared.hpp"

consumer::map consumer::map_of_photons(device& d) { return make_map(d); }
