#include "render_thread.hpp"

#include <photongrid/compare/image_difference.hpp>
#include <photongrid/io/image_file.hpp>

#include <nlohmann/json.hpp>

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace photongrid::viewer {

namespace {
    using clock = std::chrono::steady_clock;
    double ms_since(clock::time_point t) { return std::chrono::duration<double, std::milli>(clock::now() - t).count(); }

    /// Gives this thread, and threads that the backend creates in it, a lower priority than the window's, so that the
    /// window reacts when every core renders.
    void give_way()
    {
        (void)::setpriority(
            PRIO_PROCESS, static_cast<id_t>(::syscall(SYS_gettid)), 5); // of one thread, on Linux; it may fail
    }
} // namespace

render_thread::render_thread(renderer_maker make, renderer_options options, std::function<void()> wake, journal log,
    renderer::milliseconds step_time)
    : make_(make), options_(std::move(options)), wake_(std::move(wake)), log_(std::move(log)), step_time_(step_time),
      thread_([this] { work(); })
{
}

render_thread::~render_thread()
{
    {
        const std::lock_guard lock(guard_);
        ends_ = true;
        if (cancellable_ != nullptr)
            cancellable_->cancel();
    }
    changed_.notify_all();
    thread_.join();
}

std::uint64_t render_thread::show(const version& v, bool moving)
{
    std::uint64_t number = 0;
    {
        const std::lock_guard lock(guard_);
        number = ++requests_;
        // Of several requests not yet taken, the last is drawn; one that has waited for a preview waits no longer.
        const bool waits = moving && (!requested_ || requested_->moving);
        requested_ = request{v, waits, number, passes_, clock::now()};
        if (!waits && cancellable_ != nullptr)
            cancellable_->cancel();
    }
    changed_.notify_all();
    return number;
}

std::optional<frame> render_thread::newer_than(std::uint64_t seen) const
{
    const std::lock_guard lock(guard_);
    if (newest_.number <= seen)
        return std::nullopt;
    return newest_;
}

render_report render_thread::report() const
{
    const std::lock_guard lock(guard_);
    return report_;
}

void render_thread::tell(const std::string& event, const std::string& more) const
{
    if (log_)
        log_("{\"ms\": " + std::to_string(ms_since(opened_)) + ", \"event\": \"" + event + "\"" + more + "}");
}

void render_thread::work()
{
    give_way();
    for (;;) {
        {
            std::unique_lock lock(guard_);
            changed_.wait(lock, [&] { return ends_ || requested_ || drawing_; });
            if (ends_)
                break;
        }
        try {
            if (take())
                draw();
        } catch (const std::exception& e) {
            fail(e.what());
        }
    }
    const std::lock_guard lock(guard_);
    cancellable_ = nullptr;
    renderer_.reset(); // in this thread: an OpenGL context belongs to it
}

/// Those of the current request. What was chosen stays while the camera moves, and while parts do.
render_settings render_thread::settings_to_draw() const
{
    const auto& now = current_.what;
    if (!chosen_for_)
        return now.settings;
    const auto& then = chosen_for_->what;
    const bool stays = then.settings == now.settings && then.backend == now.backend
        && (current_.moving || same_light_paths(then.scene, now.scene));
    return stays ? chosen_ : now.settings;
}

/// Starts the requested drawing once it is due. Returns whether there is something to draw.
bool render_thread::take()
{
    request next;
    {
        const std::lock_guard lock(guard_);
        if (!requested_ || (requested_->moving && drawing_ && seen_ == 0))
            return drawing_;
        next = std::move(*requested_);
        requested_.reset();
    }
    drawing_ = false;
    seen_ = 0;
    last_.reset();
    current_ = std::move(next);
    const auto passes_waited = passes_ - std::min<std::uint64_t>(passes_, current_.passes_before); // a new backend: 0
    if (!renderer_ || opened_backend_ != current_.what.backend) {
        {
            const std::lock_guard lock(guard_);
            cancellable_ = nullptr;
        }
        renderer_.reset();
        auto o = options_;
        o.backend = current_.what.backend;
        renderer_ = make_(o);
        opened_backend_ = o.backend;
        const std::lock_guard lock(guard_);
        cancellable_ = renderer_.get();
    }
    begun_ = clock::now();
    // Running estimates need the whole map; while things move, previews with fewer photons come sooner.
    renderer_->start(current_.what.scene, settings_to_draw(), {.running_estimates = !current_.moving});
    drawing_ = true;
    {
        const std::lock_guard lock(guard_);
        report_.error.clear();
        if (ends_ || (requested_ && !requested_->moving))
            renderer_->cancel(); // start() has undone what was asked for before it
    }
    tell("start",
        ", \"request\": " + std::to_string(current_.number) + ", \"passes_waited\": " + std::to_string(passes_waited)
            + ", \"waited_ms\": " + std::to_string(ms_since(current_.made))
            + ", \"moving\": " + (current_.moving ? "true" : "false"));
    return true;
}

void render_thread::draw()
{
    const bool whole = renderer_->step(step_time_);
    if (renderer_->stats().pilot && (!chosen_for_ || chosen_for_->number != current_.number)) {
        chosen_for_ = current_;
        chosen_ = renderer_->settings();
    }
    passes_ = total_cost(renderer_->costs()).passes;
    const bool news = renderer_->pictures() > seen_;
    if (news) {
        seen_ = renderer_->pictures();
        publish(ms_since(begun_));
    }
    drawing_ = !whole;
    {
        const std::lock_guard lock(guard_);
        report_.request = current_.number;
        report_.whole = whole;
        report_.progress = renderer_->progress();
        report_.stats = renderer_->stats();
        report_.maps = renderer_->maps();
        report_.passes = passes_;
        report_.backend = opened_backend_;
        report_.device = renderer_->caps().device;
    }
    if (whole)
        tell("whole",
            ", \"request\": " + std::to_string(current_.number) + ", \"maps\": " + std::to_string(renderer_->maps()));
    if (news || whole)
        wake_();
}

void render_thread::publish(double ms)
{
    frame f{.request = current_.number, .number = 0, .picture = renderer_->picture(), .ms = ms, .change = 0};
    if (last_)
        f.change = compare_images(*last_, f.picture).relmse;
    last_ = f.picture;
    tell("picture",
        ", \"request\": " + std::to_string(current_.number) + ", \"pictures\": " + std::to_string(seen_)
            + ", \"maps\": " + std::to_string(renderer_->maps()) + ", \"stage\": \""
            + std::string(renderer_->progress().stage)
            + "\", \"since_request_ms\": " + std::to_string(ms_since(current_.made)));
    const std::lock_guard lock(guard_);
    f.number = newest_.number + 1;
    newest_ = std::move(f);
}

void render_thread::fail(const std::string& what)
{
    drawing_ = false;
    tell("error", ", \"what\": " + nlohmann::json(what).dump());
    {
        const std::lock_guard lock(guard_);
        report_.request = current_.number;
        report_.error = what;
    }
    wake_();
}

} // namespace photongrid::viewer
