"""CSV tables of bags."""

import contextlib
import csv
import io
import pathlib
import tempfile
import unittest
import unittest.mock

import numpy as np
from support import evs
from test_bags import FORMER_SESSION, SESSION, small_bag

from endovascular_sim import bag_export


def rows(path):
    with open(path, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


class BagExports(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_program(self, *words):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = bag_export.main([*map(str, words), "--out", str(self.folder / "out")])
        return code, err.getvalue()

    def test_every_number_of_the_steps_is_exported_with_all_digits(self):
        for path in (SESSION, FORMER_SESSION):
            bag = evs.Bag(path)
            bag_export.export(bag, self.folder)
            table = rows(self.folder / "drive.applied.csv")
            self.assertEqual([int(row["step"]) for row in table], bag.steps.tolist())
            self.assertEqual(["%016x" % int(row["state_hash"]) for row in table], bag.hashes)
            columns = ("insertion", "rotation", "pressure")
            exported = [[[float(row["%s.%d" % (name, k)]) for name in columns] for k in range(bag.commands.shape[1])] for row in table]
            self.assertTrue(np.array_equal(exported, bag.commands))

    def test_a_long_list_has_a_table_with_the_row_of_its_message(self):
        bag = evs.Bag(SESSION)
        (_, mesh), = bag.read("vessel/mesh")
        with unittest.mock.patch.object(bag_export, "LONGEST_ROW", len(mesh["mesh"]["vertices"]) - 1):
            bag_export.export(bag, self.folder, ["vessel/mesh"])
        table = rows(self.folder / "vessel.mesh.mesh.vertices.csv")
        self.assertTrue(np.array_equal([[float(row[axis]) for axis in "xyz"] for row in table], mesh["mesh"]["vertices"]))
        self.assertEqual({row["row"] for row in table}, {"0"})

    def test_every_topic_has_a_table_with_a_row_per_message(self):
        bag = evs.Bag(SESSION)
        paths = bag_export.export(bag, self.folder)
        self.assertEqual(len(paths), len({path.name for path in paths}))
        for topic, count in bag.topics.items():
            self.assertEqual(len(rows(self.folder / (topic.strip("/").replace("/", ".") + ".csv"))), count, topic)

    def test_nested_fields_texts_and_lists_become_columns(self):
        path = self.folder / "small.bag"
        path.write_bytes(small_bag())
        self.assertEqual(self.run_program(path), (0, ""))
        row, = rows(self.folder / "out" / "ns.topic.csv")
        self.assertEqual(row["header.frame_id"], "m")
        self.assertEqual([float(row["values.%d" % k]) for k in range(2)], [0.5, -1.5])
        self.assertEqual([float(row["points.0." + axis]) for axis in "xyz"], [1.0, 2.0, 3.0])
        self.assertEqual((row["words.0"], row["words.1"]), ("a", ""))

    def test_a_damaged_bag_is_exported_as_far_as_it_can_be_read_and_named(self):
        path = self.folder / "cut.bag"
        content = SESSION.read_bytes()
        path.write_bytes(content[:len(content) * 6 // 10])
        code, message = self.run_program(path)
        self.assertEqual(code, 3)
        self.assertIn("is damaged", message)

    def test_files_that_are_no_bag_and_unknown_topics_are_refused(self):
        path = self.folder / "no.bag"
        path.write_bytes(b"no bag")
        code, message = self.run_program(path)
        self.assertEqual(code, 1)
        self.assertIn("is no bag", message)
        code, message = self.run_program(SESSION, "--topic", "no/topic")
        self.assertEqual(code, 1)
        self.assertIn("no topic no/topic", message)


if __name__ == "__main__":
    unittest.main()
