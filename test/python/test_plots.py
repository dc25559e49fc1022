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


if __name__ == "__main__":
    unittest.main()
