// Writes what is made from setting_table.hpp into the schema of scene files and docs/reference/settings.md, after a
// setting was added or its words were changed. A test of scene_file fails where they differ from the table.
//
//   photongrid_setting_texts FOLDER   the source folder
#include <photongrid/io/files.hpp>
#include <photongrid/io/setting_texts.hpp>

#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>

int main(int argc, char** argv)
{
    if (argc != 2) {
        std::cerr << "usage: photongrid_setting_texts FOLDER\n";
        return 2;
    }
    try {
        const auto write = [&](const char* file, std::string (*make)(const std::string&)) {
            const auto path = std::string(argv[1]) + "/" + file;
            std::ifstream in(path, std::ios::binary);
            photongrid::write_file(path, make({std::istreambuf_iterator<char>(in), {}}));
        };
        write("examples/scenes/photongrid-scene.schema.json", photongrid::schema_with_settings);
        write("docs/reference/settings.md", photongrid::page_with_settings);
    } catch (const std::exception& e) {
        std::cerr << "photongrid_setting_texts: " << e.what() << '\n';
        return 1;
    }
    return 0;
}
