// Copies pixels, so that the picture can be displayed while rendering continues.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, vec4, original)
OUTPUT(0, vec4, light)

void kernel(uint i)
{
    light = original(i);
}
