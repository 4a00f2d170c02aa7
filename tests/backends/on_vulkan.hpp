// The Vulkan backend under test, with the validation layer watching.
#pragma once

#include "../core/under_test.hpp"
#include "vulkan_algorithms.hpp"

namespace photongrid::testing {

struct vulkan_tag {
    using type = vulkan_backend;
    static constexpr const char* name = "vulkan";
    static constexpr bool sorts_by_network = false; // up to four steps of it a pass
    // Buffers are given back when the passes that use them have run: each attribute twice, pairs and list.
    static constexpr unsigned peak_bytes_per_photon = 2 * 48 + 8 + 4;
    /// PHOTONGRID_GPU_AV=1 has the layer watch inside the kernels too: tests/run.sh --full.
    static std::unique_ptr<type> make()
    {
        auto b = std::make_unique<type>(
            vulkan_options{.validation = true, .gpu_assisted = std::getenv("PHOTONGRID_GPU_AV") != nullptr});
        return b;
    }
};

/// After all other tests of this program: the layer had nothing to say.
class no_validation_messages : public ::testing::Environment {
    void TearDown() override
    {
        std::string reason;
        if (auto* b = shared_backend<vulkan_tag>(reason); b != nullptr)
            for (const auto& m : b->validation_messages())
                ADD_FAILURE() << m;
    }
};
inline const auto* const watched_layer = ::testing::AddGlobalTestEnvironment(new no_validation_messages);

} // namespace photongrid::testing
