// One step of an inclusive prefix sum (Hillis and Steele 1986, with four terms per step instead of two): after strides
// 1, 4, 16, … element i is the sum of elements 0 to i.
struct Params {
    uint stride; // below 2^30
};
PARAMS(Params)
INPUT(0, uint, terms)
OUTPUT(0, uint, sum)

void kernel(uint i)
{
    sum = terms(i);
    if (i >= args.stride)
        sum += terms(i - args.stride);
    if (i >= 2u * args.stride)
        sum += terms(i - 2u * args.stride);
    if (i >= 3u * args.stride)
        sum += terms(i - 3u * args.stride);
}
