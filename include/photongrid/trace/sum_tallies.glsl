// Sums 16 consecutive tallies. Repeated passes sum any number of tallies.
struct Params {
    uint terms; // number of tallies
};
PARAMS(Params)
INPUT(0, uvec4, ends)
INPUT(1, uvec4, hits)
OUTPUT(0, uvec4, ends_sum)
OUTPUT(1, uvec4, hits_sum)

void kernel(uint i)
{
    ends_sum = uvec4(0u, 0u, 0u, 0u);
    hits_sum = uvec4(0u, 0u, 0u, 0u);
    for (uint n = i * 16u; n < i * 16u + 16u; ++n) {
        if (n < args.terms) {
            ends_sum += ends(n);
            hits_sum += hits(n);
        }
    }
}
