// Which switches are on.
struct Params {
    uint factor;
};
PARAMS(Params)
SWITCH(0, LOWEST)
SWITCH(5, MIDDLE)
SWITCH(31, HIGHEST)
OUTPUT(0, uint, result)

void kernel(uint i)
{
    result = i * args.factor;
    if (LOWEST)
        result = result + 1u;
    if (MIDDLE)
        result = result + 2u;
    if (HIGHEST)
        result = result + 4u;
}
