// The jobs of faulty_jobs.hpp on each backend, which fails at some of its calls: they end in the documented exception,
// free the device's memory, and work again. The algorithms are the generic ones: overrides are for the backend itself.
// A short run has the serial backend alone, a full one all.
#pragma once

#include "faulty_jobs.hpp"

#include <backends_under_test.hpp>

#include <gtest/gtest.h>

#include <memory>

namespace photongrid::testing {

template <class B>
class faulty_devices : public ::testing::Test {
protected:
    using faulty = faulty_backend<B>;

    void SetUp() override
    {
        inner = std::make_unique<B>();
        b = std::make_unique<faulty>(*inner);
        for (const auto& j : jobs<faulty>)
            (void)j.run(*b);
        resting = inner->bytes();
        ASSERT_LE(resting, 4096u) << "what a backend keeps for itself is little";
    }
    /// Calls of an undisturbed run of `j` that `f` counts: the first, the last, and some in between.
    std::vector<std::uint64_t> some_calls(const job<faulty>& j, fault f)
    {
        b->set(f, 0);
        j.run(*b);
        const std::uint64_t n = b->calls();
        std::vector<std::uint64_t> some;
        for (std::uint64_t i = 1; i < n; i += 1 + i / 2)
            some.push_back(i);
        some.push_back(n);
        return some;
    }
    std::unique_ptr<B> inner;
    std::unique_ptr<faulty> b;
    std::uint64_t resting = 0; ///< bytes of the backend's own
};
TYPED_TEST_SUITE(faulty_devices, backends_under_test<::testing::Types>);

TYPED_TEST(faulty_devices, fail_by_the_documented_exception_and_work_again)
{
    for (const auto& j : jobs<faulty_backend<TypeParam>>)
        for (const auto f : {fault::out_of_memory, fault::submit_failed}) {
            this->b->set(fault::none, 0);
            const auto whole = j.run(*this->b);
            for (const std::uint64_t i : this->some_calls(j, f)) {
                SCOPED_TRACE(std::string(j.name) + ", fault " + std::to_string(int(f)) + ", call " + std::to_string(i));
                this->b->set(f, i);
                try {
                    (void)j.run(*this->b);
                    EXPECT_LT(this->b->calls(), i) << "no exception"; // how often a drawing calls depends on the time
                } catch (const backend_error& e) {
                    EXPECT_TRUE(std::string_view(e.what()).starts_with("injected: ")) << e.what();
                }
                ASSERT_EQ(this->inner->bytes(), this->resting) << "leaked";
            }
            this->b->set(fault::none, 0);
            ASSERT_TRUE(j.run(*this->b) == whole) << j.name << ": the backend works again";
            ASSERT_EQ(this->inner->bytes(), this->resting);
        }
}

TYPED_TEST(faulty_devices, lost_stay_lost)
{
    for (const auto& j : jobs<faulty_backend<TypeParam>>)
        for (const std::uint64_t i : this->some_calls(j, fault::device_lost)) {
            SCOPED_TRACE(std::string(j.name) + ", call " + std::to_string(i));
            this->b->set(fault::device_lost, i);
            ASSERT_THROW((void)j.run(*this->b), backend_error);
            ASSERT_EQ(this->inner->bytes(), this->resting) << "leaked";
            ASSERT_THROW((void)j.run(*this->b), backend_error) << "lost for good";
        }
}

TYPED_TEST(faulty_devices, that_count_wrongly_are_refused)
{
    for (const auto& j : jobs<faulty_backend<TypeParam>>)
        for (const std::uint64_t i : this->some_calls(j, fault::wrong_count)) {
            if (this->b->calls() == 0)
                continue; // it counts nothing
            SCOPED_TRACE(std::string(j.name) + ", count " + std::to_string(i));
            this->b->set(fault::wrong_count, i, ~std::uint64_t{0});
            ASSERT_THROW((void)j.run(*this->b), backend_error);
            ASSERT_EQ(this->inner->bytes(), this->resting) << "leaked";
        }
}

} // namespace photongrid::testing
