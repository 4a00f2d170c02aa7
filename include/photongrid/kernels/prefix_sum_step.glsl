// One step of an inclusive prefix sum by doubling (Hillis and Steele 1986): after steps 1, 2, 4, … element i holds the sum
// of elements 0 to i.
struct Params {
    uint stride;
};
PARAMS(Params)
INPUT(0, uint, terms)
OUTPUT(0, uint, sum)

void kernel(uint i)
{
    sum = terms(i);
    if (i >= args.stride)
        sum += terms(i - args.stride);
}
