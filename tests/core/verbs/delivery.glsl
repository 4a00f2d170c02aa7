// Draws with destinations and amounts in buffers.
struct Params {
    uint first_payload;
};
PARAMS(Params)
INPUT(0, uint, destinations)
INPUT(1, vec4, amounts)
OUTPUT(0, uint, destination)
OUTPUT(1, uint, payload)
OUTPUT(2, vec4, amount)

void kernel(uint i)
{
    destination = destinations(i);
    payload = args.first_payload + i * 3u;
    amount = amounts(i);
}
