"""Sessions: arrays, images, results, commands of clients."""

import json
import pathlib
import tempfile
import unittest

import numpy as np
import support
from support import evs, tube


class Sessions(unittest.TestCase):
    def test_observe_hands_tips_nodes_and_forces(self):
        session = tube().session()
        session.step(n=2500)
        self.assertEqual(session.hands["insertion"].shape, (1,))
        self.assertEqual(session.tips["frame"].shape, (1, 3, 3))
        np.testing.assert_allclose(session.tips["position"][0], session.nodes[-1], atol=1e-12)
        frame = session.tips["frame"][0]
        np.testing.assert_allclose(frame.T @ frame, np.eye(3), atol=1e-12)
        forces = session.forces
        self.assertGreater(len(forces), 0)
        self.assertGreater(np.linalg.norm(forces["normal_force"], axis=1).max(), 1e-4)
        self.assertTrue((np.diff(forces["node"]) > 0).all())
        self.assertGreater(len(session.contacts), 0)
        self.assertEqual(session.branch().name, "tube")
        self.assertEqual(session.branch("guidewire").depth, session.branch(-1).depth)

    def test_observe_in_one_call_what_the_parts_say(self):
        session = tube().session()
        session.step(n=2000)
        seen = session.observe()
        for name in ("hands", "tips", "nodes", "forces"):
            np.testing.assert_array_equal(getattr(seen, name), getattr(session, name))
        self.assertEqual((seen.step, seen.time), (session.steps, session.time))
        before = seen.nodes.copy()
        session.step(n=100)
        np.testing.assert_array_equal(seen.nodes, before)

    def test_track_points_from_the_tip_to_the_introducer(self):
        session = tube().session()
        points = session.track(5, 0.004)
        np.testing.assert_allclose(points[:, 2], [0.01, 0.006, 0.002, 0.0, 0.0], atol=1e-9)
        np.testing.assert_allclose(points[0], session.tips["position"][0], atol=1e-12)
        with self.assertRaises(evs.InputError):
            session.track(-1, 0.004)

    def test_end_with_the_run_and_go_on_by_commands(self):
        session = evs.World("tube", duration=0.01).session()
        self.assertEqual(session.step(n=100), 10)
        self.assertTrue(session.over)
        self.assertEqual(session.step(), 0)
        self.assertEqual(session.step([[0.01, 0.0, 0.0]], n=5), 5)
        session.last_step = 20
        self.assertEqual(session.step(n=100), 5)

    def test_report_their_procedure(self):
        session = evs.World(support.PROCEDURE).session()
        self.assertEqual(session.procedure, "running")
        session.step(n=2000)
        self.assertEqual(session.procedure, "done")
        self.assertIsNone(tube().session().procedure)

    def test_take_images_that_do_not_depend_on_earlier_ones(self):
        session = evs.World("tube", fluoroscopy={"pixels": 128}).session()
        session.step(n=1500)
        first = session.image()
        self.assertEqual((first.shape, first.dtype), ((128, 128), np.uint8))
        self.assertEqual(session.image(raw=True).dtype, np.uint16)
        self.assertFalse(np.array_equal(session.image("LAO 40"), first))
        np.testing.assert_array_equal(session.image(), first)
        with self.assertRaisesRegex(evs.InputError, "view"):
            session.image("FROM ABOVE")

    def test_take_runs_of_x_ray_frames_at_the_pulses_of_the_scene(self):
        world = evs.World("tube", fluoroscopy={"pixels": 64})
        session = world.session()
        run = session.cine(0.3, dsa=2, raw=True)
        self.assertEqual(list(run.steps), [0, 67, 134, 200, 267])
        self.assertEqual(list(run.pulses), [0, 1, 2, 3, 4])
        np.testing.assert_array_equal(run.times, run.steps * world.time_step)
        self.assertEqual((run.images.shape, run.images.dtype), ((5, 64, 64), np.uint8))
        self.assertEqual((run.raw.shape, run.raw.dtype), ((5, 64, 64), np.uint16))
        self.assertEqual(run.subtracted.shape, (3, 64, 64))
        self.assertEqual((len(run), session.steps), (5, 300))
        state = session.save()
        later = session.cine(0.1)
        self.assertEqual(list(later.pulses), [5, 6])
        self.assertEqual(later.raw.shape, (0, 64, 64))
        session.load(state)
        held = np.zeros((len(world.instruments), 3))
        held[:, :2] = session.reached
        both = session.cine(0.1, view=("AP", "LAO 40"), commands=held)
        self.assertEqual(both.images.shape, (2, 2, 64, 64))
        self.assertFalse(np.array_equal(both.images[0, 0], both.images[0, 1]))
        session.load(state)
        np.testing.assert_array_equal(session.cine(0.1).images, later.images)
        for arguments, part in (((-1.0,), "seconds"), ((1.0, "FROM ABOVE"), "view"), ((1.0, 3), "view"),
                                ((1.0, "", -1), "dsa"), ((1.0, "", 65), "mask_frames"),
                                ((1.0, "", 1, (99.0, 0.0)), "shift"),
                                ((1.0, "", 0, (0.0, 0.0), False, None, 0.5), "needs a run of DSA"),
                                ((1.0, "", 8, (0.0, 0.0), False, None, 0.3), "begins at")):
            with self.assertRaisesRegex(evs.InputError, part):
                session.cine(*arguments)

    def test_write_the_results_of_simulate(self):
        with tempfile.TemporaryDirectory() as folder:
            session = tube().session(results=True)
            session.step(n=200)
            session.finish(pathlib.Path(folder) / "new")
            written = (pathlib.Path(folder) / "new" / "result.json").read_text()
            self.assertEqual(session.result, written)
        self.assertEqual(json.loads(session.result)["trajectory_hash"], session.trajectory_hash)
        self.assertEqual(session.rejected_steps, 0)
        with self.assertRaisesRegex(evs.UsageError, "results=True"):
            tube().session().finish("nowhere")

    def test_follow_commands_of_clients(self):
        session = evs.World("tube", **{"drive.source": "topic"}).session(clients=True)
        start = session.hands["insertion"][0]
        session.command("guidewire", "servo_jv", [0.02, 1.0])
        session.step(n=50)
        self.assertAlmostEqual(session.hands["insertion"][0], start + 0.001, delta=2e-4)
        with self.assertRaisesRegex(evs.InputError, "refused"):
            session.command(0, "move_jp", [float("nan"), 0.0])
        with self.assertRaisesRegex(evs.InputError, "unknown"):
            session.command(0, "jump", [0.0, 0.0])
        with self.assertRaisesRegex(evs.UsageError, "clients=True"):
            tube().session().command(0, "servo_jv", [0.02, 0.0])

    def test_continue_a_command_of_clients_in_a_copy(self):
        session = evs.World("tube", **{"drive.source": "topic"}).session(clients=True)
        session.command(0, "move_jp", [0.04, 0.5])
        session.step(n=100)
        copy = session.copy()
        for one in (session, copy):
            one.step(n=300)
        self.assertEqual(copy.trajectory_hash, session.trajectory_hash)
        self.assertGreater(session.hands["insertion"][0], 0.02)

    def test_adopt_a_shape_under_another_friction(self):
        first = tube().session()
        first.step(n=2500)
        second = tube().vary(**{"vessel.friction": 0.4}).session()
        with self.assertRaisesRegex(evs.InputError, "another scene"):
            second.load(first.save())
        self.assertIn("contact forces", second.adopt(first.save())[0])
        np.testing.assert_array_equal(second.nodes, first.nodes)
        self.assertEqual(second.steps, first.steps)
        with self.assertRaises(evs.InputError):
            evs.World("tube", **{"sampling.nodes": 100}).session().adopt(first.save())

    def test_measure_the_largest_forces_of_their_steps(self):
        session, again = tube().session(), tube().session()
        commands = tube().commands(2500)
        peaks = evs.advance([session], commands[np.newaxis])
        largest = 0.0
        for command in commands:
            again.step(command)
            forces = again.forces["normal_force"]
            largest = max(largest, np.linalg.norm(forces, axis=1).max(initial=0.0))
        self.assertAlmostEqual(peaks["wall_force"][0], largest, places=12)
        self.assertGreater(largest, 0.0)
        self.assertEqual(again.trajectory_hash, session.trajectory_hash)

    def test_sample_a_rollout_as_a_session(self):
        commands = tube().commands(300)
        made = evs.rollout(tube(), commands[np.newaxis], every=100)
        session = tube().session()
        for k in range(3):
            session.step(commands[100 * k:100 * (k + 1)])
            np.testing.assert_array_equal(made.tips[0, k], session.tips)
            np.testing.assert_array_equal(made.hands[0, k], session.hands)


if __name__ == "__main__":
    unittest.main()
