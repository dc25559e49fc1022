"""Environments: Gymnasium's API, with Gymnasium or its stand-in."""

import functools
import importlib.util
import os
import pickle
import tempfile
import unittest

import numpy as np
from support import evs, run_python, tube

from endovascular_sim import _gym

SAME_IN_ANOTHER_PROCESS = """
import pickle, sys
env, actions = pickle.load(open(sys.argv[1], "rb"))
for action in actions:
    info = env.step(action)[-1]
print(info["trajectory_hash"])
"""


@functools.lru_cache(maxsize=None)
def fork():
    """Wire before a fork into a left and a right branch, with an X-ray image."""
    return evs.World("fork", fluoroscopy={"pixels": 64}, **{"sampling.nodes": 140})


def make(**options):
    options = {"horizon": 12, **options}
    return evs.Env(fork(), ("left", 0.01), **options)


def worker_env():
    """Environment of a worker process, which has no world yet."""
    return make(horizon=3)


def actions(count, env, seed=3):
    env.action_space.seed(seed)
    return [env.action_space.sample() for _ in range(count)]


class Environments(unittest.TestCase):
    def test_return_what_their_spaces_promise(self):
        for options in ({}, {"observations": tuple(evs.env.OBSERVATIONS)}, {"flatten": True},
                        {"action": "position"}, {"action": "force"}, {"start": 0.05, "start_turn": 1.0}):
            with self.subTest(options), make(**options) as env:
                observation, info = env.reset(seed=1)
                self.assertTrue(env.observation_space.contains(observation))
                for action in actions(3, env):
                    observation, reward, terminated, truncated, info = env.step(action)
                    self.assertTrue(env.observation_space.contains(observation), observation)
                    self.assertEqual([type(value) for value in (reward, terminated, truncated)], [float, bool, bool])
                self.assertIsInstance(info["trajectory_hash"], str)

    def test_repeat_an_episode_bit_for_bit(self):
        hashes = []
        env, other = make(start_turn=2.0), make(start_turn=2.0)
        for one in (env, other, env):
            one.reset(seed=5)
            hashes.append([one.step(action)[-1]["trajectory_hash"] for action in actions(4, env)])
        self.assertEqual(hashes[0], hashes[1])
        self.assertEqual(hashes[0], hashes[2])
        env.reset(seed=6)
        self.assertNotEqual(env.step(actions(1, env)[0])[-1]["trajectory_hash"], hashes[0][0])

    def test_have_the_trajectory_of_a_session_with_the_same_commands(self):
        env = make(vary=False)
        env.reset(seed=1)
        session = fork().session()
        for action in actions(4, env):
            commands = env.commands(np.clip(action, -1, 1))
            info = env.step(action)[-1]
            session.step(commands)
            self.assertEqual(info["trajectory_hash"], session.trajectory_hash)

    def test_move_at_the_speed_of_the_action(self):
        env = make(vary=False, start=0.03)
        env.reset(seed=1)
        before = env.session.hands[0]
        env.step(np.array([[0.5, -1.0]], np.float32))
        after = env.session.hands[0]
        seconds = env.steps * env.world.time_step
        self.assertAlmostEqual(after["insertion"] - before["insertion"], 0.02 * seconds, places=9)
        self.assertAlmostEqual(after["rotation"] - before["rotation"], -3.0 * seconds, places=9)

    def test_move_to_the_position_of_the_action(self):
        env = make(action="position", vary=False, scale=(0.2, 10.0), turns=2.0)
        env.reset(seed=1)
        largest = env.session.stops[0, 1]
        goal = 2 * 0.03 / largest - 1
        for _ in range(3):
            env.step(np.array([[goal, 0.25]], np.float32))
        self.assertAlmostEqual(env.session.hands["insertion"][0], 0.03, places=5)
        self.assertAlmostEqual(env.session.hands["rotation"][0], 0.5, places=5)

    def test_push_with_the_force_of_the_action(self):
        env = make(action="force", vary=False, start=0.03)
        env.reset(seed=1)
        before = env.session.hands["insertion"][0]
        env.step(np.array([[0.5, 0.0]], np.float32))
        self.assertGreater(env.session.hands["insertion"][0], before)

    def test_reward_progress_along_the_centreline(self):
        env = make(start=0.03, rewards={"step": 0.0, "target": 0.0}, horizon=40)
        env.reset(seed=1)
        first = env._followed
        total = sum(env.step(np.array([[1.0, 0.0]], np.float32))[1] for _ in range(8))
        self.assertAlmostEqual(total, 100.0 * (first - env._followed), places=9)
        self.assertGreater(total, 2.0)

    def test_bring_no_more_progress_than_the_hand_moved(self):
        for seed in range(3):
            env = make(start=0.02, start_turn=3.0, rewards={"step": 0.0, "target": 0.0}, horizon=60)
            env.reset(seed=seed)
            for action in actions(40, env, seed):
                action[0, 0] = abs(action[0, 0])
                before = env.session.hands["insertion"][0]
                _, reward, terminated, _, _ = env.step(action)
                moved = abs(env.session.hands["insertion"][0] - before)
                self.assertLessEqual(reward / 100.0, 1.5 * moved + 1e-3 + 1e-12)
                if terminated:
                    break

    def test_end_at_the_target_or_at_the_horizon(self):
        near = evs.Env(fork(), ("trunk", 0.03), start=0.01, tolerance=2e-3, horizon=40)
        near.reset(seed=1)
        for _ in range(40):
            _, reward, terminated, truncated, info = near.step(np.array([[0.3, 0.0]], np.float32))
            if terminated or truncated:
                break
        self.assertEqual((terminated, truncated, info["success"], info["reason"]), (True, False, True, "target"))
        self.assertGreater(reward, 4.0)
        env = make(horizon=2)
        env.reset(seed=1)
        still = np.zeros((1, 2), np.float32)
        self.assertFalse(env.step(still)[3])
        result = env.step(still)
        self.assertEqual((result[2], result[3], result[4]["reason"]), (False, True, "horizon"))

    def test_end_or_cost_by_a_force(self):
        for ends in (True, False):
            env = make(start=0.03, force_limits={"hand_force": 1e-6}, force_ends=ends,
                       rewards={"step": 0.0, "force": 10.0, "progress": 0.0})
            env.reset(seed=1)
            _, reward, terminated, _, info = env.step(np.array([[1.0, 0.5]], np.float32))
            self.assertGreater(info["hand_force"], 1e-6)
            self.assertAlmostEqual(reward, -10.0 * (info["hand_force"] - 1e-6), places=9)
            self.assertEqual((terminated, info["reason"]), (ends, "hand_force" if ends else ""))

    def test_refuse_targets_out_of_reach(self):
        with self.assertRaisesRegex(evs.InputError, "cannot be reached.*inserted by"):
            evs.Env(evs.World("demo"), ("right_subclavian", 0.05))
        with self.assertRaisesRegex(evs.InputError, "no branch"):
            evs.Env(fork(), ("middle", 0.01))
        with self.assertRaisesRegex(evs.InputError, "does not lie in"):
            evs.Env(fork(), ("left", 5.0))
        with self.assertRaisesRegex(evs.InputError, "narrows"):
            lesion = {"branch": "trunk", "from_start": 0.03, "length": 0.02, "grade": 0.9}
            evs.Env(evs.World("fork", vessel={"lesions": [lesion]}), ("left", 0.02))

    def test_refuse_wrong_options_and_actions(self):
        for options in ({"action": "thought"}, {"observations": ("smell",)}, {"rewards": {"fun": 1}},
                        {"force_limits": {"x": 1}}, {"render_mode": "human"}, {"start": 9.0},
                        {"observations": ("image",), "flatten": True}):
            with self.assertRaises(evs.InputError, msg=options):
                make(**options)
        env = make()
        with self.assertRaises(evs.UsageError):
            env.step(np.zeros((1, 2)))
        env.reset(seed=1)
        for action in (np.zeros(2), np.full((1, 2), np.nan), np.zeros((2, 2))):
            with self.assertRaises(evs.InputError):
                env.step(action)
        env.close()
        with self.assertRaises(evs.UsageError):
            env.step(np.zeros((1, 2)))

    def test_render_x_ray_images(self):
        env = make(render_mode="rgb_array", view="LAO 20")
        env.reset(seed=1)
        image = env.render()
        self.assertEqual((image.shape, image.dtype), ((64, 64, 3), np.uint8))
        self.assertIsNone(make().render())

    def test_project_tracked_points_onto_the_image(self):
        camera = fork().camera(isocentre=[0.0, 0.0, 0.0])
        column, row, w = camera @ [0.0, 0.0, 0.0, 1.0]
        np.testing.assert_allclose([column / w, row / w], 31.5)
        with self.assertRaises(evs.InputError):
            tube().camera()

    def test_continue_pickled_in_another_process(self):
        env = make()
        env.reset(seed=2)
        first, *rest = actions(4, env)
        env.step(first)
        with tempfile.NamedTemporaryFile() as file:
            pickle.dump((env, rest), file)
            file.flush()
            done = run_python(SAME_IN_ANOTHER_PROCESS, file.name)
        for action in rest:
            info = env.step(action)[-1]
        self.assertEqual(done.stdout.strip(), info["trajectory_hash"], done.stderr)

    def test_choose_one_of_several_targets_and_starts(self):
        states = evs.Env(fork(), ("left", 0.01), start=0.02).starts + evs.Env(fork(), ("left", 0.01), start=0.03).starts
        env = evs.Env(fork(), [("left", 0.01), ("right", 0.01)], start=states)
        seen = set()
        for seed in range(12):
            env.reset(seed=seed)
            seen.add((round(env.session.hands["insertion"][0], 3), env._route.branch))
        self.assertEqual(len(seen), 4)

    @unittest.skipUnless(_gym.HAS_GYMNASIUM, "gymnasium cannot be imported")
    def test_pass_the_checks_of_gymnasium(self):
        import warnings

        from gymnasium.utils.env_checker import check_env
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            check_env(make(render_mode="rgb_array"))

    @unittest.skipUnless(_gym.HAS_GYMNASIUM, "gymnasium cannot be imported")
    def test_are_made_by_gymnasium(self):
        import gymnasium
        gymnasium.register("test/Fork-v0", entry_point=lambda **options: make(**options),
                           vector_entry_point=lambda num_envs, **options: evs.VectorEnv(
                               num_envs, fork(), ("left", 0.01), horizon=12, **options))
        for mode in ("sync", "vector_entry_point"):
            with self.subTest(mode):
                envs = gymnasium.make_vec("test/Fork-v0", num_envs=2, vectorization_mode=mode)
                observations, _ = envs.reset(seed=3)
                self.assertEqual(observations["target"].shape, (2, 3))
                self.assertEqual(envs.step(envs.action_space.sample())[1].shape, (2,))
                envs.close()

    @unittest.skipUnless(_gym.HAS_GYMNASIUM, "gymnasium cannot be imported")
    def test_have_the_same_trajectories_in_worker_processes(self):
        import gymnasium
        hashes = set()
        for mode in ("fork", "spawn", "forkserver", None):
            options = {"horizon": 3, "autoreset_mode": gymnasium.vector.AutoresetMode.NEXT_STEP}
            envs = (evs.VectorEnv(2, fork(), ("left", 0.01), **options) if mode is None else
                    gymnasium.vector.AsyncVectorEnv([worker_env, worker_env], context=mode,
                                                    autoreset_mode=options["autoreset_mode"]))
            envs.reset(seed=1)
            for _ in range(5):
                infos = envs.step(np.full((2, 1, 2), 0.5, np.float32))[4]
            hashes.add(tuple(str(one) for one in infos["trajectory_hash"]))
            envs.close()
        self.assertEqual(len(hashes), 1)

    @unittest.skipUnless(importlib.util.find_spec("stable_baselines3"), "stable-baselines3 cannot be imported")
    def test_pass_the_checks_of_stable_baselines3(self):
        from stable_baselines3.common.env_checker import check_env
        check_env(make(flatten=True))


class VectorEnvironments(unittest.TestCase):
    def episodes(self, mode, threads, steps=8, **options):
        envs = evs.VectorEnv(3, fork(), ("left", 0.01), autoreset_mode=mode, threads=threads, horizon=3, start=0.02,
                             start_turn=1.0, **options)
        envs.reset(seed=7)
        envs.action_space.seed(1)
        results = []
        for _ in range(steps):
            if mode == "Disabled" and envs._ended.any():
                envs.reset(options={"reset_mask": envs._ended.copy()})
            results.append(envs.step(envs.action_space.sample()))
        return envs, results

    def test_do_not_depend_on_the_number_of_threads(self):
        for mode in ("NextStep", "SameStep", "Disabled"):
            with self.subTest(mode):
                hashes = [[list(infos["trajectory_hash"]) for *_, infos in self.episodes(mode, threads)[1]]
                          for threads in (1, 2)]
                self.assertEqual(hashes[0], hashes[1])

    def test_have_the_trajectories_of_single_environments(self):
        envs = evs.VectorEnv(3, fork(), ("left", 0.01), threads=2)
        envs.reset(seed=7)
        envs.action_space.seed(1)
        batches = [envs.action_space.sample() for _ in range(3)]
        hashes = [list(envs.step(batch)[-1]["trajectory_hash"]) for batch in batches]
        for number in range(3):
            env = evs.Env(fork(), ("left", 0.01))
            env.reset(seed=7 + number)
            self.assertEqual([env.step(batch[number])[-1]["trajectory_hash"] for batch in batches],
                             [step[number] for step in hashes])

    def test_reset_in_the_next_step(self):
        envs, results = self.episodes("NextStep", 2)
        self.assertEqual([bool(step[3].any()) for step in results], [False, False, True, False] * 2)
        self.assertTrue((results[3][1] == 0.0).all())
        self.assertIs(envs.metadata["autoreset_mode"], _gym.AutoresetMode.NEXT_STEP)

    def test_reset_in_the_same_step(self):
        _, results = self.episodes("SameStep", 2)
        self.assertEqual([bool(step[3].any()) for step in results], [False, False, True] * 2 + [False] * 2)
        infos = results[2][4]
        self.assertTrue(infos["_final_obs"].all())
        self.assertEqual(infos["final_obs"][0].keys(), results[2][0].keys())
        self.assertEqual(list(infos["final_info"]["reason"]), ["horizon"] * 3)
        self.assertNotEqual(infos["final_info"]["trajectory_hash"][0], infos["trajectory_hash"][0])

    def test_wait_for_a_reset(self):
        envs = evs.VectorEnv(2, fork(), ("left", 0.01), autoreset_mode="Disabled", horizon=1)
        envs.reset(seed=1)
        envs.step(np.zeros((2, 1, 2)))
        with self.assertRaisesRegex(evs.UsageError, "have ended"):
            envs.step(np.zeros((2, 1, 2)))
        with self.assertRaises(evs.InputError):
            envs.reset(options={"reset_mask": np.zeros(2, bool)})
        envs.reset(options={"reset_mask": np.ones(2, bool)})
        envs.step(np.zeros((2, 1, 2)))

    def test_drive_by_forces(self):
        envs = evs.VectorEnv(2, fork(), ("left", 0.01), action="force", start=0.02, threads=2)
        observations, _ = envs.reset(seed=1)
        moved, *_ = envs.step(np.full((2, 1, 2), [0.5, 0.0]))
        self.assertTrue((moved["hand"][:, 0, 0] > observations["hand"][:, 0, 0]).all())

    def test_step_after_a_fork(self):
        envs = evs.VectorEnv(2, fork(), ("left", 0.01), threads=2)
        envs.reset(seed=1)
        zeros = np.zeros((2, 1, 2))
        envs.step(zeros)
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            os.write(writing, envs.step(zeros)[-1]["trajectory_hash"][1].encode())
            os._exit(0)
        os.waitpid(child, 0)
        self.assertEqual(os.read(reading, 99).decode(), envs.step(zeros)[-1]["trajectory_hash"][1])

    def test_refuse_wrong_calls(self):
        for options in ({"num_envs": 0}, {"autoreset_mode": "Sometimes"}, {"action": "thought"}):
            with self.assertRaises(evs.InputError):
                evs.VectorEnv(**{"num_envs": 2, "world": fork(), "target": ("left", 0.01), **options})
        envs = evs.VectorEnv(2, fork(), ("left", 0.01))
        envs.reset(seed=[1, 2])
        with self.assertRaises(evs.InputError):
            envs.step(np.zeros((1, 1, 2)))
        with self.assertRaises(evs.InputError):
            envs.reset(seed=[1])
        self.assertEqual(len(envs.call("observe")), 2)
        envs.close()
        with self.assertRaises(evs.UsageError):
            envs.step(np.zeros((2, 1, 2)))


class Routes(unittest.TestCase):
    def test_lead_from_the_introducer_to_the_target(self):
        route = evs.Route(fork(), ("left", 0.01))
        entry, _ = fork().entry
        self.assertLess(np.linalg.norm(route.points[0] - entry), 2e-3)
        np.testing.assert_allclose(route.points[-1], route.target)
        lengths = np.linalg.norm(np.diff(route.points, axis=0), axis=1)
        self.assertLess(abs(lengths.sum() - route.length), 5e-3)
        for share in (0.2, 0.5, 0.9):
            point = route.points[int(share * len(route.points))]
            self.assertLess(route.distance(point, 0 if share < 0.5 else route.branch), route.length)

    def test_measure_the_way_back_from_a_wrong_branch(self):
        left, right = evs.Route(fork(), ("left", 0.02)), evs.Route(fork(), ("right", 0.02))
        there = left.distance(right.target, right.branch)
        self.assertGreater(there, left.distance(right.target * 0.0 + right.points[len(right.points) // 2], 0))
        deeper = evs.Route(fork(), ("right", 0.04))
        self.assertAlmostEqual(left.distance(deeper.target, deeper.branch) - there, 0.02, places=6)


if __name__ == "__main__":
    unittest.main()
