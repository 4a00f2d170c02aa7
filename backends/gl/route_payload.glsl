#version 450
// Writes the payload to the slot that the stencil test has selected (2.2.2, figure 5).
flat in uint payload_out_;
layout(location = 0) out uint slot_;
void main()
{
    slot_ = payload_out_;
}
