// What each verb of a backend does, as backend.hpp promises it. References are loops in these tests. What
// algorithm_tests.hpp shows of buffers is not repeated here. Included by each on_<backend>.cpp.
#pragma once

#include "photon_sets.hpp"
#include "under_test.hpp"
#include "verb_kernels.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

namespace photongrid::testing {

/// What std::invalid_argument says when `call` is refused; nothing where it is not.
template <class F>
std::string refusal(F&& call)
{
    try {
        call();
    } catch (const std::invalid_argument& e) {
        return e.what();
    }
    return {};
}

template <class Tag>
class verbs : public on_backend<Tag> {
protected:
    using B = typename Tag::type;

    template <class T>
    auto up(const std::vector<T>& host)
    {
        return this->b().upload(std::span<const T>(host));
    }
    static std::vector<uint> random_words(std::size_t n, std::uint64_t seed)
    {
        random_source u(seed);
        std::vector<uint> words(n);
        for (auto& w : words)
            w = u.below(0xFFFFFFFFu);
        return words;
    }
    /// Every n-th word a number that careless copies change: NaNs, infinities, the smallest numbers, minus zero.
    static std::vector<uint> delicate_words(std::size_t n)
    {
        constexpr uint delicate[] = {
            0x7FC12345u, 0x7F812345u, 0xFFC00000u, 0x7F800000u, 0xFF800000u, 1u, 0x807FFFFFu, 0x80000000u, 0xFFFFFFFFu};
        auto words = random_words(n, n);
        for (std::size_t i = 0; i < n; i += 3)
            words[i] = delicate[i / 3 % std::size(delicate)];
        return words;
    }

    template <class T>
    void expect_kept(std::size_t n)
    {
        const auto words = delicate_words(n * sizeof(T) / 4);
        std::vector<T> host(n), copy(n);
        if (n > 0)
            std::memcpy(host.data(), words.data(), n * sizeof(T));
        copy = host;
        auto buffer = up(host);
        std::fill(host.begin(), host.end(), T(1)); // the caller's own again
        EXPECT_EQ(buffer.size(), n);
        EXPECT_EQ(count_different_bits(this->b().download(buffer), copy), 0u)
            << n << " elements of " << sizeof(T) << " bytes";
        const auto moved = std::move(buffer);
        EXPECT_EQ(buffer.size(), 0u); // NOLINT(bugprone-use-after-move)
        EXPECT_EQ(moved.size(), n);
        EXPECT_EQ(count_different_bits(this->b().download(moved), copy), 0u);
        EXPECT_EQ(this->b().template make<T>(n).size(), n);
    }
};
TYPED_TEST_SUITE_P(verbs);

// --- buffers
// ----------------------------------------------------------------------------------------------------------

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

TYPED_TEST_P(verbs, a_buffer_may_go_before_the_passes_that_use_it_are_done)
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
    use(); // what a backend keeps for its own from the first use on
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
                100, {.first_payload = 0}, reads(in, amounts), destinations, m, small, totals);
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

TYPED_TEST_P(verbs, a_pass_computes_its_elements_and_no_other)
{
    auto& b = this->b();
    const uint n = 9000, untouched = 12345;
    const auto host = this->random_words(n, 1);
    const auto in = this->up(host);
    for (const uint first : {0u, 1u, 63u, 2047u, 2048u, 3001u})
        for (const uint elements : {0u, 1u, 2u, 64u, 2047u, 2048u, 5999u}) {
            auto out = this->up(std::vector<uint>(n, untouched));
            b.template run<verb_kernels::shifted>({elements, first}, {.added = 17}, reads(in), writes(out));
            std::vector<uint> expected(n, untouched);
            for (uint i = first; i < first + elements; ++i)
                expected[i] = host[i] + 17u + i;
            EXPECT_EQ(count_different_bits(b.download(out), expected), 0u) << elements << " from " << first;
        }
}

TYPED_TEST_P(verbs, a_pass_has_eight_inputs_and_eight_outputs_of_mixed_types)
{
    using glm::uvec2, glm::uvec4, glm::vec2, glm::vec4;
    auto& b = this->b();
    const uint n = 3000, first = 100, elements = 2500;
    random_source random(2);
    const auto number = [&] { return static_cast<float>(random.below(1000)) / 8; }; // sums are exact
    const auto many = [&](auto make) {
        std::vector<decltype(make())> host(n);
        for (auto& x : host)
            x = make();
        return host;
    };
    const auto word = [&] { return random.below(0xFFFFFFFFu); };
    const auto pair = [&] { return uvec2(word(), word()); };
    const auto pair_of_numbers = [&] { return vec2(number(), number()); };
    const auto four = [&] { return uvec4(word(), word(), word(), word()); };
    const auto four_numbers = [&] { return vec4(number(), number(), number(), number()); };
    const auto a = many(word), g = many(word);
    const auto h_b = many(number), h = many(number);
    const auto c = many(pair_of_numbers);
    const auto d = many(pair);
    const auto e = many(four_numbers);
    const auto f = many(four);
    auto p = many(word), w = many(word);
    auto q = many(number), v = many(number);
    auto r = many(pair_of_numbers);
    auto s = many(pair);
    auto t = many(four_numbers);
    auto u = many(four);

    auto p_ = this->up(p);
    auto q_ = this->up(q);
    auto r_ = this->up(r);
    auto s_ = this->up(s);
    auto t_ = this->up(t);
    auto u_ = this->up(u);
    auto v_ = this->up(v);
    auto w_ = this->up(w);
    for (int pass = 0; pass < 2; ++pass) {
        b.template run<verb_kernels::mixed>({elements, first}, {},
            reads(this->up(a), this->up(h_b), this->up(c), this->up(d), this->up(e), this->up(f), this->up(g),
                this->up(h)),
            writes(p_, q_, r_, s_, t_, u_, v_, w_));
        for (uint i = first; i < first + elements; ++i) {
            p[i] += a[i];
            q[i] += h_b[i];
            r[i] += c[i];
            s[i] = {d[i].y, d[i].x};
            t[i] += e[i];
            u[i] = {f[i].w, f[i].z, f[i].y, f[i].x};
            v[i] = h[i];
            w[i] = g[i] + i;
        }
    }
    EXPECT_EQ(count_different_bits(b.download(p_), p), 0u);
    EXPECT_EQ(count_different_bits(b.download(q_), q), 0u);
    EXPECT_EQ(count_different_bits(b.download(r_), r), 0u);
    EXPECT_EQ(count_different_bits(b.download(s_), s), 0u);
    EXPECT_EQ(count_different_bits(b.download(t_), t), 0u);
    EXPECT_EQ(count_different_bits(b.download(u_), u), 0u);
    EXPECT_EQ(count_different_bits(b.download(v_), v), 0u);
    EXPECT_EQ(count_different_bits(b.download(w_), w), 0u);
}

TYPED_TEST_P(verbs, states_change_in_place_and_outputs_beside_them)
{
    auto& b = this->b();
    const uint n = 5000, first = 2000, elements = 2500;
    const auto added = this->random_words(n, 3);
    std::vector<glm::uvec2> totals(n);
    for (uint i = 0; i < n; ++i)
        totals[i] = {i, 7};
    std::vector<uint> old(n, 99u);
    const auto added_ = this->up(added);
    auto totals_ = this->up(totals);
    auto old_ = this->up(old);
    for (int pass = 0; pass < 3; ++pass) {
        b.template run<verb_kernels::running_total>({elements, first}, {}, reads(added_), writes(totals_, old_));
        for (uint i = first; i < first + elements; ++i) {
            old[i] = totals[i].x;
            totals[i] = {totals[i].x + added[i], totals[i].y + 1};
        }
    }
    EXPECT_EQ(b.download(totals_), totals);
    EXPECT_EQ(b.download(old_), old);
}

TYPED_TEST_P(verbs, switches_are_on_and_off_one_by_one)
{
    auto& b = this->b();
    const uint n = 100;
    auto out = b.template make<uint>(n);
    for (const uint lowest : {0u, 1u})
        for (const uint middle : {0u, 1u})
            for (const uint highest : {0u, 1u})
                for (const uint others : {0u, ~0u}) { // that the kernel lacks
                    constexpr uint known = 1u | 1u << 5 | 1u << 31;
                    b.template run<verb_kernels::switched>(
                        {n, 0u, lowest | middle << 5 | highest << 31 | (others & ~known)}, {.factor = 8}, reads(),
                        writes(out));
                    std::vector<uint> expected(n);
                    for (uint i = 0; i < n; ++i)
                        expected[i] = 8 * i + lowest + 2 * middle + 4 * highest;
                    EXPECT_EQ(b.download(out), expected) << lowest << middle << highest << " others " << others;
                }
    b.template run<verb_kernels::switched>(n, {.factor = 0}, reads(), writes(out)); // all on, unless said otherwise
    EXPECT_EQ(b.download(out), std::vector<uint>(n, 7u));
}

TYPED_TEST_P(verbs, parameters_of_every_kind_arrive)
{
    using glm::uvec4, glm::vec4;
    auto& b = this->b();
    const verb_kernels::parameters::Params args{.a = vec4(1, 2, 3, 4),
        .b = uvec4(5, 6, 7, 0xFFFFFFFFu),
        .c = {vec4(8, 9, 10, 11), uvec4(12, 13, 14, 15)},
        .d = vec4(-16, 17.5f, -0.0f, 1e30f),
        .e = {18, 19},
        .f = {20, 21},
        .g = 22.25f,
        .h = 23,
        .j = -24,
        .k = 0x80000000u};
    static_assert(sizeof args == 112);
    auto floats = b.template make<vec4>(7);
    auto wholes = b.template make<uvec4>(7);
    b.template run<verb_kernels::parameters>(7, args, reads(), writes(floats, wholes));
    EXPECT_EQ(count_different_bits(b.download(floats),
                  {args.a, vec4(0), args.c.floats, args.d, vec4(18, 19, 22.25f, 0), vec4(0), vec4(0)}),
        0u);
    EXPECT_EQ(b.download(wholes),
        (std::vector<uvec4>{
            uvec4(0), args.b, args.c.wholes, uvec4(0), uvec4(0), uvec4(20, 21, 23, 0x80000000u), uvec4(24, 1, 0, 0)}));
}

TYPED_TEST_P(verbs, a_pass_reads_one_part_of_a_buffer_and_writes_another)
{
    auto& b = this->b();
    const uint n = 3000, frames = 5;
    auto expected = this->random_words(n * frames, 4);
    auto buffer = this->up(expected);
    for (uint f = 1; f < frames; ++f) {
        b.template run<verb_kernels::frame_below>({n, f * n}, {.distance = n}, reads(buffer), writes(buffer));
        for (uint i = f * n; i < (f + 1) * n; ++i)
            expected[i] = expected[i - n] * 2 + 1;
    }
    EXPECT_EQ(b.download(buffer), expected);
}

TYPED_TEST_P(verbs, each_pass_sees_what_all_before_it_wrote)
{
    auto& b = this->b();
    const uint n = 5000;
    auto expected = this->random_words(n, 5);
    auto last = this->up(expected), next = b.template make<uint>(n);
    for (uint pass = 0; pass < 100; ++pass) {
        const uint stride = 1 + 997 * pass % n;
        b.template run<verb_kernels::stirred>(n, {.elements = n, .stride = stride}, reads(last), writes(next));
        std::swap(last, next);
        std::vector<uint> stirred(n);
        for (uint i = 0; i < n; ++i)
            stirred[i] = expected[i] * 3 + expected[(i + stride) % n] + 1;
        expected = std::move(stirred);
    }
    // And so does every other verb.
    std::vector<glm::uvec2> totals(n, glm::uvec2(3, 0));
    auto state = this->up(totals);
    auto old = b.template make<uint>(n);
    b.template run_until_done<verb_kernels::countdown>(n, {.step = 1}, reads(last), writes(state, old), nowhere);
    const auto marked = b.template count<verb_kernels::is_marked>(n, {.marks = 4}, reads(last));
    b.template run<verb_kernels::running_total>(n, {}, reads(last), writes(state, old));
    for (uint i = 0; i < n; ++i)
        totals[i] = {expected[i], expected[i] * (9 + 3 + 1) + 1};
    EXPECT_EQ(marked, static_cast<std::uint64_t>(std::count_if(expected.begin(), expected.end(), [](uint x) {
        return (x & 4u) != 0;
    })));
    EXPECT_EQ(b.download(state), totals);
    EXPECT_EQ(b.download(last), expected);
}

// --- run_until_done
// ---------------------------------------------------------------------------------------------------

TYPED_TEST_P(verbs, elements_take_as_many_passes_as_they_need)
{
    auto& b = this->b();
    constexpr uint needs[] = {0, 1, 5, 100, 0, 2, 1};
    for (const uint elements : {0u, 1u, 2u, 4u, 65u, 5000u})
        for (const uint first : {0u, 2050u}) {
            const uint n = first + elements + 100;
            const auto added = this->random_words(n, n);
            std::vector<glm::uvec2> states(n);
            for (uint i = 0; i < n; ++i)
                states[i] = {needs[(i - first) % std::size(needs)], i};
            // Those that need no pass, and those outside, keep even this.
            std::vector<uint> old(n, 77u);
            const auto added_ = this->up(added);
            // All at once, and stopped after some passes and going on.
            for (const std::vector<uint>& most :
                {std::vector<uint>{nowhere}, {0, 3, 1, 96, 10}, {100, 1}, {8, 8, 0, 83, 1, 5}}) {
                auto expected = states;
                auto expected_old = old;
                auto state = this->up(states);
                auto old_ = this->up(old);
                for (const uint passes : most) {
                    const auto p = b.template run_until_done<verb_kernels::countdown>(
                        {elements, first}, {.step = 1}, reads(added_), writes(state, old_), passes);
                    std::vector<std::uint64_t> active;
                    bool finished = true;
                    for (uint i = first; i < first + elements; ++i) {
                        uint pass = 0;
                        for (; pass < passes && expected[i].x != 0; ++pass) {
                            active.resize(std::max<std::size_t>(active.size(), pass + 1));
                            ++active[pass];
                            expected_old[i] = expected[i].x;
                            expected[i] = {expected[i].x - 1, expected[i].y * 3 + added[i]};
                        }
                        finished = finished && expected[i].x == 0;
                    }
                    const auto where = ::testing::Message()
                        << elements << " elements from " << first << ", at most " << passes << " passes";
                    EXPECT_EQ(p.passes, active.size()) << where;
                    EXPECT_EQ(p.active, active) << where;
                    EXPECT_EQ(p.finished, finished) << where;
                    EXPECT_EQ(b.download(state), expected) << where;
                    EXPECT_EQ(b.download(old_), expected_old) << where;
                }
            }
        }
}

// --- count
// ------------------------------------------------------------------------------------------------------------

TYPED_TEST_P(verbs, a_count_is_of_its_elements_and_exact)
{
    auto& b = this->b();
    const uint n = 9000;
    const auto words = this->random_words(n, 6);
    const auto random = this->up(words), all = this->up(std::vector<uint>(n, 1u));
    for (const uint first : {0u, 1u, 63u, 2048u, 3001u})
        for (const uint elements : {0u, 1u, 2u, 64u, 65u, 2048u, 5999u}) {
            const auto count = [&](const auto& buffer, uint marks) {
                return b.template count<verb_kernels::is_marked>({elements, first}, {.marks = marks}, reads(buffer));
            };
            const auto begin = words.begin() + first, end = begin + elements;
            EXPECT_EQ(count(all, 1), elements) << elements << " from " << first;
            EXPECT_EQ(count(all, 2), 0u) << elements << " from " << first;
            EXPECT_EQ(count(random, 8),
                static_cast<std::uint64_t>(std::count_if(begin, end, [](uint x) { return (x & 8u) != 0; })))
                << elements << " from " << first;
            if (elements == 0)
                continue;
            // The first and the last element, and the ones before and after these.
            std::vector<uint> ends(n + 1, 0u);
            ends[first] |= 1;
            ends[first + elements - 1] |= 2;
            ends[first > 0 ? first - 1 : n] |= 4;
            ends[first + elements] |= 4;
            const auto ends_ = this->up(ends);
            EXPECT_EQ(count(ends_, 1), 1u) << elements << " from " << first;
            EXPECT_EQ(count(ends_, 2), 1u) << elements << " from " << first;
            EXPECT_EQ(count(ends_, 4), 0u) << elements << " from " << first;
        }
}

// --- route
// ------------------------------------------------------------------------------------------------------------

TYPED_TEST_P(verbs, a_route_keeps_the_first_draws_and_adds_up_all)
{
    auto& b = this->b();
    for (const uint draws : {0u, 1u, 17u, 6000u})
        for (const uint destinations : {1u, 7u, 1000u})
            for (const uint m : {1u, 2u, b.caps().max_route_slots})
                for (const uint parts : {1u, 3u})
                    for (const uint first : {0u, 2045u}) {
                        if (destinations == 1000 && parts == 3 && m > 2)
                            continue; // as the others, and large
                        const uint n = first + draws, capacity = route_capacity(m);
                        random_source random(n + destinations + m);
                        std::vector<uint> sent(n);
                        std::vector<glm::vec4> amounts(n);
                        for (uint i = 0; i < n; ++i) {
                            sent[i] = random.below(8) == 0
                                ? nowhere - random.below(2)
                                : random.below(destinations + destinations / 10 + 1); // some to none
                            amounts[i] = {random(), -random(), 1e-3f * random(), 1};
                        }
                        const uint spare = destinations > 3 ? 3 : 0; // larger than needed: emptied too
                        std::vector<uint> slots((destinations + spare) * capacity, nowhere), arrived(destinations);
                        std::vector<glm::vec4> totals(destinations * parts + spare, glm::vec4(0));
                        const uint block = std::max(1u, (draws + parts - 1) / parts);
                        for (uint i = first; i < n; ++i) {
                            const uint d = sent[i];
                            if (d >= destinations)
                                continue;
                            if (arrived[d] < capacity)
                                slots[d * capacity + arrived[d]++] = 5 + 3 * i;
                            totals[d * parts + (i - first) / block] += amounts[i];
                        }
                        auto slots_ = this->up(std::vector<uint>(slots.size(), 5u));
                        auto totals_ = this->up(std::vector<glm::vec4>(totals.size(), glm::vec4(5)));
                        b.template route<verb_kernels::delivery>({draws, first}, {.first_payload = 5},
                            reads(this->up(sent), this->up(amounts)), destinations, m, slots_, totals_);
                        const auto where = ::testing::Message()
                            << draws << " draws from " << first << " to " << destinations << " destinations, m " << m
                            << ", " << parts << " parts";
                        EXPECT_EQ(count_different_bits(b.download(slots_), slots), 0u) << where;
                        EXPECT_EQ(count_different_bits(b.download(totals_), totals), 0u) << where;
                    }
}

// --- what it says of itself
// -------------------------------------------------------------------------------------------

TYPED_TEST_P(verbs, passes_are_counted_by_kernel)
{
    auto& b = this->b();
    const uint n = 100;
    const auto passes = [&](const char* kernel) {
        const auto found = b.costs().find(kernel);
        return found == b.costs().end() ? 0 : found->second.passes;
    };
    const std::array names{"shifted", "countdown", "is_marked", "delivery"};
    std::array<std::uint64_t, 4> before{};
    std::transform(names.begin(), names.end(), before.begin(), passes);
    const auto in = this->up(std::vector<uint>(n, 1u));
    const auto amounts = this->up(std::vector<glm::vec4>(n));
    auto out = b.template make<uint>(n);
    auto totals = b.template make<glm::vec4>(n);
    auto state = this->up(std::vector<glm::uvec2>(n, glm::uvec2(9, 0)));
    for (int pass = 0; pass < 3; ++pass)
        b.template run<verb_kernels::shifted>(n, {.added = 1}, reads(in), writes(out));
    for (const uint most : {4u, 10u})
        b.template run_until_done<verb_kernels::countdown>(n, {.step = 1}, reads(in), writes(state, out), most);
    for (int again = 0; again < 2; ++again)
        b.template count<verb_kernels::is_marked>(n, {.marks = 1}, reads(in));
    b.template route<verb_kernels::delivery>(n, {.first_payload = 0}, reads(in, amounts), 10, 1, out, totals);
    b.finish();
    const std::array<std::uint64_t, 4> expected{3, 9, 2, 1};
    for (std::size_t k = 0; k < names.size(); ++k)
        EXPECT_EQ(passes(names[k]) - before[k], expected[k]) << names[k];
}

TYPED_TEST_P(verbs, finish_may_be_called_at_any_time)
{
    auto& b = this->b();
    const uint n = 5000;
    const auto in = this->random_words(n, 7);
    const auto in_ = this->up(in);
    b.finish();
    b.finish();
    auto out = b.template make<uint>(n);
    b.template run<verb_kernels::shifted>(n, {.added = 0}, reads(in_), writes(out));
    b.finish();
    b.finish();
    std::vector<uint> expected(n);
    for (uint i = 0; i < n; ++i)
        expected[i] = in[i] + i;
    EXPECT_EQ(b.download(out), expected);
    b.finish();
    EXPECT_EQ(b.download(out), expected); // reading changes nothing
}

TYPED_TEST_P(verbs, capabilities_can_be_worked_with)
{
    const auto& c = this->b().caps();
    EXPECT_FALSE(c.backend.empty());
    EXPECT_FALSE(c.device.empty());
    EXPECT_GE(c.max_elements, 1u << 20);
    EXPECT_LE(c.max_elements, 0xFFFFFFFFu); // elements are numbered by 32 bits
    EXPECT_GE(c.max_route_slots, 1u);
    EXPECT_LE(c.max_route_slots, 16u);
    EXPECT_GT(c.cells_a_radius, 0.0f);
    EXPECT_EQ(&c, &this->b().caps());
}

REGISTER_TYPED_TEST_SUITE_P(verbs, buffers_keep_delicate_floats, buffers_move_and_may_outlive_their_backend,
    a_buffer_may_go_before_the_passes_that_use_it_are_done, memory_is_given_back,
    a_buffer_beyond_the_limit_is_refused_and_nothing_else, too_small_buffers_are_refused_by_name,
    a_pass_computes_its_elements_and_no_other, a_pass_has_eight_inputs_and_eight_outputs_of_mixed_types,
    states_change_in_place_and_outputs_beside_them, switches_are_on_and_off_one_by_one, parameters_of_every_kind_arrive,
    a_pass_reads_one_part_of_a_buffer_and_writes_another, each_pass_sees_what_all_before_it_wrote,
    elements_take_as_many_passes_as_they_need, a_count_is_of_its_elements_and_exact,
    a_route_keeps_the_first_draws_and_adds_up_all, passes_are_counted_by_kernel, finish_may_be_called_at_any_time,
    capabilities_can_be_worked_with);

} // namespace photongrid::testing
