"""One trajectory for the same commands, whoever steps."""

import pickle
import unittest

import numpy as np
import support
from support import evs, run_python, tube

STEPS = 400
IN_ANOTHER_PROCESS = """
import pickle, sys
session = pickle.load(open(sys.argv[1], "rb"))
commands = session.world.commands(int(sys.argv[2]) - session.steps, session.steps)
session.step(commands)
print(session.trajectory_hash)
"""


class Trajectories(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scene = support.REPOSITORY / "config/scenes/tube.yaml"
        cls.expected = support.hash_of_simulate(scene, "--seconds", str(STEPS * tube().time_step))
        cls.commands = tube().commands(STEPS)

    def test_by_the_drives_of_the_scene_is_that_of_simulate(self):
        session = tube().session()
        self.assertEqual(session.step(n=STEPS), STEPS)
        self.assertEqual(session.trajectory_hash, self.expected)

    def test_by_commands_step_by_step_is_that_of_simulate(self):
        session = tube().session()
        for command in self.commands:
            session.step(command)
        self.assertEqual(session.trajectory_hash, self.expected)

    def test_by_commands_in_one_call_is_that_of_simulate(self):
        session = tube().session()
        self.assertEqual(session.step(self.commands), STEPS)
        self.assertEqual(session.trajectory_hash, self.expected)

    def test_of_a_rollout_is_that_of_simulate_with_any_number_of_threads(self):
        batch = np.broadcast_to(self.commands, (3, *self.commands.shape))
        for threads in (1, 2, 0):
            self.assertEqual(set(evs.rollout(tube(), batch, threads=threads).hashes), {self.expected})

    def test_of_several_sessions_at_a_time_is_that_of_simulate(self):
        sessions = [tube().session() for _ in range(3)]
        for part in np.split(self.commands, 4):
            evs.advance(sessions, np.broadcast_to(part, (3, *part.shape)), threads=2)
        self.assertEqual({session.trajectory_hash for session in sessions}, {self.expected})

    def test_of_a_pickled_session_continues_in_another_process(self):
        import tempfile
        session = tube().session()
        session.step(self.commands[:150])
        with tempfile.NamedTemporaryFile() as file:
            pickle.dump(session, file)
            file.flush()
            done = run_python(IN_ANOTHER_PROCESS, file.name, str(STEPS))
        self.assertEqual(done.stdout.strip(), self.expected, done.stderr)

    def test_of_a_copy_continues_bit_for_bit(self):
        session = tube().session()
        session.step(n=150)
        copy = session.copy()
        self.assertEqual(copy.save(), session.save())
        copy.step(n=STEPS - 150)
        self.assertEqual(copy.trajectory_hash, self.expected)

    def test_of_a_loaded_state_continues_bit_for_bit(self):
        first = tube().session()
        first.step(n=150)
        second = tube().session()
        second.step(n=20)
        second.load(first.save())
        second.step(n=STEPS - 150)
        self.assertEqual(second.trajectory_hash, self.expected)

    def test_of_a_rollout_begins_with_a_state(self):
        session = tube().session()
        session.step(self.commands[:150])
        batch = self.commands[np.newaxis, 150:]
        self.assertEqual(evs.rollout(tube(), batch, state=session.save()).hashes, (self.expected,))

    def test_of_a_reset_session_is_that_of_a_new_one(self):
        session = tube().session()
        session.step(n=33)
        session.reset()
        session.step(n=STEPS)
        self.assertEqual(session.trajectory_hash, self.expected)

    def test_of_a_procedure_follows_a_seed(self):
        world = evs.World(support.PROCEDURE)
        plain, varied, again = world.session(), world.session(seed=7), world.session()
        again.reset(seed=7)
        for session in (plain, varied, again):
            session.step(n=200)
        self.assertNotEqual(varied.trajectory_hash, plain.trajectory_hash)
        self.assertEqual(varied.trajectory_hash, again.trajectory_hash)
        self.assertEqual(pickle.loads(pickle.dumps(varied)).seed, 7)
        self.assertEqual(pickle.loads(pickle.dumps(varied)).save(), varied.save())


if __name__ == "__main__":
    unittest.main()
