#version 450
// A triangle that covers the viewport: the paper's "screen sized quad" without a diagonal.
void main()
{
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
