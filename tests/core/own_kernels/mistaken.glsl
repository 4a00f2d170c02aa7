// A mistake that C++ does not see: GLSL has no `auto`.
struct Params {
    uint unused;
};
PARAMS(Params)
OUTPUT(0, uint, result)

void kernel(uint i)
{
    auto twice = 2u * i;
    result = twice;
}
