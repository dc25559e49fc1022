"""Misuse raises, changes nothing and ends no interpreter."""

import contextlib
import gc
import itertools
import os
import pickle
import random
import signal
import threading
import time
import unittest

import numpy as np
from support import evs, run_python, tube


class Misuse(unittest.TestCase):
    def test_after_close_raises(self):
        session = tube().session()
        session.close()
        session.close()
        self.assertTrue(session.closed)
        for use in (session.step, session.observe, session.save, session.copy, session.reset, session.image,
                    lambda: session.nodes, lambda: session.trajectory_hash, lambda: session.load(b""),
                    lambda: pickle.dumps(session), lambda: session.step([[0.0, 0.0, 0.0]])):
            with self.assertRaisesRegex(evs.UsageError, "closed"):
                use()
        self.assertIn("closed", repr(session))

    def test_after_a_with_block_raises(self):
        with tube().session() as session:
            session.step()
        with self.assertRaises(evs.UsageError):
            session.step()

    def test_wrong_commands_raise_and_change_nothing(self):
        session = tube().session()
        session.step(n=20)
        before = session.save()
        good = [0.01, 0.0, 0.0]
        for commands in ([0.0], [[0.0, 0.0]], [[[[0.0, 0.0, 0.0]]]], [good, good], [[[0.0] * 4]], np.zeros((2, 2, 3)),
                         [[np.nan, 0.0, 0.0]], [[0.0, np.inf, 0.0]], [[0.0, 0.0, 1e5]], [[good], [[0.0, 0.0, np.nan]]],
                         "text", [["a", "b", "c"]], [[1.0], [2.0, 3.0]], object(), 1.0):
            with self.assertRaises(evs.InputError, msg=repr(commands)):
                session.step(commands)
        for n in (-1, 3):
            with self.assertRaises(evs.InputError):
                session.step([[good], [good]], n=n)
        for arguments in ((), ("a",), (1, 2, 3)):
            with self.assertRaises((TypeError, evs.InputError)):
                session.step(*arguments, n="many")
        self.assertEqual(session.save(), before)

    def test_refused_states_change_nothing(self):
        session = tube().session()
        session.step(n=20)
        state = session.save()
        damaged = bytearray(state)
        damaged[len(state) // 2] ^= 1
        for bad in (b"", b"no state", bytes(damaged), state[:-1], evs.World("straight_wire").session().save()):
            with self.assertRaises(evs.InputError):
                session.load(bad)
        self.assertEqual(session.save(), state)

    def test_two_threads_on_one_session_raise(self):
        session = evs.World("tube", duration=1000).session()
        started, stop = threading.Event(), []

        def step():
            started.set()
            while not stop:
                session.step(session.world.commands(20))

        thread = threading.Thread(target=step)
        thread.start()
        started.wait()
        refused = 0
        while not refused:
            try:
                session.nodes  # noqa: B018
            except evs.UsageError as error:
                self.assertIn("another thread", str(error))
                refused += 1
        stop.append(True)
        thread.join()
        session.step()

    def test_objects_that_were_never_made_raise(self):
        class NeverMade(evs.World):
            def __init__(self):
                pass

        for use in (lambda: evs.Session.__new__(evs.Session).step(), lambda: evs.World.__new__(evs.World).name,
                    lambda: evs.Rollout(), lambda: NeverMade().session(), lambda: evs.Session(None)):
            with self.assertRaises((TypeError, evs.UsageError)):
                use()
        for unmade in (evs.Rollout, evs.Observation, evs.Branch):
            part = unmade.__new__(unmade)
            for name in dir(part):
                with contextlib.suppress(SystemError, TypeError):
                    getattr(part, name)

    def test_one_session_twice_in_one_call_raises(self):
        session = tube().session()
        with self.assertRaises(evs.UsageError):
            evs.advance([session, session], np.zeros((2, 1, 1, 3)))
        session.step()

    def test_wrong_batches_raise(self):
        commands = tube().commands(5)
        for call in (lambda: evs.rollout(tube(), commands), lambda: evs.rollout(tube(), commands[np.newaxis], threads=-1),
                     lambda: evs.rollout(tube(), commands[np.newaxis], every=0),
                     lambda: evs.rollout(tube(), commands[np.newaxis], state=b"bad"),
                     lambda: evs.advance([tube().session()], np.zeros((2, 1, 1, 3))),
                     lambda: evs.advance([tube().session(), evs.World("pci").session()], np.zeros((2, 1, 1, 3)))):
            with self.assertRaises(evs.InputError):
                call()
        self.assertEqual(evs.rollout(tube(), np.zeros((0, 5, 1, 3))).hashes, ())
        self.assertEqual(len(evs.advance([], np.zeros((0, 1, 1, 3)))), 0)

    def test_objects_may_be_deleted_in_any_order(self):
        for order in itertools.permutations(range(4)):
            world = evs.World("tube", duration=0.1)
            session = world.session()
            session.step(n=3)
            parts = [world, session, session.observe(), session.nodes]
            del world, session
            for k in order:
                parts[k] = None
                gc.collect()
                for part in parts:
                    repr(part)

    def test_random_sequences_of_calls_only_raise_errors_of_the_package(self):
        calls = random.Random(5)
        world = tube()
        state = world.session().save()
        session = world.session()
        actions = (lambda: session.step(), lambda: session.step(n=calls.randrange(-2, 5)),
                   lambda: session.step(np.full((1, 3), calls.choice([0.0, 0.01, np.nan]))),
                   lambda: session.step(np.zeros(calls.choice([(1, 3), (2, 3), (0, 1, 3), (2, 1, 3)]))),
                   lambda: session.reset(calls.randrange(3)), lambda: session.load(state), session_close := (lambda: session.close()),
                   lambda: session.load(state[:calls.randrange(len(state))]), lambda: session.observe().forces.sum,
                   lambda: session.save(), lambda: session.copy().step(), lambda: pickle.loads(pickle.dumps(session)),
                   lambda: session.track(calls.randrange(-1, 4), 0.001), lambda: session.branch(calls.randrange(-2, 2)),
                   lambda: session.image(), lambda: session.finish("/nonexistent/folder"),
                   lambda: evs.advance([session] * calls.randrange(3), np.zeros((1, 2, 1, 3)), threads=2))
        raised = 0
        for _ in range(600):
            action = calls.choice(actions)
            if action is session_close and calls.random() < 0.7:
                continue
            try:
                action()
            except evs.Error:
                raised += 1
            if session.closed and calls.random() < 0.5:
                session = world.session()
        self.assertGreater(raised, 50)

    def test_a_forked_child_steps_as_its_parent(self):
        session = tube().session()
        evs.rollout(tube(), np.broadcast_to(tube().commands(5), (2, 5, 1, 3)), threads=2)
        session.step(n=50)
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            session.step(n=50)
            made = evs.rollout(tube(), np.broadcast_to(tube().commands(100), (2, 100, 1, 3)), threads=2)
            os.write(writing, (session.trajectory_hash + made.hashes[1]).encode())
            os._exit(0)
        os.waitpid(child, 0)
        session.step(n=50)
        self.assertEqual(os.read(reading, 100).decode(), 2 * session.trajectory_hash)

    def test_an_interrupt_ends_a_long_call_after_a_step(self):
        # A shell that starts the tests in the background ignores SIGINT for them.
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        session = evs.World("tube", duration=1000).session()
        commands = [[0.01, 0.0, 0.0]]
        for call in (lambda: session.step(n=10**8), lambda: session.step(commands, n=10**8),
                     lambda: evs.rollout(tube(), np.broadcast_to(tube().commands(1), (2, 10**6, 1, 3)), threads=2)):
            timer = threading.Timer(0.2, signal.raise_signal, [signal.SIGINT])
            timer.start()
            with self.assertRaises(KeyboardInterrupt):
                call()
            timer.join()
        session.step()

    def test_other_threads_run_during_a_long_call(self):
        session = evs.World("tube", duration=1000).session()
        counted = []
        thread = threading.Thread(target=lambda: [counted.append(time.sleep(0.001)) for _ in range(20)])
        thread.start()
        while thread.is_alive():
            session.step(n=200)
        self.assertEqual(len(counted), 20)

    def test_a_closed_output_does_not_end_the_interpreter(self):
        code = ("import os; os.close(1); os.close(2); import endovascular_sim as evs; s = evs.World('tube').session();"
                "s.step(n=5)\ntry: evs.World('nothing')\nexcept evs.InputError: os._exit(7)")
        self.assertEqual(run_python(code).returncode, 7)


if __name__ == "__main__":
    unittest.main()
