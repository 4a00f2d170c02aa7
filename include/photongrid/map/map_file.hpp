// A photon map in a file, so that an animation or another process can search it without tracing and sorting again.
//
// The file has a header (detail::map_file_header) and the map's buffers in little-endian order, each aligned to 64
// bytes: cells, list, positions, powers, directions, normals, surpluses, and the caller's note. Empty buffers are left
// out. Loading maps the file into memory, if the system supports that, and uploads from there.
#pragma once

#include <photongrid/map/map_buffers.hpp>

#include <array>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <system_error>

#if __has_include(<sys/mman.h>)
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#define PHOTONGRID_CAN_MAP_FILES
#endif

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// load_map() throws it for a file that is not a complete photon map of a known version, save_map() for a file that it
/// cannot write. The message has the file, what is wrong, and what to do.
class map_file_error : public std::runtime_error {
public:
    /// The message is "file: what".
    map_file_error(const std::filesystem::path& file, const std::string& what)
        : std::runtime_error(file.string() + ": " + what)
    {
    }
};

namespace detail {
    inline constexpr std::array<char, 8> map_file_magic{'p', 'h', 'g', 'r', 'i', 'd', 'm', '\n'};
    inline constexpr std::uint32_t map_file_version = 1, map_file_byte_order = 0x01020304u;

    struct map_file_header {
        std::array<char, 8> magic = map_file_magic;
        std::uint32_t version = map_file_version;
        std::uint32_t byte_order = map_file_byte_order;
        grid cells_of{};
        std::uint32_t photons = 0;
        std::uint32_t cells = 0;
        std::uint32_t surpluses = 0;  ///< elements; 0 or as many as cells
        std::uint32_t attributes = 0; ///< bit 0: directions, bit 1: normals
        std::uint32_t invalid = 0, left_out = 0, overflowing_cells = 0;
        std::uint32_t note = 0;     ///< bytes
        std::uint64_t bytes = 0;    ///< of the whole file
        std::uint64_t checksum = 0; ///< of the whole file, taken with 0 here
    };
    static_assert(sizeof(map_file_header) == 128 && std::is_trivially_copyable_v<map_file_header>);

    constexpr std::uint64_t map_file_padded(std::uint64_t bytes) { return (bytes + 63) / 64 * 64; }

    /// Fowler, Noll and Vo's hash (FNV-1a), in words of eight bytes. Any change within one word changes it.
    class map_file_checksum {
    public:
        /// `bytes`: a multiple of eight.
        void add(const std::byte* data, std::uint64_t bytes)
        {
            for (std::uint64_t i = 0; i < bytes; i += 8) {
                std::uint64_t word;
                std::memcpy(&word, data + i, 8);
                value_ = (value_ ^ word) * 0x100000001B3u;
            }
        }
        std::uint64_t value() const { return value_; }

    private:
        std::uint64_t value_ = 0xCBF29CE484222325u;
    };

    /// The bytes of a file, in memory.
    class file_bytes {
    public:
        explicit file_bytes(const std::filesystem::path& file)
        {
#if defined(PHOTONGRID_CAN_MAP_FILES)
            const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
            if (descriptor < 0)
                throw map_file_error(file, "cannot be opened: " + std::generic_category().message(errno));
            struct ::stat status {};
            const bool known = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
            if (known && status.st_size > 0)
                mapped_
                    = ::mmap(nullptr, static_cast<std::size_t>(status.st_size), PROT_READ, MAP_PRIVATE, descriptor, 0);
            ::close(descriptor);
            if (!known || mapped_ == MAP_FAILED) {
                mapped_ = nullptr;
                throw map_file_error(file, known ? "cannot be mapped into memory" : "is not a regular file");
            }
            size_ = static_cast<std::size_t>(status.st_size);
#else
            std::ifstream in(file, std::ios::binary | std::ios::ate);
            if (!in)
                throw map_file_error(file, "cannot be opened");
            size_ = static_cast<std::size_t>(in.tellg());
            // In aligned lines of 64 bytes, so that buffers are aligned for their types.
            read_.resize((size_ + 63) / 64);
            in.seekg(0);
            if (!in.read(reinterpret_cast<char*>(read_.data()), static_cast<std::streamsize>(size_)))
                throw map_file_error(file, "cannot be read");
#endif
        }
        file_bytes(const file_bytes&) = delete;
        file_bytes& operator=(const file_bytes&) = delete;
        ~file_bytes()
        {
#if defined(PHOTONGRID_CAN_MAP_FILES)
            if (mapped_ != nullptr)
                ::munmap(mapped_, size_);
#endif
        }
        std::size_t size() const { return size_; }
        const std::byte* data() const
        {
#if defined(PHOTONGRID_CAN_MAP_FILES)
            return static_cast<const std::byte*>(mapped_);
#else
            return reinterpret_cast<const std::byte*>(read_.data());
#endif
        }

    private:
        std::size_t size_ = 0;
#if defined(PHOTONGRID_CAN_MAP_FILES)
        void* mapped_ = nullptr;
#else
        struct alignas(64) line {
            std::byte bytes[64];
        };
        std::vector<line> read_;
#endif
    };
} // namespace detail
#undef PHOTONGRID_CAN_MAP_FILES

/// Writes the map to `file`; on an error the old file remains. The same map gives the same bytes on every backend.
/// `note`: any bytes that the caller wants to store with the map, such as its scene and settings.
/// \throws map_file_error if the file cannot be written.
/// \snippet snippets.cpp save_map
template <backend B>
void save_map(B& b, const map_buffers<B>& map, const std::filesystem::path& file, const std::string& note = {})
{
    static_assert(std::endian::native == std::endian::little, "map files are those of little-endian machines");
    const auto cells = b.download(map.cells);
    const auto list = b.download(map.list);
    const auto positions = b.download(map.photons.positions), powers = b.download(map.photons.powers);
    const auto directions = b.download(map.photons.directions), normals = b.download(map.photons.normals),
               surpluses = b.download(map.surpluses);

    if (note.size() > std::numeric_limits<std::uint32_t>::max())
        throw map_file_error(
            file, "cannot be written: its note of " + std::to_string(note.size()) + " bytes is longer than 2^32 - 1");
    detail::map_file_header header;
    header.cells_of = map.cells_of;
    header.photons = map.photons.size();
    header.cells = static_cast<std::uint32_t>(cells.size());
    header.surpluses = static_cast<std::uint32_t>(surpluses.size());
    header.attributes = (directions.empty() ? 0u : 1u) | (normals.empty() ? 0u : 2u);
    header.invalid = map.invalid;
    header.left_out = map.left_out;
    header.overflowing_cells = map.overflowing_cells;
    header.note = static_cast<std::uint32_t>(note.size());
    const auto each_buffer = [&](auto&& f) {
        f(cells);
        f(list);
        for (const auto* attribute : {&positions, &powers, &directions, &normals, &surpluses})
            f(*attribute);
        f(note);
    };
    header.bytes = detail::map_file_padded(sizeof header);
    each_buffer([&](const auto& v) { header.bytes += detail::map_file_padded(v.size() * sizeof v[0]); });

    // Visits all bytes twice: for the checksum, and for the file.
    const auto each_block = [&](auto&& f) {
        const auto block = [&](const void* data, std::uint64_t bytes) {
            const std::uint64_t words = bytes / 8 * 8;
            f(static_cast<const std::byte*>(data), words);
            std::array<std::byte, 64> rest{}; // the last, incomplete word, and padding
            std::memcpy(rest.data(), static_cast<const std::byte*>(data) + words, bytes - words);
            f(rest.data(), detail::map_file_padded(bytes) - words);
        };
        block(&header, sizeof header);
        each_buffer([&](const auto& v) {
            if (!v.empty())
                block(v.data(), v.size() * sizeof v[0]);
        });
    };
    detail::map_file_checksum sum;
    each_block([&](const std::byte* data, std::uint64_t bytes) { sum.add(data, bytes); });
    header.checksum = sum.value();

    auto part = file;
    part += ".part";
    std::error_code failed;
    {
        std::ofstream out(part, std::ios::binary | std::ios::trunc);
        each_block([&](const std::byte* data, std::uint64_t bytes) {
            out.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(bytes));
        });
        out.close();
        if (!out) {
            std::filesystem::remove(part, failed);
            throw map_file_error(file, "cannot be written; check that its folder exists and has room");
        }
    }
    std::filesystem::rename(part, file, failed);
    if (failed) {
        const auto why = failed.message();
        std::filesystem::remove(part, failed);
        throw map_file_error(file, "cannot be written: " + why);
    }
}

/// Reads a map that save_map() wrote on any backend. It checks every byte first. `note` receives the caller's note.
/// \throws map_file_error for a file that is damaged, cut short, not a photon map, or of another version.
/// \throws backend_error if the backend has no room for the map.
/// \snippet snippets.cpp load_map
template <backend B>
map_buffers<B> load_map(B& b, const std::filesystem::path& file, std::string* note = nullptr)
{
    const detail::file_bytes bytes(file);
    const auto refuse = [&](const std::string& what) { throw map_file_error(file, what); };
    detail::map_file_header header;
    if (bytes.size() < sizeof header.magic
        || std::memcmp(bytes.data(), detail::map_file_magic.data(), sizeof header.magic) != 0)
        refuse("is not a photon map; give a file that save_map() wrote");
    if (bytes.size() < sizeof header)
        refuse("is cut short; save the map again");
    std::memcpy(&header, bytes.data(), sizeof header);
    if (header.byte_order != detail::map_file_byte_order)
        refuse("is damaged, or from a machine with another byte order; save the map again here");
    if (header.version != detail::map_file_version)
        refuse("is a photon map of version " + std::to_string(header.version) + ", and this photongrid reads version "
            + std::to_string(detail::map_file_version) + "; save the map again");
    if (header.bytes != bytes.size())
        refuse("has " + std::to_string(bytes.size()) + " bytes and should have " + std::to_string(header.bytes)
            + ": it is cut short or damaged; save the map again");
    detail::map_file_checksum sum;
    auto unsummed = header;
    unsummed.checksum = 0;
    sum.add(reinterpret_cast<const std::byte*>(&unsummed), sizeof unsummed);
    sum.add(bytes.data() + sizeof header, (bytes.size() - sizeof header) / 8 * 8);
    if (sum.value() != header.checksum || bytes.size() % 64 != 0)
        refuse("is damaged: its checksum is wrong; save the map again");

    // The checksum is right. A forged file could still be inconsistent, and searches must terminate for it too.
    const auto wrong = [&] { refuse("is inconsistent; it was not written by save_map()"); };
    const std::uint64_t n = header.photons, cells = header.cells;
    const auto size_of
        = [&](std::uint64_t count, std::size_t element) { return detail::map_file_padded(count * element); };
    const std::uint64_t expected = size_of(1, sizeof header) + size_of(cells, sizeof(glm::uvec2))
        + size_of(n, sizeof(uint)) + size_of(header.surpluses, sizeof(glm::vec4)) + size_of(header.note, 1)
        + size_of(n, sizeof(glm::vec4)) * (2u + (header.attributes & 1u) + (header.attributes >> 1 & 1u));
    const grid& g = header.cells_of;
    const auto& r = g.resolution;
    if (header.attributes > 3 || expected != bytes.size() || (header.surpluses != 0 && header.surpluses != cells)
        || r[0] < 1 || r[1] < 1 || r[2] < 1 || r[3] != cells || std::uint64_t{r[0]} * r[1] > cells
        || std::uint64_t{r[0]} * r[1] * r[2] != cells)
        wrong();
    for (int axis = 0; axis < 3; ++axis)
        if (!std::isfinite(g.origin[axis]) || !std::isfinite(g.inverse_cell[axis]) || !std::isfinite(g.cell[axis])
            || !(g.inverse_cell[axis] > 0) || !(g.cell[axis] > 0))
            wrong();

    const std::byte* at = bytes.data() + sizeof header;
    const auto next = [&]<class T>(std::type_identity<T>, std::uint64_t count) {
        const std::span<const T> found(reinterpret_cast<const T*>(at), static_cast<std::size_t>(count));
        at += detail::map_file_padded(count * sizeof(T));
        return found;
    };
    map_buffers<B> map;
    map.cells_of = header.cells_of;
    const auto index = next(std::type_identity<glm::uvec2>{}, cells);
    std::uint64_t sum_of_counts = 0;
    for (const auto& cell : index) {
        if (cell.x != sum_of_counts)
            wrong();
        sum_of_counts += cell.y;
    }
    if (sum_of_counts > n)
        wrong();
    map.cells = b.upload(index);
    map.list = b.upload(next(std::type_identity<uint>{}, n));
    const std::type_identity<glm::vec4> vectors;
    map.photons.positions = b.upload(next(vectors, n));
    map.photons.powers = b.upload(next(vectors, n));
    if ((header.attributes & 1u) != 0)
        map.photons.directions = b.upload(next(vectors, n));
    if ((header.attributes & 2u) != 0)
        map.photons.normals = b.upload(next(vectors, n));
    map.surpluses = b.upload(next(vectors, header.surpluses));
    if (note != nullptr)
        note->assign(reinterpret_cast<const char*>(at), header.note);
    map.invalid = header.invalid;
    map.left_out = header.left_out;
    map.overflowing_cells = header.overflowing_cells;
    return map;
}

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
