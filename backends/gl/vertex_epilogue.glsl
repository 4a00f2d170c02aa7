// Draw gl_VertexID becomes a point of m x m pixels at its destination's place, or none.
layout(location = 1) uniform uvec4 place_; // places: in a row of the target; destinations; m; rows of places
layout(location = 2) uniform uvec4 parts_; // places of a destination, draws that share one, first draw
flat out uint payload_out_;
flat out vec4 amount_out_;
void main()
{
    kernel(uint(gl_VertexID));
    uint d = output_0();
    payload_out_ = output_1();
    amount_out_ = output_2();
    gl_PointSize = float(place_.z);
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // outside: clipped
    if (d < place_.y) {
        uint place = d * parts_.x + (uint(gl_VertexID) - parts_.z) / parts_.y;
        uvec2 cell = uvec2(place % place_.x, place / place_.x);
        gl_Position = vec4(float(2u * cell.x + 1u) / float(place_.x) - 1.0, float(2u * cell.y + 1u) / float(place_.w) - 1.0, 0.0, 1.0);
    }
}
