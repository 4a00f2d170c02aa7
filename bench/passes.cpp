// How much the sorting network gains on GPUs' APIs by more steps in a pass, in place, and by two pairs to a texel,
// against the plain one, a step a pass: docs/reference/measures.md. Prints PASS or FAIL per row; exits 1 where one is
// too slow, 3 where the order differs.
#include "stopwatch.hpp"
#include "verbs.hpp"

#include <photongrid/backends/gl/overrides/bitonic_sort.hpp>
#include <photongrid/backends/vulkan/overrides/bitonic_sort.hpp>

#include <algorithm>
#include <cstdio>
#include <random>

namespace {

using namespace photongrid;
using bench::median;
using bench::seconds_of;
using pairs_type = std::vector<glm::uvec2>;

template <backend B>
struct version {
    std::string name;
    std::function<sort_report(B&, buffer_of<B, glm::uvec2>&)> sort;
    double wanted = 0; ///< times as fast as the first version; 0: nothing
    double wanted_of_second = 0;
    std::vector<double> ms{};
    uint passes = 0;
    bool right = true;
};

template <backend B>
int measure(B& b, const pairs_type& pairs, const pairs_type& expected, std::vector<version<B>> versions)
{
    for (int i = 0; i < 6;
         ++i) // in turn, so that a slow minute of the machine is everybody's; kernels compile in the first
        for (auto& v : versions) {
            auto buffer = b.upload(std::span<const glm::uvec2>(pairs));
            b.finish();
            const double ms = 1000 * seconds_of([&] {
                v.passes = v.sort(b, buffer).passes;
                b.finish();
            });
            if (i > 0)
                v.ms.push_back(ms);
            else
                v.right = b.download(buffer) == expected;
        }
    int worst = 0;
    const double plain = median(versions[0].ms), second = median(versions[1].ms);
    for (const auto& v : versions) {
        const double ms = median(v.ms);
        const bool good = plain / ms >= v.wanted && second / ms >= v.wanted_of_second;
        std::printf("| %s | %s | %u | %.0f | %.2f | %s | %s |\n", b.caps().backend.c_str(), v.name.c_str(), v.passes,
            ms, plain / ms, v.wanted > 0 ? std::to_string(v.wanted).substr(0, 3).c_str() : "",
            !v.right                                       ? "WRONG"
                : v.wanted <= 0 && v.wanted_of_second <= 0 ? ""
                : good                                     ? "PASS"
                                                           : "FAIL");
        worst = std::max(worst, !v.right ? 3 : good ? 0 : 1);
    }
    std::fflush(stdout);
    return worst;
}

int run_passes(std::size_t n)
{
    std::mt19937 engine(1);
    pairs_type pairs;
    for (std::size_t i = 0; i < n; ++i)
        pairs.emplace_back(static_cast<uint>(engine()) % 31250u, static_cast<uint>(i));
    auto expected = pairs;
    std::sort(expected.begin(), expected.end(),
        [](glm::uvec2 a, glm::uvec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    vulkan_backend vulkan;
    gl_backend gl;
    std::printf("%zu pairs; medians of five; %s; %s\n\n| backend | version | passes | ms | times the plain one's "
                "speed | wanted | |\n|---|---|---|---|---|---|---|\n",
        n, vulkan.caps().device.c_str(), gl.caps().device.c_str());
    std::vector<version<vulkan_backend>> on_vulkan{{"plain: one step per pass, from one buffer to another",
        [](auto& b, auto& p) { return bitonic_sort<vulkan_backend>(b, p); }}};
    for (const uint steps : {1u, 2u, 3u, 4u})
        on_vulkan.push_back({"in place, up to " + std::to_string(steps) + (steps == 1 ? " step" : " steps") + " a pass",
            [steps](auto& b, auto& p) { return bitonic_sort(b, p, steps); }, steps == 4 ? 4.0 : 0.0,
            steps == 4 ? 2.5 : 0.0});
    const std::vector<version<gl_backend>> on_gl{
        {"plain: one step per pass", [](auto& b, auto& p) { return bitonic_sort<gl_backend>(b, p); }},
        {"two pairs per texel, up to three steps per pass", [](auto& b, auto& p) { return bitonic_sort(b, p); }, 1.6}};
    return std::max(measure(vulkan, pairs, expected, on_vulkan), measure(gl, pairs, expected, on_gl));
}

} // namespace

photongrid::bench::verb_run photongrid::bench::add_passes(CLI::App& verb)
{
    const auto pairs = std::make_shared<std::size_t>(1 << 20);
    verb.add_option("--pairs", *pairs)->check(CLI::Range(2, 1 << 28));
    return [pairs] { return run_passes(*pairs); };
}
