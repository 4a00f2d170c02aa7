#include "shared.hpp"

void consumer::save(device& d, const map& m, const std::filesystem::path& file) { photongrid::save_map(d, m, file); }

consumer::map consumer::load(device& d, const std::filesystem::path& file) { return photongrid::load_map(d, file); }
