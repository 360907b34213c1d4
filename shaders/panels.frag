#version 330 core
uniform sampler2D atlas;
in vec2 at;
in vec4 tint;
out vec4 colour;
void main() { colour = tint * texture(atlas, at); }
