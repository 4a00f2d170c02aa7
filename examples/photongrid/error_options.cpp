#include "error_options.hpp"

#include "option_values.hpp"

#include <algorithm>
#include <string_view>

namespace photongrid {

namespace {
    /// NAME=PICTURE[,LEVEL] or NAME!=PICTURE[,LEVEL]. The second form is one that a shell leaves alone.
    region_source parsed_region(const std::string& text)
    {
        constexpr const char* expected = "NAME=PICTURE, NAME=PICTURE,LEVEL, or != for the pixels that are not bright";
        const auto equals = text.find('=');
        region_source region;
        if (equals != std::string::npos) {
            region.outside = equals > 0 && text[equals - 1] == '!';
            region.name = text.substr(0, region.outside ? equals - 1 : equals);
            region.path = text.substr(equals + 1);
        }
        if (const auto comma = region.path.rfind(','); comma != std::string::npos) {
            region.level = parsed_number("--region", region.path.substr(comma + 1), expected);
            region.path.resize(comma);
        }
        constexpr std::string_view allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
        if (region.level < 0 || region.name.empty() || region.path.empty()
            || region.name.find_first_not_of(allowed) != std::string::npos)
            throw CLI::ValidationError("--region",
                "\"" + text + "\" given; expected " + expected + ", with a name of letters, digits, _ and -");
        for (const auto* used : {"all", "edges", "surfaces", "dark", "middle", "bright"})
            if (region.name == used)
                throw CLI::ValidationError("--region",
                    "\"" + text + "\" given, but every picture has a region " + used + "; expected another name");
        return region;
    }

    void add_region(error_options& o, const std::string& text)
    {
        const auto region = parsed_region(text);
        if (std::any_of(o.regions.begin(), o.regions.end(), [&](const auto& r) { return r.name == region.name; }))
            throw CLI::ValidationError("--region", "\"" + region.name + "\" given twice; expected each name once");
        o.regions.push_back(region);
    }

    /// LOW,HIGH: two numbers above 0.
    glm::dvec2 parsed_range(const std::string& text)
    {
        constexpr const char* expected = "two numbers above 0, the second one larger: LOW,HIGH";
        const auto comma = text.find(',');
        glm::dvec2 range(parsed_number("--range", text.substr(0, comma), expected),
            parsed_number("--range", comma == std::string::npos ? "" : text.substr(comma + 1), expected));
        if (!(range.x > 0 && range.x < range.y))
            throw CLI::ValidationError("--range", "\"" + text + "\" given; expected " + expected);
        return range;
    }
} // namespace

void add_error(CLI::App& to, error_options& o)
{
    to.add_option("PICTURE", o.picture, "picture")->required()->type_name("PICTURE.exr|.pfm");
    to.add_option("REFERENCE", o.reference, "reference")->required()->type_name("REFERENCE.exr|.pfm");
    to.add_option("-o,--output", o.outputs,
          "PNG: the sheet of all pictures; EXR, PFM: (PICTURE - REFERENCE) / (REFERENCE + 0.01) of each channel, as "
          "numbers; may be given several times; default: the picture's name, -error.png")
        ->allow_extra_args(false)
        ->type_name("OUT.png|.exr|.pfm");
    to.add_option("--stats", o.stats, "statistics, as JSON")->type_name("OUT.json");
    to.add_option_function<std::vector<std::string>>(
          "--region",
          [&o](const std::vector<std::string>& texts) {
              for (const auto& text : texts)
                  add_region(o, text);
          },
          "also measure where a picture is bright, brighter than its mean luminance times LEVEL (default: 0.1): "
          "caustics=caustic.exr, made with --only caustic; NAME!=PICTURE: where it is not; may be given several times")
        ->allow_extra_args(false)
        ->type_name("NAME=PICTURE.exr|.pfm[,LEVEL]");
    to.add_option_function<std::string>(
          "--range", [&o](const std::string& text) { o.range = parsed_range(text); },
          "relative errors with the darkest and the lightest of the false colours; default: 0.001,1")
        ->type_name("LOW,HIGH");
    to.add_option("--average", o.average, "compare the means of blocks of N x N pixels, as `photongrid compare` does")
        ->type_name("N")
        ->check(CLI::Range(1, 1024).description(""));
    to.add_option_function<std::string>(
          "--pixels-per-degree",
          [&o](const std::string& text) {
              constexpr const char* expected = "a number from 1 to 1000";
              o.pixels_per_degree = parsed_number("--pixels-per-degree", text, expected);
              if (o.pixels_per_degree < 1 || o.pixels_per_degree > 1000)
                  throw CLI::ValidationError("--pixels-per-degree", "\"" + text + "\" given; expected " + expected);
          },
          "how many pixels a degree of the eye's field has, for FLIP: more with a finer screen or from farther away; "
          "default: 67, a screen 0.7 m wide of 3840 pixels from 0.7 m")
        ->type_name("N");
    add_exposure(
        to, o.exposure, "show pixel values times 2^EV, to the eye and to FLIP; default: auto, fitted to REFERENCE");
}

} // namespace photongrid
