"""Worlds: scenes, overrides, variations."""

import copy
import pathlib
import pickle
import tempfile
import unittest
import warnings

import numpy as np
import support
import yaml
from support import evs, tube


class Worlds(unittest.TestCase):
    def test_open_by_name_path_and_text_alike(self):
        path = support.REPOSITORY / "config/scenes/tube.yaml"
        text = path.read_text()
        for scene in (str(path), path, text):
            self.assertEqual(evs.World(scene).yaml, tube().yaml)

    def test_take_overrides_as_keywords_dictionaries_and_paths(self):
        by_path = evs.World("tube", duration=2, **{"vessel.friction": 0.25, "drive.speed": 0.05})
        by_dictionary = evs.World("tube", duration=2, vessel={"friction": np.float64(0.25)},
                                  drive={"speed": np.float32(0.05).item()})
        self.assertIn("friction: 0.25", by_path.yaml)
        self.assertEqual(by_path.duration, 2.0)
        self.assertNotEqual(by_path.hash, tube().hash)
        self.assertEqual(by_dictionary.yaml.count("friction: 0.25"), by_path.yaml.count("friction: 0.25"))

    def test_take_values_of_all_kinds(self):
        world = evs.World("tube", name="named", vessel={"stiffness": float("inf")}, fluoroscopy={},
                          entry={"position": np.array([0.0, 0.0, 0.001])}, haptic_device=False)
        self.assertEqual(world.name, "named")
        np.testing.assert_array_equal(world.entry[0], [0.0, 0.0, 0.001])
        self.assertEqual(len(evs.World("tube", vessel=None).vertices), 0)

    def test_refuse_bad_scenes_with_the_message_of_the_core(self):
        for scene, overrides, text in (("no_such_scene", {}, "no such file"), ("tube", {"colour": 1}, "unknown key"),
                                       ("tube", {"duration": -1}, "duration"), ("a: b\nc: d\n", {}, "missing"),
                                       (3, {}, "needs a scene"), ("tube", {"duration": print}, "builtin")):
            with self.assertRaisesRegex(evs.InputError, text):
                evs.World(scene, **overrides)
        data = yaml.safe_load((support.REPOSITORY / "test/data/refused_scenes.yaml").read_text())
        for refusal in data["refusals"].values():
            text = refusal.get("text", data["scene"] + refusal.get("add", ""))
            if "replace" in refusal:
                text = text.replace(refusal["replace"], refusal["by"])
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder, "scene.yaml")
                path.write_text(text)
                with warnings.catch_warnings(), self.assertRaises(evs.InputError):
                    warnings.simplefilter("ignore")
                    evs.World(path)

    def test_pass_the_warnings_of_a_scene_to_python(self):
        with self.assertWarnsRegex(UserWarning, "drive.speed"):
            evs.World("tube", **{"drive.speed": 3})
        with warnings.catch_warnings(), self.assertRaises(UserWarning):
            warnings.simplefilter("error")
            evs.World("tube", **{"drive.speed": 3})

    def test_describe_vessel_and_instruments(self):
        world = tube()
        self.assertEqual(world.instruments, ("guidewire",))
        self.assertEqual(world.vertices.shape[1], 3)
        self.assertEqual(world.triangles.shape[1], 3)
        self.assertLess(world.triangles.max(), len(world.vertices))
        [branch] = world.branches
        self.assertEqual(branch["points"].shape, (len(branch["radii"]), 3))
        self.assertAlmostEqual(np.median(branch["radii"]), 3e-3, delta=1e-4)

    def test_return_copies(self):
        world = tube()
        world.vertices[:] = 0.0
        self.assertGreater(np.abs(world.vertices).max(), 0.0)

    def test_vary_friction_with_the_same_vessel(self):
        varied = tube().vary(**{"vessel.friction": 0.4})
        opened = evs.World("tube", **{"vessel.friction": 0.4})
        self.assertEqual(varied.hash, opened.hash)
        sessions = [world.session() for world in (varied, opened, tube())]
        for session in sessions:
            session.step(n=2500)
        hashes = [session.trajectory_hash for session in sessions]
        self.assertEqual(hashes[0], hashes[1])
        self.assertNotEqual(hashes[0], hashes[2])

    def test_refuse_to_vary_what_they_share(self):
        for overrides in ({"vessel.tube.radius": 0.01}, {"vessel": None}, {"entry.position": [0, 0, 0.01]}):
            with self.assertRaisesRegex(evs.InputError, "open another World"):
                tube().vary(**overrides)

    def test_copy_and_pickle(self):
        self.assertIs(copy.copy(tube()), tube())
        self.assertIs(copy.deepcopy(tube()), tube())
        for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
            loaded = pickle.loads(pickle.dumps(tube(), protocol))
            self.assertEqual((loaded.hash, loaded.mesh_hash), (tube().hash, tube().mesh_hash))
            session = pickle.loads(pickle.dumps(tube().session(), protocol))
            self.assertEqual(session.save(), tube().session().save())

    def test_pickle_with_files_beside_the_scene(self):
        with tempfile.TemporaryDirectory() as folder:
            mesh = pathlib.Path(folder) / "mesh.obj"
            lines = ["v %r %r %r" % tuple(vertex) for vertex in tube().vertices.tolist()]
            lines += ["f %d %d %d" % tuple(triangle) for triangle in (tube().triangles + 1).tolist()]
            mesh.write_text("\n".join(lines) + "\n")
            scene = pathlib.Path(folder) / "scene.yaml"
            scene.write_text("vessel: {mesh: mesh.obj, unit: 1, friction: 0.1}\n"
                             "entry: {position: [0, 0, 0.001], direction: [0, 0, 1], up: [1, 0, 0]}\n"
                             "instrument: instruments/guidewire_035_straight.yaml\n"
                             "drive: {source: script, initial_insertion: 0.01, speed: 0.03, travel: 0.05}\n")
            world = evs.World(scene)
            loaded = pickle.loads(pickle.dumps(world))
        self.assertEqual((loaded.hash, loaded.mesh_hash), (world.hash, world.mesh_hash))

    def test_need_no_vessel(self):
        world = evs.World("straight_wire")
        self.assertEqual((len(world.vertices), world.branches), (0, []))
        session = world.session()
        session.step()
        self.assertEqual(session.branch().name, "outside")


if __name__ == "__main__":
    unittest.main()
