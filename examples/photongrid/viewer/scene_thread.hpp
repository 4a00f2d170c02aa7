// Reads the window's scenes in a thread of its own, so that the window goes on meanwhile.
#pragma once

#include "file_watch.hpp"

#include <photongrid/io/files.hpp>
#include <photongrid/scene/scene.hpp>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace photongrid::viewer {

/// A scene that was read from a file.
struct opened_scene {
    std::string path{};
    std::string text{}; ///< the file's, if it is in photongrid's own format, which can be saved with changes
    std::string stem{}; ///< files that the window saves are called STEM.png, STEM-2.png, …
    photongrid::scene scene{};
    render_settings settings{};
    std::size_t notes = 0; ///< how many things the scene has otherwise than its file
    file_stamps files{};   ///< all that were read for it, as they were before
};

/// Reads a scene; `before_reading` hears of the files that it names.
/// \throws std::exception for one that cannot be read.
using scene_opener = std::function<opened_scene(const std::string& path, const file_listener& before_reading)>;

/// Calls `open`, and notes in `files` what was read, which are some files too if it throws.
opened_scene open_noting_files(const scene_opener& open, const std::string& path, file_stamps& files);

/// What came of reading a scene.
struct scene_news {
    std::string path;
    bool again = false;                  ///< it is the present scene, one of whose files has changed
    std::optional<opened_scene> scene{}; ///< none: it cannot be read ...
    std::string error{};                 ///< ... for this reason
};

class scene_thread {
public:
    /// Time from look to look at the present scene's files.
    static constexpr std::chrono::milliseconds usual_period{500};

    /// `wake` is called in this object's thread when there is news. `reloads`: a scene whose files change is read
    /// again.
    scene_thread(
        scene_opener open, std::function<void()> wake, bool reloads, std::chrono::milliseconds period = usual_period);
    ~scene_thread();
    scene_thread(const scene_thread&) = delete;
    scene_thread& operator=(const scene_thread&) = delete;

    /// From now on this is the present scene.
    void watch(const opened_scene& present);
    /// Reads a scene. Of several that wait, the last is read.
    void open(const std::string& path);
    /// The oldest news not taken yet. Of several readings of the present scene only the last is news.
    std::optional<scene_news> take();

private:
    void work();
    void look(std::unique_lock<std::mutex>& lock);
    scene_news read(const std::string& path, file_stamps& files) const;
    void publish(scene_news news);

    const scene_opener open_;
    const std::function<void()> wake_;
    const bool reloads_;
    const std::chrono::milliseconds period_;

    std::mutex guard_;
    std::condition_variable changed_;
    bool ends_ = false;
    std::optional<std::string> asked_;
    std::deque<scene_news> news_;
    std::string present_;
    std::uint64_t number_ = 0; ///< of the present scene
    file_watch files_;         ///< the present scene's

    std::thread thread_;
};

} // namespace photongrid::viewer
