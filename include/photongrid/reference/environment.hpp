// The environment's light for the reference renderer: exact in each texel, in double precision.
#pragma once

#include <photongrid/scene/distant_lights.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// Samples directions in proportion to radiance (sum of rgb), evenly over the solid angle of each texel.
class environment {
public:
    explicit environment(const environment_light& l)
        : map_(l.map ? l.map : std::make_shared<const environment_map>()), factor_(l.radiance),
          turned_(rotation_about(l.axis, l.degrees))
    {
        sums_.reserve(map_->radiance.size());
        for (std::size_t i = 0; i < map_->radiance.size(); ++i)
            sums_.push_back((sums_.empty() ? 0.0 : sums_.back()) + weight(i));
    }

    /// The radiance from all directions together, W/m^2.
    dvec3 irradiance_everywhere() const
    {
        dvec3 sum(0);
        for (std::size_t i = 0; i < map_->radiance.size(); ++i)
            sum += radiance(i) * solid_angle(i);
        return sum;
    }

    struct sample {
        dvec3 towards{0, 1, 0}; ///< unit
        dvec3 radiance{0};      ///< W/(m^2 sr)
        double density = 0;     ///< per sr
    };
    template <class Random>
    sample draw(Random& random) const
    {
        const double goal = random() * sums_.back();
        const auto found = std::upper_bound(sums_.begin(), sums_.end(), goal) - sums_.begin();
        const auto i = std::min(static_cast<std::size_t>(found), sums_.size() - 1);
        const auto row = static_cast<double>(i / map_->width), column = static_cast<double>(i % map_->width);
        const double z = std::lerp(cosine_at(row), cosine_at(row + 1), random()),
                     turn = 2 * std::numbers::pi * (column + random()) / map_->width, across = std::sqrt(1 - z * z);
        return {turned_ * dvec3(across * std::sin(turn), z, -across * std::cos(turn)), radiance(i),
            weight(i) / sums_.back() / solid_angle(i)};
    }

    /// What comes from direction `towards`, a unit vector, as draw() would return it.
    sample at(const dvec3& towards) const
    {
        const dvec3 d = glm::transpose(turned_) * towards;
        double turn = std::atan2(d.x, -d.z) / (2 * std::numbers::pi);
        turn -= std::floor(turn);
        const double down = std::acos(std::clamp(d.y, -1.0, 1.0)) / std::numbers::pi;
        const auto column = std::min(static_cast<std::size_t>(turn * map_->width), std::size_t{map_->width} - 1),
                   row = std::min(static_cast<std::size_t>(down * map_->height), std::size_t{map_->height} - 1);
        const auto i = row * map_->width + column;
        return {towards, radiance(i), weight(i) / sums_.back() / solid_angle(i)};
    }

private:
    dvec3 radiance(std::size_t i) const { return factor_ * dvec3(map_->radiance[i]); }
    double cosine_at(double row) const { return std::cos(std::numbers::pi * row / map_->height); }
    double solid_angle(std::size_t i) const
    {
        const auto row = static_cast<double>(i / map_->width);
        return 2 * std::numbers::pi / map_->width * (cosine_at(row) - cosine_at(row + 1));
    }
    double weight(std::size_t i) const
    {
        const dvec3 l = radiance(i);
        return (l.x + l.y + l.z) * solid_angle(i);
    }

    std::shared_ptr<const environment_map> map_;
    dvec3 factor_;
    glm::dmat3 turned_;
    std::vector<double> sums_; ///< of the weights up to each texel
};

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
