#!/usr/bin/env python3
"""Opens the pages of unit/html_report_test.cpp in Chromium and uses them as a person would, with
real pointer, wheel and key events. Usage: report_in_browser.py FOLDER [SCREENSHOTS]

FOLDER holds report.html, index.html, hostile/report.html and expected.json. Exit status 0: all is
well; 1: not (the reason on stdout); 77: there is no Chromium."""

import json
import sys
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from support import browser  # noqa: E402

folder, shots, chromium = Path("."), None, None
PLOT, LEFT, RIGHT = ".plot canvas", ".panels canvas:first-child", ".panels canvas:last-child"
BALL = (0.62, 0.7)  # where the made-up `light` is black


class Page(unittest.TestCase):
    width, height, options, file = 1280, 900, {}, "report.html"

    def setUp(self):
        self.browser = chromium
        self.browser.look(self.width, self.height, **self.options)
        self.browser.open(folder / self.file)

    def tearDown(self):
        self.assertEqual([], self.browser.messages, "the console stays empty")
        self.assertEqual([(folder / self.file).resolve().as_uri()], self.browser.requests)
        self.shot("end")

    def shot(self, name, whole=False):
        if shots:
            self.browser.screenshot(shots / f"{self.id().split('.', 1)[1]}-{name}.png", whole)

    def fits(self):
        self.shot("whole", whole=True)
        self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"),
                             self.width)

    def image_point(self, selector, at):
        """Where a point of the whole image (0 to 1 each way) lies in the window."""
        left, top, width, height = self.browser.box(selector)
        side = min(width, height)
        return (left + width / 2 + (at[0] - .5) * side, top + height / 2 + (at[1] - .5) * side)

    def colour(self, selector, at):
        """Red, green, blue that the canvas shows at a point of the window."""
        return self.browser.evaluate(
            f"(() => {{ const c = document.querySelector({json.dumps(selector)}),"
            f"b = c.getBoundingClientRect(), g = Object.assign(document.createElement('canvas'),"
            "{width: 1, height: 1}).getContext('2d', {willReadFrequently: true});"
            f"g.drawImage(c, Math.floor(b.left - {at[0]}), Math.floor(b.top - {at[1]}));"
            "return [...g.getImageData(0, 0, 1, 1).data.slice(0, 3)]; })()")

    def readout(self, at):
        """Pixel and values that are shown for a point of the window: (x, y), {name: [r, g, b]}."""
        self.browser.mouse("mouseMoved", *at)
        self.browser.settle()
        first, *lines = self.browser.evaluate(
            "document.querySelector('.readout').textContent").split("\n")
        pixel = tuple(int(v.strip(",")) for v in first.split()[1:3])
        return pixel, {line.split()[0]: [float(v) for v in line.split()[1:4]] for line in lines}

    def choose(self, selector, value):
        self.browser.evaluate(
            f"(() => {{ const s = document.querySelector({json.dumps(selector)}); s.value = {value};"
            "s.dispatchEvent(new Event('change')); })()")
        self.browser.settle()

    def focus(self, selector):
        self.browser.box(selector)
        self.browser.evaluate(f"document.querySelector({json.dumps(selector)}).focus()")


class Charts(Page):
    def chart(self, expression):
        return self.browser.evaluate(
            f"(() => {{ const chart = Chart.getChart(document.querySelector('{PLOT}'));"
            f"return {expression}; }})()")

    def shown_values(self):
        """Labels in the box of values, or none where there is no box."""
        return self.chart("chart.tooltip.opacity ? chart.tooltip.body.map(b => b.lines[0].trim())"
                          " : []")

    def test_pointing_shows_every_curve(self):
        left, top, width, height = self.browser.box(PLOT)
        self.browser.mouse("mouseMoved", left + width / 2, top + height / 2)
        self.browser.settle()
        values = self.shown_values()
        self.assertEqual(6, len(values), values)
        self.assertIn("bdpt:2: ", " ".join(values))
        self.shot("hover")

    def test_keys_show_values_and_hide_them(self):
        self.focus(PLOT)
        self.browser.key("ArrowRight", 39)
        self.browser.key("ArrowRight", 39)
        self.assertEqual(6, len(self.shown_values()))
        self.browser.key("Escape", 27)
        self.assertEqual([], self.shown_values())

    def test_names_hide_curves(self):
        self.browser.click(".legend button", 1)
        shown = "chart.data.datasets.filter((d, i) => chart.isDatasetVisible(i))"
        names = self.chart(f"[...new Set({shown}.map(d => d.label))]")
        self.assertEqual(["path", "bdpt:0", "bdpt:1", "bdpt:2", "auto"], names)
        self.browser.click(".legend button", 1)
        self.assertEqual(18, self.chart(f"{shown}.length"))

    def test_axes_can_be_chosen_and_nothing_moves(self):
        below = "document.querySelectorAll('h2')[1].getBoundingClientRect().top + scrollY"
        before = self.browser.evaluate(below)
        points = self.chart("chart.data.datasets[0].data[29]")
        self.choose(".chart label:nth-child(2) select", 2)  # samples
        self.choose(".chart label:nth-child(1) select", 2)  # MSE
        self.assertEqual("samples per pixel", self.chart("chart.options.scales.x.title.text"))
        self.assertEqual("MSE", self.chart("chart.options.scales.y.title.text"))
        after = self.chart("chart.data.datasets[0].data[29]")
        self.assertAlmostEqual(points["x"] * 12, after["x"], delta=1e-6 * after["x"])
        self.assertAlmostEqual(points["y"] * .3, after["y"], delta=1e-6 * after["y"])
        self.assertEqual(before, self.browser.evaluate(below))

    def test_the_floor_is_drawn_and_shaded(self):
        self.assertEqual(["below", "none"], self.chart("chart.options.midway_levels.map(l => l.shade)"))
        area = self.chart("[chart.chartArea.left, chart.chartArea.right, chart.chartArea.bottom,"
                          "chart.scales.y.getPixelForValue(chart.options.midway_levels[0].value)]")
        self.assertLess(area[3], area[2] - 4)
        pixel = ("[...chart.ctx.getImageData((chart.chartArea.left + 7) * devicePixelRatio,"
                 "({}) * devicePixelRatio, 1, 1).data]")
        inside = self.chart(pixel.format("chart.chartArea.bottom - 3"))
        self.assertGreater(inside[3], 20)

    def test_the_table_of_numbers_unfolds(self):
        self.browser.click(".chart summary")
        rows = "document.querySelectorAll('.numbers tbody tr').length"
        self.browser.until(f"{rows} === 180", 5)


class Images(Page):
    def setUp(self):
        super().setUp()
        self.expected = json.loads((folder / "expected.json").read_text())
        self.choose(".pick[data-side='1']", 2)  # path on the left, light on the right
        self.ball = self.image_point(LEFT, BALL)

    def test_values_are_those_of_the_render(self):
        x, y = self.expected["pixel"]
        pixel, values = self.readout(self.image_point(LEFT, ((x + .5) / 256, (y + .5) / 256)))
        self.assertEqual((x, y), pixel)
        for name in ("reference", "path"):
            for shown, true in zip(values[name], self.expected[name]):
                self.assertAlmostEqual(true, shown, delta=.006 * true)
        self.assertEqual([0, 0, 0], values["light"])

    def test_exposure_is_exact(self):
        def srgb(v):
            v = min(v, 1)
            return 255 * (12.92 * v if v <= .0031308 else 1.055 * v ** (1 / 2.4) - .055)
        x, y = self.expected["pixel"]
        at = self.image_point(LEFT, ((x + .5) / 256, (y + .5) / 256))
        before = float(self.browser.evaluate("document.querySelector('.exposure').value"))
        self.focus(".exposure")
        for _ in range(8):
            self.browser.key("ArrowLeft", 37)
        ev = float(self.browser.evaluate("document.querySelector('.exposure').value"))
        self.assertEqual(before - 2, ev)
        at = self.image_point(LEFT, ((x + .5) / 256, (y + .5) / 256))
        for shown, linear in zip(self.colour(LEFT, at), self.expected["path"]):
            self.assertAlmostEqual(srgb(linear * 2 ** ev), shown, delta=.75)

    def test_wheel_zooms_both_and_keeps_the_place(self):
        away = (self.ball[0] + 60, self.ball[1])
        pixel, _ = self.readout(self.ball)
        far, _ = self.readout(away)
        for _ in range(3):
            self.browser.wheel(*self.ball, -300)
        self.assertEqual(pixel, self.readout(self.ball)[0])
        near, _ = self.readout(away)
        self.assertLess(near[0] - pixel[0], (far[0] - pixel[0]) / 4)
        left, right = self.browser.box(LEFT), self.browser.box(RIGHT)
        other = (away[0] - left[0] + right[0], away[1] - left[1] + right[1])
        self.assertEqual(near, self.readout(other)[0])
        self.shot("zoom")

    def test_drag_moves_both(self):
        for _ in range(2):
            self.browser.wheel(*self.ball, -300)
        pixel, _ = self.readout(self.ball)
        to = (self.ball[0] - 70, self.ball[1] - 40)
        self.browser.drag(self.ball, to)
        self.assertEqual(pixel, self.readout(to)[0])
        self.browser.click(".fit")
        self.assertEqual(self.readout(self.image_point(LEFT, BALL))[0], (158, 179))

    def test_wipe_shows_one_beside_the_other(self):
        self.browser.click("[data-mode='wipe']")
        ball, middle = self.image_point(LEFT, BALL), self.image_point(LEFT, (.5, .4))
        self.assertLess(sum(self.colour(LEFT, ball)), 30)  # light, to the right of the line
        to = self.image_point(LEFT, (.9, .4))
        self.browser.drag(middle, to)
        self.assertAlmostEqual(.9, float(self.browser.evaluate(
            "document.querySelector('.wipe').value")), delta=.01)
        self.assertGreater(sum(self.colour(LEFT, ball)), 100)  # path now
        self.shot("wipe")

    def test_flip_changes_places(self):
        self.browser.click("[data-mode='flip']")
        ball = self.image_point(LEFT, BALL)
        self.assertGreater(sum(self.colour(LEFT, ball)), 100)
        self.focus(LEFT)
        self.browser.key("f", 70)
        self.assertLess(sum(self.colour(LEFT, ball)), 30)
        self.browser.click(".flip")
        ball = self.image_point(LEFT, BALL)
        self.assertGreater(sum(self.colour(LEFT, ball)), 100)
        self.browser.click(".blink")
        ball = self.image_point(LEFT, BALL)
        end = time.monotonic() + 5
        while sum(self.colour(LEFT, ball)) > 30:
            self.assertLess(time.monotonic(), end, "it does not keep flipping")

    def test_differences_have_a_sign(self):
        self.browser.click("[data-view='difference']")
        red, _, blue = self.colour(RIGHT, self.image_point(RIGHT, BALL))
        self.assertGreater(blue, red + 50)  # light is too dark there
        self.assertIn("too dark", self.browser.evaluate(
            "document.querySelector('.explain').textContent"))
        self.shot("difference")
        self.choose(".pick[data-side='1']", 0)
        self.assertEqual([247, 247, 247], self.colour(RIGHT, self.image_point(RIGHT, BALL)))
        self.browser.click("[data-view='relative']")
        self.assertEqual([0, 0, 4], self.colour(RIGHT, self.image_point(RIGHT, BALL)))
        self.shot("relative")

    def test_nothing_moves_when_the_mode_changes(self):
        below = "document.querySelector('.thumbs').getBoundingClientRect().top + scrollY"
        before = self.browser.evaluate(below)
        for button in ("[data-mode='wipe']", "[data-view='difference']", "[data-mode='flip']",
                       "[data-view='relative']"):
            self.browser.click(button)
            self.assertEqual(before, self.browser.evaluate(below), button)

    def test_small_images_choose_the_right_one(self):
        self.browser.click(".thumbs button", 4)
        self.assertEqual("4", self.browser.evaluate("document.querySelectorAll('.pick')[1].value"))


class Whole(Page):
    def test_fits_and_saves_its_data(self):
        self.fits()
        self.browser.click("[data-download]")
        file = self.browser.downloads / "convergence.csv"
        end = time.monotonic() + 10
        while not file.exists() and time.monotonic() < end:
            time.sleep(.05)
        lines = file.read_text().splitlines()
        self.assertTrue(lines[0].startswith("technique,exponent,seed,seconds"))
        self.assertEqual(1 + 6 * 4 * 30, len(lines))
        self.browser.click("[data-copy]")
        self.browser.until("['Copied', 'Selected'].includes("
                           "document.querySelector('[data-copy]').textContent)", 5)
        pages = self.browser.call("Page.printToPDF")["data"]
        self.assertGreater(len(pages), 10000)


class Dark(Page):
    options = {"dark": True}

    def test_is_dark(self):
        self.fits()
        self.assertEqual("rgb(20, 24, 27)", self.browser.evaluate(
            "getComputedStyle(document.body).backgroundColor"))

    def test_paper_is_white(self):
        colours = ("[midway.css('--ink'), Chart.getChart(document.querySelector('.plot canvas'))"
                   ".data.datasets[0].borderColor]")
        self.browser.evaluate("dispatchEvent(new Event('beforeprint'))")
        self.assertEqual(["#1d2327", "#00857a"], self.browser.evaluate(colours))
        self.browser.evaluate("dispatchEvent(new Event('afterprint'))")
        self.assertEqual(["#e4e7e6", "#2fc4b2"], self.browser.evaluate(colours))


class Phone(Page):
    width, height, options = 400, 800, {"touch": True}

    def test_fits(self):
        self.fits()


class Suite(Page):
    file = "index.html"

    def test_fits_and_leads_to_the_reports(self):
        self.fits()
        self.assertEqual(["idol/report.html", "terrace/report.html", "plates/report.html"],
                         self.browser.evaluate("[...document.querySelectorAll('td a, th a')]"
                                               ".map(a => a.getAttribute('href'))"))
        self.assertEqual(3, self.browser.evaluate(
            "[...document.images].filter(i => i.naturalWidth > 0).length"))


class Hostile(Page):
    file = "hostile/report.html"

    def test_names_are_only_text(self):
        name = (folder / "hostile/name.txt").read_text()
        self.assertIn(name, self.browser.evaluate("document.querySelector('h1').textContent"))
        self.assertEqual(0, self.browser.evaluate("document.querySelectorAll('[onerror]').length"))
        self.assertEqual("undefined", self.browser.evaluate("typeof stolen"))


def main():
    global folder, shots, chromium
    if not browser.installed():
        print("no Chromium; install the package chromium")
        return 77
    folder = Path(sys.argv[1])
    if len(sys.argv) > 2:
        shots = Path(sys.argv[2])
        shots.mkdir(parents=True, exist_ok=True)
    with browser.Browser() as chromium:
        result = unittest.TextTestRunner(stream=sys.stdout).run(
            unittest.defaultTestLoader.loadTestsFromModule(sys.modules[__name__]))
    return 0 if result.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
