// Reads element i - args.stride of its own output: the frame before.
struct Params {
    uint stride;
};
PARAMS(Params)
INPUT(0, uvec2, frames)
OUTPUT(0, uvec2, frame)

void kernel(uint i) { frame = frames(i - args.stride) + uvec2(1u, i); }
