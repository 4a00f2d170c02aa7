// LOAD_STATES_(at): load_state_B(at) for every slot B that is a STATE. The backend defines it.
void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    uint i = uint(at.y) << 11u | uint(at.x);
    if (i - launch_.x >= launch_.y) {
        discard;
    } else {
        LOAD_STATES_(at)
#if defined(RUN_)
        kernel(i);
#elif defined(UNTIL_DONE_)
        if (done())
            discard; // keeps the element's final state
        else
            kernel(i);
#elif defined(NOT_DONE_)
        if (done())
            discard;
#elif defined(HOLDS_)
        if (!holds(i))
            discard;
#endif
    }
}
