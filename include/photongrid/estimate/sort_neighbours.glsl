// One step of the sorting network of bitonic_step.glsl, on the lists of all points at once (neighbour_pair.glsl).
struct Params {
    uint points;
    uint run;    // length of the runs being merged: 2, 4, … entries of a list
    uint stride; // distance between partners: run / 2, … 1
};
PARAMS(Params)
INPUT(0, uvec2, pairs)
OUTPUT(0, uvec2, pair)

void kernel(uint i)
{
    uint entry = i / args.points;
    uint point = i - entry * args.points;
    uvec2 mine = pairs(i);
    uvec2 partner = pairs((entry ^ args.stride) * args.points + point);
    bool rising = (entry & args.run) == 0u;
    bool low = (entry & args.stride) == 0u;
    bool mine_is_less = mine.x < partner.x || (mine.x == partner.x && mine.y < partner.y);
    pair = (low == rising) == mine_is_less ? mine : partner;
}
