// Keeps the photon map in use and builds the next one. A map is rebuilt only for another world, or if a setting that
// same_map() compares changes (figure 1).
#pragma once

#include <photongrid/render/scene_map.hpp>

#include <memory>
#include <optional>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// What a photon map depends on.
struct map_key {
    std::uint64_t world = 0;  ///< number of the world
    render_settings settings; ///< those of its pass; with fewer photons for a preview
    uint pass = 0;

    /// Whether a map of `other` would be the same.
    bool same(const map_key& other) const { return world == other.world && same_map(settings, other.settings); }
    /// Whether a map of `whole` differs only in having more photons.
    bool is_preview_of(const map_key& whole) const
    {
        auto with = settings;
        with.map.photons = whole.settings.map.photons;
        with.map.caustic_photons = whole.settings.map.caustic_photons;
        for (const bool of_caustics : {false, true})
            with.estimate.sought(of_caustics) = whole.settings.estimate.sought(of_caustics);
        return world == whole.world && settings.map.photons < whole.settings.map.photons
            && same_map(with, whole.settings);
    }
};

/// Keeps a map as long as it can be used, and builds another in steps.
template <backend B>
class map_keeper {
public:
    /// `device` must outlive it.
    explicit map_keeper(B& device, map_use use = map_use::light) : device_(device), use_(use) {}

    /// The map in use; there must be one.
    const built_map<B>& map() const { return *built_; }
    /// The inputs of the map in use.
    const map_key& source() const { return source_; }
    /// Whether the map in use is that of `wanted`.
    bool serves(const map_key& wanted) const { return built_ && source_.same(wanted); }
    /// Whether the map in use is that of `wanted` with fewer photons.
    bool serves_preview_of(const map_key& wanted) const { return built_ && source_.is_preview_of(wanted); }
    /// Whether the map of `wanted` is being built.
    bool is_making(const map_key& wanted) const { return making_ && making_source_.same(wanted); }
    /// The number of photons of the map being built, if one is.
    std::optional<uint> making_photons() const
    {
        return making_ ? std::optional(making_source_.settings.map.photons) : std::nullopt;
    }
    /// The fraction of that map's photons that have been traced.
    double fraction() const { return making_ ? making_->fraction() : 0.0; }
    /// How many maps were started.
    std::uint64_t begun() const { return begun_; }

    /// Takes a step to the map of `wanted` in its world, `of`. Returns whether that map is in use. Views of the one
    /// before must be gone.
    /// \throws what map_building throws.
    bool advance(const map_key& wanted, std::shared_ptr<world<B>> of)
    {
        if (serves(wanted))
            return true;
        if (!is_making(wanted)) {
            making_.reset();
            if (built_ && !source_.is_preview_of(wanted)) // a preview's map stays until the new one is complete
                built_.reset();
            making_source_ = wanted;
            making_.emplace(device_, std::move(of), making_source_.settings, use_);
            ++begun_;
        }
        making_->advance();
        if (!making_->finished())
            return false;
        built_.emplace(making_->take());
        source_ = std::move(making_source_);
        making_.reset();
        return true;
    }
    /// Discards both maps.
    void clear()
    {
        making_.reset();
        built_.reset();
    }

private:
    B& device_;
    map_use use_;
    std::optional<built_map<B>> built_;
    map_key source_; ///< of built_
    std::optional<map_building<B>> making_;
    map_key making_source_;
    std::uint64_t begun_ = 0;
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
