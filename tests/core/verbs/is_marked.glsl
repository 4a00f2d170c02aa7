// Whether an element has one of the marks.
struct Params {
    uint marks;
};
PARAMS(Params)
INPUT(0, uint, marked)

bool holds(uint i) { return (marked(i) & args.marks) != 0u; }
