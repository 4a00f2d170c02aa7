// Photon maps in files: loading returns what was saved, or an error that names the fault. Included by each
// on_<backend>.cpp.
#pragma once

#include "../backends/serial_algorithms.hpp"
#include "../core/under_test.hpp"
#include "photon_sets.hpp"

#include <photongrid/map/map_file.hpp>

#include <filesystem>
#include <fstream>

namespace photongrid::testing {

/// A folder of its own, gone afterwards.
class temporary_folder {
public:
    temporary_folder() { std::filesystem::create_directory(path_); }
    ~temporary_folder() { std::filesystem::remove_all(path_); }
    temporary_folder(const temporary_folder&) = delete;
    temporary_folder& operator=(const temporary_folder&) = delete;
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

private:
    std::filesystem::path path_
        = std::filesystem::temp_directory_path() / ("photongrid-map-test-" + std::to_string(std::random_device()()));
};

inline std::string bytes_of(const std::filesystem::path& file)
{
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
inline void write_bytes(const std::filesystem::path& file, const std::string& bytes)
{
    std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

template <class Tag>
class map_files : public on_backend<Tag> {
};
TYPED_TEST_SUITE_P(map_files);

TYPED_TEST_P(map_files, come_back_to_the_bit_on_every_backend)
{
    auto& b = this->b();
    serial_backend serial;
    const temporary_folder folder;
    for (const std::size_t n : {0u, 1u, 15u, 3000u})
        for (const map_kind kind : all_maps)
            for (const bool oriented : {false, true}) {
                SCOPED_TRACE(name_of(kind) + (" of " + std::to_string(n) + " photons"));
                auto set = make_photons(distribution::clustered, n, {9, 7, 11}, 6);
                if (n > 7)
                    set.positions[7].x = std::numeric_limits<float>::quiet_NaN();
                for (std::size_t i = 3; i < n; i += 5)
                    set.positions[i].w = 1;
                auto p = upload_photons(b, set);
                if (oriented) {
                    std::vector<glm::vec4> some(n, glm::vec4(0, 1, 0, 0));
                    p.directions = b.upload(std::span<const glm::vec4>(some));
                    p.normals = b.upload(std::span<const glm::vec4>(some));
                }
                const auto map = make_map(b, kind, std::move(p), set.g, 4, 3, oriented ? other_part : every_part);
                save_map(b, map, folder / "map");
                const auto mine = load_map(b, folder / "map");
                const auto theirs = load_map(serial, folder / "map");
                const auto same = [&](const auto& saved, const auto& here, const auto& there) {
                    const auto known = b.download(saved);
                    EXPECT_EQ(count_different_bits(b.download(here), known), 0u);
                    EXPECT_EQ(count_different_bits(serial.download(there), known), 0u);
                };
                same(map.cells, mine.cells, theirs.cells);
                same(map.boxes, mine.boxes, theirs.boxes);
                same(map.list, mine.list, theirs.list);
                same(map.photons.positions, mine.photons.positions, theirs.photons.positions);
                same(map.photons.powers, mine.photons.powers, theirs.photons.powers);
                same(map.photons.directions, mine.photons.directions, theirs.photons.directions);
                same(map.photons.normals, mine.photons.normals, theirs.photons.normals);
                same(map.surpluses, mine.surpluses, theirs.surpluses);
                EXPECT_EQ(mine.has_blocks(), kind == map_kind::blocks);
                EXPECT_EQ(mine.levels, map.levels);
                EXPECT_EQ(mine.in_blocks, map.in_blocks);
                EXPECT_EQ(mine.words, map.words);
                EXPECT_EQ(mine.invalid, map.invalid);
                EXPECT_EQ(mine.left_out, map.left_out);
                EXPECT_EQ(mine.overflowing_cells, map.overflowing_cells);
                EXPECT_EQ(std::memcmp(&mine.cells_of, &map.cells_of, sizeof mine.cells_of), 0);
                EXPECT_EQ(std::memcmp(&mine.curve, &map.curve, sizeof mine.curve), 0);

                const auto points = make_points(set, 50, 2);
                const auto find = [&](const auto& in) {
                    return b.download(knn_grid_estimate(
                        b, in, b.upload(std::span<const glm::vec4>(points)), {.k = 10, .max_radius = 1})
                                          .irradiance);
                };
                EXPECT_EQ(count_different_bits(find(mine), find(map)), 0u);

                // The file does not tell who wrote it, nor, for blocks, who built the map.
                const auto first = bytes_of(folder / "map");
                save_map(serial, theirs, folder / "map");
                EXPECT_EQ(bytes_of(folder / "map"), first);
                if (kind == map_kind::blocks && !oriented) {
                    save_map(serial, block_map(serial, upload_photons(serial, set)), folder / "map");
                    EXPECT_EQ(bytes_of(folder / "map"), first);
                }
            }
}

REGISTER_TYPED_TEST_SUITE_P(map_files, come_back_to_the_bit_on_every_backend);

} // namespace photongrid::testing
