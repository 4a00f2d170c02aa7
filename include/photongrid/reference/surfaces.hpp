// What light meets at a hit, for the reference renderer: nothing where the surface is clear, one part of a mixture, and
// the values of textures.
#pragma once

#include <photongrid/reference/bsdf.hpp>
#include <photongrid/reference/random_stream.hpp>
#include <photongrid/reference/rebounds.hpp>
#include <photongrid/reference/texture.hpp>
#include <photongrid/trace/media.hpp>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// A material at a hit.
class met_material {
public:
    met_material(const material& m, std::uint32_t number, const hit& h, const facet_rebounds* rebounds)
        : number_(number), material_(&m), rebounds_(rebounds),
          reflectance_(m.reflectance * h.color * color_at(m.texture, h.coordinates))
    {
        if (m.roughness_texture.map) {
            own_ = m;
            own_->roughness *= number_at(m.roughness_texture, h.coordinates);
        }
    }

    /// Its index in scene::materials.
    std::uint32_t number() const { return number_; }
    /// Sets its index of refraction relative to what lies outside, if that is not air.
    void set_index(double index)
    {
        if (!own_)
            own_ = *material_;
        own_->index_of_refraction = index;
        rebounds_ = nullptr; // they are those of the material's own index
    }
    /// With its roughness here, but its colour without textures.
    const material& of() const { return own_ ? *own_ : *material_; }
    /// With textures and the colours of vertices.
    const dvec3& reflectance() const { return reflectance_; }

    /// The BSDF where it is rough, or of a rough coat: see rough_bsdf().
    dvec3 bsdf(const hit& h, const dvec3& d, const dvec3& towards) const
    {
        return rough_bsdf(is_rough(of()) ? rebounds_ : nullptr, of(), reflectance_, h, d, towards);
    }
    /// How a ray goes on where it has no base: see specular().
    specular_bounce bounce(const hit& h, const dvec3& d, random_stream& random) const
    {
        return is_rough(of()) && rebounds_ != nullptr ? rough(*rebounds_, of(), reflectance_, h, d, random)
                                                      : specular(of(), h, d, random);
    }
    /// The same for power from a light.
    specular_bounce bounce_of_light(const hit& h, const dvec3& d, random_stream& random) const
    {
        return is_rough(of()) ? bounce(h, d, random) : specular_of_light(of(), h, d, random);
    }

private:
    std::uint32_t number_;
    const material* material_;
    const facet_rebounds* rebounds_; ///< null: none
    std::optional<material> own_;
    dvec3 reflectance_;
};

/// The media that a path is in, one after the other of rising priority.
class path_media {
public:
    /// At the point where the path begins.
    path_media(const media_places& places, const dvec3& at) : media_(&places.media())
    {
        if (!media_->empty())
            for (std::uint32_t n = 0, inside = places.at(at); n < media_->size(); ++n)
                if ((inside >> n & 1u) != 0)
                    inside_.push_back(n);
    }

    /// The share of light that is left after t, m.
    dvec3 left_after(double t) const
    {
        return inside_.empty() ? dvec3(1) : glm::exp(-t * (*media_)[inside_.back()].absorption);
    }

    /// The path meets glass. Whether there is a surface; if so, sets its index of refraction. Else the path goes
    /// straight on, into other media.
    bool meets(met_material& met, bool from_outside)
    {
        met_ = number_of(met);
        if (met_ == media_->size() || !refracts(met.of()))
            return true;
        std::erase(inside_, met_);
        const auto& here = (*media_)[met_];
        const bool is_real = here.is_interface || inside_.empty() || inside_.back() < met_;
        if (is_real && !here.is_interface && !inside_.empty())
            met.set_index(here.index_of_refraction / (*media_)[inside_.back()].index_of_refraction);
        from_outside_ = from_outside;
        if (is_real != from_outside)
            enter(); // on the ray's side of a surface; past what is none
        return is_real;
    }

    /// The path is refracted by the surface that it has met.
    void pass(const met_material& met)
    {
        if (met_ == media_->size() || !refracts(met.of()))
            return;
        if (from_outside_)
            enter();
        else
            std::erase(inside_, met_);
    }

private:
    std::size_t number_of(const met_material& met) const
    {
        std::size_t n = 0;
        while (n < media_->size() && (*media_)[n].material != met.number())
            ++n;
        return n;
    }
    void enter() { inside_.insert(std::lower_bound(inside_.begin(), inside_.end(), met_), met_); }

    const std::vector<medium>* media_;
    std::vector<std::size_t> inside_;
    std::size_t met_ = 0; ///< the medium whose surface the path has met
    bool from_outside_ = false;
};

/// Whether light goes straight on through a pane.
inline bool goes_straight_on(const material& m, const specular_bounce& b)
{
    return is_thin(m) && !is_rough(m) && b.refracted;
}

/// The factor on light that a surface which is not matte reflects or refracts.
inline dvec3 tint(const met_material& met, const specular_bounce& b)
{
    const bool is_white = is_thin(met.of()) && !is_rough(met.of()) && !b.refracted;
    return is_white ? dvec3(1) : met.reflectance();
}

/// The surfaces of a scene.
class surfaces {
public:
    /// The arguments must outlive it.
    surfaces(const scene& s, const geometry& shapes)
        : materials_(s.materials), shapes_(shapes), media_(s, media_of(s)),
          any_clear_(std::any_of(s.materials.begin(), s.materials.end(),
              [](const material& m) { return is_clear(m) || is_smooth_pane(m); }))
    {
        std::map<std::tuple<double, double, bool>, std::shared_ptr<const facet_rebounds>> made;
        for (const auto& m : s.materials) {
            rebounds_.push_back(nullptr);
            if (!has_rebounds(m))
                continue;
            auto& one
                = made[{refracts(m) ? m.index_of_refraction : 0, m.roughness, m.roughness_texture.map != nullptr}];
            if (!one)
                one = std::make_shared<const facet_rebounds>(m);
            rebounds_.back() = one;
        }
    }

    /// The media at a point.
    path_media media_at(const dvec3& p) const { return {media_, p}; }

    /// Whether light passes the surface by chance.
    bool passes(const hit& h, random_stream& random) const
    {
        const auto& m = materials_[h.material];
        return is_clear(m) && random() >= opacity(m, h);
    }

    /// The material that light meets; of a mixture one of its parts by chance.
    met_material met(const hit& h, random_stream& random) const
    {
        const auto& m = materials_[h.material];
        if (!is_mixture(m))
            return {m, h.material, h, rebounds_[h.material].get()};
        const auto number = m.parts[random() < m.share * number_at(m.share_texture, h.coordinates) ? 1 : 0];
        return {materials_[number], number, h, rebounds_[number].get()};
    }

    /// The first part that stores photons, or null.
    const material* base(const hit& h) const
    {
        for (const auto* part : parts_of(materials_, materials_[h.material]))
            if (is_diffuse(*part))
                return part;
        return nullptr;
    }

    /// The share of light that shapes other than `target` let pass up to `far`, m.
    dvec3 share_through(ray r, double far, std::uint32_t target) const
    {
        if (!any_clear_)
            return dvec3(shapes_.blocked(r, far, target) ? 0 : 1);
        dvec3 share(1);
        while (share != dvec3(0)) {
            const hit h = shapes_.nearest(r);
            if (!(h.t < far) || h.shape == target)
                return share;
            share *= h.light != nothing ? dvec3(0) : light_past(h, r.direction);
            r = {h.position, r.direction, h.shape};
            far -= h.t;
        }
        return dvec3(0);
    }

private:
    /// The share of light of direction d that goes straight on at a hit.
    dvec3 light_past(const hit& h, const dvec3& d) const
    {
        const auto& m = materials_[h.material];
        const double opacity_here = opacity(m, h),
                     second = is_mixture(m) ? m.share * number_at(m.share_texture, h.coordinates) : 1;
        const auto straight = [&](std::uint32_t number) {
            const met_material met(materials_[number], number, h, nullptr);
            if (!is_thin(met.of()) || is_rough(met.of()))
                return dvec3(0);
            return met.reflectance() * (1 - pane_reflectance(met.of(), -glm::dot(facing_normals(h, d).shading, d)));
        };
        dvec3 panes = second * straight(is_mixture(m) ? m.parts[1] : h.material);
        if (is_mixture(m))
            panes += (1 - second) * straight(m.parts[0]);
        return 1 - opacity_here + opacity_here * panes;
    }

    static double opacity(const material& m, const hit& h)
    {
        return m.opacity * number_at(m.opacity_texture, h.coordinates);
    }

    const std::vector<material>& materials_;
    const geometry& shapes_;
    media_places media_;
    bool any_clear_;
    std::vector<std::shared_ptr<const facet_rebounds>> rebounds_; ///< by material; null: none
};

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
