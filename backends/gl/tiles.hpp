// The passes of run_until_done over tiles (3.3): by conditional rendering, the device draws a tile only if the pass
// before had an unfinished element in it.
#pragma once

#include <photongrid/backends/gl/queries.hpp>
#include <photongrid/backends/gl/regions.hpp>

namespace photongrid::gl {

/// The tiles of a launch, with a set of queries for each of the last `together` passes.
class tiled_passes {
public:
    static constexpr uint together = 8; ///< passes per readback of the queries

    tiled_passes(device& on, queries& asked, const launch& l, uint tile)
        : on_(on), asked_(asked), tiles_(tiles_of(l, tile)), live_(tiles_.size(), 1)
    {
        asked_.make(together * (tiles_.size() + 1));
    }

    /// Draws the passes from `begin` to `end`, exclusive, at most `together`. Program, targets and textures are bound.
    void draw(uint begin, uint end)
    {
        functions& gl = on_.call;
        gl.Enablei(GL_SCISSOR_TEST, 0);
        for (uint pass = begin; pass < end; ++pass) {
            gl.TextureBarrier(); // states are read where the last pass wrote them
            for (std::size_t t = 0; t < tiles_.size(); ++t) {
                if (!live_[t])
                    continue;
                if (pass > begin)
                    gl.BeginConditionalRender(query(pass - 1, t), GL_QUERY_WAIT);
                gl.BeginQuery(GL_SAMPLES_PASSED, query(pass, t));
                gl.ScissorIndexed(0, tiles_[t].x, tiles_[t].y, tiles_[t].width, tiles_[t].height);
                gl.DrawArrays(GL_TRIANGLES, 0, 3);
                gl.EndQuery(GL_SAMPLES_PASSED);
                if (pass > begin)
                    gl.EndConditionalRender();
            }
        }
        gl.Disablei(GL_SCISSOR_TEST, 0);
    }

    /// Waits for these passes, and appends the number of unfinished elements that each one began with.
    void read(uint begin, uint end, std::vector<std::uint64_t>& unfinished)
    {
        for (uint pass = begin; pass < end; ++pass) {
            std::uint64_t active = 0;
            for (std::size_t t = 0; t < tiles_.size(); ++t)
                if (live_[t]) {
                    const std::uint64_t n = asked_.result(query(pass, t));
                    live_[t] = n != 0;
                    active += n;
                }
            unfinished.push_back(active);
        }
    }

    /// The last query of a pass's set, for the number of elements that are unfinished after it.
    GLuint rest(uint pass) const { return query(pass, tiles_.size()); }

private:
    GLuint query(uint pass, std::size_t tile) const { return asked_[pass % together * (tiles_.size() + 1) + tile]; }

    device& on_;
    queries& asked_;
    std::vector<region> tiles_;
    std::vector<char> live_;
};

} // namespace photongrid::gl
