// The image viewer (images.html): two of the images, side by side, under a wipe or alternating, with
// one zoom and one place for both; picture, difference or relative error; values under the pointer.
"use strict";
midway.image_viewer = (root) => {
    const spec = midway.json(root.dataset.images), table = midway.half_values();
    const find = (selector) => root.querySelector(selector);
    const [left, right] = root.querySelectorAll(".panels canvas");
    const readout = find(".readout");
    for (const image of spec.images) {
        image.values = midway.decode_image(image.id, 2 ** image.scale, table);
        image.surface = midway.element("canvas", { width: spec.width, height: spec.height });
        image.painted = "";
    }
    const reference = spec.images[0];
    const state = {
        mode: "side", view: "picture", exposure: spec.exposure, range: spec.range, wipe: .5, flipped: false,
        shown: [Math.min(1, spec.images.length - 1), spec.right],
        zoom: 1, x: spec.width / 2, y: spec.height / 2,  // zoom 1 shows the whole, x and y in its middle
    };

    // The surface of an image, painted again where the look has changed.
    const painted = (image) => {
        const look = { view: state.view, exposure: state.exposure, range: 2 ** state.range };
        const key = JSON.stringify(look);
        if (image.painted !== key) {
            const g = image.surface.getContext("2d"), data = g.createImageData(spec.width, spec.height);
            midway.paint_image(data.data, image.values, spec, reference.values, look);
            g.putImageData(data, 0, 0);
            image.painted = key;
        }
        return image.surface;
    };

    // From image to canvas: canvas = origin + scale * image, in CSS pixels.
    const place = (canvas) => {
        const w = canvas.clientWidth, h = canvas.clientHeight;
        const scale = state.zoom * Math.min(w / spec.width, h / spec.height);
        return { scale, w, h, ox: w / 2 - state.x * scale, oy: h / 2 - state.y * scale };
    };

    const keep_inside = () => {
        state.zoom = Math.min(Math.max(state.zoom, 1), 64);
        const held = (at, size) => Math.min(Math.max(at, size / 2 / state.zoom), size - size / 2 / state.zoom);
        state.x = held(state.x, spec.width);
        state.y = held(state.y, spec.height);
    };

    const draw_part = (g, at, image, from, to) => {
        g.save();
        g.beginPath();
        g.rect(from, 0, to - from, at.h);
        g.clip();
        g.imageSmoothingEnabled = at.scale * devicePixelRatio < 1;
        g.drawImage(painted(image), at.ox, at.oy, spec.width * at.scale, spec.height * at.scale);
        g.restore();
    };

    const name_tag = (g, text, x, to_right) => {
        g.font = "600 13px system-ui, sans-serif";
        const width = g.measureText(text).width + 14, from = to_right ? x - width : x;
        g.fillStyle = "rgba(0, 0, 0, .65)";
        g.fillRect(from, 8, width, 24);
        g.fillStyle = "#fff";
        g.textBaseline = "middle";
        g.fillText(text, from + 7, 20);
    };

    // The part of the panel that the image covers, and the wipe's place in it.
    const covered = (canvas) => {
        const at = place(canvas);
        return [Math.max(at.ox, 0), Math.min(at.ox + spec.width * at.scale, at.w)];
    };
    const wipe_at = (canvas) => {
        const [from, to] = covered(canvas);
        return from + state.wipe * (to - from);
    };

    const draw_panel = (canvas, side) => {
        const at = place(canvas), dpr = devicePixelRatio;
        if (!at.w) return;
        canvas.style.touchAction = state.zoom > 1 ? "none" : "pan-y";
        canvas.width = Math.round(at.w * dpr);
        canvas.height = Math.round(at.h * dpr);
        const g = canvas.getContext("2d"), [a, b] = state.shown.map((i) => spec.images[i]);
        g.scale(dpr, dpr);
        if (state.mode === "wipe") {
            const x = wipe_at(canvas);
            draw_part(g, at, a, 0, x);
            draw_part(g, at, b, x, at.w);
            g.fillStyle = "#000";
            g.fillRect(x - 2, 0, 4, at.h);
            g.fillStyle = "#fff";
            g.fillRect(x - 1, 0, 2, at.h);
            g.beginPath();
            g.arc(x, at.h / 2, 9, 0, 7);
            g.fill();
            name_tag(g, a.name, x - 6, true);
            name_tag(g, b.name, x + 6, false);
        } else {
            const image = side === 1 || (state.mode === "flip" && state.flipped) ? b : a;
            draw_part(g, at, image, 0, at.w);
            name_tag(g, image.name, 8, false);
        }
    };

    const explain = () => {
        const range = midway.number(2 ** state.range), [first, last] = midway.error_decades;
        const texts = {
            picture: ["", "", "Linear light times 2 to the exposure, shown as sRGB; what is too bright is clipped."],
            difference: [`−${range} or less`, `+${range} or more`, "Luminance minus the reference's: blue is too dark, red too bright, white is equal. Noise is both; a surface of one colour is bias, or light that a technique does not cover."],
            relative: [`10${midway.superscript(first)} or less`, `10${midway.superscript(last)} or more`, "Each pixel's share of relMSE, (x − r)² / (r² + 0.01 m²), on a logarithmic scale. The reference's own noise is in it."],
        }[state.view];
        find(".scale-low").textContent = texts[0];
        find(".scale-high").textContent = texts[1];
        find(".explain").textContent = [texts[2], spec.note].filter((t) => t).join(" ");
        find(".scale").style.visibility = state.view === "picture" ? "hidden" : "visible";
        const colours = midway.ramp_table(state.view === "difference" ? midway.signed_colours : midway.error_colours);
        find(".scale canvas").getContext("2d").putImageData(new ImageData(colours, midway.ramp_steps, 1), 0, 0);
    };

    const draw = () => {
        keep_inside();
        root.dataset.shown = state.mode;
        draw_panel(left, 0);
        if (state.mode === "side") draw_panel(right, 1);
    };

    const show_controls = () => {
        const on = (button, yes) => button.setAttribute("aria-pressed", String(yes));
        for (const button of root.querySelectorAll("[data-mode]")) on(button, button.dataset.mode === state.mode);
        for (const button of root.querySelectorAll("[data-view]")) on(button, button.dataset.view === state.view);
        for (const pick of root.querySelectorAll(".pick")) pick.value = state.shown[pick.dataset.side];
        find(".exposure").value = state.exposure;
        find(".exposure").disabled = state.view !== "picture";
        find(".exposure-value").textContent = `${state.exposure >= 0 ? "+" : "−"}${Math.abs(state.exposure).toFixed(2)} EV`;
        find(".range").value = state.range;
        find(".range").disabled = state.view !== "difference";
        find(".range-value").textContent = `±${midway.number(2 ** state.range)}`;
        find(".wipe").value = state.wipe;
        find(".wipe").disabled = state.mode !== "wipe";
        find(".flip").disabled = find(".blink").disabled = state.mode !== "flip";
        for (const thumb of root.querySelectorAll(".thumbs button"))
            thumb.classList.toggle("shown", state.shown.includes(Number(thumb.dataset.image)));
    };

    const draw_thumbs = () => {
        for (const thumb of root.querySelectorAll(".thumbs button")) {
            const canvas = thumb.querySelector("canvas"), g = canvas.getContext("2d");
            g.drawImage(painted(spec.images[thumb.dataset.image]), 0, 0, canvas.width, canvas.height);
        }
    };

    let waiting = false;
    const refresh = (looks = true) => {
        if (looks) { show_controls(); explain(); }
        if (waiting) return;
        waiting = true;
        requestAnimationFrame(() => {
            waiting = false;
            draw();
            draw_thumbs();
        });
    };

    const value_text = (image, x, y) => {
        const i = 3 * (y * spec.width + x);
        const rgb = [0, 1, 2].map((c) => midway.number(image.values[i + c]).padStart(9)).join(" ");
        const error = midway.relative_error(image.values, reference.values, i, 0.01 * spec.mean ** 2);
        const off = midway.luminance(image.values, i) - midway.luminance(reference.values, i);
        return `${image.name.padEnd(12)} ${rgb}` + (image === reference ? "" :
            `   difference ${off < 0 ? "−" : "+"}${midway.number(Math.abs(off))}, relative error ${midway.number(error)}`);
    };

    const show_values = (x, y) => {
        x = Math.floor(x);
        y = Math.floor(y);
        if (x < 0 || y < 0 || x >= spec.width || y >= spec.height) return;
        const lines = [...new Set([...state.shown, 0])].map((i) => value_text(spec.images[i], x, y));
        readout.textContent = [`pixel ${x}, ${y} (red, green, blue)`, ...lines].join("\n");
    };

    // Zooms so that the image's point under (px, py) of the canvas stays there.
    const zoom_at = (canvas, factor, px, py) => {
        const before = place(canvas), ix = (px - before.ox) / before.scale, iy = (py - before.oy) / before.scale;
        state.zoom = Math.min(Math.max(state.zoom * factor, 1), 64);
        const scale = place(canvas).scale;
        state.x = ix - (px - before.w / 2) / scale;
        state.y = iy - (py - before.h / 2) / scale;
        refresh(false);
    };

    midway.watch_panel([left, right], { state, place, covered, wipe_at, zoom_at, show_values, refresh });

    const set = (changes) => {
        Object.assign(state, changes);
        refresh();
    };
    for (const pick of root.querySelectorAll(".pick")) {
        spec.images.forEach((image, i) => pick.append(new Option(image.name, i)));
        pick.addEventListener("change", () => {
            state.shown[pick.dataset.side] = Number(pick.value);
            refresh();
        });
    }
    for (const button of root.querySelectorAll("[data-mode]"))
        button.addEventListener("click", () => set({ mode: button.dataset.mode, flipped: false }));
    for (const button of root.querySelectorAll("[data-view]"))
        button.addEventListener("click", () => set({ view: button.dataset.view }));
    find(".exposure").min = Math.floor(spec.exposure) - 12;
    find(".exposure").max = Math.ceil(spec.exposure) + 12;
    find(".range").min = Math.floor(spec.range) - 10;
    find(".range").max = Math.ceil(spec.range) + 10;
    for (const name of ["exposure", "range", "wipe"])
        find(`.${name}`).addEventListener("input", (event) => set({ [name]: Number(event.target.value) }));
    find(".flip").addEventListener("click", () => set({ flipped: !state.flipped }));
    let blinking = 0;
    find(".blink").addEventListener("click", () => {
        clearInterval(blinking);
        blinking = blinking ? 0 : setInterval(() => state.mode === "flip" && set({ flipped: !state.flipped }), 600);
        find(".blink").setAttribute("aria-pressed", String(blinking !== 0));
    });
    find(".zoom-in").addEventListener("click", () => set({ zoom: state.zoom * 1.5 }));
    find(".zoom-out").addEventListener("click", () => set({ zoom: state.zoom / 1.5 }));
    find(".fit").addEventListener("click", () => set({ zoom: 1 }));
    spec.images.forEach((image, i) => {
        const width = Math.min(spec.width, 400);
        const height = Math.max(1, Math.round(width * spec.height / spec.width));
        const canvas = midway.element("canvas", { width, height });
        const thumb = midway.element("button", { type: "button", title: "Show on the right" }, canvas, image.name,
            midway.element("small", {}, image.caption));
        thumb.dataset.image = i;
        thumb.addEventListener("click", () => {
            state.shown[1] = i;
            refresh();
        });
        find(".thumbs").append(thumb);
    });
    readout.textContent = "Point at an image to read its values; drag to move, turn the wheel or pinch to zoom.";
    new ResizeObserver(() => refresh(false)).observe(find(".panels"));
    midway.themed.push(refresh);
};

// Pointer, wheel and keys of the panels: drag moves (or takes the wipe along), two fingers zoom.
midway.watch_panel = (canvases, viewer) => {
    const { state } = viewer, pointers = new Map();
    let wiping = false;
    const spread = () => {
        const [a, b] = [...pointers.values()];
        return Math.hypot(a.x - b.x, a.y - b.y);
    };
    for (const canvas of canvases) {
        canvas.addEventListener("pointerdown", (event) => {
            pointers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
            wiping = state.mode === "wipe" && Math.abs(event.offsetX - viewer.wipe_at(canvas)) < 16;
            canvas.setPointerCapture(event.pointerId);
        });
        canvas.addEventListener("pointermove", (event) => {
            const at = viewer.place(canvas), before = pointers.get(event.pointerId);
            viewer.show_values((event.offsetX - at.ox) / at.scale, (event.offsetY - at.oy) / at.scale);
            if (!before) return;
            const apart = pointers.size === 2 ? spread() : 0;
            pointers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
            if (apart > 0) {
                const [a, b] = [...pointers.values()];
                viewer.zoom_at(canvas, spread() / apart, (a.x + b.x) / 2, (a.y + b.y) / 2);
            } else if (wiping) {
                const [from, to] = viewer.covered(canvas);
                state.wipe = Math.min(Math.max((event.offsetX - from) / (to - from), 0), 1);
                viewer.refresh();
            } else {
                state.x -= (event.offsetX - before.x) / at.scale;
                state.y -= (event.offsetY - before.y) / at.scale;
                viewer.refresh(false);
            }
        });
        for (const end of ["pointerup", "pointercancel"])
            canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
        canvas.addEventListener("wheel", (event) => {
            if (event.deltaY > 0 && state.zoom <= 1) return;  // the page scrolls on
            event.preventDefault();
            viewer.zoom_at(canvas, 2 ** (-event.deltaY / 300), event.offsetX, event.offsetY);
        }, { passive: false });
        canvas.addEventListener("keydown", (event) => {
            const at = viewer.place(canvas), step = 40 / at.scale;
            const moves = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] };
            if (moves[event.key]) {
                state.x += moves[event.key][0];
                state.y += moves[event.key][1];
            } else if (event.key === "+" || event.key === "=") state.zoom *= 1.5;
            else if (event.key === "-") state.zoom /= 1.5;
            else if (event.key === "0") state.zoom = 1;
            else if (event.key === "f") state.flipped = !state.flipped;
            else return;
            event.preventDefault();
            viewer.refresh();
            viewer.show_values(state.x, state.y);
        });
    }
};

for (const root of document.querySelectorAll(".viewer")) midway.image_viewer(root);
