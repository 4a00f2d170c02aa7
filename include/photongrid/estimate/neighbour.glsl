// Entry by entry, point by point: the lists of neighbours as their reader wants them (neighbour_pair.glsl).
struct Params {
    uint points;
    uint wanted; // k
};
PARAMS(Params)
INPUT(0, uvec2, pairs)
OUTPUT(0, uint, id)
OUTPUT(1, float, distance2)

void kernel(uint i)
{
    uint point = i / args.wanted;
    uint entry = i - point * args.wanted;
    uvec2 pair = pairs(entry * args.points + point);
    id = pair.y;
    distance2 = uintBitsToFloat(pair.x);
}
