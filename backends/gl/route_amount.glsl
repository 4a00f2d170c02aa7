#version 450
// Amounts add up by blending: exact counts and flux, which an 8-bit stencil cannot hold.
flat in vec4 amount_out_;
layout(location = 0) out vec4 total_;
void main()
{
    total_ = amount_out_;
}
