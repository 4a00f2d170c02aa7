// Files that change while the window shows what they said, without a display.
#pragma once

#include "../scene/test_scenes.hpp"
#include "viewer/document.hpp"
#include "viewer/scene_thread.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

#include <unistd.h>

namespace photongrid::viewer {
namespace {

    class files_that_change : public ::testing::Test {
    protected:
        files_that_change() { std::filesystem::create_directories(folder); }
        ~files_that_change() override { std::filesystem::remove_all(folder); }
        std::string path(const std::string& name) const { return (folder / name).string(); }
        void write(const std::string& name, const std::string& content) const
        {
            // At once: a file that is being written may rest for two looks.
            std::ofstream(folder / "new", std::ios::binary) << content;
            std::filesystem::rename(folder / "new", folder / name);
        }
        std::filesystem::path folder
            = std::filesystem::temp_directory_path() / ("photongrid_changing_" + std::to_string(::getpid()));
    };

    using file_watching = files_that_change;

    TEST_F(file_watching, a_change_counts_once_it_rests)
    {
        write("a", "1");
        file_watch w({{path("a"), stamp_of(path("a"))}, {path("b"), stamp_of(path("b"))}});
        EXPECT_FALSE(w.look());
        write("a", "12");
        EXPECT_FALSE(w.look()) << "it may still be written";
        write("a", "123");
        EXPECT_FALSE(w.look());
        EXPECT_TRUE(w.look());
        EXPECT_TRUE(w.look()) << "nobody has read it yet";
        w.failed({{path("c"), stamp_of(path("c"))}});
        EXPECT_FALSE(w.look()) << "what could not be read is not read until it changes";
        EXPECT_FALSE(w.look());
        // The same size at another time; a file that comes; one that goes.
        const auto changes = [&](const char* what) {
            EXPECT_FALSE(w.look()) << what;
            EXPECT_TRUE(w.look()) << what;
            w.failed({});
        };
        namespace fs = std::filesystem;
        fs::last_write_time(folder / "a", fs::last_write_time(folder / "a") + std::chrono::milliseconds(50));
        changes("time");
        write("b", "");
        changes("one that was missing");
        write("c", "");
        changes("one that was missing, and named by a text that could not be read");
        fs::remove(folder / "a");
        changes("removed");
    }

    /// Scenes whose "file" is their name, and the name of a file that they name after a blank.
    class scenes_read : public files_that_change {
    protected:
        void begin(bool reloads = true)
        {
            const auto open = [this](const std::string& from, const file_listener& before_reading) {
                ++readings;
                std::ifstream in(from);
                opened_scene made{.path = from, .scene = testing::small_cornell()};
                made.scene.name.clear();
                std::string named;
                in >> made.scene.name >> named;
                if (!named.empty()) {
                    before_reading(path(named));
                    std::ifstream other(path(named));
                    made.scene.name.append(std::istreambuf_iterator<char>(other), {});
                    if (const auto happens = std::exchange(while_reading, nullptr))
                        happens();
                }
                if (made.scene.name.empty() || made.scene.name.find("bad") != std::string::npos)
                    throw std::runtime_error(from + ":1:1: error: bad");
                return made;
            };
            thread = std::make_unique<scene_thread>(
                open, [this] { ++wakes; }, reloads, std::chrono::milliseconds(1));
        }
        /// Waits for news; a minute at most.
        scene_news next()
        {
            const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
            while (std::chrono::steady_clock::now() < end) {
                if (auto news = thread->take())
                    return std::move(*news);
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
            ADD_FAILURE() << "nothing was read";
            return {};
        }
        /// Time for dozens of looks, after which nothing else has been read.
        void expect_no_more()
        {
            const int before = readings;
            std::this_thread::sleep_for(std::chrono::milliseconds(60));
            EXPECT_EQ(readings, before);
            EXPECT_FALSE(thread->take());
        }
        static std::string name_of(const scene_news& n) { return n.scene ? n.scene->scene.name : "error " + n.error; }

        std::function<void()> while_reading; ///< once, when a scene and the file that it names have been read
        std::atomic<int> readings = 0, wakes = 0;
        std::unique_ptr<scene_thread> thread; // last: it ends first
    };

    TEST_F(scenes_read, again_when_one_of_their_files_changes)
    {
        begin();
        write("one", "first mesh");
        write("mesh", "A");
        thread->open(path("one"));
        auto news = next();
        EXPECT_EQ(name_of(news), "firstA");
        EXPECT_FALSE(news.again);
        EXPECT_EQ(news.path, path("one"));
        ASSERT_TRUE(news.scene);
        EXPECT_EQ(news.scene->files.size(), 2u);
        write("mesh", "BB");
        expect_no_more(); // it is not the present scene yet
        thread->watch(*news.scene);
        news = next();
        EXPECT_EQ(name_of(news), "firstBB") << "it changed before it became the present one";
        EXPECT_TRUE(news.again);
        EXPECT_EQ(wakes, 2);
        expect_no_more();
        write("one", "second mesh");
        EXPECT_EQ(name_of(next()), "secondBB");

        // Text that cannot be read is read once; when its other file is mended, and when it is mended itself.
        write("other", "bad");
        write("one", "thirdscene other");
        EXPECT_EQ(name_of(next()), "error " + path("one") + ":1:1: error: bad");
        expect_no_more();
        write("other", "good");
        EXPECT_EQ(name_of(next()), "thirdscenegood");
        write("one", "bad");
        EXPECT_EQ(name_of(next()).substr(0, 6), "error ");
        std::filesystem::remove(folder / "one");
        EXPECT_EQ(name_of(next()).substr(0, 6), "error ");
        write("one", "fourth");
        EXPECT_EQ(name_of(next()), "fourth");
        write("other", "does not matter any more");
        expect_no_more();

        // Another one is opened, in vain: the present one stays that.
        write("two", "bad");
        thread->open(path("two"));
        EXPECT_EQ(name_of(next()), "error " + path("two") + ":1:1: error: bad");
        write("one", "fifth");
        EXPECT_EQ(name_of(next()), "fifth");
    }

    TEST_F(scenes_read, again_when_a_file_has_changed_meanwhile)
    {
        while_reading = [&] { write("mesh", "BB"); };
        begin();
        write("mesh", "A");
        write("one", "first mesh");
        thread->open(path("one"));
        const auto one = next();
        EXPECT_EQ(name_of(one), "firstA");
        thread->watch(*one.scene);
        EXPECT_EQ(name_of(next()), "firstBB");
    }

    TEST_F(scenes_read, news_of_the_scene_before_is_none)
    {
        begin();
        write("one", "first");
        write("two", "second");
        thread->open(path("one"));
        const auto one = next();
        thread->watch(*one.scene);
        thread->open(path("two"));
        const auto two = next();
        const int before = wakes;
        write("one", "first, changed");
        while (wakes == before)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        thread->watch(*two.scene);
        expect_no_more();
    }

    TEST_F(scenes_read, once_without_reloads)
    {
        begin(false);
        write("one", "first");
        thread->open(path("one"));
        const auto one = next();
        thread->watch(*one.scene);
        write("one", "changed");
        expect_no_more();
    }

    TEST(read_again, keeps_what_was_changed_in_the_window)
    {
        const auto s = testing::small_cornell();
        const version was{s, s.render, "serial"};
        auto now = was;
        now.backend = "cpu";
        now.settings.estimate.k = was.settings.estimate.k + 1;
        auto is = was;
        is.scene.spheres[0].radius *= 0.5;
        is.scene.camera.vertical_fov += 1;
        is.settings.estimate.k += 2;
        is.settings.map.photons += 100;
        is.settings.output.width += 16;
        auto expected = is;
        expected.backend = "cpu";
        expected.settings.estimate.k = now.settings.estimate.k;
        EXPECT_EQ(read_again(now, was, is), expected) << "a camera that nobody moved here is the file's";
        EXPECT_FALSE(moves_parts(now, was));
        now.scene.camera.position.x += 0.1;
        expected.scene.camera = now.scene.camera;
        EXPECT_EQ(read_again(now, was, is), expected);
        EXPECT_FALSE(moves_parts(now, was));
        move(now.scene, parts_of(now.scene).back(), {0.1, 0, 0});
        EXPECT_TRUE(moves_parts(now, was));
        EXPECT_EQ(read_again(now, was, is), expected) << "what was moved here goes back";
    }

} // namespace
} // namespace photongrid::viewer
