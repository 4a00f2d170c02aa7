// One step of a bitonic merge sort of (key, value) pairs (2.2.1, figures 2 and 3): element i keeps the smaller or the
// larger of itself and its partner. Both members of a pair are compared, so that equal keys keep all values and the
// order is reproducible.
struct Params {
    uint run;    // length of the runs being merged: 2, 4, … n
    uint stride; // distance between partners: run / 2, … 1
};
PARAMS(Params)
INPUT(0, uvec2, pairs) // x: key, y: value
OUTPUT(0, uvec2, pair)

void kernel(uint i)
{
    uvec2 mine = pairs(i);
    uvec2 partner = pairs(i ^ args.stride);
    bool rising = (i & args.run) == 0u;
    bool low = (i & args.stride) == 0u;
    bool mine_is_less = mine.x < partner.x || (mine.x == partner.x && mine.y < partner.y);
    pair = (low == rising) == mine_is_less ? mine : partner;
}
