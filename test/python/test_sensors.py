"""Sensors and faults of a robot in Python."""

import pickle
import unittest

import numpy as np
from support import evs, tube

SENSORS = [
    {"name": "tracker", "kind": "em_tracker", "rate": 40, "delay": 0.02, "drop_out": 0.1,
     "noise": {"position": 1e-3, "angle": 0.02}},
    {"name": "encoder", "kind": "encoder", "noise": {"insertion": 1e-5}},
    {"name": "force", "kind": "force_sensor", "rate": 333, "delay": 0.005},
    {"name": "screen", "kind": "detector"},
]
C_ARM = {"isocentre": [0, 0, 0.05], "pixels": 64}


def measured(**overrides):
    return evs.World("tube", sensors=SENSORS, fluoroscopy=C_ARM, **overrides)


def readings(session, steps):
    rows = []
    for _ in range(steps):
        session.step()
        rows.append([(name, reading.sequence, reading.step, reading.valid, reading.values.tobytes())
                     for name, reading in session.sensors.items()])
    return rows


class Sensors(unittest.TestCase):
    def test_have_values_beside_the_true_ones(self):
        session = measured().session()
        session.step(n=500)
        seen = session.observe()
        self.assertEqual(list(seen.sensors), [one["name"] for one in SENSORS])
        self.assertEqual([reading.values.shape for reading in seen.sensors.values()], [(7,), (2,), (2,), (2,)])
        error = seen.sensors["encoder"].values - [seen.hands["insertion"][0], seen.hands["rotation"][0]]
        self.assertLess(abs(error[0]), 6e-5)
        self.assertNotEqual(error[0], 0.0)
        self.assertEqual(error[1], 0.0)
        camera = session.world.camera() @ [*seen.tips["position"][0], 1.0]
        np.testing.assert_allclose(seen.sensors["screen"].values, camera[:2] / camera[2], rtol=1e-12)
        self.assertAlmostEqual(seen.sensors["force"].time, 0.495, 2)
        self.assertLessEqual(seen.sensors["tracker"].time, 0.48)
        self.assertIn("Reading", repr(seen.sensors["tracker"]))

    def test_have_the_same_bits_again_and_after_a_pickle(self):
        world = measured()
        session, same = world.session(), world.session()
        first = readings(session, 130)
        self.assertEqual(readings(same, 130), first)
        copies = pickle.loads(pickle.dumps(session)), session.copy()
        further = readings(session, 200)
        for copy in copies:
            self.assertEqual(readings(copy, 200), further)
        same.reset()
        same.noise_seed = 3
        self.assertNotEqual(readings(same, 130), first)
        self.assertEqual(readings(measured(seed=1).session(), 1)[0][2], readings(world.session(), 1)[0][2])
        self.assertNotEqual(readings(measured(seed=1).session(), 130), first)

    def test_are_empty_without_the_key(self):
        session = tube().session()
        self.assertEqual(session.sensors, {})
        self.assertEqual(session.faults, [])
        self.assertEqual(session.observe().sensors, {})

    def test_do_not_change_the_trajectory(self):
        hashes = set()
        for world in (measured(), evs.World("tube")):
            session = world.session()
            session.step(n=200)
            hashes.add(session.trajectory_hash)
        self.assertEqual(len(hashes), 1)

    def test_are_observations_of_environments_by_name(self):
        world = evs.World("tube", sensors=SENSORS[:2], centreline=True)
        env = evs.Env(world, ("tube", 0.1), observations=("hand", "tracker", "encoder"), start=0.03, horizon=5)
        self.assertEqual(env.observation_space["tracker"].shape, (8,))
        runs = []
        for seed in (1, 1, 2):
            env.reset(seed=seed)
            for _ in range(3):
                observation = env.step([[0.5, 0.1]])[0]
                self.assertTrue(env.observation_space.contains(observation))
            runs.append(observation)
        np.testing.assert_array_equal(runs[0]["encoder"], runs[1]["encoder"])
        self.assertNotEqual(runs[0]["encoder"][0], runs[2]["encoder"][0])
        self.assertEqual(runs[0]["hand"][0, 0], runs[2]["hand"][0, 0])
        self.assertAlmostEqual(runs[0]["encoder"][0], runs[0]["hand"][0, 0], 4)
        flat = evs.Env(world, ("tube", 0.1), observations=("hand", "encoder"), flatten=True)
        self.assertEqual(flat.reset(seed=1)[0].shape, (5,))
        with self.assertRaisesRegex(evs.InputError, "tracker"):
            evs.Env(world, ("tube", 0.1), observations=("trakcer",))
        named = evs.World("tube", sensors=[{"name": "hand", "kind": "encoder"}], centreline=True)
        with self.assertRaisesRegex(evs.InputError, "rename the sensor"):
            evs.Env(named, ("tube", 0.1))

    def test_refuse_mistakes_with_the_key(self):
        for sensor, text in (({"name": "a"}, "sensors.0.kind"), ({"name": "a", "kind": "encoder", "nois": {}}, "noise"),
                             ({"name": "a", "kind": "encoder", "instrument": "needle"}, "sensors.0.instrument"),
                             ({"name": "a", "kind": "detector"}, "fluoroscopy")):
            with self.assertRaisesRegex(evs.InputError, text):
                evs.World("tube", sensors=[sensor])


class Faults(unittest.TestCase):
    def test_of_the_scene_act_on_commands(self):
        world = evs.World("tube", faults=[{"axis": "insertion", "kind": "stuck", "start": 0.1, "end": 0.2}])
        session = world.session()
        session.step(n=100)
        before = session.hands["insertion"][0]
        session.step(n=100)
        self.assertAlmostEqual(session.hands["insertion"][0], before, 9)
        self.assertEqual(session.faults[0]["kind"], "stuck")
        self.assertEqual(evs.World(world.yaml, faults=None).session().faults, [])

    def test_can_be_added_removed_saved_and_loaded(self):
        session = tube().session()
        session.step(n=20)
        session.add_fault("guidewire", "insertion", "slipping", 0.5, duration=0.2, probability=0.5, interval=0.01, seed=2)
        session.add_fault(0, "rotation", "delayed", 0.03)
        session.step(n=30)
        other = pickle.loads(pickle.dumps(session))
        self.assertEqual(other.faults, session.faults)
        for one in (session, other):
            one.step(tube().commands(100, first=50))
        self.assertEqual(other.trajectory_hash, session.trajectory_hash)
        self.assertGreater(session.reached[0, 0] - session.hands["insertion"][0], 1e-4)
        self.assertEqual(session.remove_faults("guidewire", "rotation"), 1)
        self.assertEqual([fault["kind"] for fault in session.faults], ["slipping"])
        session.reset()
        self.assertEqual(session.faults, [])

    def test_refuse_impossible_values(self):
        session = tube().session()
        before = session.save()
        for arguments in (("needle", "insertion", "stuck"), (1, "insertion", "stuck"), (0, "pressure", "stuck"),
                          (0, "insertion", "sticky"), (0, "insertion", "slipping", 2.0),
                          (0, "insertion", "delayed", np.nan), (0, "insertion", "delayed", 11.0),
                          (0, "insertion", "stuck", 0.0, -1.0), (0, "insertion", "stuck", 0.0, None, 2.0),
                          (0, "insertion", "stuck", 0.0, None, 1.0, 0.0)):
            with self.assertRaises(evs.InputError, msg=repr(arguments)):
                session.add_fault(*arguments)
        with self.assertRaises(evs.InputError):
            session.remove_faults(3, "insertion")
        self.assertEqual(session.save(), before)

    def test_an_environment_steps_on_through_slipping(self):
        world = evs.World("tube", centreline=True, faults=[{"axis": "insertion", "kind": "slipping", "share": 0.5}])
        env = evs.Env(world, ("tube", 0.1), vary=False)
        env.reset(seed=1)
        before = env.session.hands["insertion"][0]
        for _ in range(3):
            env.step([[0.5, 0.0]])
        moved = env.session.hands["insertion"][0] - before
        self.assertAlmostEqual(moved, 0.5 * 3 * 0.5 * 0.04 * 2 / 15, 4)


if __name__ == "__main__":
    unittest.main()
