#version 330 core
// A line with soft edges, and where it is in sight a dark rim that keeps it legible over any image.
uniform float pixel;  // of the screen, in points
in vec2 place;
flat in vec2 form;
flat in vec4 tint;
out vec4 colour;

float inside(float distance) { return clamp(0.5 - distance / pixel, 0.0, 1.0); }

void main() {
    float beside = abs(place.y) - form.x;
    if (form.y > 0.0) {
        // Dashes are as long as their gaps.
        float in_period = mod(place.x, form.y);
        beside = max(beside, abs(in_period - 0.25 * form.y) - 0.25 * form.y);
    }
    float line = inside(beside), rim = form.y > 0.0 ? 0.0 : inside(beside - 1.2);
    float alpha = tint.a * max(line, 0.55 * rim);
    if (!(alpha > 0.0)) discard;
    colour = vec4(tint.rgb * line, alpha);
}
