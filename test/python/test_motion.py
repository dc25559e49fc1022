"""Motion of the patient in Python."""

import pickle
import unittest

import numpy as np
from support import evs, tube


def patient(**overrides):
    return evs.World("catheter", fluoroscopy=None, motion="adult", **overrides)


class Motion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = patient()
        cls.session = cls.world.session()
        cls.session.step(n=300)
        cls.ostium = next(one for one in cls.world.branches if one["name"] == "left_main")["points"][0]

    def test_has_phases_and_a_map(self):
        motion = self.session.motion
        self.assertAlmostEqual(motion.heart_phase, 0.3 * 1.1667, 12)
        self.assertEqual(motion.heart_rate, 1.1667)
        self.assertTrue(motion.systole)
        self.assertAlmostEqual(motion.breath_phase, 0.075, 12)
        self.assertEqual(motion.breathing_rate, 0.25)
        self.assertFalse(motion.breath_held)
        self.assertGreater(motion.diaphragm, 0.0)
        self.assertIn("Motion", repr(motion))
        moved = motion.position(self.ostium)
        self.assertGreater(np.linalg.norm(moved - self.ostium), 5e-3)
        np.testing.assert_allclose(motion.pull_back(moved), self.ostium, atol=1e-12)

    def test_maps_arrays_with_the_bits_of_points(self):
        motion = self.session.motion
        points = np.array([self.ostium, self.ostium + [0.01, 0.0, 0.0], [0.0, 0.0, -1.0]])
        for function in (motion.position, motion.pull_back, motion.velocity):
            values = function(points)
            self.assertEqual(values.shape, (3, 3))
            for point, value in zip(points, values):
                np.testing.assert_array_equal(function(point), value)
        np.testing.assert_array_equal(motion.position(points)[2], points[2], "does not move")
        self.assertEqual(motion.position(np.zeros((0, 3))).shape, (0, 3))
        np.testing.assert_array_equal(motion.position(points[::-1]), motion.position(points)[::-1])
        np.testing.assert_array_equal(motion.position(points.tolist()), motion.position(points))
        for wrong in (1.0, [1.0, 2.0], np.zeros((3, 2)), np.zeros((2, 3, 3))):
            self.assertRaises(evs.InputError, motion.position, wrong)

    def test_has_the_velocity_of_its_map(self):
        session = self.session.copy()
        before = session.motion
        session.step(n=2)
        between = (session.motion.position(self.ostium) - before.position(self.ostium)) / (2 * self.world.time_step)
        again = self.session.copy()
        again.step()
        np.testing.assert_allclose(again.motion.velocity(self.ostium), between, atol=2e-3)
        self.assertGreater(np.linalg.norm(between), 0.01)

    def test_is_part_of_observations_and_copies(self):
        seen = self.session.observe().motion
        self.assertEqual(seen.heart_phase, self.session.motion.heart_phase)
        copies = self.session.copy(), pickle.loads(pickle.dumps(self.session))
        for copy in copies:
            copy.step(n=5)
            self.assertNotEqual(copy.motion.heart_phase, seen.heart_phase)
        np.testing.assert_array_equal(copies[0].motion.position(self.ostium), copies[1].motion.position(self.ostium))

    def test_changes_with_the_teachers_controls(self):
        session = self.world.session()
        self.assertEqual(session.motion.controls, {"heart_rate": 1.1667, "breathing_rate": 0.25, "breath_held": False})
        session.set_motion(heart_rate=2.0, breath_held=True)
        self.assertEqual(session.motion.controls, {"heart_rate": 2.0, "breathing_rate": 0.25, "breath_held": True})
        session.step(n=1000)
        self.assertEqual(session.motion.heart_rate, 2.0)
        self.assertEqual(session.motion.diaphragm, 0.0)
        for wrong in ({"heart_rate": 0.0}, {"heart_rate": 400 / 60}, {"breathing_rate": 0.0}, {"breathing_rate": float("nan")}):
            self.assertRaises(evs.InputError, session.set_motion, **wrong)
        with self.assertRaisesRegex(evs.InputError, "heart_rate is 70 Hz"):
            session.set_motion(heart_rate=70)
        self.assertEqual(session.motion.controls["heart_rate"], 2.0)

    def test_is_driven_by_the_flow(self):
        session = patient(flow="adult").session()
        with self.assertRaisesRegex(evs.InputError, "the flow, which drives the heart"):
            session.set_motion(heart_rate=2.0)
        session.set_motion(breathing_rate=0.5)
        self.assertEqual(session.motion.controls["breathing_rate"], 0.5)

    def test_is_none_in_other_scenes(self):
        session = tube().session()
        self.assertIsNone(session.motion)
        self.assertIsNone(session.observe().motion)
        with self.assertRaisesRegex(evs.UsageError, "motion='adult'"):
            session.set_motion(breath_held=True)

    def test_is_refused_with_its_key(self):
        with self.assertRaisesRegex(evs.InputError, "motion.heart_rate.*20 to 300 per minute"):
            patient(**{"motion.heart_rate": 0})
        with self.assertRaisesRegex(evs.InputError, "no motion \"child\"; known: adult"):
            evs.World("catheter", motion="child")


if __name__ == "__main__":
    unittest.main()
