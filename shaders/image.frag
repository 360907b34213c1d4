#version 330 core
uniform sampler2D image;
in vec2 place;
out vec4 colour;
void main() { colour = vec4(texture(image, place).rgb, 1.0); }
