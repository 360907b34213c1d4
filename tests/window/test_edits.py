"""Lights and materials by hand: real mouse and key events on the idol."""

import unittest
from pathlib import Path

from window_test import TOOLS, HandsTest, wait_for

IDOL = Path(__file__).resolve().parents[2] / "assets" / "idol.glb"
# Distances from a section's top: the middle of its first row and of those that follow.
FIRST_ROW, ROW = 40, 29


@unittest.skipIf(TOOLS, f"{' and '.join(TOOLS)} missing (app/packages.txt lists them)")
class EditByHand(HandsTest):
    def place(self, report, section, row, from_left=None, from_right=None):
        x0, y0, x1, _ = report["sections"][section]
        x = x0 + from_left if from_left is not None else x1 - from_right
        return round(x), round(y0 + FIRST_ROW + row * ROW)

    def test_edit_a_light_undo_select_edit_a_material_reset(self):
        self.open_in_steps([f"open {IDOL}", "set size 142x138", "set spp 2"], "idol.glb - Midway")
        self.hand("mousemove", 640, 660)
        first = self.state()
        self.assertEqual(([], [{"name": "lamp", "on": True}], 0, 0),
                         tuple(first[k] for k in ("edits", "lights", "undo", "redo")))

        self.hand("mousemove", *self.place(first, "Lights", 0, from_left=11), "click", 1)
        dark = self.state()
        self.look("edits-1-lamp-off")
        self.assertEqual((['material "lamp": off'], [{"name": "lamp", "on": False}]),
                         (dark["edits"], dark["lights"]))
        self.assertGreater(dark["job"], first["job"])
        self.assertEqual(first["sections"]["Lights"], dark["sections"]["Lights"],
                         "rows stay in place when a lamp is switched")
        self.press("ctrl+z")
        self.assertEqual(([], 0, 1), tuple(self.state()[k] for k in ("edits", "undo", "redo")))
        self.press("ctrl+shift+z")
        self.assertEqual(dark["edits"], self.state()["edits"])
        self.press("ctrl+z")
        self.assertEqual([], self.state()["edits"])

        self.drag(*self.place(first, "Lights", 0, from_right=30), 30, 0)
        dragged = self.state()
        self.assertRegex(dragged["edits"][0], r'^material "lamp": emission_strength 2\d\d\d')
        self.assertEqual((1, 0), (dragged["undo"], dragged["redo"]), "a drag is one step")
        self.press("ctrl+z")
        self.assertEqual([], self.state()["edits"])
        self.press("ctrl+y")
        again = self.state()
        self.assertEqual(dragged["edits"], again["edits"])

        self.hand("mousemove", 640, 660)
        self.press("u")
        self.hand("mousemove", 520, 290, "click", 1)
        selected = self.state()
        self.look("edits-2-selected")
        self.assertEqual({"object": "idol", "material": "idol glass"}, selected["selected"])
        self.assertEqual(again["job"], selected["job"], "selecting restarts nothing")
        self.drag(*self.place(selected, "Material", 4, from_left=92), 60, 0)  # roughness
        rough = self.state()
        self.look("edits-3-rough-glass")
        self.assertEqual(dragged["edits"], rough["edits"][:1])
        self.assertRegex(rough["edits"][1], r'^material "idol glass": roughness 0\.[2-7]\d*$')
        self.hand("mousemove", *self.place(rough, "Material", 10, from_left=120), "click", 1)
        self.assertEqual(dragged["edits"], self.state()["edits"], "the glass as in the file")
        self.press("ctrl+z")
        self.assertEqual(rough["edits"], self.state()["edits"])

        self.hand("mousemove", *self.place(rough, "Scene", 1.5, from_right=40), "click", 1)
        self.assertEqual([], self.state()["edits"], "all as in the file")
        self.press("ctrl+q")
        self.assertIsNotNone(wait_for(lambda: self.process.poll() is not None))
        self.assertEqual(0, self.process.returncode, self.process.stderr.read())
