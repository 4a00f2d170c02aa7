// Buffers of any backend.
#pragma once

#include "verbs.hpp"

namespace photongrid::testing {

TYPED_TEST_P(verbs, buffers_keep_delicate_floats)
{
    for (const std::size_t n : {0u, 1u, 2047u, 2048u, 2049u, 100000u}) {
        this->template expect_kept<uint>(n);
        this->template expect_kept<float>(n);
        this->template expect_kept<glm::uvec2>(n);
        this->template expect_kept<glm::vec2>(n);
        this->template expect_kept<glm::uvec4>(n);
        this->template expect_kept<glm::vec4>(n);
    }
}

TYPED_TEST_P(verbs, buffers_move_and_may_outlive_their_backend)
{
    using B = typename TestFixture::B;
    buffer_of<B, uint> kept;
    EXPECT_EQ(kept.size(), 0u);
    {
        const auto other = TypeParam::make();
        kept = other->template make<uint>(1000);
        auto gone = other->template make<uint>(10);
        gone = std::move(kept);
        EXPECT_EQ(kept.size(), 0u); // NOLINT(bugprone-use-after-move)
        EXPECT_EQ(gone.size(), 1000u);
        kept = std::move(gone);
    }
    EXPECT_EQ(kept.size(), 1000u);
    kept = {};
    EXPECT_EQ(kept.size(), 0u);
}

TYPED_TEST_P(verbs, a_buffer_may_be_destroyed_before_passes_that_use_it_end)
{
    auto& b = this->b();
    const uint n = 5000;
    auto last = this->up(std::vector<uint>(n, 1u));
    for (uint pass = 0; pass < 200; ++pass) {
        auto next = b.template make<uint>(n);
        b.template run<verb_kernels::frame_below>(n, {.distance = 0}, reads(last), writes(next));
        last = std::move(next);
    }
    EXPECT_EQ(b.download(last), std::vector<uint>(n, 0xFFFFFFFFu)); // 2^201 - 1 modulo 2^32
}

TYPED_TEST_P(verbs, memory_is_given_back)
{
    auto& b = this->b();
    const std::size_t n = 30000;
    const auto use = [&] {
        auto first = this->up(std::vector<uint>(n, 1u));
        auto second = b.template make<uint>(n);
        b.template run<verb_kernels::shifted>(n, {.added = 1}, reads(first), writes(second));
        first = std::move(second);
        return b.template count<verb_kernels::is_marked>(n, {.marks = ~0u}, reads(first));
    };
    use(); // memory that a backend keeps after its first use
    b.finish();
    const auto before = b.bytes();
    for (int again = 0; again < 3; ++again)
        use();
    b.finish();
    EXPECT_EQ(b.bytes(), before);

    const auto grows = [&](auto make) {
        const auto without = b.bytes();
        {
            auto buffer = make();
            const auto least = without + n * sizeof(typename decltype(buffer)::value_type);
            EXPECT_GE(b.bytes(), least);
            EXPECT_GE(b.peak_bytes(), b.bytes());
            const auto moved = std::move(buffer);
            EXPECT_GE(b.bytes(), least);
        }
        b.finish();
        EXPECT_EQ(b.bytes(), without);
    };
    grows([&] { return b.template make<uint>(n); });
    grows([&] { return b.template make<glm::vec2>(n); });
    grows([&] { return this->up(std::vector<glm::vec4>(n)); });
    EXPECT_GE(b.peak_bytes(), before + n * sizeof(glm::vec4));
}

TYPED_TEST_P(verbs, a_buffer_beyond_the_limit_is_refused_and_nothing_else)
{
    auto& b = this->b();
    const auto n = b.caps().max_elements + 1;
    std::string said;
    try {
        (void)b.template make<glm::vec4>(n);
    } catch (const backend_error& e) {
        said = e.what();
    }
    EXPECT_NE(said.find(std::to_string(n)), std::string::npos) << said;
    const glm::vec4 first{}; // the others are not there: a refusal comes before any is read
    EXPECT_THROW((void)b.upload(std::span<const glm::vec4>(&first, n)), backend_error);
    const auto after = this->up(std::vector<uint>{1, 2, 3});
    EXPECT_EQ(b.download(after), (std::vector<uint>{1, 2, 3}));
}

TYPED_TEST_P(verbs, too_small_buffers_are_refused_by_name)
{
    auto& b = this->b();
    const auto in = b.template make<uint>(100);
    const auto amounts = b.template make<glm::vec4>(100);
    const std::vector<uint> marks(9, 7u);
    auto small = this->up(marks), old = b.template make<uint>(20);
    auto state = b.template make<glm::uvec2>(20);
    auto totals = b.template make<glm::vec4>(20);

    EXPECT_NE(refusal([&] {
        b.template run<verb_kernels::shifted>({8, 2u}, {.added = 0}, reads(in), writes(small));
    }).find("'after'"),
        std::string::npos);
    EXPECT_NE(refusal([&] {
        b.template run<verb_kernels::running_total>(20, {}, reads(in), writes(state, small));
    }).find("'old'"),
        std::string::npos);
    EXPECT_NE(refusal([&] {
        b.template run_until_done<verb_kernels::countdown>(21, {.step = 1}, reads(in), writes(state, old), 0u);
    }).find("'state'"),
        std::string::npos);
    EXPECT_NE(refusal([&] {
        b.template run_until_done<verb_kernels::countdown>({10, 0u}, {.step = 1}, reads(in), writes(state, small), 0u);
    }).find("'old'"),
        std::string::npos);
    const auto route = [&](uint destinations, uint m) {
        return refusal([&] {
            b.template route<verb_kernels::delivery>(
                100, {.first_payload = 0}, reads(in, amounts), {destinations, m}, small, totals);
        });
    };
    EXPECT_NE(route(10, 1).find("slots"), std::string::npos); // 9
    EXPECT_NE(route(3, 2).find("slots"), std::string::npos);  // 12
    EXPECT_NE(route(3, 0).find("m:"), std::string::npos);
    EXPECT_NE(route(3, b.caps().max_route_slots + 1).find("m:"), std::string::npos);
    totals = b.template make<glm::vec4>(2);
    EXPECT_NE(route(3, 1).find("totals"), std::string::npos);
    EXPECT_EQ(b.download(small), marks);
}

// --- run
// --------------------------------------------------------------------------------------------------------------

} // namespace photongrid::testing
