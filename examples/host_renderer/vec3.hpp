// Vectors, colours and random numbers of the host.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace host {

constexpr double pi = std::numbers::pi;

/// A point (m), a direction, or a colour (red, green, blue).
struct vec3 {
    double x = 0, y = 0, z = 0;
};

constexpr vec3 operator+(vec3 a, vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr vec3 operator-(vec3 a, vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr vec3 operator*(vec3 a, vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
constexpr vec3 operator*(double s, vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
constexpr vec3 operator-(vec3 a) { return {-a.x, -a.y, -a.z}; }

constexpr double dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr vec3 cross(vec3 a, vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double length(vec3 a) { return std::sqrt(dot(a, a)); }
inline vec3 normalized(vec3 a) { return (1 / length(a)) * a; }
inline double largest(vec3 a) { return std::fmax(a.x, std::fmax(a.y, a.z)); }

/// A stream of random numbers (splitmix64; Steele, Lea and Flood 2014). Each pixel's sample and each photon has its
/// own, so results do not depend on threads.
class random_stream {
public:
    random_stream(std::uint64_t seed, std::uint64_t element) : state_(seed * 0x9E3779B97F4A7C15u)
    {
        state_ = bits() + element * 0xD1342543DE82EF95u;
        state_ = bits();
    }

    /// Uniform in [0, 1).
    double next() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

private:
    std::uint64_t bits()
    {
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
        z = (z ^ z >> 27) * 0x94D049BB133111EBu;
        return z ^ z >> 31;
    }
    std::uint64_t state_;
};

/// A direction in the hemisphere of the unit vector `normal`, with density cosine / pi.
inline vec3 cosine_direction(vec3 normal, random_stream& random)
{
    const vec3 aside = normalized(cross(std::abs(normal.x) < 0.5 ? vec3{1, 0, 0} : vec3{0, 1, 0}, normal));
    const double radius2 = random.next(), angle = 2 * pi * random.next(), radius = std::sqrt(radius2);
    return radius * std::cos(angle) * aside + radius * std::sin(angle) * cross(normal, aside)
        + std::sqrt(1 - radius2) * normal;
}

} // namespace host
