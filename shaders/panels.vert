#version 330 core
// The panels' triangles, in points.
uniform vec4 to_clip;  // scale and offset
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 texcoord;
layout(location = 2) in vec4 colour;
out vec2 at;
out vec4 tint;
void main() {
    at = texcoord;
    tint = colour;
    gl_Position = vec4(position * to_clip.xy + to_clip.zw, 0.0, 1.0);
}
