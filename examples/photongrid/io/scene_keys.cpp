#include <photongrid/io/scene_keys.hpp>
#include <photongrid/scene/scene.hpp>

#include <iterator>
#include <type_traits>

namespace photongrid {

namespace {
    constexpr bool must = true, may = false;
    constexpr scene_key scene_keys[] = {{"$schema", may}, {"photongrid", must}, {"name", may}, {"units", must},
        {"camera", must}, {"materials", must}, {"shapes", must}, {"lights", must}, {"render", may}, {"as_paper", may}};
    constexpr scene_key units_keys[] = {{"length", must}, {"power", must}};
    constexpr scene_key camera_keys[] = {{"position", must}, {"look_at", must}, {"up", may}, {"vertical_fov", must}};
    /// Of meshes, as shapes and as lights.
    constexpr scene_key surface_keys[]
        = {{"file", may}, {"positions", may}, {"triangles", may}, {"normals", may}, {"texture_coordinates", may},
            {"colors", may}, {"scale", may}, {"rotate", may}, {"translate", may}, {"matrix", may}};
    /// Of environments, but for their fields.
    constexpr scene_key environment_keys[] = {{"file", may}, {"rotate", may}};
    constexpr scene_key texture_keys[] = {{"file", must}, {"wrap", may}, {"scale", may}, {"offset", may}};
    /// Of a texture that is a number.
    constexpr scene_key number_texture_keys[]
        = {{"file", must}, {"channel", may}, {"wrap", may}, {"scale", may}, {"offset", may}};
    constexpr scene_key rotate_keys[] = {{"axis", must}, {"degrees", must}};
    constexpr scene_key leaks_keys[] = {{"side", may}, {"min_cosine", may}, {"flattening", may}};
    // The keys of materials, shapes and lights come from the tables in scene/ (material_kinds, shape_kind, light_kind).
    template <class Kind>
    std::vector<scene_key> keys_of(Kind kind, std::vector<scene_key> before, std::vector<scene_key> after)
    {
        for_each_field(kind.fields, [&](const auto& f) { before.push_back({f.name, must}); });
        before.insert(before.end(), after.begin(), after.end());
        return before;
    }

    /// The keys of each kind of material, of shape, or of light, by the name of the kind.
    struct kind_keys {
        const char* name;
        std::vector<scene_key> keys;
    };
    const std::vector<kind_keys>& material_keys()
    {
        static const auto all = [] {
            std::vector<kind_keys> kinds;
            for (const auto& m : material_kinds) {
                kinds.push_back({m.name, {{"type", must}}});
                for (const auto& f : m.fields) {
                    kinds.back().keys.push_back({f.key, f.if_absent ? may : must});
                    if (f.texture != nullptr)
                        kinds.back().keys.push_back({detail::texture_key(f.texture), may});
                }
                if (has_energy(m))
                    kinds.back().keys.push_back({"energy", may});
                if (m.surface == surface_kind::mixed)
                    kinds.back().keys.push_back({"materials", must});
                else
                    kinds.back().keys.push_back({"texture", may});
            }
            return kinds;
        }();
        return all;
    }
    const std::vector<kind_keys>& shape_keys()
    {
        static const auto all = [] {
            std::vector<kind_keys> kinds;
            const scene none;
            for_each_shape(none, [&](const auto& list, auto kind) {
                const auto keys = keys_of(kind, {{"type", must}}, {{"material", must}});
                if constexpr (std::is_same_v<std::decay_t<decltype(list)>, std::vector<polygon>>)
                    kinds.push_back({triangle_name, keys});
                kinds.push_back({kind.name, keys});
            });
            std::vector<scene_key> of_meshes{{"type", must}, {"material", must}};
            of_meshes.insert(of_meshes.end(), std::begin(surface_keys), std::end(surface_keys));
            kinds.push_back({shape_kind<placed_mesh>::name, of_meshes});
            return kinds;
        }();
        return all;
    }
    const std::vector<kind_keys>& light_keys()
    {
        static const auto all = [] {
            std::vector<kind_keys> kinds;
            const scene none;
            for_each_light(none, [&](const auto& list, auto kind) {
                auto keys = keys_of(kind, {{"type", must}, {"name", may}}, {});
                if constexpr (std::is_same_v<std::decay_t<decltype(list)>, std::vector<mesh_light>>)
                    keys.insert(keys.end(), std::begin(surface_keys), std::end(surface_keys));
                if constexpr (std::is_same_v<std::decay_t<decltype(list)>, std::vector<environment_light>>) {
                    for (auto& k : keys)
                        k.required = k.name == std::string_view("type"); // a factor of 1 is the default
                    keys.insert(keys.end(), std::begin(environment_keys), std::end(environment_keys));
                }
                kinds.push_back({kind.name, keys});
            });
            return kinds;
        }();
        return all;
    }
    const std::vector<scene_key>& render_keys()
    {
        static const auto all = [] {
            std::vector<scene_key> keys;
            for_each_setting([&](const auto& row) {
                if (row.use != in_scenes::never)
                    keys.push_back({row.name, may});
            });
            return keys;
        }();
        return all;
    }
    std::vector<std::string> names_of(const std::vector<kind_keys>& kinds)
    {
        std::vector<std::string> names;
        names.reserve(kinds.size());
        for (const auto& k : kinds)
            names.emplace_back(k.name);
        return names;
    }
} // namespace

std::vector<std::string> material_names() { return names_of(material_keys()); }
std::vector<std::string> shape_names() { return names_of(shape_keys()); }
std::vector<std::string> light_names() { return names_of(light_keys()); }

std::span<const object_keys> known_objects()
{
    static const auto all = [] {
        std::vector<object_keys> objects{{"scene", scene_keys}, {"units", units_keys}, {"camera", camera_keys},
            {"render", render_keys()}, {"as_paper", render_keys()}, {"leaks", leaks_keys}, {"rotate", rotate_keys},
            {"texture", texture_keys}, {"number_texture", number_texture_keys}};
        for (const auto* kinds : {&material_keys(), &shape_keys(), &light_keys()})
            for (const auto& k : *kinds)
                objects.push_back({k.name, k.keys});
        return objects;
    }();
    return all;
}

} // namespace photongrid
