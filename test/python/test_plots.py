"""Plots of sessions."""

import contextlib
import importlib.util
import io
import pathlib
import tempfile
import unittest

import numpy as np
from support import evs, tube

from endovascular_sim.plots import command, tables


@unittest.skipUnless(importlib.util.find_spec("matplotlib"), "matplotlib cannot be imported")
class Plots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        import matplotlib
        matplotlib.use("Agg")
        cls.session = evs.World("tube", fluoroscopy={"pixels": 64}).session()
        cls.session.step(n=3000)

    def tearDown(self):
        from matplotlib import pyplot
        pyplot.close("all")

    def test_show_the_wire_in_the_vessel_with_its_forces(self):
        axes = evs.plots.wire_in_vessel(self.session, route=evs.Route(tube(), ("tube", 0.1)))
        [wire] = [line for line in axes.lines if line.get_label() == "wire"]
        np.testing.assert_allclose(wire.get_xydata(), 1e3 * self.session.nodes[:, [0, 2]])
        self.assertEqual(len(axes.collections), 2)
        axes.figure.canvas.draw()
        with self.assertRaises(evs.InputError):
            evs.plots.wire_in_vessel(self.session, view="behind")

    def test_show_forces_over_time(self):
        made = evs.rollout(tube(), tube().commands(50)[np.newaxis])
        axes = evs.plots.forces(0.001 * np.arange(50), made.hands["force"][0], labels=tube().instruments)
        self.assertEqual(axes.lines[0].get_label(), "guidewire")
        with self.assertRaises(evs.InputError):
            evs.plots.forces([0.0], [1.0, 2.0])

    def test_show_x_ray_images(self):
        image = self.session.image()
        np.testing.assert_array_equal(evs.plots.x_ray(image).images[0].get_array(), image)

    def test_draw_into_given_axes(self):
        from matplotlib import pyplot
        axes = pyplot.figure().add_subplot()
        self.assertIs(evs.plots.x_ray(self.session.image(), axes), axes)


class Tables(unittest.TestCase):
    def read(self, text):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "table.csv")
            path.write_text(text, encoding="utf-8")
            return tables.read_if_any(path, ("time",))

    def test_have_columns_of_numbers_and_of_texts(self):
        table = self.read("time,name,force\n1,wire,\n2,2,0.5\n")
        np.testing.assert_array_equal(table["time"], [1.0, 2.0])
        self.assertEqual(list(table["name"]), ["wire", "2"])
        np.testing.assert_array_equal(table["force"], [np.nan, 0.5])
        self.assertEqual([(key, list(rows["time"])) for key, rows in tables.groups(table, "name")], [(("wire",), [1.0]), (("2",), [2.0])])

    def test_leave_out_the_incomplete_last_row_of_an_interrupted_session(self):
        for last in ("3,0.", "3,0.5,1e-", "3"):
            with self.subTest(last=last), contextlib.redirect_stderr(io.StringIO()) as warning:
                table = self.read("time,force,torque\n1,0.5,2\n2,0.5,2\n" + last)
                np.testing.assert_array_equal(table["time"], [1.0, 2.0])
                self.assertIn("line 4 skipped", warning.getvalue())

    def test_name_a_missing_column(self):
        with self.assertRaisesRegex(command.Failure, "no column time"):
            self.read("force\n1\n")


def straight_shaft(radius_of_bend=None):
    """Table of a shaft of 200 mm and 0.9 mm, whose last 20 mm are bent."""
    arc = np.linspace(0.0, 0.2, 401)
    along, across = arc.copy(), np.zeros_like(arc)
    if radius_of_bend:
        angle = np.maximum(arc - 0.18, 0.0) / radius_of_bend
        along, across = np.minimum(arc, 0.18) + radius_of_bend * np.sin(angle), radius_of_bend * (1.0 - np.cos(angle))
    return {"arc_length": arc, "x": np.zeros_like(arc), "y": across, "z": along, "diameter": np.full_like(arc, 9e-4),
            "inner_diameter": np.zeros_like(arc), "bending_stiffness": np.where(arc < 0.1, 291e-6, 40e-6)}


@unittest.skipUnless(importlib.util.find_spec("matplotlib"), "matplotlib cannot be imported")
class SheetOfInstruments(unittest.TestCase):
    def test_draws_all_tips_to_one_scale_with_their_names(self):
        from endovascular_sim.plots import library
        shafts = {"guidewire_%d" % k: straight_shaft(0.01 if k == 2 else None) for k in range(6)}
        balloon = {"from_tip": np.array([0.005]), "length": np.array([0.015])}
        stent = {"nominal_diameter": np.array([3e-3]), "diameter": np.array([1e-3, 3e-3]), "length": np.array([0.018, 0.0178])}
        figure = library.draw(shafts, {}, {"guidewire_0": balloon}, {"stent_3": stent})
        tips = figure.axes[0]
        figure.canvas.draw()
        self.assertEqual(tips.get_aspect(), 1.0)
        names = [text.get_text() for text in tips.texts]
        for name in [*shafts, "stent_3"]:
            self.assertIn(name.replace("_", " "), names)
        widths = [np.ptp(patch.get_xy()[:, 0]) for patch in tips.patches]
        self.assertAlmostEqual(min(widths), 0.9, places=6)   # a straight wire has its diameter [mm]
        self.assertGreater(max(widths), 9.0)                 # the bent tip
        self.assertEqual([label.get_text() for label in figure.axes[1].get_yticklabels()], ["guidewire %d" % k for k in range(6)])


class Reproduction(unittest.TestCase):
    def test_writes_its_tables_between_the_marks_of_a_page(self):
        from endovascular_sim.plots.paper import page
        from endovascular_sim.plots.paper.row import Measurement
        lines = [Measurement("nodes", "75", "48", "≤ 88", True, True).cells("fig8"),
                 Measurement("charts", "12", "1", "as stated", False, False).cells("fig10"),
                 Measurement(page.SECONDS, "–", "200").cells("fig10")]
        text = "before\n" + page.BEGIN + "\nOLD\n" + page.END + "\nafter\n"
        made = page.with_tables(text, lines, "page")
        self.assertTrue(made.startswith("before\n") and made.endswith("\nafter\n") and "OLD" not in made)
        self.assertIn("| Fig. 8 | nodes | 75 | 48 | yes | ≤ 88 | yes |", made)
        self.assertIn("| 3 min | fails |", made)
        self.assertEqual(page.with_tables(made, lines, "page"), made)
        with self.assertRaisesRegex(command.Failure, "marks"):
            page.with_tables("nothing", lines, "page")

    def test_compares_results_but_no_times(self):
        from endovascular_sim.plots.commands import reproduce
        from endovascular_sim.plots.paper.row import TIME, Measurement
        here = [Measurement("nodes", "–", "48").cells("fig8"), Measurement("time", "–", "1", kind=TIME).cells("fig8")]
        there = [Measurement("nodes", "–", "48").cells("fig8"), Measurement("time", "–", "2", kind=TIME).cells("fig8"),
                 Measurement("other", "–", "1").cells("fig9")]
        self.assertEqual(reproduce.differences(here, there, ["fig8"]), [])
        there[0]["here"] = "49"
        self.assertEqual(reproduce.differences(here, there, ["fig8"]), ["fig8, nodes: 48, expected 49"])
        self.assertEqual([line["row"] for line in reproduce.merged(there, here, ["fig8"])], ["fig8", "fig8", "fig9"])


if __name__ == "__main__":
    unittest.main()
