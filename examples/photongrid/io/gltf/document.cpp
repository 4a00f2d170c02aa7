#include <photongrid/io/gltf/document.hpp>
#include <photongrid/io/gltf/uri.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <span>

namespace photongrid::gltf {

namespace {
    constexpr json_limits limits{.bytes = std::size_t{1} << 31, .depth = 64, .values = 8'000'000};

    std::uint32_t word_at(std::string_view bytes, std::size_t offset) // little-endian
    {
        std::uint32_t made = 0;
        for (std::size_t i = 4; i-- > 0;)
            made = made << 8 | static_cast<unsigned char>(bytes[offset + i]);
        return made;
    }

    constexpr std::string_view compressing[] = {"KHR_draco_mesh_compression", "EXT_meshopt_compression"};
    /// Extensions whose parts are read, or noted where they are used.
    constexpr std::string_view known[] = {"KHR_lights_punctual", "KHR_materials_ior", "KHR_materials_transmission",
        "KHR_materials_volume", "KHR_materials_emissive_strength", "KHR_materials_unlit", "KHR_materials_specular",
        "KHR_materials_pbrSpecularGlossiness", "KHR_texture_transform", "KHR_mesh_quantization",
        "EXT_mesh_gpu_instancing", "KHR_materials_clearcoat", "KHR_materials_sheen", "KHR_materials_anisotropy",
        "KHR_materials_iridescence", "KHR_materials_dispersion", "KHR_materials_diffuse_transmission",
        "KHR_materials_variants", "KHR_node_visibility"};

    bool is_in(std::span<const std::string_view> list, std::string_view name)
    {
        return std::find(list.begin(), list.end(), name) != list.end();
    }
} // namespace

document::document(const std::string& file, std::string_view bytes, scene_builder& builder)
    : builder_(builder), file_(std::make_shared<const std::string>(file)),
      most_numbers_((std::size_t{1} << 22) + 16 * bytes.size())
{
    if (bytes.starts_with("glTF"))
        split_binary(bytes);
    else
        json_ = bytes;
    tree_.emplace(file, std::move(json_), limits);
    const auto& text = tree_->text();
    lines_.push_back(0);
    if (!is_binary_)
        for (auto at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1))
            lines_.push_back(at + 1);
    if (tree_->root().kind != json_kind::object)
        root().fail("found " + root().described() + "; expected the object of a glTF file");
    const auto asset = root().object("asset");
    if (!asset)
        root().fail("there is no \"asset\", so that this is no glTF file");
    const auto version = asset->text("version").value_or("");
    if (!version.starts_with("2."))
        asset->fail("found version " + shown_word(version) + " of glTF; expected 2.0");
    const auto generator = asset->text("generator").value_or("");
    is_by_blender_ = generator.find("glTF Blender I/O") != std::string::npos;
    check_extensions();
}

void document::split_binary(std::string_view bytes)
{
    is_binary_ = true;
    const auto refuse = [&](const std::string& what) { fail_at(source_place(*file_), what); };
    if (bytes.size() < 20)
        refuse("the file ends within its header");
    if (const auto version = word_at(bytes, 4); version != 2)
        refuse("found version " + std::to_string(version) + " of binary glTF; expected 2");
    const std::size_t length = word_at(bytes, 8);
    if (length > bytes.size())
        refuse("the file has " + std::to_string(bytes.size()) + " of the " + std::to_string(length)
            + " bytes that its header says");
    bytes = bytes.substr(0, length);
    bool has_json = false;
    for (std::size_t at = 12; at + 8 <= bytes.size();) {
        const std::size_t size = word_at(bytes, at);
        const auto kind = bytes.substr(at + 4, 4);
        at += 8;
        if (size > bytes.size() - at)
            refuse("a chunk of the file reaches beyond its end");
        if (!has_json) {
            if (kind != "JSON")
                refuse("the first chunk of the file is not its JSON");
            json_ = bytes.substr(at, size);
            has_json = true;
        } else if (kind == std::string_view("BIN\0", 4) && chunk_.data() == nullptr) {
            chunk_ = bytes.substr(at, size);
        }
        at += size;
    }
    if (!has_json)
        refuse("the file has no JSON");
}

source_place document::place_of(std::size_t offset) const
{
    if (is_binary_)
        return {std::make_shared<const std::string>(*file_ + pointer_to(offset)), 0, 0};
    const auto next = std::upper_bound(lines_.begin(), lines_.end(), offset);
    return {file_, static_cast<std::size_t>(next - lines_.begin()), offset - *(next - 1) + 1};
}

/// "#/meshes/0/primitives/1" (RFC 6901) of the value at a place.
std::string document::pointer_to(std::size_t offset) const
{
    std::string pointer;
    for (const auto* v = &tree_->root(); v->place != offset;) {
        const auto next = std::upper_bound(v->items.begin(), v->items.end(), offset,
            [](std::size_t wanted, const json_value& i) { return wanted < i.place; });
        if (next == v->items.begin())
            break;
        const auto index = static_cast<std::size_t>(next - v->items.begin()) - 1;
        pointer += '/' + (v->kind == json_kind::array ? std::to_string(index) : printable(v->items[index].key, 60));
        v = &v->items[index];
    }
    return pointer.empty() ? "" : '#' + pointer;
}

void document::check_extensions()
{
    for (const auto& e : root().items("extensionsRequired")) {
        const auto name = e.as_text();
        if (is_in(compressing, name))
            e.fail(
                "the meshes are compressed (" + name + "), which photongrid does not read; export them uncompressed");
        if (!is_in(known, name))
            e.fail("the file requires " + shown_word(name) + ", which photongrid does not read");
    }
    for (const auto& e : root().items("extensionsUsed"))
        if (const auto name = e.as_text(); !is_in(known, name))
            builder_.note(e.place(), "extension " + shown_word(name) + ": is left out");
}

std::size_t document::count(const char* list) const
{
    const auto* v = tree_->root().find(list);
    return v == nullptr || v->kind != json_kind::array ? 0 : v->items.size();
}

part document::element(const char* list, std::size_t index) const
{
    const part p(*this, tree_->root().find(list)->items[index]);
    if (tree_->root().find(list)->items[index].kind != json_kind::object)
        p.fail("found " + p.described() + "; expected an object");
    return p;
}

std::string document::name_of(const char* kind, const char* list, std::size_t index) const
{
    const auto name = element(list, index).text("name");
    return kind + (name && !name->empty() ? " " + shown_word(*name) : " " + std::to_string(index));
}

void document::count_numbers(const part& p, std::size_t more)
{
    if (more > most_numbers_ - numbers_)
        p.fail("the accessors that are read have more numbers than a file of this size may have: 16 for each byte, and "
               "2^22; place a mesh several times by nodes");
    numbers_ += more;
}

const std::string& document::buffer(std::size_t index)
{
    if (const auto found = buffers_.find(index); found != buffers_.end())
        return found->second;
    const auto b = element("buffers", index);
    const auto length = b.whole("byteLength");
    if (!length)
        b.fail("the buffer has no \"byteLength\"");
    std::string bytes;
    if (const auto uri = b.text("uri")) {
        if (auto data = data_of(b.at("uri"), *uri))
            bytes = std::move(*data);
        else
            try {
                bytes = builder_.files().bytes_of(file_name(*uri));
            } catch (const file_error& e) {
                b.at("uri").fail(e.what());
            }
    } else if (index == 0 && chunk_.data() != nullptr) {
        bytes = chunk_;
    } else {
        b.fail("the buffer has no \"uri\"");
    }
    if (bytes.size() < *length)
        b.fail("the buffer has " + std::to_string(bytes.size()) + " of its " + std::to_string(*length) + " bytes");
    most_numbers_ += 16 * bytes.size();
    return buffers_.emplace(index, std::move(bytes)).first->second;
}

byte_range document::view(std::size_t index)
{
    const auto v = element("bufferViews", index);
    const auto b = v.index("buffer", "buffers");
    const auto length = v.whole("byteLength");
    if (!b || !length)
        v.fail("a view of a buffer has a \"buffer\" and a \"byteLength\"");
    const auto& bytes = buffer(*b);
    const auto offset = v.whole("byteOffset").value_or(0);
    if (offset > bytes.size() || *length > bytes.size() - offset)
        v.fail("the view reaches beyond the end of its buffer, which has " + std::to_string(bytes.size()) + " bytes");
    return {bytes.data() + offset, *length, v.whole("byteStride", 252).value_or(0)};
}

} // namespace photongrid::gltf
