// Draws every figure.chart of the page from its JSON (html_page.cpp, add_chart): selectors for what
// the axes show, a legend that switches series, bands, levels with a shaded side, values under the
// pointer or the arrow keys, a table of all numbers.
"use strict";
midway.superscript = (n) => String(n).replace(/[-0-9]/g, (c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]);

// Label of a tick on a logarithmic axis that spans so many decades; most ticks have none.
midway.log_tick = (value, decades) => {
    const exponent = Math.floor(Math.log10(value) + 1e-9);
    const lead = Math.round(value / 10 ** exponent);
    if (Math.abs(value / 10 ** exponent - lead) > 1e-6) return "";  // the ends of the axis
    if (lead !== 1 && !(decades < 2.2 && (lead === 2 || lead === 5))) return "";
    if (exponent >= -2 && exponent <= 4) return String(Number(value.toPrecision(2)));
    return (lead === 1 ? "" : `${lead}·`) + "10" + midway.superscript(exponent);
};

Chart.defaults.font.family = "system-ui, 'Segoe UI', 'DejaVu Sans', Helvetica, sans-serif";

// Every visible curve's point that is nearest to the pointer, by distance along x.
Chart.Interaction.modes.each_curve = (chart, event) => {
    const found = [];
    chart.data.datasets.forEach((dataset, index) => {
        if (dataset.band || !chart.isDatasetVisible(index)) return;
        let best = null;
        chart.getDatasetMeta(index).data.forEach((element, i) => {
            const distance = Math.abs(element.x - event.x);
            if (!element.skip && (!best || distance < best.distance))
                best = { element, datasetIndex: index, index: i, distance };
        });
        if (best && best.distance < 60) found.push(best);
    });
    return found;
};

// Levels: a line across, its name, and the shaded side.
midway.level_plugin = {
    id: "levels",
    beforeDatasetsDraw(chart) {
        const { ctx, chartArea: area, scales } = chart;
        for (const level of chart.options.midway_levels) {
            const y = Math.min(Math.max(scales.y.getPixelForValue(level.value), area.top), area.bottom);
            ctx.save();
            ctx.beginPath();
            ctx.rect(area.left, area.top, area.width, area.height);
            ctx.clip();
            ctx.strokeStyle = ctx.fillStyle = midway.css("--muted");
            if (level.shade !== "none") {
                const top = level.shade === "below" ? y : area.top;
                const bottom = level.shade === "below" ? area.bottom : y;
                ctx.globalAlpha = .13;
                ctx.fillRect(area.left, top, area.width, bottom - top);
                ctx.globalAlpha = 1;
            }
            ctx.setLineDash([4, 4]);
            ctx.beginPath();
            ctx.moveTo(area.left, y);
            ctx.lineTo(area.right, y);
            ctx.stroke();
            ctx.font = "12px system-ui, sans-serif";
            const under = level.shade === "below" && y + 18 < area.bottom || y - 16 < area.top;
            ctx.textBaseline = under ? "top" : "bottom";
            ctx.fillText(level.name, area.left + 8, under ? y + 4 : y - 4, area.width - 16);
            ctx.restore();
        }
    },
};

// The points of a series for two chosen columns; what a logarithmic axis cannot show is left out.
midway.points = (series, x_axis, y_axis) => {
    const xs = series.columns[x_axis.key], ys = series.columns[y_axis.key];
    if (!xs || !ys) return [];
    const fits = (value, axis) => value !== null && (!axis.logarithmic || value > 0);
    const points = [];
    xs.value.forEach((x, i) => {
        if (!fits(x, x_axis) || !fits(ys.value[i], y_axis)) return;
        const low = ys.low[i] ?? null, high = ys.high[i] ?? null;
        points.push({ x, y: ys.value[i], low, high });
    });
    return points.sort((a, b) => a.x - b.x);
};

// Levels that are not so far below the curves that showing them would flatten these.
midway.near_levels = (axis, lowest) => axis.levels.filter((l) => !axis.logarithmic || l.value > lowest / 300);

// Limits that hold all values (and levels that are not far below), whatever is switched off.
midway.limits = (values, logarithmic) => {
    const low = Math.min(...values), high = Math.max(...values);
    if (!Number.isFinite(low)) return logarithmic ? [1, 10] : [0, 1];
    if (!logarithmic) {
        const room = (high - low || Math.abs(high) || 1) * .06;
        return [low - room, high + room];
    }
    const room = Math.max((high / low) ** .05, 1.15);
    return [low / room, high * room];
};

midway.draw_chart = (figure) => {
    const spec = midway.json(figure.dataset.chart);
    const state = { x: spec.x[0], y: spec.y[0], hidden: new Set() };
    const canvas = figure.querySelector(".plot canvas");
    const note = figure.querySelector(".axis-note");
    let chart = null, cursor = -1;

    const selector = (which, text) => {
        if (spec[which].length < 2) return;
        const select = midway.element("select");
        spec[which].forEach((axis, i) => select.append(new Option(axis.label, i)));
        select.addEventListener("change", () => {
            state[which] = spec[which][select.value];
            draw();
        });
        figure.querySelector(".controls").append(midway.element("label", {}, text, select));
    };

    const legend_button = (series) => {
        const icon = midway.element("canvas", { width: 68, height: 28 });
        const button = midway.element("button", { type: "button", title: series.note }, icon, series.name);
        button.setAttribute("aria-pressed", "true");
        button.addEventListener("click", () => {
            const show = state.hidden.delete(series.name);
            if (!show) state.hidden.add(series.name);
            button.setAttribute("aria-pressed", String(show));
            draw();
        });
        const paint = () => {
            const look = midway.look(series.name), g = icon.getContext("2d");
            g.clearRect(0, 0, 68, 28);
            g.strokeStyle = g.fillStyle = look.colour;
            g.lineWidth = 4;
            g.setLineDash(look.dash.map((d) => 2 * d));
            g.beginPath();
            if (spec.lines) { g.moveTo(0, 14); g.lineTo(68, 14); }
            g.stroke();
            g.setLineDash([]);
            Chart.helpers.drawPoint(g, { pointStyle: look.shape, radius: 9, rotation: 0, borderWidth: 4 }, 34, 14);
        };
        midway.themed.push(paint);
        return button;
    };

    const datasets = (bottom) => spec.series.flatMap((series) => {
        const look = midway.look(series.name), points = midway.points(series, state.x, state.y);
        const hidden = state.hidden.has(series.name);
        const banded = points.filter((p) => p.low !== null && p.high !== null);
        const edge = (end) => ({
            label: series.name, band: true, hidden, pointRadius: 0, pointHitRadius: 0, borderWidth: 0,
            data: banded.map((p) => ({ x: p.x, y: Math.max(p[end], bottom) })),
            backgroundColor: look.colour + "30",
        });
        const line = {
            label: series.name, note: series.note, hidden, data: points, parsing: false,
            borderColor: look.colour, backgroundColor: look.colour, borderDash: look.dash,
            borderWidth: 2, showLine: spec.lines, pointStyle: look.shape, pointRadius: spec.lines ? 3 : 2.5,
            pointHoverRadius: 6, pointBorderWidth: 1.5, tension: 0,
        };
        return banded.length ? [line, { ...edge("low"), fill: "+1" }, { ...edge("high"), fill: false }] : [line];
    });

    const axis = (which, limits) => {
        const chosen = state[which], decades = Math.log10(limits[1] / limits[0]);
        const ink = midway.css("--muted"), major = midway.css("--line"), minor = midway.css("--faint");
        const ticks = { color: ink, maxRotation: 0, autoSkipPadding: 12 };
        if (chosen.logarithmic) {
            ticks.callback = (value) => midway.log_tick(value, decades);
            ticks.autoSkip = false;
        } else ticks.callback = (value) => midway.number(value);
        return {
            type: chosen.logarithmic ? "logarithmic" : "linear", min: limits[0], max: limits[1], ticks,
            title: { display: true, text: chosen.label, color: ink, font: { size: 13 } },
            grid: { borderColor: ink, color: (c) => c.tick && c.tick.label !== "" ? major : minor },
        };
    };

    const same_x = (items) => new Set((items ?? []).map((item) => midway.number(item.raw.x))).size === 1;
    const tooltip = () => ({
        itemSort: (a, b) => b.raw.y - a.raw.y, filter: (item) => !item.dataset.band, usePointStyle: true,
        backgroundColor: midway.css("--panel"), titleColor: midway.css("--ink"), bodyColor: midway.css("--ink"),
        borderColor: midway.css("--muted"), borderWidth: 1, padding: 10, bodyFont: { size: 13 },
        callbacks: {
            title: (items) => same_x(items) ? `${state.y.label} · ${state.x.label}: ${midway.number(items[0].raw.x)}`
                : `${state.y.label} · ${state.x.label}`,
            label: (item) => {
                const { x, y, low, high } = item.raw;
                const band = low === null || high === null ? "" : ` (${midway.number(low)} … ${midway.number(high)})`;
                const at = same_x(item.chart.tooltip.dataPoints) ? "" : ` at ${midway.number(x)}`;
                return ` ${item.dataset.label}: ${midway.number(y)}${band}${at}`;
            },
        },
    });

    const note_of = (x, y) => {
        const lowest = Math.min(...spec.series.map((s) => midway.points(s, x, y)).flat().map((p) => p.y));
        const near = midway.near_levels(y, lowest);
        const far = y.levels.filter((l) => !near.includes(l))
            .map((l) => `${l.name}: ${midway.number(l.value)}, far below this plot.`);
        return [x.note, y.note, ...far].filter((t) => t).join(" ");
    };

    // What stands below the chart stays where it is, whichever axes are chosen.
    const keep_room = () => {
        const shown = note.textContent;
        note.style.minHeight = "";
        const heights = spec.x.flatMap((x) => spec.y.map((y) => {
            note.textContent = note_of(x, y);
            return note.getBoundingClientRect().height;
        }));
        note.textContent = shown;
        note.style.minHeight = `${Math.max(...heights)}px`;
    };

    const draw = () => {
        const all = spec.series.map((series) => midway.points(series, state.x, state.y)).flat();
        const ys = all.map((p) => p.y), lowest = Math.min(...ys);
        const near = midway.near_levels(state.y, lowest);
        // Few seeds give bands of many decades, which would leave no room for the curves.
        const roof = state.y.logarithmic ? 10 * Math.max(...ys) : Infinity;
        const highs = all.map((p) => p.high).filter((v) => v !== null).map((v) => Math.min(v, roof));
        const y_limits = midway.limits([...ys, ...highs, ...near.map((l) => l.value)], state.y.logarithmic);
        const x_limits = midway.limits(all.map((p) => p.x), state.x.logarithmic);
        note.textContent = note_of(state.x, state.y);
        const bottom = state.y.logarithmic ? y_limits[0] / 1e3 : -Infinity;
        const data = { datasets: datasets(bottom) };
        const options = {
            animation: false, responsive: true, maintainAspectRatio: false, normalized: true,
            interaction: { mode: "each_curve", intersect: false }, midway_levels: near,
            scales: { x: axis("x", x_limits), y: axis("y", y_limits) },
            plugins: { legend: { display: false }, tooltip: tooltip() },
        };
        if (chart) chart.destroy();
        cursor = -1;
        chart = new Chart(canvas, { type: "line", data, options, plugins: [midway.level_plugin] });
    };

    // Left and right go along the first visible curve; Escape hides the values.
    canvas.addEventListener("keydown", (event) => {
        const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
        const index = chart.data.datasets.findIndex((d) => !d.band && !d.hidden && d.data.length > 0);
        const first = index < 0 ? null : chart.getDatasetMeta(index);
        if (event.key === "Escape") chart.tooltip.setActiveElements([], { x: 0, y: 0 });
        else if (step && first) {
            event.preventDefault();
            cursor = Math.min(Math.max(cursor + step, 0), first.data.length - 1);
            const { x, y } = first.data[cursor];
            chart.tooltip.setActiveElements(Chart.Interaction.modes.each_curve(chart, { x, y }), { x, y });
        } else return;
        chart.update("none");
    });

    const numbers = figure.querySelector(".numbers");
    numbers.parentElement.addEventListener("toggle", () => midway.fill_numbers(spec, numbers));
    selector("y", "Show");
    selector("x", "against");
    if (spec.series.length > 1) figure.querySelector(".legend").append(...spec.series.map(legend_button));
    midway.themed.push(draw);
    keep_room();
    window.addEventListener("resize", keep_room);
};

// All values behind a chart as a table, made when it is first unfolded.
midway.fill_numbers = (spec, place) => {
    if (place.firstChild) return;
    const axes = [...spec.x, ...spec.y.filter((y) => !spec.x.some((x) => x.key === y.key))];
    const cell = (tag, text, number) => midway.element(tag, { className: number ? "number" : "" }, text);
    const body = midway.element("tbody");
    for (const series of spec.series) {
        const rows = Math.max(0, ...Object.values(series.columns).map((c) => c.value.length));
        for (let i = 0; i < rows; ++i)
            body.append(midway.element("tr", {}, cell("th", series.name), ...axes.map((axis) =>
                cell("td", midway.number(series.columns[axis.key]?.value[i] ?? null, 5), true))));
    }
    const head = midway.element("tr", {}, cell("th", "series"), ...axes.map((a) => cell("th", a.label, true)));
    place.append(midway.element("table", {}, midway.element("thead", {}, head), body));
};

for (const figure of document.querySelectorAll("figure.chart")) midway.draw_chart(figure);
