// As many passes as the state says; beside it, what it was before the last of them.
struct Params {
    uint step;
};
PARAMS(Params)
INPUT(0, uint, added)
STATE(0, uvec2, state)
OUTPUT(1, uint, old)

bool done() { return state.x == 0u; }

void kernel(uint i)
{
    old = state.x;
    state = uvec2(state.x - args.step, state.y * 3u + added(i));
}
