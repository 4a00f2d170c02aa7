// Zeroes.
struct Params {
    uint unused;
};
PARAMS(Params)
OUTPUT(0, vec4, light)

void kernel(uint i)
{
    light = vec4(0.0f, 0.0f, 0.0f, 0.0f);
}
