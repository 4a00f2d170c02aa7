// Several steps of a bitonic merge sort in one pass, in place (2.2.1): an invocation has the 2^STEPS pairs that STEPS
// consecutive strides compare with each other only. The host defines STEPS, 1 to 4. SORT_BLOCKS: the pass sorts blocks
// of 2^STEPS consecutive, unsorted pairs.
struct Params {
    uint pairs;  // a power of two
    uint run;    // length of the runs being merged
    uint stride; // smallest of the strides
};
PARAMS(Params)
layout(std430, binding = 0) buffer pairs_block_ { uvec2 pairs_[]; };

uvec2 p0, p1, p2, p3, p4, p5, p6, p7, p8, p9, p10, p11, p12, p13, p14, p15;

#define EXCHANGE(A, B, RISING)                                                \
    {                                                                         \
        bool less = A.x < B.x || (A.x == B.x && A.y < B.y);                   \
        uvec2 first = less == (RISING) ? A : B;                               \
        B = less == (RISING) ? B : A;                                         \
        A = first;                                                            \
    }

// The last N steps of a merge of 2^N pairs, starting with the largest stride.
void merge_2(bool rising) { EXCHANGE(p0, p1, rising) }
void merge_4(bool rising)
{
    EXCHANGE(p0, p2, rising)
    EXCHANGE(p1, p3, rising)
    EXCHANGE(p0, p1, rising)
    EXCHANGE(p2, p3, rising)
}
void merge_8(bool rising)
{
    EXCHANGE(p0, p4, rising)
    EXCHANGE(p1, p5, rising)
    EXCHANGE(p2, p6, rising)
    EXCHANGE(p3, p7, rising)
    EXCHANGE(p0, p2, rising)
    EXCHANGE(p1, p3, rising)
    EXCHANGE(p4, p6, rising)
    EXCHANGE(p5, p7, rising)
    EXCHANGE(p0, p1, rising)
    EXCHANGE(p2, p3, rising)
    EXCHANGE(p4, p5, rising)
    EXCHANGE(p6, p7, rising)
}
void merge_16(bool rising)
{
    EXCHANGE(p0, p8, rising)
    EXCHANGE(p1, p9, rising)
    EXCHANGE(p2, p10, rising)
    EXCHANGE(p3, p11, rising)
    EXCHANGE(p4, p12, rising)
    EXCHANGE(p5, p13, rising)
    EXCHANGE(p6, p14, rising)
    EXCHANGE(p7, p15, rising)
    EXCHANGE(p0, p4, rising)
    EXCHANGE(p1, p5, rising)
    EXCHANGE(p2, p6, rising)
    EXCHANGE(p3, p7, rising)
    EXCHANGE(p8, p12, rising)
    EXCHANGE(p9, p13, rising)
    EXCHANGE(p10, p14, rising)
    EXCHANGE(p11, p15, rising)
    EXCHANGE(p0, p2, rising)
    EXCHANGE(p1, p3, rising)
    EXCHANGE(p4, p6, rising)
    EXCHANGE(p5, p7, rising)
    EXCHANGE(p8, p10, rising)
    EXCHANGE(p9, p11, rising)
    EXCHANGE(p12, p14, rising)
    EXCHANGE(p13, p15, rising)
    EXCHANGE(p0, p1, rising)
    EXCHANGE(p2, p3, rising)
    EXCHANGE(p4, p5, rising)
    EXCHANGE(p6, p7, rising)
    EXCHANGE(p8, p9, rising)
    EXCHANGE(p10, p11, rising)
    EXCHANGE(p12, p13, rising)
    EXCHANGE(p14, p15, rising)
}
#if SORT_BLOCKS
// Sorts runs of 2, 4 and 8, whose direction depends on their position in the block.
void sort_runs_of_8()
{
    EXCHANGE(p0, p1, true)
    EXCHANGE(p2, p3, false)
    EXCHANGE(p4, p5, true)
    EXCHANGE(p6, p7, false)
    EXCHANGE(p8, p9, true)
    EXCHANGE(p10, p11, false)
    EXCHANGE(p12, p13, true)
    EXCHANGE(p14, p15, false)

    EXCHANGE(p0, p2, true)
    EXCHANGE(p1, p3, true)
    EXCHANGE(p4, p6, false)
    EXCHANGE(p5, p7, false)
    EXCHANGE(p8, p10, true)
    EXCHANGE(p9, p11, true)
    EXCHANGE(p12, p14, false)
    EXCHANGE(p13, p15, false)
    EXCHANGE(p0, p1, true)
    EXCHANGE(p2, p3, true)
    EXCHANGE(p4, p5, false)
    EXCHANGE(p6, p7, false)
    EXCHANGE(p8, p9, true)
    EXCHANGE(p10, p11, true)
    EXCHANGE(p12, p13, false)
    EXCHANGE(p14, p15, false)

    EXCHANGE(p0, p4, true)
    EXCHANGE(p1, p5, true)
    EXCHANGE(p2, p6, true)
    EXCHANGE(p3, p7, true)
    EXCHANGE(p8, p12, false)
    EXCHANGE(p9, p13, false)
    EXCHANGE(p10, p14, false)
    EXCHANGE(p11, p15, false)
    EXCHANGE(p0, p2, true)
    EXCHANGE(p1, p3, true)
    EXCHANGE(p4, p6, true)
    EXCHANGE(p5, p7, true)
    EXCHANGE(p8, p10, false)
    EXCHANGE(p9, p11, false)
    EXCHANGE(p12, p14, false)
    EXCHANGE(p13, p15, false)
    EXCHANGE(p0, p1, true)
    EXCHANGE(p2, p3, true)
    EXCHANGE(p4, p5, true)
    EXCHANGE(p6, p7, true)
    EXCHANGE(p8, p9, false)
    EXCHANGE(p10, p11, false)
    EXCHANGE(p12, p13, false)
    EXCHANGE(p14, p15, false)
}
#endif

#if STEPS == 1
#define EACH(F) F(0) F(1)
#elif STEPS == 2
#define EACH(F) F(0) F(1) F(2) F(3)
#elif STEPS == 3
#define EACH(F) F(0) F(1) F(2) F(3) F(4) F(5) F(6) F(7)
#else
#define EACH(F) F(0) F(1) F(2) F(3) F(4) F(5) F(6) F(7) F(8) F(9) F(10) F(11) F(12) F(13) F(14) F(15)
#endif
#define LOAD(N) p##N = pairs_[base + uint(N) * args.stride];
#define STORE(N) pairs_[base + uint(N) * args.stride] = p##N;

void main()
{
    uint t = element_();
    if (t >= args.pairs >> STEPS)
        return;
    uint below = t & (args.stride - 1u);
    uint base = ((t - below) << STEPS) + below;
    bool rising = (base & args.run) == 0u;
    EACH(LOAD)
#if SORT_BLOCKS
    sort_runs_of_8();
#endif
#if STEPS == 1
    merge_2(rising);
#elif STEPS == 2
    merge_4(rising);
#elif STEPS == 3
    merge_8(rising);
#else
    merge_16(rising);
#endif
    EACH(STORE)
}
