// What commands that read a scene have in common: its options; and files that must differ, of any command.
#pragma once

#include <photongrid/io/imported_scene.hpp>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace photongrid {

/// The scene, and how to read those of other programs.
void add_scene(CLI::App& to, std::string& path, import_settings& how);

/// The files of a command: what it reads and what it writes must differ.
class files_of_command {
public:
    files_of_command() = default;
    files_of_command(const std::string& scene, const import_settings& how);
    /// A file that is read. Several may be the same.
    void read(const std::string& path);
    /// A file that is written. \throws CLI::ValidationError for a file that was added before.
    void add(const std::string& option, const std::string& path);

private:
    struct file {
        std::string what;
        std::filesystem::path path;
    };
    std::vector<file> files_;
};

} // namespace photongrid
