// The first of `count` inclusive prefix sums that is above `rank`; the last must be. Included by kernels after their
// input `sums`.
uint first_sum_above(uint rank, uint count)
{
    uint low = 0u;
    uint high = count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (sums(middle) > rank)
            high = middle;
        else
            low = middle + 1u;
    }
    return low;
}
