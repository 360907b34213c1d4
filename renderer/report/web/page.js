// Small things of every page: copying, downloads, printing, and the colours that series keep on
// every page, by name. Loaded before charts.js and the scripts of single pages.
"use strict";
const midway = { themed: [] };  // themed: called when light turns to dark, or the page is printed

// Name: [on white, on black, shape of points]. Camera side teal, light side amber; the hues differ
// in lightness too, for people who see few colours.
midway.fixed_looks = {
    "path": ["#00857a", "#2fc4b2", "circle"],
    "light": ["#cf8200", "#ffb83d", "triangle"],
    "bdpt:0": ["#a8549a", "#dc93cb", "crossRot"],
    "bdpt:1": ["#4a9fd8", "#9bd5ff", "rect"],
    "bdpt:2": ["#0b4f9e", "#4d94ff", "rectRot"],
    "auto": ["#c8400e", "#ff7a45", "star"],
};
midway.spare_looks = [
    ["#7a1f4b", "#e36a9f", "circle"], ["#80801a", "#cfcf5c", "rect"], ["#3d2c8d", "#a99aff", "triangle"],
    ["#5f3a13", "#d0a070", "rectRot"], ["#2d6a2d", "#8fd08f", "cross"], ["#555c60", "#b5bdc2", "star"],
];
midway.given_looks = new Map();  // spare looks in use on this page

// The page has the class `printing` while it is made ready for paper.
midway.printing = () => document.documentElement.classList.contains("printing");

midway.dark = () => !midway.printing() && matchMedia("(prefers-color-scheme: dark)").matches;

midway.css = (name) =>
    getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// {colour, shape, dash} of a series. Names that are not fixed start looking for a free spare look at
// a place that follows from the name.
midway.look = (name) => {
    let look = Object.hasOwn(midway.fixed_looks, name) ? midway.fixed_looks[name] : undefined;
    let dash = [];
    if (!look) {
        if (!midway.given_looks.has(name)) {
            let hash = 0;
            for (const c of name) hash = (hash * 31 + c.codePointAt(0)) >>> 0;
            const taken = new Set(midway.given_looks.values());
            let index = hash % midway.spare_looks.length;
            for (let i = 0; i < midway.spare_looks.length && taken.has(index); ++i)
                index = (index + 1) % midway.spare_looks.length;
            midway.given_looks.set(name, index);
        }
        look = midway.spare_looks[midway.given_looks.get(name)];
        dash = [7, 3];
    }
    return { colour: look[midway.dark() ? 1 : 0], shape: look[2], dash };
};

midway.retheme = () => {
    for (const swatch of document.querySelectorAll(".swatch"))
        swatch.style.background = midway.look(swatch.dataset.series).colour;
    for (const update of midway.themed) update();
};

midway.json = (id) => JSON.parse(document.getElementById(id).textContent);

midway.element = (tag, properties, ...children) => {
    const node = Object.assign(document.createElement(tag), properties);
    node.append(...children);
    return node;
};

midway.save = (blob, name) => {
    const link = midway.element("a", { href: URL.createObjectURL(blob), download: name });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
};

// A number for people, as format_number in html_page.cpp writes it.
midway.number = (value, digits = 3) => {
    if (value === null || !Number.isFinite(value)) return "-";
    if (value === 0) return "0";
    const size = Math.abs(value);
    if (size < 1e-3 || size >= 1e5) {
        const [m, e] = value.toExponential(digits - 1).split("e");
        return `${m}e${e[0]}${e.slice(1).padStart(2, "0")}`;
    }
    return size >= 10 ** digits ? value.toFixed(0) : String(Number(value.toPrecision(digits)));
};

addEventListener("DOMContentLoaded", () => {
    for (const button of document.querySelectorAll("button[data-copy]"))
        button.addEventListener("click", async () => {
            const code = document.getElementById(button.dataset.copy);
            getSelection().selectAllChildren(code);
            let copied = false;
            try {
                await navigator.clipboard.writeText(code.textContent);
                copied = true;
            } catch {
                copied = document.execCommand("copy");  // from a file there may be no clipboard
            }
            button.textContent = copied ? "Copied" : "Selected";
        });
    for (const button of document.querySelectorAll("button[data-download]"))
        button.addEventListener("click", () =>
            midway.save(new Blob([midway.json(button.dataset.download)], { type: "text/csv" }),
                button.dataset.name));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", midway.retheme);
    midway.retheme();
});

// Paper is white and cannot unfold anything.
addEventListener("beforeprint", () => {
    document.documentElement.classList.add("printing");
    for (const details of document.querySelectorAll("details:not([open]):not(.screen-only)")) {
        details.open = true;
        details.dataset.folded = "";
    }
    midway.retheme();
});
addEventListener("afterprint", () => {
    document.documentElement.classList.remove("printing");
    for (const details of document.querySelectorAll("details[data-folded]")) {
        details.open = false;
        delete details.dataset.folded;
    }
    midway.retheme();
});
