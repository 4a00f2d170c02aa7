#include <photongrid/io/gltf/accessors.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>

namespace photongrid::gltf {

namespace {
    /// The types of components, by their numbers in a file.
    enum component : std::size_t {
        int8 = 5120,
        uint8 = 5121,
        int16 = 5122,
        uint16 = 5123,
        uint32 = 5125,
        float32 = 5126,
    };

    std::size_t size_of(const part& p, std::size_t type)
    {
        switch (type) {
        case int8:
        case uint8: return 1;
        case int16:
        case uint16: return 2;
        case uint32:
        case float32: return 4;
        default: p.fail("\"componentType\": found " + std::to_string(type) + "; expected 5120 to 5126 without 5124");
        }
    }

    std::size_t components_of(const part& p)
    {
        constexpr std::array<std::pair<std::string_view, std::size_t>, 7> types{
            {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};
        const auto type = p.text("type").value_or("");
        const auto* found = std::find_if(types.begin(), types.end(), [&](const auto& t) { return t.first == type; });
        if (found == types.end())
            p.fail("the \"type\" of an accessor must be SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4");
        return found->second;
    }

    template <class T>
    T read(const char* from)
    {
        T made;
        std::memcpy(&made, from, sizeof made); // the file's order is that of all machines that photongrid runs on
        return made;
    }

    /// A component as a number (glTF 2.0, 3.6.2.2).
    float as_float(const char* from, std::size_t type, bool normalized)
    {
        const auto scaled = [&](auto v) {
            using integer = decltype(v);
            const float f = static_cast<float>(v);
            return normalized ? std::max(f / static_cast<float>(std::numeric_limits<integer>::max()), -1.0f) : f;
        };
        switch (type) {
        case int8: return scaled(read<std::int8_t>(from));
        case uint8: return scaled(read<std::uint8_t>(from));
        case int16: return scaled(read<std::int16_t>(from));
        case uint16: return scaled(read<std::uint16_t>(from));
        case uint32: return scaled(read<std::uint32_t>(from));
        default: return read<float>(from);
        }
    }

    std::uint32_t as_whole(const char* from, std::size_t type)
    {
        return type == uint8 ? read<std::uint8_t>(from)
            : type == uint16 ? read<std::uint16_t>(from)
                             : read<std::uint32_t>(from);
    }

    /// Where the elements of an accessor lie.
    struct elements {
        part of;
        std::size_t count = 0, components = 0, type = 0, component_size = 0;
        bool normalized = false;
        byte_range bytes{}; ///< null: all are 0

        std::size_t element_size() const { return components * component_size; }
        std::size_t stride() const { return bytes.stride > 0 ? bytes.stride : element_size(); }
    };

    /// The bytes of `count` elements in a view.
    byte_range range_of(document& all, const part& p, std::size_t size, std::size_t count)
    {
        const auto view = p.index("bufferView", "bufferViews");
        if (!view)
            return {};
        auto bytes = all.view(*view);
        const auto offset = p.whole("byteOffset").value_or(0);
        const std::size_t stride = bytes.stride > 0 ? bytes.stride : size;
        if (stride < size)
            p.fail("the elements of the accessor overlap: the stride of its view is below their size");
        if (count > 0
            && (offset > bytes.size || size > bytes.size - offset
                || (count - 1) > (bytes.size - offset - size) / stride))
            p.fail("the accessor reaches beyond the end of its buffer view");
        bytes.data += count > 0 ? offset : 0;
        return bytes;
    }

    elements elements_of(document& all, std::size_t accessor, std::initializer_list<std::size_t> components)
    {
        elements e{.of = all.element("accessors", accessor)};
        const auto& p = e.of;
        const auto count = p.whole("count"), type = p.whole("componentType");
        if (!count || !type)
            p.fail("an accessor has a \"count\" and a \"componentType\"");
        e.count = *count;
        e.type = *type;
        e.component_size = size_of(p, e.type);
        e.components = components_of(p);
        if (std::find(components.begin(), components.end(), e.components) == components.end())
            p.fail("found an accessor of " + std::to_string(e.components) + " numbers for each element; expected "
                + std::to_string(*components.begin()));
        e.normalized = p.truth("normalized", false);
        if (e.count > std::numeric_limits<std::uint32_t>::max())
            p.fail("found an accessor of more than 2^32 - 1 elements");
        all.count_numbers(p, e.count * e.components);
        e.bytes = range_of(all, p, e.element_size(), e.count);
        return e;
    }

    /// Calls `put(element, component, bytes)` for all numbers that are given: those of the view, then the sparse ones.
    template <class Put>
    void for_each_number(document& all, const elements& e, Put put)
    {
        const auto element = [&](std::size_t n, const char* from) {
            for (std::size_t c = 0; c < e.components; ++c)
                put(n, c, from + c * e.component_size);
        };
        if (e.bytes.data != nullptr)
            for (std::size_t n = 0; n < e.count; ++n)
                element(n, e.bytes.data + n * e.stride());
        const auto sparse = e.of.object("sparse");
        if (!sparse)
            return;
        const auto count = sparse->whole("count");
        const auto at = sparse->object("indices"), values = sparse->object("values");
        if (!count || !at || !values)
            sparse->fail("a sparse accessor has a \"count\", \"indices\" and \"values\"");
        const auto type = at->whole("componentType").value_or(0);
        if (type != uint8 && type != uint16 && type != uint32)
            at->fail("the indices of a sparse accessor must be unsigned");
        const std::size_t size = size_of(*at, type);
        const auto indices = range_of(all, *at, size, *count),
                   numbers = range_of(all, *values, e.element_size(), *count);
        if (*count > 0 && (indices.data == nullptr || numbers.data == nullptr))
            sparse->fail("the indices and the values of a sparse accessor have a \"bufferView\"");
        for (std::size_t n = 0; n < *count; ++n) {
            const auto index = as_whole(indices.data + n * size, type);
            if (index >= e.count)
                at->fail("found the index " + std::to_string(index) + "; the accessor has " + std::to_string(e.count)
                    + " elements");
            element(index, numbers.data + n * e.element_size());
        }
    }

    template <class Vector>
    std::vector<Vector> vectors(document& all, std::size_t accessor, std::initializer_list<std::size_t> components,
        const Vector& absent = Vector(0.0f))
    {
        const auto e = elements_of(all, accessor, components);
        std::vector<Vector> made(e.count, absent);
        for_each_number(all, e, [&](std::size_t n, std::size_t c, const char* from) {
            made[n][static_cast<int>(c)] = as_float(from, e.type, e.normalized);
        });
        return made;
    }

    void require_unsigned(const elements& e)
    {
        if (e.type != uint8 && e.type != uint16 && e.type != uint32)
            e.of.fail("found signed numbers or floats; indices must be unsigned");
    }
} // namespace

std::vector<glm::vec2> pairs(document& all, std::size_t accessor) { return vectors<glm::vec2>(all, accessor, {2}); }

std::vector<glm::vec3> triples(document& all, std::size_t accessor) { return vectors<glm::vec3>(all, accessor, {3}); }

std::vector<glm::vec4> quadruples(document& all, std::size_t accessor)
{
    return vectors<glm::vec4>(all, accessor, {4, 3}, glm::vec4(0, 0, 0, 1));
}

std::vector<glm::mat4> matrices(document& all, std::size_t accessor)
{
    const auto e = elements_of(all, accessor, {16});
    std::vector<glm::mat4> made(e.count, glm::mat4(0.0f));
    for_each_number(all, e, [&](std::size_t n, std::size_t c, const char* from) {
        made[n][static_cast<int>(c / 4)][static_cast<int>(c % 4)] = as_float(from, e.type, e.normalized);
    });
    return made;
}

std::vector<std::uint32_t> indices(document& all, std::size_t accessor)
{
    const auto e = elements_of(all, accessor, {1});
    require_unsigned(e);
    std::vector<std::uint32_t> made(e.count, 0);
    for_each_number(all, e, [&](std::size_t n, std::size_t, const char* from) { made[n] = as_whole(from, e.type); });
    return made;
}

std::vector<glm::uvec4> joints(document& all, std::size_t accessor)
{
    const auto e = elements_of(all, accessor, {4});
    require_unsigned(e);
    std::vector<glm::uvec4> made(e.count, glm::uvec4(0));
    for_each_number(all, e,
        [&](std::size_t n, std::size_t c, const char* from) { made[n][static_cast<int>(c)] = as_whole(from, e.type); });
    return made;
}

} // namespace photongrid::gltf
