#version 330 core
// The lines of the path inspector, each a rectangle; in points.
uniform vec4 to_clip;  // scale and offset
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 along_across;  // from the line's start, and from its middle
layout(location = 2) in vec2 half_dash;     // half of the width; dash and gap, 0: no gaps
layout(location = 3) in vec4 colour;
out vec2 place;
flat out vec2 form;
flat out vec4 tint;
void main() {
    place = along_across;
    form = half_dash;
    tint = colour;
    gl_Position = vec4(position * to_clip.xy + to_clip.zw, 0.0, 1.0);
}
