// From the embedded half floats to pixels that a canvas shows: the picture at an exposure, its
// signed difference to the reference, its relative error. viewer.js puts them on screen.
"use strict";

midway.half_values = () => {
    const table = new Float32Array(65536);
    for (let bits = 0; bits < 65536; ++bits) {
        const exponent = bits >> 10 & 31, fraction = bits & 1023;
        const size = exponent === 0 ? fraction * 2 ** -24
            : exponent === 31 ? (fraction ? NaN : Infinity) : (1 + fraction / 1024) * 2 ** (exponent - 15);
        table[bits] = bits & 0x8000 ? -size : size;
    }
    return table;
};

// Red, green, blue of every pixel, in the units of the render.
midway.decode_image = (id, scale, table) => {
    const text = atob(document.getElementById(id).textContent.trim());
    const values = new Float32Array(text.length / 2);
    for (let i = 0; i < values.length; ++i)
        values[i] = table[text.charCodeAt(2 * i) | text.charCodeAt(2 * i + 1) << 8] * scale;
    return values;
};

midway.luminance = (v, i) => 0.2126 * v[i] + 0.7152 * v[i + 1] + 0.0722 * v[i + 2];

// Encoded sRGB (IEC 61966-2-1) of linear values in steps of 1 / 8192.
midway.srgb_table = Uint8ClampedArray.from({ length: 8193 }, (_, i) => {
    const v = i / 8192;
    return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
});

// Colours between the given ones, evenly spaced, at t in [0, 1].
midway.ramp = (colours, t) => {
    const at = Math.min(Math.max(t, 0), 1) * (colours.length - 1);
    const i = Math.min(Math.floor(at), colours.length - 2), f = at - i;
    return colours[i].map((c, k) => c + f * (colours[i + 1][k] - c));
};
// Too dark blue, right white, too bright red; and dark for small, light for large errors.
midway.signed_colours = [[5, 48, 97], [67, 147, 195], [247, 247, 247], [214, 96, 77], [103, 0, 31]];
midway.error_colours = [[0, 0, 4], [59, 15, 112], [140, 41, 129], [222, 73, 104], [254, 159, 109], [252, 253, 191]];
midway.error_decades = [-4, 1];  // what the colours of relative errors span

// An odd number of steps, so that the middle is one of them.
midway.ramp_steps = 255;
midway.ramp_table = (colours) => {
    const steps = midway.ramp_steps, table = new Uint8ClampedArray(steps * 4);
    for (let i = 0; i < steps; ++i) table.set([...midway.ramp(colours, i / (steps - 1)), 255], 4 * i);
    return table;
};

// Fills RGBA bytes. `look` is {view, exposure, range}: exposure in stops, range the difference
// that has the full colour. What is not finite becomes magenta.
midway.paint_image = (bytes, values, spec, reference, look) => {
    const pixels = values.length / 3;
    const colour = midway.ramp_table(look.view === "difference" ? midway.signed_colours : midway.error_colours);
    const gain = 2 ** look.exposure * 8192, floor = 0.01 * spec.mean ** 2;
    const [first, last] = midway.error_decades;
    for (let p = 0, i = 0, o = 0; p < pixels; ++p, i += 3, o += 4) {
        bytes[o + 3] = 255;
        const finite = Number.isFinite(values[i] + values[i + 1] + values[i + 2]);
        if (!finite) {
            bytes[o] = bytes[o + 2] = 255;
            bytes[o + 1] = 0;
        } else if (look.view === "picture") {
            for (let c = 0; c < 3; ++c)
                bytes[o + c] = midway.srgb_table[Math.min(Math.max(values[i + c] * gain, 0), 8192) + .5 | 0];
        } else {
            const t = look.view === "difference"
                ? .5 + .5 * (midway.luminance(values, i) - midway.luminance(reference, i)) / look.range
                : (Math.log10(midway.relative_error(values, reference, i, floor)) - first) / (last - first);
            const at = 4 * Math.round((midway.ramp_steps - 1) * Math.min(Math.max(t, 0), 1));
            for (let c = 0; c < 3; ++c) bytes[o + c] = colour[at + c];
        }
    }
};

// The pixel's share of relMSE: mean over channels of (x - r)^2 / (r^2 + 0.01 m^2).
midway.relative_error = (values, reference, i, floor) => {
    let sum = 0;
    for (let c = 0; c < 3; ++c) {
        const r = reference[i + c], below = r * r + floor;
        if (below > 0) sum += (values[i + c] - r) ** 2 / below;
    }
    return sum / 3;
};
