// The JSON of a glTF file and its buffers. Every value is checked where it is read, and every error has its place.
#pragma once

#include <photongrid/io/import/scene_builder.hpp>
#include <photongrid/io/json_tree.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace photongrid::gltf {

class document;

/// A value of the document.
class part {
public:
    part(const document& all, const json_value& value) : all_(&all), value_(&value) {}

    source_place place() const;
    /// "the text "x"", for messages.
    std::string described() const { return photongrid::described(*value_); }
    [[noreturn]] void fail(const std::string& what) const { fail_at(place(), what); }

    /// \name Properties of an object
    /// All are optional. A value of another kind, or out of its range, is a scene_error.
    /// @{
    bool has(std::string_view key) const { return value_->find(key) != nullptr; }
    /// An object.
    std::optional<part> object(std::string_view key) const;
    /// The elements of an array; none if it is absent.
    std::vector<part> items(std::string_view key) const;
    double number(std::string_view key, double if_absent, double low = -1e18, double high = 1e18) const;
    std::optional<std::size_t> whole(std::string_view key, std::size_t most = std::size_t{1} << 40) const;
    /// The index of an element of a list of the document, as "meshes".
    std::optional<std::size_t> index(std::string_view key, const char* list) const;
    std::optional<std::string> text(std::string_view key) const;
    bool truth(std::string_view key, bool if_absent) const;
    /// `Count` numbers.
    template <std::size_t Count>
    std::optional<std::array<double, Count>> numbers(
        std::string_view key, double low = -1e18, double high = 1e18) const;
    std::optional<dvec3> colour(std::string_view key, double most) const;
    /// An object in "extensions".
    std::optional<part> extension(std::string_view name) const;
    /// @}

    /// \name An element of an array
    /// @{
    double as_number(double low, double high) const;
    std::size_t as_index(const char* list) const;
    std::string as_text() const;
    /// @}

    /// The keys of an object.
    std::vector<std::string> keys() const;
    /// The value of a key, which must be there.
    part at(std::string_view key) const { return {*all_, *value_->find(key)}; }

private:
    const json_value* find(std::string_view key, json_kind kind, const char* expected) const;
    void numbers_into(std::string_view key, double low, double high, double* to, std::size_t count) const;

    const document* all_;
    const json_value* value_;
};

/// A part of a buffer.
struct byte_range {
    const char* data = nullptr;
    std::size_t size = 0;
    std::size_t stride = 0; ///< of its elements; 0: they follow each other
};

/// A .gltf or a .glb.
class document {
public:
    /// `builder`: reads the files of buffers.
    /// \throws scene_error for what is no glTF 2, and for extensions that a reader must know and photongrid does not.
    document(const std::string& file, std::string_view bytes, scene_builder& builder);
    document(const document&) = delete; // its parts point to it

    /// The element of a list, as "meshes". It must exist.
    part element(const char* list, std::size_t index) const;
    std::size_t count(const char* list) const;
    part root() const { return {*this, tree_->root()}; }

    /// How messages call an element: `material "Wood"`, or `material 3` if it has no name.
    std::string name_of(const char* kind, const char* list, std::size_t index) const;

    /// The bytes of a buffer view.
    byte_range view(std::size_t index);

    scene_builder& builder() const { return builder_; }
    /// Whether Blender wrote it.
    bool is_by_blender() const { return is_by_blender_; }
    /// The place of a value in the text. In a .glb, whose lines nobody can look up, it has a JSON pointer.
    source_place place_of(std::size_t offset) const;
    /// Counts the numbers that are read of accessors, so that a short file cannot fill the memory by naming the same
    /// ones again and again.
    void count_numbers(const part& p, std::size_t more);

private:
    const std::string& buffer(std::size_t index);
    std::string pointer_to(std::size_t offset) const;
    void split_binary(std::string_view bytes);
    void check_extensions();

    scene_builder& builder_;
    std::shared_ptr<const std::string> file_;
    std::string json_;
    bool is_binary_ = false, is_by_blender_ = false;
    std::string_view chunk_{}; ///< of a .glb: its first buffer
    std::optional<json_tree> tree_;
    std::vector<std::size_t> lines_; ///< where each begins
    std::map<std::size_t, std::string> buffers_;
    std::size_t numbers_ = 0, most_numbers_;
};

template <std::size_t Count>
std::optional<std::array<double, Count>> part::numbers(std::string_view key, double low, double high) const
{
    if (!has(key))
        return std::nullopt;
    std::array<double, Count> made{};
    numbers_into(key, low, high, made.data(), Count);
    return made;
}

} // namespace photongrid::gltf
