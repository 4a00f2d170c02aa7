// Converts the length of a pass's list into the workgroups of its indirect dispatch.
struct Params {
    uint pass_number;
    uint most; // the most workgroups in one dimension
};
PARAMS(Params)
layout(std430, binding = 0) buffer control_block_ { uint control_[]; };

void main()
{
    if (element_() != 0u)
        return;
    uint at = args.pass_number * 8u;
    uint groups = (control_[at + 3u] + uint(GROUP) - 1u) / uint(GROUP);
    uint rows = (groups + args.most - 1u) / args.most;
    uint columns = rows == 0u ? 0u : (groups + rows - 1u) / rows;
    control_[at] = columns;
    control_[at + 1u] = rows;
    control_[at + 2u] = 1u;
}
