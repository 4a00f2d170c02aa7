// run and run_until_done on any backend.
#pragma once

#include "verbs.hpp"

namespace photongrid::testing {

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

// Longer than others because each of sixteen buffers has a name and contents of its own.
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
    b.template run_until_done<verb_kernels::countdown>(n, {.step = 1}, reads(last), writes(state, old), all_passes);
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
                {std::vector<uint>{all_passes}, {0, 3, 1, 96, 10}, {100, 1}, {8, 8, 0, 83, 1, 5}}) {
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

} // namespace photongrid::testing
