// The document of the window, and the thread that draws it, without a display.
#include "../backends/serial_picture.hpp"
#include "document_tests.hpp"
#include "scene_thread_tests.hpp"
#include "viewer/render_thread.hpp"

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <thread>

namespace photongrid::viewer {
namespace {

    /// A thread that draws, and its messages.
    class drawn : public ::testing::Test {
    protected:
        explicit drawn(renderer::milliseconds step_time = render_thread::usual_step_time)
            : thread(
                make_renderer, {.backend = "serial"}, [this] { notify(); },
                [this](const std::string& line) { notify(line); }, step_time)
        {
        }
        void notify(const std::string& line = {})
        {
            const std::lock_guard lock(guard);
            if (!line.empty())
                lines.push_back(line);
            ++news;
            came.notify_all();
        }
        /// Waits until `good` of the report; a minute at most.
        template <class Good>
        bool wait(Good good)
        {
            const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
            for (int known = -1;;) {
                {
                    std::unique_lock lock(guard);
                    if (!came.wait_until(lock, end, [&] { return news != known; }))
                        return false;
                    known = news;
                }
                if (good(thread.report()))
                    return true;
            }
        }
        /// Waits until the drawing has begun.
        bool begun_to_draw(std::uint64_t request)
        {
            const auto line = "\"event\": \"start\", \"request\": " + std::to_string(request) + ",";
            return wait([&](const render_report&) { return count(line) > 0; });
        }
        bool whole(std::uint64_t request)
        {
            return wait([=](const render_report& r) {
                return r.request == request && (r.progress.stage == "finished" || !r.error.empty());
            });
        }
        std::size_t count(const std::string& what)
        {
            const std::lock_guard lock(guard);
            return static_cast<std::size_t>(std::count_if(
                lines.begin(), lines.end(), [&](const std::string& l) { return l.find(what) != std::string::npos; }));
        }

        std::mutex guard;
        std::condition_variable came;
        std::vector<std::string> lines;
        int news = 0;
        render_thread thread; // last: its thread ends first
    };
    /// A step ends with the picture, unless it is cancelled.
    class drawn_without_time_limit : public drawn {
    protected:
        drawn_without_time_limit() : drawn(renderer::no_limit) {}
    };
    /// Every picture is shown.
    class drawn_step_by_step : public drawn {
    protected:
        drawn_step_by_step() : drawn(renderer::milliseconds(0)) {}
    };

    image rendered(const version& v) { return serial_picture(v.scene, v.settings); }

    TEST_F(drawn, ends_with_the_bytes_of_render)
    {
        auto v = begun(small_cornell());
        ASSERT_TRUE(whole(thread.show(v, false)));
        const auto first = thread.newer_than(0);
        ASSERT_TRUE(first);
        EXPECT_GE(first->number, 2u);
        EXPECT_EQ(first->picture.pixels, rendered(v).pixels);
        EXPECT_FALSE(thread.newer_than(first->number));
        const auto maps = thread.report().maps;

        v.scene.camera.position.x += 0.1;
        ASSERT_TRUE(whole(thread.show(v, false)));
        EXPECT_EQ(thread.newer_than(first->number)->picture.pixels, rendered(v).pixels);
        EXPECT_EQ(thread.report().maps, maps) << "a moving camera keeps the map";
        v.scene.rectangle_lights[0].corner.x += 0.1;
        ASSERT_TRUE(whole(thread.show(v, false)));
        EXPECT_EQ(thread.newer_than(first->number)->picture.pixels, rendered(v).pixels);
        EXPECT_GT(thread.report().maps, maps);
    }

    TEST_F(drawn, automatic_settings_stay_until_the_light_changes)
    {
        auto v = begun(small_cornell());
        v.settings.estimate.k = automatic_number;
        const auto chose = [&](bool moving) {
            EXPECT_TRUE(whole(thread.show(v, moving)));
            return thread.report().stats.pilot.has_value();
        };
        EXPECT_TRUE(chose(false));
        v.scene.camera.position.x += 0.1;
        EXPECT_FALSE(chose(false));
        v.scene.rectangle_lights[0].corner.x += 0.1;
        EXPECT_FALSE(chose(true)) << "the lamp is being moved";
        EXPECT_TRUE(chose(false)) << "it rests";
        v.settings.map.photons += 1;
        EXPECT_TRUE(chose(false));
        v.settings.estimate.k = 20;
        EXPECT_FALSE(chose(false));
    }

    /// A change waits for the rest of one step, not for the picture: at most the passes of the longest step, a sort of
    /// all photons (13 x 14 / 2 passes) or a batch of photon paths (a pass per surface, and its sums).
    TEST_F(drawn, a_change_waits_for_the_passes_of_one_step)
    {
        auto v = begun(small_cornell());
        v.settings.view.spp = 60000; // minutes, and a hundred thousand passes
        for (int i = 0; i < 8; ++i) {
            v.settings.seed = static_cast<std::uint32_t>(i);
            const auto request = thread.show(v, false);
            ASSERT_TRUE(wait([=](const render_report& r) { return r.request == request; })) << "it was not begun";
        }
        v.settings.view.spp = 1;
        ASSERT_TRUE(whole(thread.show(v, false)));
        EXPECT_EQ(thread.newer_than(0)->picture.pixels, rendered(v).pixels);
        EXPECT_GT(thread.report().passes, 100u) << "passes are the device's: a sort alone takes 91";
        const std::lock_guard lock(guard);
        int starts = 0, largest = 0;
        for (const auto& l : lines)
            if (const auto at = l.find("\"passes_waited\": "); at != std::string::npos) {
                ++starts;
                largest = std::max(largest, std::atoi(l.c_str() + at + 17));
            }
        EXPECT_EQ(starts, 9);
        EXPECT_LE(largest, 200);
    }

    /// A change cancels a step that would go on for seconds.
    TEST_F(drawn_without_time_limit, a_change_ends_the_step)
    {
        auto v = begun(small_cornell());
        v.settings.view.spp = 100;
        for (int i = 0; i < 4; ++i) {
            v.settings.seed = static_cast<std::uint32_t>(i);
            ASSERT_TRUE(begun_to_draw(thread.show(v, false)));
            ASSERT_EQ(count("\"whole\""), 0u) << "a picture was drawn to its end after a change";
        }
        v.settings.view.spp = 1;
        ASSERT_TRUE(whole(thread.show(v, false)));
        EXPECT_EQ(thread.newer_than(0)->picture.pixels, rendered(v).pixels);
        EXPECT_EQ(count("\"whole\""), 1u);
        EXPECT_EQ(count("\"waited_ms\": "), 5u);
    }

    /// The paper's running estimate (2.4, figure 8), on a backend whose own search shows it and on one whose does not.
    TEST_F(drawn_step_by_step, the_papers_search_is_shown_while_it_runs)
    {
        auto v = begun(small_cornell());
        v.settings = as_paper(v.settings);
        v.settings.output.width = v.settings.output.height = 24;
        for (const auto* backend : {"serial", "cpu"}) {
            v.backend = backend;
            const auto request = thread.show(v, false);
            ASSERT_TRUE(whole(request));
            if (thread.report().error.find("built without it") != std::string::npos)
                continue;
            ASSERT_EQ(thread.report().error, "");
            const auto shown = "\"event\": \"picture\", \"request\": " + std::to_string(request) + ",";
            const auto stage = [&](const std::string& name) {
                const std::lock_guard lock(guard);
                return std::count_if(lines.begin(), lines.end(), [&](const std::string& l) {
                    return l.find(shown) != std::string::npos
                        && l.find("\"stage\": \"" + name + "\"") != std::string::npos;
                });
            };
            EXPECT_EQ(stage("preview"), 0) << backend;
            EXPECT_GE(stage("radiance_estimate"), 3) << backend << " shows its only sample while it is searched for";
            EXPECT_EQ(stage("finished"), 1) << backend;
            EXPECT_EQ(thread.newer_than(0)->picture.pixels,
                render(*make_renderer({.backend = backend}), v.scene, v.settings).picture.pixels);
        }
    }

    TEST_F(drawn, while_things_move_every_request_that_is_begun_is_seen)
    {
        auto v = begun(small_cornell());
        std::uint64_t last = 0;
        for (int i = 0; i < 60; ++i) {
            v.scene.rectangle_lights[0].corner.x = 0.35 + 0.005 * i;
            last = thread.show(v, true);
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        ASSERT_TRUE(whole(last));
        EXPECT_EQ(thread.newer_than(0)->picture.pixels, rendered(v).pixels) << "what came last rests";
        // Each that was begun has had its first look, though the next one waited already.
        const std::lock_guard lock(guard);
        bool seen = true;
        for (const auto& l : lines) {
            if (l.find("\"start\"") != std::string::npos) {
                EXPECT_TRUE(seen) << "given up before it was seen; then " << l;
                seen = false;
            }
            seen = seen || l.find("\"picture\"") != std::string::npos;
        }
    }

    TEST_F(drawn, errors_are_reported_and_the_next_picture_is_drawn)
    {
        auto good = begun(small_cornell()), bad = good, none = good;
        bad.scene.spheres.push_back(bad.scene.spheres[1]); // two overlapping balls of glass
        none.backend = "abacus";
        for (const auto& [wrong, word] : {std::pair{bad, "overlaps"}, {none, "abacus"}}) {
            ASSERT_TRUE(whole(thread.show(wrong, false)));
            EXPECT_NE(thread.report().error.find(word), std::string::npos) << thread.report().error;
            ASSERT_TRUE(whole(thread.show(good, false)));
            EXPECT_EQ(thread.report().error, "");
            EXPECT_EQ(thread.newer_than(0)->picture.pixels, rendered(good).pixels);
        }
        EXPECT_EQ(count("\"error\""), 2u);
    }

} // namespace
} // namespace photongrid::viewer
