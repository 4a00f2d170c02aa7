#version 450
// The stencil test has chosen the slot; the payload goes there (2.2.2, figure 5).
flat in uint payload_out_;
layout(location = 0) out uint slot_;
void main()
{
    slot_ = payload_out_;
}
