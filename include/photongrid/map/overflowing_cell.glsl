// True for a cell that received more photons than it has slots.
struct Params {
    uint capacity;
};
PARAMS(Params)
INPUT(0, vec4, totals)

bool holds(uint i)
{
    return totals(i).w > float(args.capacity);
}
