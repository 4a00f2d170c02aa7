// The index of cell i's first pair among the sorted pairs, and the number of its pairs: two binary searches in one pass
// (2.2.1). An empty cell begins where the next cell does.
struct Params {
    uint pairs; // number of sorted pairs
};
PARAMS(Params)
INPUT(0, uvec2, pairs)
OUTPUT(0, uvec2, cell) // x: first, y: count

// The number of keys that are less than `key`.
uint keys_below(uint key)
{
    uint low = 0u;
    uint high = args.pairs;
    while (low < high) {
        uint middle = low + (high - low) / 2u;
        if (pairs(middle).x < key)
            low = middle + 1u;
        else
            high = middle;
    }
    return low;
}

void kernel(uint i)
{
    uint first = keys_below(i);
    cell = uvec2(first, keys_below(i + 1u) - first);
}
