// The point of search number i of a round, and its surface normal.
struct Params {
    uint words;
};
PARAMS(Params)
INPUT(0, uint, searched) // searched_words.glsl
INPUT(1, uint, sums)     // inclusive prefix sums of their bits
INPUT(2, vec4, points)
INPUT(3, vec4, surfaces)
OUTPUT(0, vec4, point)
OUTPUT(1, vec4, surface)

#include <photongrid/map/first_sum_above.glsl>

uint searched_pixel(uint i)
{
    uint at = first_sum_above(i, args.words);
    uint word = searched(at);
    uint left = i + uint(bitCount(word)) - sums(at); // bits of the word before it
    for (uint b = 0u; b < left; ++b)
        word &= word - 1u; // clears the lowest
    return 32u * at + uint(findLSB(word));
}

void kernel(uint i)
{
    uint pixel = searched_pixel(i);
    point = points(pixel);
    surface = surfaces(pixel);
}
