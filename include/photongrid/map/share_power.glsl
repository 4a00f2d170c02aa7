// Divides the power of a photon of a routed map among its entries, and notes their number, which standard errors need.
struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uint, entries) // of the photon that entry i holds
STATE(0, vec4, power)   // rgb, W; w: entries

void kernel(uint i)
{
    float number = float(entries(i));
    float share = 1.0f / number;
    power = vec4(power.x * share, power.y * share, power.z * share, number);
}
