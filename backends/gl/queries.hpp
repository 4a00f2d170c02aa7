// The queries of a backend: those that count the elements of a pass, and the two that time a verb.
#pragma once

#include <photongrid/backends/gl/device.hpp>

namespace photongrid::gl {

/// Queries, which are created when they are first needed.
class queries {
public:
    explicit queries(std::shared_ptr<device> d) : device_(std::move(d)) {}
    queries(const queries&) = delete;
    queries& operator=(const queries&) = delete;
    ~queries()
    {
        try {
            device_->make_current();
            device_->call.DeleteQueries(static_cast<GLsizei>(counters_.size()), counters_.data());
            device_->call.DeleteQueries(static_cast<GLsizei>(clock_.size()), clock_.data());
        } catch (const backend_error&) { // the caller's context was destroyed, and its queries
        }
    }

    /// Makes sure that there are n occlusion queries.
    void make(std::size_t n)
    {
        if (n <= counters_.size())
            return;
        const std::size_t old = counters_.size();
        counters_.resize(n);
        device_->call.CreateQueries(GL_SAMPLES_PASSED, static_cast<GLsizei>(n - old), counters_.data() + old);
    }
    GLuint operator[](std::size_t i) const { return counters_[i]; }
    /// Waits for the result.
    std::uint64_t result(GLuint query) const
    {
        GLuint64 n = 0;
        device_->call.GetQueryObjectui64v(query, GL_QUERY_RESULT, &n);
        return n;
    }

    void start_clock()
    {
        if (clock_[0] == 0)
            device_->call.CreateQueries(GL_TIMESTAMP, 2, clock_.data());
        device_->call.QueryCounter(clock_[0], GL_TIMESTAMP);
    }
    /// The device's milliseconds since start_clock(), for which it waits.
    double stop_clock()
    {
        device_->call.QueryCounter(clock_[1], GL_TIMESTAMP);
        const std::uint64_t start = result(clock_[0]), end = result(clock_[1]); // ns
        return 1e-6 * static_cast<double>(end - std::min(start, end));
    }

private:
    std::shared_ptr<device> device_;
    std::vector<GLuint> counters_;
    std::array<GLuint, 2> clock_{}; ///< timestamps of a verb's start and end
};

} // namespace photongrid::gl
