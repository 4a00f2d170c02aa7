// The running estimate as files: numbered pictures in a folder with a table of their errors, and a strip of some of
// them.
#pragma once

#include <photongrid/io/image_file.hpp>

#include <chrono>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

namespace photongrid {

/// A part of a picture, in pixels from its top left.
struct crop {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
};

/// Which files record the running estimate. Empty members are off.
struct series_options {
    std::string folder;             ///< for numbered pictures and the table
    std::string stem;               ///< of the files' names
    std::string strip;              ///< a picture of several stages side by side, as the paper's figure 8
    std::optional<crop> strip_crop; ///< of each picture; empty: the whole picture
    std::string reference;          ///< a picture to compute errors against
    glm::uvec2 size{0};             ///< of all pictures
    std::optional<double> exposure; ///< EV; none: fitted to each picture
    double every_ms = 0; ///< between pictures; 0: every picture, but at least a tenth of the elapsed time apart
};

/// Writes pictures STEM-0001.png, STEM-0002.png … as they are made and, at the end, STEM.csv with a line for each: its
/// file, its time in ms since the series began without the time for writing, its relMSE and structural similarity to
/// the last picture, and to the reference.
class picture_series {
public:
    /// \throws file_error when the folder cannot be made or the reference cannot be read, std::invalid_argument when the
    ///         reference has another size or the crop is not inside the picture.
    explicit picture_series(series_options o);

    bool enabled() const { return !options_.folder.empty() || !options_.strip.empty(); }
    /// Whether it is time for another picture.
    bool due() const;
    void add(const image& picture);
    /// Adds the last picture, and writes table and strip.
    /// \throws file_error.
    void finish(const image& picture);

    /// Times of the stages in the strip, ms.
    const std::vector<double>& strip_times() const { return strip_times_; }

private:
    using clock = std::chrono::steady_clock;
    struct step {
        image picture;
        double ms;
    };
    double elapsed_ms() const
    {
        return std::chrono::duration<double, std::milli>(clock::now() - start_).count() - spent_ms_;
    }
    std::string path(std::size_t number) const;
    void write_table() const;
    void write_strip();

    series_options options_;
    std::optional<image> reference_;
    clock::time_point start_ = clock::now();
    std::vector<step> steps_;
    double spent_ms_ = 0;
    std::vector<double> strip_times_;
};

} // namespace photongrid
