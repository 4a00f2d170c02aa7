// Which backends a test runs on. A test body is written once, for a tag; each on_<backend>.cpp instantiates all of
// them.
#pragma once

#include <photongrid/core/backend.hpp>

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

namespace photongrid::testing {

/// True where a backend that cannot be had is a failure (CI sets it), not a skip with the reason.
inline bool every_backend_required() { return std::getenv("PHOTONGRID_REQUIRE_BACKENDS") != nullptr; }
/// True when software devices are refused: tests/run.sh --device hardware.
inline bool hardware_wanted()
{
    const char* device = std::getenv("PHOTONGRID_DEVICE");
    return device != nullptr && std::string(device) == "hardware";
}

/// One backend per tag and process: contexts are slow to make, and kernels stay compiled.
template <class Tag>
typename Tag::type* shared_backend(std::string& reason)
{
    static std::string why;
    static const std::unique_ptr<typename Tag::type> instance = []() -> std::unique_ptr<typename Tag::type> {
        try {
            auto b = Tag::make();
            if (hardware_wanted() && b->caps().software && b->caps().backend != "serial"
                && b->caps().backend != "cpu") {
                why = "hardware was asked for, but this device is software: " + b->caps().device;
                return nullptr;
            }
            return b;
        } catch (const backend_error& e) {
            why = e.what();
            return nullptr;
        }
    }();
    reason = why;
    return instance.get();
}

/// A fixture whose `b()` is the backend under test; without one the test fails or skips aloud.
template <class Tag>
class on_backend : public ::testing::Test {
protected:
    using B = typename Tag::type;
    void SetUp() override
    {
        if constexpr (requires { Tag::never_hardware(); })
            if (hardware_wanted() && Tag::never_hardware())
                GTEST_SKIP() << Tag::name << " is never hardware";
        std::string reason;
        instance_ = shared_backend<Tag>(reason);
        if (instance_ != nullptr)
            return;
        if (every_backend_required() || hardware_wanted())
            FAIL() << Tag::name << ": " << reason;
        GTEST_SKIP() << Tag::name << ": " << reason;
    }
    B& b() { return *instance_; }
    /// Whether its division rounds as IEEE says.
    bool divides_exactly() { return b().caps().exact_division; }

    /// Says, and records in the test's report, the largest error of a case of docs/reference/hard_cases.md.
    void report(const std::string& hard_case, const std::string& what, double value)
    {
        char text[64];
        std::snprintf(text, sizeof text, "%.3g", value);
        std::printf("hard case %s on %s: %s %s\n", hard_case.c_str(), Tag::name, what.c_str(), text);
        ::testing::Test::RecordProperty(hard_case, what + " " + text);
    }

private:
    B* instance_ = nullptr;
};

/// Defaults unless a tag says otherwise: sorts take the network's passes, and sums of light equal serial's to the bit
/// where division rounds correctly.
template <class Tag>
constexpr bool sorts_by_network()
{
    if constexpr (requires { Tag::sorts_by_network; })
        return Tag::sorts_by_network;
    return true;
}
template <class Tag>
constexpr bool adds_as_serial()
{
    if constexpr (requires { Tag::adds_as_serial; })
        return Tag::adds_as_serial;
    return true;
}

/// At the peak of building a map: photons and list, 52, and an attribute that is in memory twice while it is reordered.
template <class Tag>
constexpr unsigned peak_bytes_per_photon()
{
    if constexpr (requires { Tag::peak_bytes_per_photon; })
        return Tag::peak_bytes_per_photon;
    return 52 + 16;
}

struct tag_names {
    template <class Tag>
    static std::string GetName(int)
    {
        return Tag::name;
    }
};

} // namespace photongrid::testing
