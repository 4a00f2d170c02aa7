// A scene on a device, prepared once for all passes of a picture, which share it.
#pragma once

#include <photongrid/render/stage_clock.hpp>
#include <photongrid/trace/device_scene.hpp>
#include <photongrid/trace/emission_guide.hpp>
#include <photongrid/trace/photon_request.hpp>
#include <photongrid/trace/render_observer.hpp>
#include <photongrid/trace/sky_guide.hpp>

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A scene on a device, and what passes learn of it.
template <backend B>
class world {
public:
    world(device_scene<B> uploaded, const stage_stats& time) : scene(std::move(uploaded)), prepared(time) {}

    const device_scene<B> scene; ///< recentred
    const stage_stats prepared;  ///< of preparing it

    /// The emission guide for `request` in a picture with settings `s`, if a pass has added it; else null.
    const emission_guide* guide(const render_settings& s, const photon_request& request) const
    {
        const auto at = guides_.find(key_of(s, request));
        return at != guides_.end() ? &at->second : nullptr;
    }
    void add_guide(const render_settings& s, const photon_request& request, emission_guide guide)
    {
        guides_[key_of(s, request)] = std::move(guide);
    }

    /// The guide to the sky for what a camera sees, in a picture of `aspect` (sky_guide.hpp); null if it needs none. It
    /// is there until another view asks for one.
    /// \throws backend_error.
    const buffer_of<B, glm::vec4>* sky_guide(B& device, const camera& view, double aspect)
    {
        if (sky_of_ != std::pair(view, aspect)) {
            const auto table = learn_sky(device, scene, view, aspect);
            sky_.reset();
            if (!table.empty())
                sky_ = device.upload(std::span<const glm::vec4>(table));
            sky_of_ = std::pair(view, aspect);
        }
        return sky_ ? &*sky_ : nullptr;
    }

private:
    /// For more photons there are more pilot paths: with the guide for others, a picture would depend on which map was
    /// built first, that of a preview or of the first radii, or that of a pass.
    using key = std::tuple<uint, uint, uint, uint>; // kinds, ends, number of photons, depth of paths
    static key key_of(const render_settings& s, const photon_request& r)
    {
        return {r.kinds, r.ends, r.photons, s.map.photon_depth};
    }

    std::map<key, emission_guide> guides_;
    std::optional<std::pair<camera, double>> sky_of_; // the view that sky_ is for
    std::optional<buffer_of<B, glm::vec4>> sky_;
};

/// Prepares a world in steps, between which it can be interrupted.
template <backend B>
class world_building {
public:
    /// It does nothing yet. `before`: the world of another scene, with which this one shares what is the same; may be
    /// null. `s` must outlive the first step, `device` the last.
    world_building(B& device, const scene& s, std::shared_ptr<const world<B>> before = {})
        : device_(device), before_(std::move(before)), upload_(device, s, before_ ? &before_->scene : nullptr)
    {
    }
    world_building(B&, const scene&&, std::shared_ptr<const world<B>> = {}) = delete; // it keeps a reference
    world_building(const world_building&) = delete;
    world_building& operator=(const world_building&) = delete;

    /// Takes a step; returns whether it was the last.
    /// \throws what upload_scene throws.
    bool advance()
    {
        detail::time_stage(device_, time_, [&] { upload_.advance(); });
        return upload_.finished();
    }
    double fraction() const { return upload_.fraction(); }

    /// The world, once it has finished.
    std::shared_ptr<world<B>> take() { return std::make_shared<world<B>>(upload_.take(), time_); }

private:
    B& device_;
    std::shared_ptr<const world<B>> before_;
    scene_upload<B> upload_;
    stage_stats time_;
};

/// Checks a scene, lays it out and uploads it.
/// \throws what upload_scene throws, render_cancelled.
/// \snippet snippets.cpp prepare
template <backend B>
std::shared_ptr<world<B>> prepare(B& device, const scene& s, const render_observer& observer = {})
{
    world_building<B> building(device, s);
    do {
        detail::stop_if_cancelled(observer);
        building.advance();
        if (observer.progress)
            observer.progress("prepare_scene", building.fraction());
    } while (building.fraction() < 1);
    return building.take();
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
