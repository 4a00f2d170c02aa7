#version 450
// Sums amounts by blending, because an 8-bit stencil cannot hold exact counts or powers.
flat in vec4 amount_out_;
layout(location = 0) out vec4 total_;
void main()
{
    total_ = amount_out_;
}
