// Sets vectors to zero.
struct Params {
    uint unused;
};
PARAMS(Params)
OUTPUT(0, vec4, zero)

void kernel(uint i)
{
    zero = vec4(0.0f, 0.0f, 0.0f, 0.0f);
}
