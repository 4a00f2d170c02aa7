// The records of a scene for kernels: one buffer of vec4, recentred so that single precision suffices far from the
// origin. trace/scene_layout.glsl describes its layout.
#pragma once

#include <photongrid/core/backend.hpp>
#include <photongrid/scene/scene.hpp>
#include <photongrid/trace/coat_layout.hpp>
#include <photongrid/trace/environment_layout.hpp>
#include <photongrid/trace/instance_tree.hpp>
#include <photongrid/trace/light_tree.hpp>
#include <photongrid/trace/material_layout.hpp>
#include <photongrid/trace/mesh_layout.hpp>
#include <photongrid/trace/moved_scene.hpp>
#include <photongrid/trace/rebound_layout.hpp>
#include <photongrid/trace/scene_layout.kernel.hpp>
#include <photongrid/trace/shape_tree.hpp>

#include <algorithm>
#include <limits>
#include <utility>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The features of a scene, as SWITCHes of the tracing kernels, which compile only the code that the scene needs. The
/// bits of shapes are those of shape_kind::number, those of materials material_entry::switches.
enum scene_feature : uint {
    has_spheres = 1u << shape_kind<sphere>::number,
    has_quadrics = 1u << detail::quadric_number, ///< cylinders, cones and others
    has_polygons = 1u << shape_kind<polygon>::number,
    has_mirrors = detail::entry_of(material_kind::mirror).switches,
    has_glass = detail::entry_of(material_kind::glass).switches,
    has_point_lights = 1u << light_kind<point_light>::number,
    has_area_lights = 1u << light_kind<rectangle_light>::number,
    has_meshes = 1u << 9,         ///< number 8 is that of boxes
    has_smooth_meshes = 1u << 10, ///< meshes with normals
    has_textures = 1u << 16,      ///< or colours of vertices
    has_rough = 1u << 17,         ///< a rough surface
    has_shape_tree = 1u << 18,    ///< of many shapes
    has_coats = 1u << 19,         ///< diffuse surfaces under a coat
    has_instances = 1u << 20,     ///< surfaces of triangles that stand in several places
    has_mixtures = detail::entry_of(material_kind::mixture).switches,
    has_clear = 1u << 22,         ///< surfaces through which some light goes straight on
    rebounds_on_rough = 1u << 23, ///< rough surfaces whose facets scatter light several times
    has_media = 1u << 25,         ///< glass that touches other glass, or absorbs (trace/media.hpp)
};

static_assert(
    [] {
        std::uint32_t taken = has_mirrors | has_glass | has_meshes | has_smooth_meshes | has_textures | has_rough
            | has_shape_tree | has_coats | has_instances | has_mixtures | has_clear | rebounds_on_rough | has_media;
        bool distinct = true;
        std::uint32_t before = kernels::SCENE_TABLES; // kinds of shapes with the same kernel code follow each other
        const auto take = [&](std::uint32_t number) {
            distinct = distinct && (number == before || (taken >> number & 1u) == 0);
            taken |= 1u << number;
            before = number;
        };
        for (const auto n : detail::shape_numbers(static_cast<decltype(shape_lists(std::declval<scene&>()))*>(nullptr)))
            take(n);
        for (const auto n : detail::light_numbers(static_cast<decltype(light_lists(std::declval<scene&>()))*>(nullptr)))
            take(n);
        return distinct;
    }(),
    "shape_kind::number, light_kind::number: is taken");
static_assert(static_cast<uint>(surface_kind::diffuse) == kernels::LAMBERTIAN_SURFACE
    && static_cast<uint>(surface_kind::reflecting) == kernels::MIRROR_SURFACE
    && static_cast<uint>(surface_kind::refracting) == kernels::GLASS_SURFACE
    && static_cast<uint>(surface_kind::coated) == kernels::COATED_SURFACE
    && static_cast<uint>(surface_kind::mixed) == kernels::MIXED_SURFACE
    && static_cast<uint>(surface_kind::thin) == kernels::THIN_SURFACE
    && detail::entry_of(material_kind::plastic).switches == (has_coats | has_mirrors)); // coats reflect, too

/// What the large parts of a layout are made from. A scene that was edited often has the same.
struct layout_sources {
    /// Meshes, relative to the scene's anchor, and what their layout takes from the rest of the scene.
    struct of_meshes {
        std::vector<placed_mesh> meshes;
        std::vector<mesh_light> lights;
        dvec3 center{0};
        uint features = 0;
        uint first_light = 0;
        double longest_edge = 0; ///< that is not split, m

        bool operator==(const of_meshes&) const = default;
    };
    of_meshes meshes;
    std::vector<std::shared_ptr<const texture>> textures; ///< in the order of their texels
    std::vector<environment_light> environments;
};

/// The records of a scene, and their layout.
struct scene_layout {
    std::vector<glm::vec4> records; ///< as trace/scene_layout.glsl describes them; positions are recentred
    uint features = 0;              ///< scene_feature bits of the shapes, materials and lights in use
    /// Whether light without size reaches rough surfaces by smooth ones: only photons find it there
    /// (render/rough_photons.hpp).
    bool needs_photons_on_rough = false;
    std::uint64_t steps_per_ray = 0; ///< bound on the loop iterations of a ray, its shaft included (shape_kind::steps)
    dvec3 center{0};                 ///< subtracted from every position, m
    bool is_matte = false;           ///< there is a Lambertian surface, which stores photons
    glm::vec3 low{0};                ///< m; box of the Lambertian surfaces, recentred; of all, if there is none
    glm::vec3 high{0};               ///< m; its other corner
    media_places media;              ///< not recentred
    mesh_layout meshes;
    environment_layout environment;
    layout_sources sources;
    /// \name Parts that an earlier layout has, and this one lacks
    /// @{
    bool shares_meshes = false, shares_texels = false, shares_environment = false;
    /// @}

    /// The records of a table's items; `number` is a shape_kind::number, kernels::MATERIAL_TABLE or
    /// kernels::LIGHT_TABLE.
    kernels::Table table(uint number) const { return kernels::table_of(records[number]); }
};

namespace detail {
    /// \throws std::invalid_argument for more records than single precision can number, as tables do.
    inline void require_numbered(std::size_t records)
    {
        require(records <= 1u << 24,
            "scene: takes " + std::to_string(records)
                + " records; at most 2^24 are possible. A vertex takes 2, so use fewer vertices");
    }

    /// The most iterations of the kernels' loops over a shape of this kind, per ray.
    template <class Kind, class Shape>
    std::uint64_t steps_of(Kind kind, const Shape& x)
    {
        if constexpr (requires { kind.steps(x); })
            return kind.steps(x);
        else
            return 2; // the shaft; the closest hit, or occlusion
    }

    /// How many records each of some items has.
    class record_lengths {
    public:
        explicit record_lengths(const record_writer& w) : w_(&w), end_(w.next()) {}
        /// An item has been written.
        void note_end()
        {
            const uint length = w_->next() - std::exchange(end_, w_->next());
            differ_ = differ_ || (length_ != 0 && length != length_);
            length_ = length;
        }
        /// The length of all; 0 if they differ.
        uint all() const { return differ_ ? 0 : length_; }

    private:
        const record_writer* w_;
        uint end_, length_ = 0;
        bool differ_ = false;
    };

    /// Lays a scene out. Each member function writes one part.
    class layout_writer {
    public:
        /// `s` and `media` must be relative to its anchor. `before`: sources of parts that need not be written; may be
        /// null.
        layout_writer(const scene& s, const media_places& media, const layout_sources* before)
            : s_(s), media_(media), before_(before), shared_(s)
        {
        }

        scene_layout write()
        {
            measure();
            record_writer w(out_.records, out_.center, extent_.is_even ? extent_.scale : 0);
            out_.records.resize(kernels::SCENE_TABLES, glm::vec4(0));
            out_.records[kernels::SCENE_SIZES] = offset_shares();
            write_materials(w);
            write_shapes(w);
            write_shape_tree(w);
            write_meshes();
            write_lights(w);
            for (const auto& r : out_.records)
                require(std::isfinite(r.x) && std::isfinite(r.y) && std::isfinite(r.z) && std::isfinite(r.w),
                    "scene: a size or a power is too large for single precision; use smaller values");
            require_numbered(out_.records.size());
            out_.needs_photons_on_rough = needs_photons_on_rough();
            return std::move(out_);
        }

    private:
        /// See SCENE_SIZES.
        glm::vec4 offset_shares() const
        {
            const double scale = extent_.scale, of_rough = of_rough_instances_;
            if (extent_.is_even) {
                const double any = std::max(round_size_ * 0x1p-19, scale * 0x1p-26);
                return glm::vec4(glm::dvec4(any, 0, any + of_rough, 0));
            }
            const double any = extent_.smallest.size * 0x1p-16;
            return glm::vec4(glm::dvec4(any, 0x1p-20, any + std::max(of_rough, rough_size_ * 0x1p-20), 0));
        }

        uint features_of(const material& m)
        {
            uint features = entry_of(m.kind).switches | (is_clear(m) ? has_clear : 0u);
            for (const auto* part : parts_of(s_.materials, m)) {
                const bool rough = is_rough(*part), specular = !is_diffuse(*part) || is_coated(*part);
                features |= entry_of(part->kind).switches | (rough ? has_rough : 0u)
                    | (is_smooth_pane(*part) ? has_clear : 0u) | (has_rebounds(*part) ? rebounds_on_rough : 0u);
                is_smooth_ = is_smooth_ || (specular && (!rough || part->roughness_texture.map));
            }
            return features;
        }
        /// Whether a light without size and a smooth surface that is specular are there, and a rough one.
        bool needs_photons_on_rough() const
        {
            bool without_size = false;
            for_each_light(s_, [&](const auto& list, auto kind) {
                without_size = without_size || (!list.empty() && kind.samples == light_samples::once);
            });
            return without_size && is_smooth_ && (out_.features & has_rough) != 0;
        }

        /// Computes the bounds, the centre and the features.
        void measure()
        {
            extent_ = extent_of(s_);
            bounds diffuse;
            for_each_shape(s_, [&](const auto& list, auto kind) {
                for (const auto& x : list) {
                    const auto& m = s_.materials[x.material];
                    if (is_diffuse(s_.materials, m))
                        kind.add_bounds(diffuse, x);
                    out_.features |= features_of(m);
                    round_size_ = std::max(round_size_, kind.round_size(x));
                    if ((features_of(m) & has_rough) != 0)
                        rough_size_ = std::max(rough_size_, kind.round_size(x));
                    out_.steps_per_ray += steps_of(kind, x);
                }
                out_.features |= list.empty() ? 0u : 1u << kind.number;
            });
            for (std::size_t i = 0; i < s_.meshes.size(); ++i) {
                const auto& m = s_.meshes[i];
                const auto& of = s_.materials[m.material];
                const bounds& box = extent_.meshes[i];
                if (is_diffuse(s_.materials, of))
                    diffuse.add(box);
                out_.features |= has_meshes | features_of(of);
                out_.features |= m.surface->normals.empty() ? 0u : has_smooth_meshes;
                out_.features |= shared_.holds(m) ? has_instances : 0u;
                if (shared_.holds(m) && (features_of(of) & has_rough) != 0)
                    of_rough_instances_
                        = std::max(of_rough_instances_, rounding_of_placing(m.linear, box.high - box.low));
                out_.features |= m.surface->colors.empty() && !has_texture(s_.materials, of) ? 0u : has_textures;
            }
            out_.features |= media_.media().empty() ? 0u : has_media;
            require(has_surfaces(s_), no_shape);
            out_.is_matte = !diffuse.empty();
            if (!out_.is_matte)
                diffuse = extent_.all; // of which nothing is seen
            for_each_light(s_, [&](const auto& list, auto kind) {
                for (const auto& l : list) {
                    if constexpr (requires { surface_of(l); }) {
                        const auto surface = surface_of(l);
                        const shape_kind<std::remove_cvref_t<decltype(surface)>> of;
                        out_.steps_per_ray += steps_of(of, surface);
                        round_size_ = std::max(round_size_, of.round_size(surface));
                    }
                }
                out_.features |= list.empty() ? 0u : kind.switches;
            });
            // Of loops over kinds, lights and faces, the corners of a lamp, and a last round of each loop: about 20.
            out_.steps_per_ray += 32;
            out_.center = extent_.center;
            out_.low = glm::vec3(diffuse.low - out_.center);
            out_.high = glm::vec3(diffuse.high - out_.center);
        }

        /// Writes a table of `count` items from record `first` on; `stride` is 0 if their lengths differ.
        void enter(uint number, uint first, std::size_t count, uint stride)
        {
            out_.records[number]
                = glm::vec4(static_cast<float>(first), static_cast<float>(count), static_cast<float>(stride), 0.0f);
        }

        void write_shapes(record_writer& w)
        {
            uint number = kernels::NO_SHAPE, first = 0;
            std::size_t count = 0;
            record_lengths lengths(w);
            for_each_shape(s_, [&](const auto& list, auto kind) {
                if (kind.number != number) {
                    number = kind.number;
                    first = w.next();
                    count = 0;
                    lengths = record_lengths(w);
                }
                for (const auto& x : list) {
                    place(kind, x, w.next());
                    kind.write(w, x);
                    lengths.note_end();
                }
                count += list.size() + write_surfaces_of_lights(w, kind, lengths);
                if (count > 0)
                    enter(number, first, count, lengths.all());
            });
        }

        /// Writes the surfaces of lights that are shapes of this kind. Returns how many there are.
        template <class Kind>
        std::size_t write_surfaces_of_lights(record_writer& w, Kind kind, record_lengths& lengths)
        {
            std::size_t light = 0, written = 0;
            for_each_light(s_, [&](const auto& list, auto) {
                for (const auto& l : list) {
                    ++light;
                    if constexpr (requires { kind.write(w, surface_of(l), light); }) {
                        const auto surface = surface_of(l);
                        place(kind, surface, w.next());
                        kind.write(w, surface, light);
                        lengths.note_end();
                        ++written;
                    }
                }
            });
            return written;
        }

        /// Remembers a shape whose records begin at `at`, for the tree. Its box has a margin, since polygons are a
        /// little larger than they are, and rays hit a little off the shape.
        template <class Kind, class Shape>
        void place(Kind kind, const Shape& x, uint at)
        {
            bounds b;
            kind.add_bounds(b, x);
            const dvec3 margin(extent_.scale * 0x1p-17);
            shapes_.push_back(
                {{glm::vec3(b.low - out_.center - margin), glm::vec3(b.high - out_.center + margin)}, kind.number, at});
        }

        /// The tree of all shapes, if there are many.
        void write_shape_tree(record_writer& w)
        {
            if (shapes_.size() <= most_shapes_without_tree)
                return;
            out_.features |= has_shape_tree;
            const std::size_t lamps = s_.rectangle_lights.size(); // the last shapes
            const bool apart = lamps_block_none(s_.rectangle_lights, extent_.scale * 0x1p-26);
            const auto nodes = build_shape_tree(shapes_, apart ? lamps : 0);
            out_.steps_per_ray += nodes.size();
            enter(kernels::SHAPE_TREE, w.next(), nodes.size(), 2);
            const std::size_t others = shapes_.size() - lamps; // after the root, a tree of these
            const std::size_t past = !apart || lamps == 0 ? nodes.size() : others == 0 ? 0 : 2 * others;
            out_.records[kernels::SHAPE_TREE].w = static_cast<float>(past);
            for (const auto& n : nodes) {
                w.put(dvec3(n.shape.box.low), n.is_leaf ? -1.0 - n.shape.kind : n.past);
                w.put(dvec3(n.shape.box.high), n.shape.at);
            }
        }

        /// Appends the triangles of mesh lights and of all meshes.
        void write_meshes()
        {
            std::size_t light = 0; // the number of the first mesh light
            bool before = true;
            for_each_light(s_, [&](const auto& list, auto kind) {
                before = before && !std::is_same_v<decltype(kind), light_kind<mesh_light>>;
                light += before ? list.size() : 0;
            });
            auto& from = out_.sources.meshes;
            from = {s_.meshes, s_.mesh_lights, out_.center, out_.features & (has_smooth_meshes | has_textures),
                static_cast<uint>(light),
                extent_.is_even ? std::numeric_limits<double>::infinity() : extent_.smallest.size * 0x1p12};
            out_.shares_meshes = before_ != nullptr && before_->meshes == from;
            if (out_.shares_meshes)
                return;
            mesh_writer w(out_.meshes, out_.center, (out_.features & has_smooth_meshes) != 0,
                (out_.features & has_textures) != 0, from.longest_edge);
            w.write_all(s_, shared_, from.first_light);
        }

        void write_materials(record_writer& w)
        {
            enter(kernels::MATERIAL_TABLE, w.next(), s_.materials.size(), kernels::MATERIAL_RECORDS);
            const auto textures = put_materials(w, s_.materials, media_.media());
            enter(kernels::TEXTURE_TABLE, w.next(), textures.size(), kernels::TEXTURE_RECORDS);
            out_.sources.textures = put_textures(w, textures);
            out_.shares_texels = before_ != nullptr && before_->textures == out_.sources.textures;
            if (!out_.shares_texels)
                out_.meshes.texels = texels_of(out_.sources.textures);
            write_coats(w, out_.records, s_.materials);
            write_rebounds(w, out_.records, s_.materials);
            enter(kernels::MEDIA_TABLE, w.next(), media_.media().size(), 1);
            for (const auto& m : media_.media())
                w.put(m.absorption, m.index_of_refraction);
        }

        /// Lights are chosen with probabilities proportional to their power.
        void write_lights(record_writer& w)
        {
            const bounds box = box_for_lights(s_);
            std::vector<dvec3> powers; // W
            double total = 0;
            for_each_light(s_, [&](const auto& list, auto kind) {
                for (const auto& l : list) {
                    powers.push_back(power_of(kind, l, box));
                    total += powers.back().x + powers.back().y + powers.back().z;
                }
            });
            double below = 0;
            light_context in{box};
            auto next = powers.begin();
            enter(kernels::LIGHT_TABLE, w.next(), powers.size(), 6);
            for_each_light(s_, [&](const auto& list, auto kind) {
                for (const auto& l : list) {
                    const dvec3& power = *next++;
                    const double weight = power.x + power.y + power.z;
                    below += weight;
                    w.put(dvec3(kind.number, weight / total, below / total), static_cast<int>(kind.samples));
                    kind.write_record(w, l, in);
                    bounds place;
                    kind.add_bounds(place, l);
                    w.put(power, place.empty() ? 0.0 : media_.at(0.5 * (place.low + place.high)));
                    if constexpr (requires { l.surface; })
                        in.first_triangle += l.surface.surface->triangles.size();
                }
            });
            out_.sources.environments = s_.environment_lights;
            out_.shares_environment = before_ != nullptr && before_->environments == s_.environment_lights;
            for (const auto& l : s_.environment_lights)
                if (!out_.shares_environment)
                    out_.environment = lay_out(l);
            write_light_tree(w);
        }

        /// The tree of all lights that have a place, if samples choose among them.
        void write_light_tree(record_writer& w)
        {
            const auto lights = out_.table(kernels::LIGHT_TABLE);
            std::vector<light_ball> balls;
            const glm::vec4* record = &out_.records[lights.first];
            for_each_light(s_, [&](const auto& list, auto kind) {
                for (const auto& l : list) {
                    if (lights.count > most_lights_sampled_each)
                        if (const auto ball = ball_around(kind, l, record))
                            balls.push_back(*ball);
                    record += lights.stride;
                }
            });
            const auto nodes = build_light_tree(balls);
            enter(kernels::LIGHT_TREE, w.next(), nodes.size(), 2);
            out_.records[kernels::LIGHT_TREE].w = static_cast<float>(balls.size());
            for (const auto& n : nodes) {
                w.put(n.ball.center, n.ball.radius);
                const double power = std::min(n.ball.power, 1e38); // of all together it may be too large for a float
                w.put(dvec3(power, static_cast<double>(n.left), static_cast<double>(n.right)), 0);
            }
        }

        const scene& s_;
        const media_places& media_;
        const layout_sources* before_;
        shared_surfaces shared_;
        scene_layout out_;
        std::vector<boxed_shape> shapes_;
        bool is_smooth_ = false; ///< a surface that reflects or refracts is smooth
        scene_extent extent_;
        double round_size_ = 0;         ///< the largest shape_kind::round_size, m
        double rough_size_ = 0;         ///< of rough shapes
        double of_rough_instances_ = 0; ///< what ray_offset adds for rough surfaces in several places, m
    };
} // namespace detail

/// Lays a scene out for kernels. `before`: the sources of another scene's layout, whose parts this one shares where
/// their sources are the same; null: none.
/// \throws std::invalid_argument as check(scene) does, if there is no shape, or if a size or a power does not
///         fit single precision.
inline scene_layout lay_out(const scene& original, const layout_sources* before = nullptr)
{
    check(original);
    // All coordinates are relative to a point of the scene, so that a scene that is moved by an exactly representable
    // vector has the same records, bit for bit.
    const dvec3 anchor = detail::anchor(original);
    scene s = detail::moved_back(original, anchor);
    const media_places media(s, media_of(s));
    part_walls(s, media.media());
    auto layout = detail::layout_writer(s, media, before).write();
    layout.center += anchor;
    layout.media = {original, media.media()};
    return layout;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
