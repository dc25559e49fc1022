#!/usr/bin/python3
"""Random sequences of calls of the package, right and wrong ones. Each raises nothing but the errors of the package.

Run under the address sanitizer by test/scripts/all/test_python_calls_sanitized.sh. A sequence is a function of its number:
    random_calls.py --first 17 --count 1 --verbose
"""

import argparse
import copy
import gc
import os
import pickle
import random
import sys
import tempfile
import threading
import traceback

import numpy as np

import endovascular_sim as evs

TUBE = {"duration": 0.5, "sampling.nodes": 70}
TWO = """
name: two
duration: 0.2
vessel: {friction: 0.1, tube: {radius: 0.004, facet_length: 0.002, pieces: [{length: 0.15}]}}
entry: {position: [0, 0, 0], direction: [0, 0, 1], up: [1, 0, 0]}
instruments:
  - {instrument: {use: guidewire_035_j, name: wire}, drive: {source: topic, initial_insertion: 0.03}}
  - {instrument: {use: catheter_6f_multipurpose, name: tube}, drive: {source: topic, initial_insertion: 0.01}}
sampling: {nodes: 200}
"""
PROCEDURE = """
name: procedure
duration: 0.2
vessel: {friction: 0.1, tube: {radius: 0.004, facet_length: 0.002, pieces: [{length: 0.1}]}}
entry: {position: [0, 0, 0], direction: [0, 0, 1], up: [1, 0, 0]}
instruments:
  - {instrument: {use: guidewire_035_j, name: wire}, drive: {source: procedure, initial_insertion: 0.03}}
procedure:
  steps:
    - {advance: wire, until: {insertion: 0.034}, speed: 0.05}
    - {rotate: wire, until: {turned: 0.1}}
sampling: {nodes: 200}
"""
SENSORS = [{"name": "tracker", "kind": "em_tracker", "rate": 100, "delay": 0.003, "drop_out": 0.2, "noise": {"position": 1e-3}},
           {"name": "encoder", "kind": "encoder"}, {"name": "screen", "kind": "detector", "noise": {"pixels": 1.0}}]
C_ARM = {"isocentre": [0, 0, 0.05], "pixels": 32}
FORKED = 77  # exit code of a child that has stepped


def worlds():
    """Worlds of all sequences: plain, with sensors, faults and images, without a vessel, of two wires, with a procedure."""
    return [evs.World("tube", **TUBE), evs.World("tube", sensors=SENSORS, fluoroscopy=C_ARM, **TUBE),
            evs.World("tube", faults=[{"axis": "insertion", "kind": "slipping", "share": 0.3, "probability": 0.5}], **TUBE),
            evs.World("straight_wire", duration=0.2), evs.World(TWO), evs.World(PROCEDURE),
            evs.World("tube", centreline=True, fluoroscopy=C_ARM, **TUBE)]


class Sequence:
    """Objects of one sequence, and the calls on them."""

    def __init__(self, number, every_world):
        self.choice = random.Random(number)
        self.worlds = list(every_world)
        self.sessions = [self.new_session()]
        self.states = [b"", b"no state", self.sessions[0].save()]
        self.parts, self.envs, self.raised = [], [], 0
        self.calls = [getattr(self, name) for name in sorted(dir(self)) if name.startswith("call_")]

    # ---------------------------------------------------------------------------------------------------- arguments

    def world(self):
        return self.choice.choice(self.worlds)

    def session(self):
        return self.choice.choice(self.sessions)

    def new_session(self):
        return self.world().session(seed=self.choice.choice([0, 0, 0, 5]), results=self.choice.random() < 0.3,
                                    clients=self.choice.random() < 0.3)

    def number(self):
        return self.choice.choice([0.0, 0.01, 0.02, -0.01, 1.0, 1e3, 1e300, -1e300, np.nan, np.inf, 5e-324])

    def count(self):
        return self.choice.choice([0, 1, 1, 2, 3, 7, -1])

    def commands(self, dimensions=None):
        shape = [self.choice.choice([1, 1, 1, 2, 0]), self.choice.choice([3, 3, 3, 2])]
        for _ in range(self.choice.choice([0, 1, 1]) if dimensions is None else dimensions):
            shape.insert(0, self.choice.choice([0, 1, 2, 3]))
        commands = np.full(shape, 0.01)
        commands[..., 2:] = 0.0
        if self.choice.random() < 0.2 and commands.size:
            commands.flat[self.choice.randrange(commands.size)] = self.number()
        kind = self.choice.random()
        if kind < 0.1:
            return commands[..., ::-1]
        if kind < 0.2:
            return commands.astype(np.float32)
        if kind < 0.25:
            return np.asfortranarray(commands)
        return commands.tolist() if kind < 0.3 else commands

    def instrument(self):
        return self.choice.choice([0, 0, 0, 1, -1, 2**31, "wire", "guidewire", "needle", None, 0.5])

    def state(self):
        state = self.choice.choice(self.states)
        if self.choice.random() < 0.3 and state:
            damaged = bytearray(state)
            for _ in range(self.choice.randrange(1, 4)):
                damaged[self.choice.randrange(len(damaged))] ^= 1 << self.choice.randrange(8)
            return bytes(damaged[:self.choice.randrange(len(damaged))] if self.choice.random() < 0.3 else damaged)
        return state

    # -------------------------------------------------------------------------------------------------------- calls

    def call_step(self):
        self.session().step(n=self.count())

    def call_step_by_commands(self):
        self.session().step(self.commands(), n=self.choice.choice([None, None, 1, 3]))

    def call_client(self):
        name = self.choice.choice(["servo_jp", "servo_jv", "servo_jf", "servo_jr", "move_jp", "move_jr", "hold", "free",
                                   "pause", "resume", "disable", "enable", "unhome", "home", "dance", ""])
        self.session().command(self.instrument(), name, [self.number() for _ in range(self.choice.randrange(4))])

    def call_new_session(self):
        self.sessions.append(self.new_session())

    def call_reset(self):
        self.session().reset(self.choice.choice([0, 1, 2**64 - 1, -1, "a"]))

    def call_close(self):
        if self.choice.random() < 0.5:
            self.session().close()

    def call_forget(self):
        if len(self.sessions) > 1:
            del self.sessions[self.choice.randrange(len(self.sessions))]
        if self.choice.random() < 0.2:
            gc.collect()

    def call_read(self):
        session = self.session()
        name = self.choice.choice([name for name in dir(type(session)) if not name.startswith("__")])
        value = getattr(session, name)
        if not callable(value):
            self.parts.append(value)
            repr(value)

    def call_write(self):
        setattr(self.session(), self.choice.choice(["last_step", "noise_seed", "seed", "nodes"]),
                self.choice.choice([0, 3, 2**63, -1, 1.5, None]))

    def call_observe(self):
        observation = self.session().observe()
        self.parts.append(self.choice.choice([observation, observation.hands, observation.forces, observation.sensors]))

    def call_change_an_array(self):
        for part in self.parts[-3:]:
            if isinstance(part, np.ndarray) and part.size and part.dtype.names is None:
                part[...] = 0
            repr(part)

    def call_track(self):
        self.session().track(self.choice.choice([0, 1, 5, -1, 300]), self.number(), self.instrument())

    def call_branch(self):
        repr(self.session().branch(self.instrument()))

    def call_image(self):
        self.parts.append(self.session().image(self.choice.choice(["", "LAO 40", "RAO 30 CAU 20", "LAO 400", "side"]),
                                               raw=self.choice.random() < 0.5))

    def call_save(self):
        self.states.append(self.session().save())
        del self.states[2:-4]

    def call_load(self):
        self.session().load(self.state())

    def call_adopt(self):
        repr(self.session().adopt(self.state()))

    def call_copy(self):
        session = self.session()
        self.sessions.append(self.choice.choice([session.copy, lambda: copy.copy(session), lambda: copy.deepcopy(session),
                                                 lambda: pickle.loads(pickle.dumps(session))])())

    def call_pickle_a_world(self):
        world = pickle.loads(pickle.dumps(self.world()))
        world.session().step()

    def call_vary(self):
        key = self.choice.choice(["vessel.friction", "drive.speed", "sampling.nodes", "nothing", "duration", "sensors", "faults"])
        world = self.world().vary(**{key: self.choice.choice([0.1, 50, None, "a", [1, 2], {"a": 1}, np.nan, [SENSORS[1]]])})
        self.sessions.append(world.session())

    def call_read_a_world(self):
        world = self.world()
        name = self.choice.choice([name for name in dir(type(world)) if not name.startswith("__")])
        value = getattr(world, name)
        self.parts.append(None if callable(value) else value)

    def call_camera(self):
        self.world().camera(self.choice.choice(["", "LAO 40", "side"]), self.choice.choice([None, [0, 0, 0], [0, 0], [np.nan] * 3]))

    def call_scene(self):
        evs.World(self.choice.choice(["nothing", "", "a: [", "{}", "name: x\ninstrument: {}", TWO[:self.choice.randrange(len(TWO))]]))

    def call_fault(self):
        self.session().add_fault(self.instrument(), self.choice.choice(["insertion", "rotation", "pressure"]),
                                 self.choice.choice(["stuck", "slipping", "delayed", "backlash", "none"]),
                                 self.choice.choice([0.0, 0.004, 0.5, 2.0, np.nan, -1.0]),
                                 self.choice.choice([None, 0.002, 0.0, np.inf]), self.choice.choice([1.0, 0.5, 2.0]),
                                 self.choice.choice([0.1, 0.001, 0.0, 1e300]), self.choice.choice([0, 7, -1]))

    def call_no_fault(self):
        self.session().remove_faults(self.instrument(), self.choice.choice(["insertion", "rotation", "x"]))

    def call_rollout(self):
        state = self.choice.choice([None, None, self.state()])
        made = evs.rollout(self.world(), self.commands(2), threads=self.choice.choice([0, 1, 2, -1]), state=state,
                           every=self.choice.choice([1, 2, 0, 100]))
        self.parts += [made, made.tips, made.peaks]

    def call_advance(self):
        sessions = [self.session() for _ in range(self.choice.randrange(4))]
        if self.choice.random() < 0.5:
            evs.advance(sessions, self.commands(1), threads=2)
        else:
            evs.advance(sessions, threads=self.choice.choice([1, 2]), n=self.choice.choice([0, 1, 3]))

    def call_finish(self):
        with tempfile.TemporaryDirectory() as folder:
            self.session().finish(self.choice.choice([folder, os.path.join(folder, "new"), "/nonexistent/folder"]),
                                  all=self.choice.random() < 0.5)

    def call_two_threads(self):
        session = self.session()

        def use():
            for _ in range(3):
                try:
                    session.step(n=2)
                    session.observe()
                except evs.Error:
                    pass

        threads = [threading.Thread(target=use) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()

    def call_fork(self):
        if self.choice.random() < 0.8:
            return
        session = self.session()
        child = os.fork()
        if child == 0:
            try:
                session.step(n=2)
            except BaseException:  # noqa: B902 - the exit code tells
                os._exit(FORKED)
            os._exit(FORKED)
        _, status = os.waitpid(child, 0)
        assert os.WIFEXITED(status) and os.WEXITSTATUS(status) == FORKED, "the forked child ended with %x" % status

    def call_environment(self):
        if self.choice.random() < 0.5 and self.envs:
            env = self.choice.choice(self.envs)
            self.choice.choice([lambda: env.reset(seed=self.choice.choice([None, 1])), env.render, env.close])()
            return
        self.envs.append(evs.Env(self.worlds[-1], self.choice.choice([("tube", 0.1), ("tube", 9.0), ("arm", 0.1)]),
                                 action=self.choice.choice(["velocity", "position", "force"]), control_step=0.003,
                                 horizon=self.choice.choice([2, 100]), render_mode=self.choice.choice([None, "rgb_array"])))

    def call_step_an_environment(self):
        if self.envs:
            env = self.choice.choice(self.envs)
            env.step(self.choice.choice([[[0.5, 0.1]], [[np.nan, 0.0]], [0.5], [[2.0, -3.0]]]))

    def call_vector(self):
        envs = evs.VectorEnv(self.choice.choice([1, 2]), self.worlds[-1], ("tube", 0.1), control_step=0.003,
                             horizon=self.choice.choice([1, 3]), threads=2,
                             autoreset_mode=self.choice.choice(["NextStep", "SameStep", "Disabled"]))
        envs.reset(seed=1)
        for _ in range(self.choice.randrange(3)):
            envs.step(np.zeros((envs.num_envs, 1, 2)))
        if self.choice.random() < 0.5:
            envs.close()

    # -------------------------------------------------------------------------------------------------------- running

    def run(self, calls, verbose):
        for _ in range(calls):
            call = self.choice.choice(self.calls)
            if verbose:
                print(call.__name__, flush=True)
            try:
                call()
            except (evs.Error, TypeError, AttributeError) as error:  # of the package, or of wrong types of arguments
                self.raised += isinstance(error, evs.Error)
                if verbose:
                    print("    %s: %s" % (type(error).__name__, error), flush=True)
            del self.parts[:-10], self.sessions[:-4], self.envs[:-2]
            if not self.sessions or all(session.closed for session in self.sessions):
                self.sessions.append(self.new_session())


def main():
    line = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    line.add_argument("--first", type=int, default=0, metavar="N", help="number of the first sequence [0]")
    line.add_argument("--count", type=int, default=1000, metavar="N", help="number of sequences [1000]")
    line.add_argument("--calls", type=int, default=15, metavar="N", help="calls of a sequence [15]")
    line.add_argument("--verbose", action="store_true", help="prints every call")
    options = line.parse_args()
    every_world, raised = worlds(), 0
    for number in range(options.first, options.first + options.count):
        sequence = Sequence(number, every_world)
        try:
            sequence.run(options.calls, options.verbose)
        except BaseException:
            traceback.print_exc()
            sys.exit("sequence %d failed; repeat it by --first %d --count 1 --verbose" % (number, number))
        raised += sequence.raised
        if number % 50 == 49:
            print("%d sequences, %d refused calls" % (number + 1 - options.first, raised), flush=True)
    print("%d sequences of %d calls: no error but those of the package, %d refused calls" %
          (options.count, options.calls, raised))


if __name__ == "__main__":
    main()
