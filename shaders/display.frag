#version 330 core
// From the renderer's numbers to the encoded colours on the screen, pixel by pixel: exposure, tone
// curve, false colour, channels, differences of two images. The same as shown_colour() and
// seen_pixel() in app/viewer, which write PNG files; curves as in renderer/image/tonemap.cpp, with
// their sources there. A difference lies on the pixels of `other`, A; `values`, B, may be coarser.
uniform sampler2D values;
uniform int mode;       // DisplayMode in display_maths.h
uniform int curve;      // Curve in image/tonemap.h
uniform float scale;    // on the values, or on their difference
uniform vec2 range;     // of stops, depths or differences
uniform vec3 ramp[10];  // of false colours
uniform sampler2D other;
uniform vec2 other_lies;        // from the first corner of `values`, in pixels
uniform float pixels;           // of `other` along one of `values`
uniform float relative_floor;   // below A^2
uniform vec3 signed_ramp[11];
out vec4 encoded;

float srgb(float x) {
    if (!(x > 0.0)) return 0.0;
    if (x >= 1.0) return 1.0;
    return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
}

vec3 srgb(vec3 c) { return vec3(srgb(c.r), srgb(c.g), srgb(c.b)); }

vec3 filmic(vec3 c) {
    vec3 x = min(max(c, vec3(0.0)), vec3(1e6));
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

float hyperbola(float x) { return x / pow(1.0 + pow(x, 1.5), 2.0 / 3.0); }

float hyperbola_scale(float width, float height) {
    return 2.0 * width / pow(pow(2.0 * width / height, 1.5) - 1.0, 2.0 / 3.0);
}

float agx_sigmoid(float x) {
    const float pivot_x = 10.0 / 16.5;
    float pivot_y = srgb(0.18);
    if (x < pivot_x) {
        float s = hyperbola_scale(pivot_x, pivot_y);
        return pivot_y - s * hyperbola(2.0 * (pivot_x - x) / s);
    }
    float s = hyperbola_scale(1.0 - pivot_x, 1.0 - pivot_y);
    return pivot_y + s * hyperbola(2.0 * (x - pivot_x) / s);
}

vec3 agx(vec3 exposed) {
    vec3 c = min(max(exposed, vec3(0.0)), vec3(1e6));
    c = 0.8 * c + vec3(0.2 * dot(vec3(0.2120, 0.3922, 0.3958), c));
    vec3 x = clamp((log2(max(c, vec3(1e-10)) / 0.18) + 10.0) / 16.5, 0.0, 1.0);
    return vec3(agx_sigmoid(x.r), agx_sigmoid(x.g), agx_sigmoid(x.b));
}

vec3 tone(vec3 c) {
    if (curve == 2) return agx(c);
    return srgb(curve == 1 ? filmic(c) : c);
}

vec3 ramp_at(float x) {
    float p = clamp(x, 0.0, 1.0) * 9.0;
    int i = min(int(p), 8);
    return mix(ramp[i], ramp[i + 1], p - float(i));
}

vec3 stops(float light) {
    if (!(light > 0.0)) return vec3(0.0);
    return ramp_at((log2(light) - range.x) / (range.y - range.x));
}

vec3 difference() {
    const vec3 luminance = vec3(0.2126, 0.7152, 0.0722);
    vec2 place = (floor(gl_FragCoord.xy) + 0.5 + other_lies) / pixels;
    ivec2 texel = clamp(ivec2(floor(place)), ivec2(0), textureSize(values, 0) - 1);
    float a = dot(texelFetch(other, ivec2(gl_FragCoord.xy), 0).rgb, luminance);
    float d = dot(texelFetch(values, texel, 0).rgb, luminance) - a;
    if (mode == 7) d /= sqrt(a * a + relative_floor);
    float p = clamp((d * scale - range.x) / (range.y - range.x), 0.0, 1.0) * 10.0;
    int i = min(int(p), 9);
    return mix(signed_ramp[i], signed_ramp[i + 1], p - float(i));
}

// A colour for a whole number, far from those of its neighbours.
vec3 object_colour(float number) {
    if (number <= 0.0) return vec3(0.0);
    vec3 turns = fract(number * vec3(0.6180339887, 0.7548776662, 0.5698402910));
    return 0.25 + 0.65 * turns;
}

void main() {
    if (mode >= 6) {
        encoded = vec4(difference(), 1.0);
        return;
    }
    vec3 v = texelFetch(values, ivec2(gl_FragCoord.xy), 0).rgb;
    vec3 c;
    if (mode == 0)
        c = tone(v * scale);
    else if (mode == 1)
        c = stops(dot(v, vec3(0.2126, 0.7152, 0.0722)) * scale);
    else if (mode == 2)
        c = srgb(v);
    else if (mode == 3)
        c = dot(v, v) > 0.0 ? 0.5 * v + 0.5 : vec3(0.0);
    else if (mode == 4)
        c = vec3(v.r > 0.0 ? mix(0.95, 0.1, clamp((v.r - range.x) / (range.y - range.x), 0.0, 1.0))
                           : 0.0);
    else
        c = object_colour(v.r);
    encoded = vec4(c, 1.0);
}
