// libFuzzer's target: any bytes, read as a scene of the format that --format=NAME names. Built by clang with the preset
// "fuzz"; tests/fuzz.sh runs it for each format.
#include "scene_corpus.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>

namespace {
std::optional<photongrid::scene_format> format;
}

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments)
{
    constexpr std::string_view option = "--format=";
    for (int i = 1; i < *count; ++i)
        for (const auto& f : photongrid::testing::corpus_formats)
            if ((*arguments)[i] == std::string(option) + f.name)
                format = f.format;
    if (!format) {
        std::fprintf(stderr, "fuzz_scene: expected --format= with a folder of tests/io/scene_corpus\n");
        std::exit(2);
    }
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const auto broken = photongrid::testing::broken_promise(*format, {reinterpret_cast<const char*>(data), size});
    if (!broken.empty()) {
        std::fprintf(stderr, "fuzz_scene: %s\n", broken.c_str());
        std::abort(); // libFuzzer keeps the input
    }
    return 0;
}
