// Whether a number is odd.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uint, numbers)

bool holds(uint i) { return (numbers(i) & 1u) == 1u; }
