// The fixture of tests of the interactive loop.
#pragma once

#include "pictures.hpp"

#include <photongrid/render/render.hpp>

namespace photongrid::testing {

template <class Tag>
class progressive : public on_backend<Tag> {
protected:
    using B = typename Tag::type;
    using loop = progressive_render<B>;
    using ms = typename loop::milliseconds;

    static scene small_scene()
    {
        auto s = small_cornell();
        s.render.output.width = 48;
        s.render.output.height = 40;
        s.render.map.photons = 4000;
        return s;
    }
    image whole(const scene& s, const render_settings& settings) { return render(this->b(), s, settings).picture; }
    /// Draws to the end, step by step; every picture that was shown.
    static std::vector<image> pictures_of(loop& drawing)
    {
        std::vector<image> shown;
        for (std::uint64_t seen = 0; !drawing.finished();) {
            drawing.step(ms(0));
            if (drawing.pictures() > seen)
                shown.push_back(drawing.picture());
            seen = drawing.pictures();
        }
        return shown;
    }
    /// Passes of a kernel so far.
    std::uint64_t passes(const char* kernel)
    {
        const auto at = this->b().costs().find(kernel);
        return at == this->b().costs().end() ? std::uint64_t{0} : at->second.passes;
    }
};
TYPED_TEST_SUITE_P(progressive);

} // namespace photongrid::testing
