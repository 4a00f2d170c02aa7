// Work that can be interrupted between steps: a list of steps, some of which create further lists when they are
// reached.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Steps in the order in which they were added. A step does a bounded amount of work per call, and is called until it
/// returns true.
class step_list {
public:
    using step = std::function<bool()>;

    /// Adds a step. `stage` is its name for observers.
    void add(std::string_view stage, step run) { entries_.push_back({stage, std::move(run), {}, 0, 0}); }
    /// Adds the lists that `body` returns for first, first + 1, ..., past - 1. Each is created when it is reached.
    void repeat(std::uint32_t first, std::uint32_t past, std::function<step_list(std::uint32_t)> body)
    {
        entries_.push_back({{}, {}, std::move(body), first, past});
    }
    /// Adds the list that `body` returns. It is created when it is reached.
    void expand(std::function<step_list()> body)
    {
        repeat(0, 1, [body = std::move(body)](std::uint32_t) { return body(); });
    }

    /// Whether every step is done.
    bool finished() const { return at_ == entries_.size(); }
    /// The stage of the next step; empty if all are done or none was run yet.
    std::string_view stage() const
    {
        if (finished())
            return {};
        return inner_ ? inner_->stage() : entries_[at_].stage;
    }

    /// Runs the next step once.
    void advance()
    {
        settle();
        if (finished())
            return;
        if (inner_)
            inner_->advance();
        else if (entries_[at_].run())
            ++at_;
        settle();
    }

private:
    struct entry {
        std::string_view stage;
        step run;
        std::function<step_list(std::uint32_t)> body;
        std::uint32_t next, past; ///< arguments of body
    };

    /// Moves on to the next step with work to do, so that finished() is true as soon as the last step is done.
    void settle()
    {
        while (!finished()) {
            if (inner_) {
                inner_->settle();
                if (!inner_->finished())
                    return;
                inner_.reset();
            }
            auto& e = entries_[at_];
            if (e.run)
                return;
            if (e.next < e.past)
                inner_ = std::make_unique<step_list>(e.body(e.next++));
            else
                ++at_;
        }
    }

    std::vector<entry> entries_;
    std::size_t at_ = 0;
    std::unique_ptr<step_list> inner_; ///< the current list of entries_[at_]
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
