#version 330 core
// The rectangle that the image covers on the screen; its first row is on top.
uniform vec4 rectangle;  // left, top, right, bottom in clip space
out vec2 place;
void main() {
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
    place = corner;
    gl_Position = vec4(mix(rectangle.xy, rectangle.zw, corner), 0.0, 1.0);
}
