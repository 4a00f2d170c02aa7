#include "scene_thread.hpp"

#include <utility>

namespace photongrid::viewer {

scene_thread::scene_thread(
    scene_opener open, std::function<void()> wake, bool reloads, std::chrono::milliseconds period)
    : open_(std::move(open)), wake_(std::move(wake)), reloads_(reloads), period_(period), thread_([this] { work(); })
{
}

scene_thread::~scene_thread()
{
    {
        const std::lock_guard lock(guard_);
        ends_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void scene_thread::watch(const opened_scene& present)
{
    const std::lock_guard lock(guard_);
    present_ = present.path;
    ++number_;
    files_ = file_watch(present.files);
    std::erase_if(news_, [](const scene_news& n) { return n.again; }); // of the scene before
}

void scene_thread::open(const std::string& path)
{
    {
        const std::lock_guard lock(guard_);
        asked_ = path;
    }
    changed_.notify_all();
}

std::optional<scene_news> scene_thread::take()
{
    const std::lock_guard lock(guard_);
    if (news_.empty())
        return std::nullopt;
    auto oldest = std::move(news_.front());
    news_.pop_front();
    return oldest;
}

void scene_thread::work()
{
    std::unique_lock lock(guard_);
    for (;;) {
        changed_.wait_for(lock, period_, [&] { return ends_ || asked_; });
        if (ends_)
            return;
        if (asked_) {
            const auto path = *std::exchange(asked_, std::nullopt);
            lock.unlock();
            file_stamps files;
            auto news = read(path, files);
            lock.lock();
            publish(std::move(news));
        } else if (reloads_ && number_ > 0) {
            look(lock);
        }
    }
}

/// Looks at the present scene's files, and reads it again if that is due.
void scene_thread::look(std::unique_lock<std::mutex>& lock)
{
    auto files = files_;
    const auto path = present_;
    const auto number = number_;
    lock.unlock(); // a slow disk does not stop the window
    std::optional<scene_news> news;
    if (files.look()) {
        file_stamps tried;
        news = read(path, tried);
        news->again = true;
        if (news->scene)
            files = file_watch(tried);
        else
            files.failed(tried);
    }
    lock.lock();
    if (number != number_) // another scene has come meanwhile
        return;
    files_ = std::move(files);
    if (news) {
        std::erase_if(news_, [](const scene_news& n) { return n.again; });
        publish(std::move(*news));
    }
}

scene_news scene_thread::read(const std::string& path, file_stamps& files) const
{
    scene_news news{.path = path};
    try {
        news.scene = open_noting_files(open_, path, files);
    } catch (const std::exception& e) {
        news.error = e.what();
    }
    return news;
}

void scene_thread::publish(scene_news news)
{
    news_.push_back(std::move(news));
    wake_();
}

} // namespace photongrid::viewer
