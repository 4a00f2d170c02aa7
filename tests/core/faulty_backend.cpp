// Every algorithm and the renderer on a device that fails at its first call, its second, … its last: they end in the
// documented exception, hold no memory afterwards, and work again on a device that does.
#include "faulty_device_tests.hpp"
#include "faulty_jobs.hpp"
#include <photongrid/io/image_file.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <unistd.h>

namespace photongrid {
namespace {

    using faulty = testing::faulty_backend<serial_backend>;

    class faulty_backend : public ::testing::TestWithParam<job<faulty>> {
    protected:
        serial_backend inner;
        faulty b{inner};

        std::string run() { return GetParam().run(b); }
        /// How many calls of an undisturbed run fault `f` counts.
        std::uint64_t calls(fault f)
        {
            b.set(f, 0);
            run();
            return b.calls();
        }
        /// Makes the n-th call fail; returns the error message.
        std::string failure(fault f, std::uint64_t n)
        {
            b.set(f, n);
            try {
                run();
                return "no exception";
            } catch (const backend_error& e) {
                return e.what();
            }
        }
    };

    TEST_P(faulty_backend, out_of_memory)
    {
        const auto whole = run();
        const auto n = calls(fault::out_of_memory);
        ASSERT_GE(n, 3u);
        for (std::uint64_t i = 1; i <= n; ++i) {
            SCOPED_TRACE("allocation " + std::to_string(i) + " of " + std::to_string(n));
            ASSERT_EQ(failure(fault::out_of_memory, i), "injected: out of memory");
            ASSERT_EQ(inner.bytes(), 0u) << "leaked";
            ASSERT_TRUE(run() == whole) << "the backend works again"; // the fault is over
            ASSERT_EQ(inner.bytes(), 0u);
        }
    }

    TEST_P(faulty_backend, submit_failed)
    {
        const auto whole = run();
        const auto n = calls(fault::submit_failed);
        ASSERT_GE(n, 3u);
        for (std::uint64_t i = 1; i <= n; ++i) {
            SCOPED_TRACE("call " + std::to_string(i) + " of " + std::to_string(n));
            ASSERT_EQ(failure(fault::submit_failed, i), "injected: submit failed");
            ASSERT_EQ(inner.bytes(), 0u) << "leaked";
            ASSERT_TRUE(run() == whole) << "the backend works again";
            ASSERT_EQ(inner.bytes(), 0u);
        }
    }

    TEST_P(faulty_backend, device_lost)
    {
        const auto n = calls(fault::device_lost);
        for (std::uint64_t i = 1; i <= n; ++i) {
            SCOPED_TRACE("call " + std::to_string(i) + " of " + std::to_string(n));
            ASSERT_EQ(failure(fault::device_lost, i), "injected: device lost");
            ASSERT_EQ(inner.bytes(), 0u) << "leaked";
            ASSERT_THROW(run(), backend_error) << "lost for good";
            ASSERT_EQ(inner.bytes(), 0u);
        }
    }

    /// Runs with a device that is wrong, not refusing: an exception of the documented kinds, or a wrong answer.
    void expect_wrong_or_refused(const job<faulty>& j, faulty& b, serial_backend& inner)
    {
        try {
            j.run(b);
        } catch (const backend_error&) {
        } catch (const map_file_error&) { // what was saved is no map
        } catch (const std::runtime_error& e) {
            EXPECT_TRUE(std::string_view(e.what()).starts_with("trace_photons: "))
                << e.what(); // too few photons stored
        }
        ASSERT_EQ(inner.bytes(), 0u) << "leaked";
    }

    /// Floats and whole numbers: ids, cells, materials, events. Reads are guarded (PHOTONGRID_GUARD_READS), so that
    /// none leaves its buffer; the sanitizers watch.
    TEST_P(faulty_backend, garbage)
    {
        const auto n = calls(fault::garbage);
        ASSERT_GE(n, 3u);
        for (std::uint64_t i = 1; i <= n; ++i) {
            SCOPED_TRACE("pass " + std::to_string(i) + " of " + std::to_string(n));
            b.set(fault::garbage, i);
            expect_wrong_or_refused(GetParam(), b, inner);
        }
    }

    TEST_P(faulty_backend, wrong_contents)
    {
        const auto n = calls(fault::wrong_contents);
        ASSERT_GT(n, 0u);
        for (std::uint64_t i = 1; i <= n; ++i) {
            SCOPED_TRACE("download " + std::to_string(i) + " of " + std::to_string(n));
            b.set(fault::wrong_contents, i);
            expect_wrong_or_refused(GetParam(), b, inner);
        }
    }

    // A count that cannot be is refused by name; one that could be, and is not, gives a wrong answer at worst.
    TEST_P(faulty_backend, wrong_count)
    {
        const auto n = calls(fault::wrong_count);
        for (std::uint64_t i = 1; i <= n; ++i) {
            SCOPED_TRACE("count " + std::to_string(i) + " of " + std::to_string(n));
            for (const auto wrong : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{17}}) {
                b.set(fault::wrong_count, i, wrong);
                expect_wrong_or_refused(GetParam(), b, inner);
            }
            for (const auto wrong :
                {std::uint64_t{1} << 24, std::uint64_t{0xFFFFFFFFu}, (std::uint64_t{1} << 32) + 1, ~std::uint64_t{0}}) {
                b.set(fault::wrong_count, i, wrong);
                try {
                    run();
                    ADD_FAILURE() << wrong << " was believed";
                } catch (const backend_error& e) {
                    EXPECT_NE(std::string_view(e.what()).find("the device returned " + std::to_string(wrong)),
                        std::string_view::npos)
                        << e.what();
                }
                ASSERT_EQ(inner.bytes(), 0u) << "leaked";
            }
        }
    }

    INSTANTIATE_TEST_SUITE_P(all, faulty_backend, ::testing::ValuesIn(jobs<faulty>),
        [](const auto& info) { return std::string(info.param.name); });

    // No path emitted would mean tracing for ever.
    TEST(faulty_tracer, throws_if_no_path_was_emitted)
    {
        serial_backend inner;
        faulty b(inner);
        b.set(fault::wrong_count, 2, 0); // the first asks whether a path goes on
        try {
            (void)picture(b, map_builder::sort);
            FAIL();
        } catch (const backend_error& e) {
            EXPECT_STREQ(
                e.what(), "serial: count<path_is_emitted>: the device returned 0; at least 1 of 1024 paths is emitted");
        }
    }

    // A render as the program does it: what fails before the picture is whole leaves what was there before.
    TEST(faulty_render, leaves_the_old_file)
    {
        namespace fs = std::filesystem;
        const auto folder = fs::temp_directory_path() / ("photongrid_faulty_" + std::to_string(::getpid()));
        fs::create_directories(folder);
        const auto path = (folder / "a.pfm").string();
        const auto contents = [&] {
            std::ifstream in(path, std::ios::binary);
            return std::string(std::istreambuf_iterator<char>(in), {});
        };
        serial_backend inner;
        faulty b(inner);
        const auto render_to_file = [&] {
            render_observer observer; // as --progressive: every picture on the way is written too
            observer.intermediate = [&](const image& p) { write_image(path, p); };
            write_image(path, picture(b, map_builder::sort, observer).picture);
        };
        b.set(fault::device_lost, 0);
        render_to_file();
        const auto n = b.calls();
        const auto whole_size = contents().size();
        for (const std::uint64_t at : {std::uint64_t{1}, n / 3, n / 2, n - 1, n}) {
            std::ofstream(path) << "old";
            b.set(fault::device_lost, at);
            EXPECT_THROW(render_to_file(), backend_error);
            const auto left = contents();
            EXPECT_TRUE(left == "old" || left.size() == whole_size) << left.size() << " bytes";
            EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1)
                << "a temporary file is left";
        }
        fs::remove_all(folder);
    }

} // namespace
} // namespace photongrid
