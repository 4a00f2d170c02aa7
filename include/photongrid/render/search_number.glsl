// The number of a pixel's search in a round. Included by kernels after their inputs `searched` (searched_words.glsl)
// and `sums`, the inclusive prefix sums of its bits.
uint search_number(uint pixel)
{
    uint word = pixel / 32u;
    uint before = word > 0u ? sums(word - 1u) : 0u;
    return before + uint(bitCount(searched(word) & ((1u << pixel % 32u) - 1u)));
}
