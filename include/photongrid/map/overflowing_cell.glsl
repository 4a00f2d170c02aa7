// True where more photons were destined for a cell than it has slots.
struct Params {
    uint capacity;
};
PARAMS(Params)
INPUT(0, vec4, totals)

bool holds(uint i)
{
    return totals(i).w > float(args.capacity);
}
