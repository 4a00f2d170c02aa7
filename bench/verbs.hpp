// The verbs of photongrid_bench. Each has a file of its own, which adds the verb's options and returns what runs it.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace photongrid::bench {

/// Returns the exit status: 0, or 1 where a measure is not as wanted, 2 where something is broken, 3 where results are
/// wrong.
using verb_run = std::function<int()>;

verb_run add_algorithms(CLI::App& verb);
verb_run add_clusters(CLI::App& verb);
verb_run add_fields(CLI::App& verb);
verb_run add_files(CLI::App& verb);
verb_run add_grids(CLI::App& verb);
verb_run add_interactive(CLI::App& verb);
verb_run add_kernels(CLI::App& verb);
verb_run add_maps(CLI::App& verb);
verb_run add_passes(CLI::App& verb);
verb_run add_pictures(CLI::App& verb);
verb_run add_povray(CLI::App& verb);
verb_run add_rays(CLI::App& verb);
verb_run add_search(CLI::App& verb);
verb_run add_sort(CLI::App& verb);
verb_run add_unfinished(CLI::App& verb);

} // namespace photongrid::bench
