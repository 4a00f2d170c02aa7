// The host's program. It selects whether to add caustics, but does not know how.
#include "caustics.hpp"

#include <png.h>

#include <algorithm>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <thread>

namespace {

/// Radiance to an 8-bit sRGB value; radiance 1 is white.
unsigned char tone_mapped(double radiance)
{
    const double v = std::clamp(radiance, 0.0, 1.0);
    return static_cast<unsigned char>(
        std::lround(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055)));
}

/// Throws std::runtime_error if the file cannot be written.
void write_png(const std::string& path, const std::vector<host::vec3>& picture, int size)
{
    std::vector<unsigned char> bytes;
    for (const auto& p : picture)
        for (const double channel : {p.x, p.y, p.z})
            bytes.push_back(tone_mapped(channel));
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = png.height = static_cast<png_uint_32>(size);
    png.format = PNG_FORMAT_RGB;
    if (!png_image_write_to_file(&png, path.c_str(), 0, bytes.data(), 0, nullptr))
        throw std::runtime_error(path + ": " + png.message);
}

/// A whole number from 1 to 100,000, or 0 for anything else.
int count_of(const std::string& text)
{
    const bool is_count
        = !text.empty() && text.size() <= 6 && text.find_first_not_of("0123456789") == std::string::npos;
    const int n = is_count ? std::stoi(text) : 0;
    return n <= 100000 ? n : 0;
}

} // namespace

int main(int argc, char** argv)
{
    std::vector<std::string> arguments(argv + 1, argv + argc);
    const auto take = [&](const char* option) { return std::erase(arguments, option) > 0; };
    const bool without_caustics = take("--without-caustics"), reference = take("--reference");
    host::render_settings settings;
    settings.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    settings.keeps_specks = reference;
    if (arguments.size() > 1)
        settings.size = count_of(arguments[1]);
    if (arguments.size() > 2)
        settings.samples = count_of(arguments[2]);
    if (arguments.empty() || arguments.size() > 3 || arguments[0].starts_with("-") || (without_caustics && reference)
        || settings.size < 1 || settings.samples < 1) {
        std::cerr << "usage: host_renderer [--without-caustics | --reference] FILE.png [SIZE [SAMPLES]]\n"
                     "  SIZE: pixels per side, 400; SAMPLES: paths per pixel, 64; whole numbers from 1 to 100000\n";
        return 2;
    }
    try {
        const auto scene = host::box_scene();
        const bool adds_caustics = !without_caustics && !reference;
        write_png(arguments[0],
            host::render(scene, settings, adds_caustics ? host::caustics_of(scene, 4000000, settings.seed) : nullptr),
            settings.size);
    } catch (const std::exception& e) {
        std::cerr << "host_renderer: " << e.what() << '\n';
        return 1;
    }
}
