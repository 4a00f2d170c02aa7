#include <photongrid/io/export/side_files.hpp>
#include <photongrid/io/files.hpp>
#include <photongrid/io/ply_writer.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <cstdint>

namespace photongrid {

namespace {
    namespace fs = std::filesystem;

    /// FNV-1a of 64 bits, in hexadecimal digits.
    std::string hash_of(const std::string& bytes)
    {
        std::uint64_t hash = 0xcbf29ce484222325;
        for (const char c : bytes)
            hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
        std::string digits;
        for (int shift = 60; shift >= 0; shift -= 4)
            digits += "0123456789abcdef"[hash >> shift & 15];
        return digits;
    }

    bool has_bytes(const fs::path& path, const std::string& bytes)
    {
        std::error_code none;
        return fs::is_regular_file(path, none) && fs::file_size(path, none) == bytes.size()
            && whole_file(path.string()) == bytes;
    }
} // namespace

side_files::side_files(const std::string& scene) : scene_(scene), name_(fs::path(scene).stem().string())
{
    check_file_path(scene);
}

side_files::~side_files()
{
    std::error_code none;
    std::for_each(made_.rbegin(), made_.rend(), [&](const fs::path& path) { fs::remove(path, none); });
}

std::string side_files::add(const std::string& kind, const std::string& ending, const std::string& bytes)
{
    const auto where = folder() / name_;
    std::error_code wrong;
    if (fs::exists(where, wrong) && !fs::is_directory(where, wrong))
        fail_file(where.string(), "is no folder; the scene's meshes and pictures belong into one of that name");
    if (fs::create_directory(where, wrong))
        made_.push_back(where);
    else if (wrong)
        fail_file(where.string(), "cannot be made: " + wrong.message());
    const auto name = kind + "_" + hash_of(bytes) + ending;
    const auto path = where / name;
    if (!has_bytes(path, bytes)) {
        const bool is_new = !fs::exists(path, wrong);
        write_file(path.string(), bytes);
        if (is_new)
            made_.push_back(path);
    }
    paths_.insert(path.string());
    return name_ + "/" + name;
}

std::string side_files::add_surface(const std::shared_ptr<const mesh>& surface)
{
    auto& name = surfaces_[surface];
    if (name.empty())
        name = add("mesh", ".ply", ply_bytes(*surface));
    return name;
}

std::vector<std::string> side_files::finish(const std::string& bytes)
{
    write_file(scene_, bytes);
    made_.clear();
    std::vector<std::string> all(paths_.begin(), paths_.end());
    all.push_back(scene_);
    return all;
}

} // namespace photongrid
