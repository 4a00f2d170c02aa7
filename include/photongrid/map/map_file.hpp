// A photon map in a file, so that an animation or another process can search it without tracing and sorting again.
//
// The file has a header (detail::map_file_header) and the map's buffers in little-endian order, each aligned to 64
// bytes: cells, boxes, list, positions, powers, directions, normals, surpluses, and the caller's note. Empty buffers
// are left out: a grid map has no boxes, and a block map has no cells and no surpluses. Loading maps the file into
// memory, if the system supports that, and uploads from there.
#pragma once

#include <photongrid/core/file_target.hpp>
#include <photongrid/map/file_bytes.hpp>

#include <array>
#include <bit>
#include <cstring>
#include <filesystem>
#include <limits>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Writes the map to `file`; on an error the old file remains. Threads and processes may save to the same file at the
/// same time: it is then one of their maps, whole. The same map gives the same bytes on every backend.
/// `note`: any bytes that the caller wants to store with the map, such as its scene and settings.
/// \throws map_file_error if the file cannot be written.
/// \snippet snippets.cpp save_map
template <backend B>
void save_map(B& device, const map_buffers<B>& map, const std::filesystem::path& file, const std::string& note = {})
{
    static_assert(std::endian::native == std::endian::little, "map files are those of little-endian machines");
    const auto cells = device.download(map.cells);
    const auto list = device.download(map.list);
    const auto boxes = device.download(map.boxes), positions = device.download(map.photons.positions),
               powers = device.download(map.photons.powers), directions = device.download(map.photons.directions),
               normals = device.download(map.photons.normals), surpluses = device.download(map.surpluses);

    if (note.size() > std::numeric_limits<std::uint32_t>::max())
        throw map_file_error(
            file, "cannot be written: its note of " + std::to_string(note.size()) + " bytes is longer than 2^32 - 1");
    detail::map_file_header header;
    header.cells_of = map.cells_of;
    header.curve = map.curve;
    header.photons = map.photons.size();
    header.cells = static_cast<std::uint32_t>(cells.size());
    header.boxes = static_cast<std::uint32_t>(boxes.size());
    header.levels = map.levels;
    header.in_blocks = map.in_blocks;
    header.words = map.words;
    header.surpluses = static_cast<std::uint32_t>(surpluses.size());
    header.attributes = (directions.empty() ? 0u : 1u) | (normals.empty() ? 0u : 2u);
    header.invalid = map.invalid;
    header.left_out = map.left_out;
    header.overflowing_cells = map.overflowing_cells;
    header.note = static_cast<std::uint32_t>(note.size());
    const auto each_buffer = [&](auto&& f) {
        f(cells);
        f(boxes);
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

    const auto reason = detail::replace_file(file, [&](const auto& append) {
        each_block([&](const std::byte* data, std::uint64_t bytes) { append(data, static_cast<std::size_t>(bytes)); });
    });
    if (!reason.empty())
        throw map_file_error(file, "cannot be written: " + reason);
}

/// Reads a map that save_map() wrote on any backend. It checks every byte first. `note` receives the caller's note.
/// \throws map_file_error for a file that is damaged, cut short, not a photon map, or of another version.
/// \throws backend_error if the backend has no room for the map.
/// \snippet snippets.cpp load_map
template <backend B>
map_buffers<B> load_map(B& device, const std::filesystem::path& file, std::string* note = nullptr)
{
    const detail::file_bytes bytes(file);
    const auto header = detail::map_header_of({bytes.data(), bytes.size()}, file);
    detail::check_map_header(header, file);

    const std::byte* at = bytes.data() + sizeof header;
    const std::uint64_t n = header.photons;
    const auto next = [&]<class T>(std::type_identity<T>, std::uint64_t count) {
        const std::span<const T> found(reinterpret_cast<const T*>(at), static_cast<std::size_t>(count));
        at += detail::map_file_padded(count * sizeof(T));
        return found;
    };
    map_buffers<B> map;
    map.cells_of = header.cells_of;
    map.curve = header.curve;
    map.levels = header.levels;
    map.in_blocks = header.in_blocks;
    map.words = header.words;
    const auto index = next(std::type_identity<glm::uvec2>{}, header.cells);
    detail::check_map_index(index, n, file);
    const std::type_identity<glm::vec4> vectors;
    const auto boxes = next(vectors, header.boxes);
    const auto list = next(std::type_identity<uint>{}, n);
    const auto positions = next(vectors, n);
    if (!boxes.empty())
        detail::check_map_boxes(boxes, positions.first(header.in_blocks), file);
    map.cells = device.upload(index);
    map.boxes = device.upload(boxes);
    map.list = device.upload(list);
    map.photons.positions = device.upload(positions);
    map.photons.powers = device.upload(next(vectors, n));
    if ((header.attributes & 1u) != 0)
        map.photons.directions = device.upload(next(vectors, n));
    if ((header.attributes & 2u) != 0)
        map.photons.normals = device.upload(next(vectors, n));
    map.surpluses = device.upload(next(vectors, header.surpluses));
    if (note != nullptr)
        note->assign(reinterpret_cast<const char*>(at), header.note);
    map.invalid = header.invalid;
    map.left_out = header.left_out;
    map.overflowing_cells = header.overflowing_cells;
    return map;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
