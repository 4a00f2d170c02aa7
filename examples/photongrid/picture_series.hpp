// The running estimate as files: numbered pictures in a folder, and how far each was from the last one when it came.
#pragma once

#include "image_file.hpp"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace photongrid {

/// Writes pictures STEM-0001.png, STEM-0002.png … as they come and, at the end, STEM.csv with a line for each: its file, when
/// it was there, in ms since the series began less what writing has taken, and its relMSE to the last picture.
class picture_series {
public:
    /// An empty folder: nothing is written. \throws file_error when the folder cannot be made.
    picture_series(std::string folder, std::string stem, double exposure)
        : folder_(std::move(folder))
        , stem_(std::move(stem))
        , exposure_(exposure)
    {
        if (folder_.empty())
            return;
        std::error_code error;
        std::filesystem::create_directories(folder_, error);
        if (error)
            throw file_error(folder_ + ": cannot be made: " + error.message());
        check_image_path(path(1));
        start_ = clock::now();
    }
    bool wanted() const { return !folder_.empty(); }

    void add(const image& picture)
    {
        if (folder_.empty())
            return;
        const auto begin = clock::now();
        steps_.push_back({picture, ms_between(start_, begin) - spent_ms_});
        write_image(path(steps_.size()), picture, exposure_);
        spent_ms_ += ms_between(begin, clock::now());
    }
    /// Adds the last picture, and writes the table.
    void finish(const image& picture)
    {
        if (folder_.empty())
            return;
        add(picture);
        std::string table = "picture,ms,relmse\n";
        for (std::size_t i = 0; i < steps_.size(); ++i) {
            char line[64];
            std::snprintf(line, sizeof line, ",%.3f,%.6g\n", steps_[i].ms, compare_images(steps_[i].picture, picture).relmse);
            table += std::filesystem::path(path(i + 1)).filename().string() + line;
        }
        write_file(folder_ + "/" + stem_ + ".csv", table);
    }

private:
    using clock = std::chrono::steady_clock;
    struct step {
        image picture;
        double ms;
    };
    static double ms_between(clock::time_point from, clock::time_point to) { return std::chrono::duration<double, std::milli>(to - from).count(); }
    std::string path(std::size_t number) const
    {
        char digits[24];
        std::snprintf(digits, sizeof digits, "-%04zu.png", number);
        return folder_ + "/" + stem_ + digits;
    }
    std::string folder_, stem_;
    double exposure_ = 0;
    clock::time_point start_;
    std::vector<step> steps_;
    double spent_ms_ = 0;
};

} // namespace photongrid
