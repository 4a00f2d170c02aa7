// Weights of 1.
struct Params {
    uint unused;
};
PARAMS(Params)
OUTPUT(0, vec4, weight)

void kernel(uint i)
{
    weight = vec4(1.0f, 1.0f, 1.0f, 0.0f);
}
