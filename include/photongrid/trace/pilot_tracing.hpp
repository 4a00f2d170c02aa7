// Pilot paths, from which an emission guide is made (emission_guide.hpp). They store nothing: only whether each path
// would store a photon is read back.
#pragma once

#include <photongrid/core/random.kernel.hpp>
#include <photongrid/trace/emission_guide.hpp>
#include <photongrid/trace/photon_frames.hpp>
#include <photongrid/trace/photon_request.hpp>
#include <photongrid/trace/tally_path.kernel.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Whether emission for `request` is to be guided.
inline bool is_guided(const render_settings& s, const photon_request& request)
{
    return s.map.emission == photon_emission::guided && request.photons > 0;
}

/// Traces pilot paths in batches. Their random numbers are the same for every seed of a picture, so that all of its
/// passes, wherever they are drawn, have the same guide and do not depend on each other.
template <backend B>
class pilot_tracing {
public:
    /// It traces nothing yet. `device` and `uploaded` must outlive it.
    pilot_tracing(
        B& device, const device_scene<B>& uploaded, const render_settings& settings, const photon_request& request);
    pilot_tracing(B&, const device_scene<B>&&, const render_settings&, const photon_request&) = delete;

    /// Traces one more batch of paths. Returns whether there are enough.
    /// \throws backend_error.
    bool advance();

    /// The guide, once there are enough paths. It has no boxes if it would not gain much.
    emission_guide guide() const;

private:
    bool is_done() const;
    /// Traces so many more paths at once.
    void trace(uint n);

    /// Whether there are enough paths is asked after so many, and whenever their number has doubled, so that the
    /// guide does not depend on the device's batches.
    static constexpr uint first_paths = 4096, most_paths = 1u << 16;
    /// So many useful paths are enough to tell where they are.
    static constexpr uint enough_useful = 4096;
    /// Emission is guided only if even emission needs so many times as many paths.
    static constexpr double least_gain = 1.25;

    B& device_;
    const device_scene<B>& scene_;
    render_settings settings_;
    photon_request request_;
    uint useful_ = 0;
    std::uint64_t stored_ = 0; // photons that paths would store
    std::vector<pilot_path> paths_;
};

// Defined outside the class: functions defined inside are implicitly inline, and `extern template` does not suppress
// them.

template <backend B>
pilot_tracing<B>::pilot_tracing(
    B& device, const device_scene<B>& uploaded, const render_settings& settings, const photon_request& request)
    : device_(device), scene_(uploaded), settings_(settings), request_(request)
{
    settings_.seed = 0x70696C6Fu;
}

template <backend B>
bool pilot_tracing<B>::is_done() const
{
    const auto n = static_cast<double>(paths_.size());
    // Where half of the paths are useful, a guide gains little.
    const bool gains_little = useful_ >= n / 2;
    // Pilot paths must not cost more than they save: at most a quarter of the paths of even emission.
    const bool are_many = 4 * stored_ >= request_.photons;
    return n >= most_paths || useful_ >= enough_useful || gains_little || are_many;
}

template <backend B>
bool pilot_tracing<B>::advance()
{
    const uint batch = detail::most_paths(device_.caps(), settings_.map.photon_depth);
    const auto enough = std::max(2 * static_cast<uint>(paths_.size()), uint{first_paths});
    while (paths_.size() < enough)
        trace(std::min(batch, enough - static_cast<uint>(paths_.size())));
    return is_done();
}

template <backend B>
void pilot_tracing<B>::trace(uint n)
{
    const auto first = static_cast<uint>(paths_.size());
    detail::photon_frames<B> frames(device_, std::size_t{n} * (settings_.map.photon_depth + 1));
    const uint traced
        = trace_batch(device_, scene_, frames, path_batch<B>{n, first, request_.ends, nullptr}, settings_);
    auto storable = device_.template make<uint>(n);
    path_tally<B> tally{device_.template make<glm::uvec4>(n), device_.template make<glm::uvec4>(n)};
    device_.template run<kernels::tally_path>(n, {.paths = n, .frames = traced, .kinds = request_.kinds},
        reads(frames.positions), writes(storable, tally.ends, tally.hits));
    const auto stored = device_.download(storable);
    paths_.reserve(std::size_t{first} + n);
    for (uint i = 0; i < n; ++i) {
        pilot_path path{{}, stored[i] > 0};
        // As trace/emission_numbers.glsl draws them.
        for (uint half = 0; half < 2; ++half) {
            const auto u = kernels::random4(glm::uvec4(first + i, 0u, half, settings_.seed));
            for (uint c = 0; c < 4; ++c)
                path.numbers[half * 4 + c] = u[static_cast<int>(c)];
        }
        useful_ += path.useful ? 1 : 0;
        stored_ += stored[i];
        paths_.push_back(path);
    }
}

template <backend B>
emission_guide pilot_tracing<B>::guide() const
{
    emission_guide even;
    even.has_none_useful = useful_ == 0;
    if (useful_ == 0 || useful_ >= paths_.size() / 2)
        return even;
    auto guide = guide_by(paths_);
    return guide.gain < least_gain ? even : guide;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
