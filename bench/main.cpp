// Measures by verbs; bench/run.sh runs them all. photongrid_bench is built as users build the library,
// photongrid_bench_native for this very machine, with what is compared with other libraries: an inline function is once
// in a program, whichever way it was compiled, so that one program cannot have both.
#include "verbs.hpp"

#include <cstdio>

int main(int argc, char** argv)
{
    using namespace photongrid::bench;
    CLI::App app("Measures photongrid. Exit status: 1 where a measure is not as wanted, 2 where something is broken, 3 "
                 "where results are wrong.");
    app.require_subcommand(1);
    app.option_defaults()->always_capture_default();
    std::vector<std::pair<CLI::App*, verb_run>> verbs;
    const auto add = [&](const char* name, const char* what, verb_run (*add_options)(CLI::App&)) {
        auto* verb = app.add_subcommand(name, what);
        verbs.emplace_back(verb, add_options(*verb));
    };
#ifdef BENCH_NEIGHBOURS
    add("search", "the k nearest of even sets against CGAL, FLANN and nanoflann", add_search);
#endif
#ifdef BENCH_NATIVE
#ifdef BENCH_NEIGHBOURS
    add("clusters", "the k nearest of photons in clusters against the same", add_clusters);
#endif
#ifdef BENCH_RAYS
    add("rays", "rays against triangles, beside Embree's", add_rays);
#endif
#ifdef BENCH_SORT
    add("sort", "pairs of 32 bits against std::sort, Highway's vqsort and TBB's parallel_sort", add_sort);
#endif
#else
    add("algorithms", "every algorithm on every backend; takes Google Benchmark's options", add_algorithms);
    add("fields", "errors and seconds of estimates of fields with a known answer, CSV", add_fields);
    add("files", "how fast scene files are read, and with how much memory", add_files);
    add("grids", "the k nearest, and at least k, by grid", add_grids);
    add("interactive", "how soon a change of a scene is seen", add_interactive);
    add("kernels", "instructions of kernels, and what integer addresses save", add_kernels);
    add("maps", "which map suits photons in clusters, on every backend", add_maps);
    add("passes", "what the sorting network gains by more steps in a pass, on vulkan and gl", add_passes);
    add("pictures", "a room with a mesh", add_pictures);
    add("povray", "a scene in POV-Ray's language, and its picture compared", add_povray);
    add("unfinished", "what leaving out finished elements gains", add_unfinished);
#endif
    try {
        app.parse(argc, argv);
        for (const auto& [verb, run] : verbs)
            if (verb->parsed())
                return run();
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s: %s\n", argv[0], e.what());
    }
    return 2;
}
