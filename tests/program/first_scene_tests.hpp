// The scenes of tests/first_scenes, small and in one pass: each is drawn, and shows something.
#pragma once

#include "program_under_test.hpp"

namespace photongrid {
namespace {

    /// The share of pixels of a PNG that are black, and of those that are white, and how many values its channels have.
    struct looks {
        double black = 0, white = 0;
        std::size_t values = 0;

        explicit looks(const std::string& png)
        {
            const auto picture = read_channels(png);
            std::vector<bool> seen(256);
            const auto pixels = static_cast<double>(picture.pixels.size());
            for (const auto& p : picture.pixels) {
                long least = 255, most = 0;
                for (int c = 0; c < 3; ++c) {
                    const long v = std::lround(p[c] * 255);
                    least = std::min(least, v);
                    most = std::max(most, v);
                    seen[static_cast<std::size_t>(v)] = true;
                }
                black += most < 5 ? 1 / pixels : 0;
                white += least > 250 ? 1 / pixels : 0;
            }
            values = static_cast<std::size_t>(std::count(seen.begin(), seen.end(), true));
        }
    };

    TEST_F(program, draws_first_scenes)
    {
        std::size_t drawn = 0;
        for (const auto& file : fs::directory_iterator(PHOTONGRID_FIRST_SCENES)) {
            const auto ending = file.path().extension();
            if (!file.is_regular_file() || ending == ".mtl" || ending == ".png" || ending == ".py" || ending == ".sh"
                || ending == ".md" || ending == "")
                continue;
            const auto e = run({"render", file.path().string(), "--backend", "cpu", "--size", "48x48", "--passes", "1",
                "--photons", "20000", "--quiet", "-o", "first.png"});
            ASSERT_EQ(e.code, 0) << file.path() << '\n' << e.err;
            const looks l((folder / "first.png").string());
            EXPECT_LT(l.black, 0.9) << file.path();
            EXPECT_LT(l.white, 0.25) << file.path();
            EXPECT_GT(l.values, 3u) << file.path() << " shows nothing";
            ++drawn;
        }
        EXPECT_GE(drawn, 30u);
        const auto points = run({"render", PHOTONGRID_FIRST_SCENES "/no_faces/scan_points.ply", "-o", "first.png"});
        EXPECT_EQ(points.code, 3);
        EXPECT_NE(points.err.find("a cloud of points has no surface"), std::string::npos) << points.err;
    }

} // namespace
} // namespace photongrid
