// A map made in one library goes through a file in another; estimates of both libraries and of this program agree; an
// exception that leaves a library is caught here by its type.
#include "shared.hpp"

int main(int, char** arguments)
{
    consumer::device device;
    const auto map = consumer::map_of_photons(device);
    const auto file = std::filesystem::path(arguments[0]).concat(".map");
    consumer::save(device, map, file);
    const auto loaded = consumer::load(device, file);
    const auto in_library = consumer::estimate_at_point(device, loaded);
    if (!consumer::is_right(in_library) || in_library != consumer::estimate(device, map))
        return 1;
    try {
        consumer::load(device, "no such file");
    } catch (const photongrid::map_file_error& e) {
        std::printf("refused: %s\n", e.what());
        return 0;
    }
    return 1;
}
