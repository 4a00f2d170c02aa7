// Transposes the lists of neighbour_pair.glsl, so that the entries of one point are contiguous.
struct Params {
    uint points;
    uint k;
};
PARAMS(Params)
INPUT(0, uvec2, pairs)
OUTPUT(0, uint, id)
OUTPUT(1, float, distance2)

void kernel(uint i)
{
    uint point = i / args.k;
    uint entry = i - point * args.k;
    uvec2 pair = pairs(entry * args.points + point);
    id = pair.y;
    distance2 = uintBitsToFloat(pair.x);
}
