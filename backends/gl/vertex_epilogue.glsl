// Draws gl_VertexID's point into its destination's block of m x m pixels, or nowhere.
layout(location = 1) uniform uvec4 blocks_; // blocks in a row of the target; destinations; m; rows of blocks
layout(location = 2) uniform uvec4 sums_;  // blocks per destination, draws per block, first draw
flat out uint payload_out_;
flat out vec4 amount_out_;
void main()
{
    kernel(uint(gl_VertexID));
    uint d = output_0();
    payload_out_ = output_1();
    amount_out_ = output_2();
    gl_PointSize = float(blocks_.z);
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // outside the viewport: clipped
    if (d < blocks_.y) {
        uint block = d * sums_.x + (uint(gl_VertexID) - sums_.z) / sums_.y;
        uvec2 cell = uvec2(block % blocks_.x, block / blocks_.x);
        gl_Position = vec4(float(2u * cell.x + 1u) / float(blocks_.x) - 1.0, float(2u * cell.y + 1u) / float(blocks_.w) - 1.0, 0.0, 1.0);
    }
}
