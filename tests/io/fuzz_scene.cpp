// libFuzzer's target: any bytes, read as a scene. Built by clang with the preset "fuzz"; docs/reference/measures.md has
// the command.
#include "scene_corpus.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const auto broken = photongrid::testing::broken_promise({reinterpret_cast<const char*>(data), size});
    if (!broken.empty()) {
        std::fprintf(stderr, "fuzz_scene: %s\n", broken.c_str());
        std::abort(); // libFuzzer keeps the input
    }
    return 0;
}
