// Draw i goes to destination x of the i-th pair, if that exists.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uvec2, pairs)
INPUT(1, vec4, amounts)
OUTPUT(0, uint, destination)
OUTPUT(1, uint, payload)
OUTPUT(2, vec4, amount)

void kernel(uint i)
{
    destination = pairs(i).x;
    payload = pairs(i).y;
    amount = amounts(i);
}
