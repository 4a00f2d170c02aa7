// Damaged or modified map files: each gives an error that names the fault; never a crash, a hang or another map. The
// serial backend; map_file_tests.hpp has all of them.
#include "../backends/on_serial.hpp"
#include "map_file_tests.hpp"

#include <atomic>
#include <barrier>
#include <csignal>
#include <set>
#include <thread>

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace photongrid::testing {
namespace {

    class damaged_map_files : public ::testing::Test {
    protected:
        damaged_map_files()
        {
            const auto set = make_photons(distribution::box_faces, 100, {4, 3, 5}, 1);
            save_map(b, sorted_map(b, upload_photons(b, set), set.g), folder / "map", "a note of 18 bytes");
            whole = bytes_of(folder / "map");

            // 18 blocks under two boxes, and 12 photons of another part of the light.
            auto more = make_photons(distribution::box_faces, 300, {4, 3, 5}, 1);
            for (std::size_t i = 0; i < more.positions.size(); i += 25)
                more.positions[i].w = 1;
            save_map(b, block_map(b, upload_photons(b, more), other_part), folder / "other");
            blocks = bytes_of(folder / "other");
            std::filesystem::remove(folder / "other");
        }
        /// The error of load_map() for these bytes; empty if it accepts them.
        std::string complaint(const std::string& bytes)
        {
            write_bytes(folder / "changed", bytes);
            try {
                (void)load_map(b, folder / "changed");
                return {};
            } catch (const map_file_error& e) {
                EXPECT_EQ(std::string(e.what()).find((folder / "changed").string()), 0u) << e.what();
                return e.what();
            }
        }
        /// The same with its checksum put right.
        static std::string summed(std::string bytes)
        {
            detail::map_file_header header;
            std::memcpy(&header, bytes.data(), sizeof header);
            header.checksum = 0;
            std::memcpy(bytes.data(), &header, sizeof header);
            detail::map_file_checksum sum;
            sum.add(reinterpret_cast<const std::byte*>(bytes.data()), bytes.size());
            header.checksum = sum.value();
            std::memcpy(bytes.data(), &header, sizeof header);
            return bytes;
        }

        /// A file after a change to its header and to what follows, with its size and checksum put right.
        using change = void (*)(detail::map_file_header&, std::string&);
        static std::string forged(const std::string& bytes, change c)
        {
            detail::map_file_header header;
            std::memcpy(&header, bytes.data(), sizeof header);
            std::string rest = bytes.substr(sizeof header);
            c(header, rest);
            header.bytes = sizeof header + rest.size();
            return summed(std::string(reinterpret_cast<const char*>(&header), sizeof header) + rest);
        }

        /// The files in the folder.
        std::set<std::string> names() const
        {
            std::set<std::string> all;
            for (const auto& entry : std::filesystem::directory_iterator(folder / ""))
                all.insert(entry.path().filename().string());
            return all;
        }

        serial_backend b;
        temporary_folder folder;
        std::string whole;  ///< of a grid map, "map" in the folder
        std::string blocks; ///< of a block map
    };

    TEST_F(damaged_map_files, are_detected_whichever_byte_changed)
    {
        ASSERT_EQ(complaint(whole), "");
        // One byte of the file at a time, since writing all of it each time is slow.
        std::fstream file(folder / "changed", std::ios::binary | std::ios::in | std::ios::out);
        const auto put = [&](std::size_t at, char byte) {
            file.seekp(static_cast<std::streamoff>(at));
            file.put(byte).flush();
        };
        for (std::size_t at = 0; at < whole.size(); ++at)
            for (const int bit : {0, 7}) {
                put(at, static_cast<char>(whole[at] ^ (1 << bit)));
                EXPECT_THROW((void)load_map(b, folder / "changed"), map_file_error)
                    << "bit " << bit << " of byte " << at;
                put(at, whole[at]);
            }
        EXPECT_EQ(bytes_of(folder / "changed"), whole);
    }

    TEST_F(damaged_map_files, keep_the_callers_note)
    {
        std::string note = "old";
        (void)load_map(b, folder / "map", &note);
        EXPECT_EQ(note, "a note of 18 bytes");
    }

    TEST_F(damaged_map_files, are_detected_when_cut_short_or_longer)
    {
        for (std::size_t n = 0; n < whole.size(); n += n < 200 ? 1 : 61)
            EXPECT_NE(complaint(whole.substr(0, n)), "") << n << " bytes";
        EXPECT_NE(complaint(whole + std::string(64, '\0')), "");
        EXPECT_NE(complaint(summed(whole + std::string(64, '\0'))), "");
    }

    TEST_F(damaged_map_files, are_rejected_with_the_reason)
    {
        EXPECT_THROW((void)load_map(b, folder / "none"), map_file_error);
        EXPECT_THROW((void)load_map(b, folder / "."), map_file_error);
        EXPECT_NE(complaint("PNG or whatever").find("is not a photon map"), std::string::npos);
        for (const int version : {2, 4}) {
            auto another = whole;
            another[8] = static_cast<char>(version);
            EXPECT_NE(complaint(another).find("version " + std::to_string(version)), std::string::npos);
        }
        auto other = whole;
        std::swap(other[12], other[15]);
        std::swap(other[13], other[14]);
        EXPECT_NE(complaint(other).find("byte order"), std::string::npos);
    }

    TEST_F(damaged_map_files, with_a_valid_checksum_are_rejected_too)
    {
        // Every word of the header, and the first cells or boxes: a wrong one is seen, or it is one of those that only
        // tell a number.
        const std::size_t harmless[] = {offsetof(detail::map_file_header, invalid),
            offsetof(detail::map_file_header, left_out), offsetof(detail::map_file_header, overflowing_cells),
            offsetof(detail::map_file_header, checksum), offsetof(detail::map_file_header, checksum) + 4};
        for (const auto& file : {whole, blocks}) {
            ASSERT_EQ(summed(file), file);
            ASSERT_EQ(complaint(file), "");
            for (std::size_t at = 8; at < sizeof(detail::map_file_header) + 64; at += 4) {
                const bool is_header = at < sizeof(detail::map_file_header);
                constexpr std::size_t lattice = offsetof(detail::map_file_header, cells_of),
                                      resolution = lattice + offsetof(grid, resolution);
                const bool is_lattice = at >= lattice && at < resolution;
                if (std::find(std::begin(harmless), std::end(harmless), at) != std::end(harmless))
                    continue;
                if ((is_lattice || (!is_header && file == blocks)) && (at - lattice) % 16 == 12)
                    continue; // fourth components are not read
                const std::uint32_t values[] = {0x7FC00000u, 0xFFFFFFFFu, 0xFFFFFF00u};
                for (const auto value : values) {
                    auto changed = file;
                    std::memcpy(changed.data() + at, &value, 4);
                    EXPECT_NE(complaint(summed(changed)), "")
                        << (file == blocks ? "block map: " : "grid map: ") << "word at " << at
                        << (is_header ? " of the header" : " of the cells or boxes") << " = " << value;
                }
            }
        }
    }

    /// A block map whose parts do not fit each other could lead a search out of its buffers.
    TEST_F(damaged_map_files, of_blocks_are_rejected_if_their_parts_do_not_fit)
    {
        using header = detail::map_file_header;
        ASSERT_EQ(forged(blocks, [](header&, std::string&) {}), blocks);
        header h;
        std::memcpy(&h, blocks.data(), sizeof h);
        ASSERT_EQ(h.in_blocks, 288u); // the changes below suit this tree
        ASSERT_EQ(h.levels, 2u);
        ASSERT_EQ(h.boxes, 2u * (16 + 32));
        static const auto put = [](std::string& rest, std::size_t element, float value) { // x of a box or photon
            std::memcpy(rest.data() + element * sizeof(glm::vec4), &value, sizeof value);
        };
        static constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                               infinity = std::numeric_limits<float>::infinity();
        static constexpr std::size_t photons = 2 * (16 + 32) + detail::map_file_padded(300 * sizeof(uint)) / 16;
        using kernels::high_corner, kernels::low_corner;
        const std::pair<const char*, change> changes[] = {
            {"a level less", [](header& f, std::string&) { --f.levels; }},
            {"a level more", [](header& f, std::string&) { ++f.levels; }},
            {"no level", [](header& f, std::string&) { f.levels = 0; }},
            {"photons of one level in blocks", [](header& f, std::string&) { f.in_blocks = 256; }},
            {"a block less", [](header& f, std::string&) { f.in_blocks = 272; }},
            {"a block more", [](header& f, std::string&) { f.in_blocks = 289; }},
            {"more in blocks than there are", [](header& f, std::string&) { f.in_blocks = 301; }},
            {"more in blocks than there are, in wide boxes",
                [](header& f, std::string& rest) {
                    f.in_blocks = 301;
                    for (const uint node : {1u, 33u, 34u}) {
                        const glm::vec4 low(-1e30f), high(1e30f);
                        std::memcpy(rest.data() + low_corner(node) * sizeof low, &low, sizeof low);
                        std::memcpy(rest.data() + high_corner(node) * sizeof high, &high, sizeof high);
                    }
                }},
            {"no photon in blocks", [](header& f, std::string&) { f.in_blocks = 0; }},
            {"no word", [](header& f, std::string&) { f.words = 0; }},
            {"ten words", [](header& f, std::string&) { f.words = 10; }},
            {"a curve without scale", [](header& f, std::string&) { f.curve.scale.x = 0; }},
            {"a curve of half the scale", [](header& f, std::string&) { f.curve.scale.x *= 0.5f; }},
            {"a curve that ends early", [](header& f, std::string&) { f.curve.scale.y *= 0.5f; }},
            {"a curve from -infinity", [](header& f, std::string&) { f.curve.low.y = -infinity; }},
            {"a curve to 10^20", [](header& f, std::string&) { f.curve.high.z = 1e20f; }},
            {"no box",
                [](header& f, std::string& rest) {
                    rest.erase(0, f.boxes * sizeof(glm::vec4));
                    f.boxes = 0;
                }},
            {"fewer boxes",
                [](header& f, std::string& rest) {
                    f.boxes -= 32;
                    rest.erase(f.boxes * sizeof(glm::vec4), 32 * sizeof(glm::vec4));
                }},
            {"more boxes",
                [](header& f, std::string& rest) {
                    rest.insert(f.boxes * sizeof(glm::vec4), 32 * sizeof(glm::vec4), '\0');
                    f.boxes += 32;
                }},
            {"a grid",
                [](header& f, std::string&) {
                    f.cells_of = make_grid(glm::vec3(0), glm::vec3(1), {1, 1, 1});
                }},
            {"a grid and its cell",
                [](header& f, std::string& rest) {
                    f.cells_of = make_grid(glm::vec3(0), glm::vec3(1), {1, 1, 1});
                    f.cells = 1;
                    rest.insert(0, 64, '\0');
                }},
            {"a cell",
                [](header& f, std::string& rest) {
                    f.cells = 1;
                    rest.insert(0, 64, '\0');
                }},
            {"surpluses",
                [](header& f, std::string& rest) {
                    f.surpluses = 4;
                    rest.append(64, '\0');
                }},
            // Nodes 0 and 1 are used on the higher level, 16 to 33 on the lower one.
            {"a box without children", [](header&, std::string& rest) { put(rest, low_corner(2), 0); }},
            {"the last box without children", [](header&, std::string& rest) { put(rest, high_corner(15), 1e30f); }},
            {"a block without photons", [](header&, std::string& rest) { put(rest, high_corner(34), nan); }},
            {"a box of NaN", [](header&, std::string& rest) { put(rest, low_corner(1), nan); }},
            {"a block of NaN", [](header&, std::string& rest) { put(rest, high_corner(33), nan); }},
            {"a box without end", [](header&, std::string& rest) { put(rest, high_corner(0), infinity); }},
            {"a block without end", [](header&, std::string& rest) { put(rest, low_corner(16), -infinity); }},
            {"a box of nothing", [](header&, std::string& rest) { put(rest, low_corner(0), 3e38f); }},
            {"a box smaller than its children", [](header&, std::string& rest) { put(rest, high_corner(0), 0.5f); }},
            {"a block smaller than its photons", [](header&, std::string& rest) { put(rest, low_corner(20), 1.5f); }},
            {"the first photon far away", [](header&, std::string& rest) { put(rest, photons, 2); }},
            {"the last photon far away", [](header&, std::string& rest) { put(rest, photons + 287, -2); }},
            {"a photon of NaN", [](header&, std::string& rest) { put(rest, photons + 100, nan); }},
        };
        for (const auto& [what, c] : changes)
            EXPECT_NE(complaint(forged(blocks, c)).find("is inconsistent"), std::string::npos) << what;
        // A photon in no block may lie anywhere.
        EXPECT_EQ(complaint(forged(blocks, [](header&, std::string& rest) { put(rest, photons + 288, nan); })), "");
    }

    TEST_F(damaged_map_files, replace_no_device_and_no_link)
    {
        const auto set = make_photons(distribution::uniform, 10, {2, 2, 2}, 1);
        const auto map = sorted_map(b, upload_photons(b, set), set.g);
        const auto refused = [&](const std::filesystem::path& file) {
            try {
                save_map(b, map, file);
                return std::string();
            } catch (const map_file_error& e) {
                return std::string(e.what());
            }
        };
        ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
        EXPECT_NE(refused(folder / "pipe").find("is not a regular file"), std::string::npos);
        EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe"));
        EXPECT_NE(refused(folder / "").find("is a folder"), std::string::npos);
        EXPECT_NE(refused(folder / "none/map").find("there is no folder"), std::string::npos);

        std::filesystem::create_symlink("map", folder / "link");
        EXPECT_EQ(refused(folder / "link"), "");
        EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
        EXPECT_NE(bytes_of(folder / "map"), whole);
        EXPECT_EQ(bytes_of(folder / "map"), bytes_of(folder / "link"));
    }

    TEST_F(damaged_map_files, are_never_left_by_a_failed_save)
    {
        const auto set = make_photons(distribution::uniform, 10, {2, 2, 2}, 1);
        const auto map = sorted_map(b, upload_photons(b, set), set.g);
        EXPECT_THROW(save_map(b, map, folder / "no/such/folder"), map_file_error);
        std::filesystem::create_directory(folder / "occupied");
        write_bytes(folder / "occupied/file", "x");
        EXPECT_THROW(save_map(b, map, folder / "occupied"), map_file_error);
        EXPECT_EQ(names(), (std::set<std::string>{"map", "occupied"}));
        save_map(b, map, folder / "map"); // over an older one
        EXPECT_EQ(load_map(b, folder / "map").photons.size(), 10u);
        EXPECT_EQ(names(), (std::set<std::string>{"map", "occupied"}));
    }

    // A file-size limit simulates a full disk.
    TEST_F(damaged_map_files, are_not_what_a_full_disk_leaves)
    {
        const auto set = make_photons(distribution::uniform, 3000, {2, 2, 2}, 1);
        const auto map = sorted_map(b, upload_photons(b, set), set.g);
        rlimit old{};
        ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
        const rlimit small{.rlim_cur = 4096, .rlim_max = old.rlim_max};
        const auto handler = std::signal(SIGXFSZ, SIG_IGN);
        ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
        std::string said;
        try {
            save_map(b, map, folder / "map");
        } catch (const map_file_error& e) {
            said = e.what();
        }
        setrlimit(RLIMIT_FSIZE, &old);
        std::signal(SIGXFSZ, handler);
        EXPECT_NE(said.find("cannot be written: File too large"), std::string::npos) << said;
        EXPECT_EQ(bytes_of(folder / "map"), whole);
        EXPECT_EQ(names(), std::set<std::string>{"map"});
    }

    /// Two threads save to one file, each its own map on its own device, while this one loads it.
    TEST_F(damaged_map_files, are_not_what_two_writers_leave)
    {
        std::atomic<int> failed = 0, saving = 2;
        std::barrier together(2);
        std::set<std::string> expected{whole};
        for (const std::size_t n : {3000u, 5000u}) {
            const auto set = make_photons(distribution::uniform, n, {4, 4, 4}, 1);
            save_map(b, sorted_map(b, upload_photons(b, set), set.g), folder / "other");
            expected.insert(bytes_of(folder / "other"));
        }
        {
            std::vector<std::jthread> threads;
            for (const std::size_t n : {3000u, 5000u})
                threads.emplace_back([&, n] {
                    bool waits = true;
                    try {
                        serial_backend mine;
                        const auto set = make_photons(distribution::uniform, n, {4, 4, 4}, 1);
                        const auto map = sorted_map(mine, upload_photons(mine, set), set.g);
                        waits = false;
                        together.arrive_and_wait();
                        for (int i = 0; i < 40; ++i)
                            save_map(mine, map, folder / "map");
                    } catch (const std::exception& e) {
                        ADD_FAILURE() << e.what();
                        ++failed;
                        if (waits)
                            together.arrive_and_drop();
                    }
                    --saving;
                });
            while (saving > 0)
                EXPECT_EQ(expected.count(bytes_of(folder / "map")), 1u);
        }
        EXPECT_EQ(failed, 0);
        EXPECT_EQ(expected.count(bytes_of(folder / "map")), 1u);
        EXPECT_EQ(names(), (std::set<std::string>{"map", "other"}));
    }

    /// Links by the names that a save may choose lead nowhere.
    TEST_F(damaged_map_files, are_not_written_through_links_to_come)
    {
        const auto number = [&] { // of the next save: the name ends with it and ".part"
            const detail::replacement_file now(folder / "now");
            for (const auto& name : names())
                if (name.starts_with("now."))
                    return std::stoi(name.substr(name.rfind('-') + 1)) + 1;
            return 0;
        }();
        for (int i = number; i < number + 20; ++i)
            std::filesystem::create_symlink(
                "victim", folder / ("map." + std::to_string(::getpid()) + "-" + std::to_string(i) + ".part"));
        const auto set = make_photons(distribution::uniform, 10, {2, 2, 2}, 1);
        save_map(b, sorted_map(b, upload_photons(b, set), set.g), folder / "map");
        EXPECT_EQ(load_map(b, folder / "map").photons.size(), 10u);
        EXPECT_FALSE(std::filesystem::exists(folder / "victim"));
        EXPECT_TRUE(std::filesystem::is_regular_file(std::filesystem::symlink_status(folder / "map")));
    }

} // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(serial, map_files, ::testing::Types<serial_tag>);

} // namespace photongrid::testing
