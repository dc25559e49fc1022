"""Environments in Gymnasium's API."""

import numpy as np

from . import _gym
from ._core import InputError, UsageError, World, advance
from .route import Route

ACTIONS = ("velocity", "position", "force")
OBSERVATIONS = ("tracking", "tracking2d", "target", "target2d", "hand", "hand_force", "wall_force", "last_action", "image")
PEAKS = ("wall_force", "tip_force", "hand_force")
REWARDS = {"progress": 100.0, "step": -0.02, "target": 5.0, "force": 0.0}


class Env(_gym.EnvBase):
    """Steering of instruments to a target in a branch, in the API of Gymnasium.

    world         World, or its scene
    target        (branch, depth): branch, and distance from its ostium [m]; or a list of these, one per episode
    instrument    index of the instrument whose tip shall reach the target
    action        "velocity", "position" or "force"; an action is [instrument, 2] in [-1, 1]: insertion and rotation
    scale         full scale of an action per instrument: velocities (0.04 m/s, 3 rad/s), which also limit "position",
                  or force and torque (1 N, 0.005 N m)
    turns         full scale of a "position" rotation [rad]; that of the insertion is the largest insertion
    observations  names: tracking, points of the instrument from the tip backwards [m]; tracking2d, the same on the
                  detector, -1 to 1; target [m]; target2d; hand, insertion [m] and rotation [rad]; hand_force [N, N m];
                  wall_force, the largest wall and tip force of the step [N]; last_action; image, uint8; and names of
                  sensors of the scene, with the values as Session.sensors, and last 1 if the sample is valid, else 0
    points        number and spacing [m] of the tracked points
    flatten       True: one vector of all observations; False: a dictionary
    view          of tracking2d, target2d, image and render(), e.g. "LAO 40"
    control_step  simulated time of a step [s]; below drive.limits.time_out for "force"
    horizon       number of steps after which an episode is truncated
    tolerance     distance from the target, along the centreline, that counts as reached [m]
    start         None: the beginning of the scene, varied by the seed of the episode; an insertion [m], to which the
                  instrument is pushed once; or a state of Session.save(), or a list of states, one per episode
    vary          False: None starts every episode alike
    start_turn    half width of the random turn of the handle before an episode [rad]
    rewards       weights: progress [1/m] along the centreline, step, target, and force, per newton beyond a limit
    force_limits  largest wall_force, tip_force or hand_force of a step [N], as the result of advance()
    force_ends    True: a larger force terminates the episode; False: it costs rewards["force"]
    render_mode   None or "rgb_array"

    A step brings no more progress than 1.5 times the motion of the handle plus 1 mm: a projection that jumps is followed
    at this rate. Raises InputError for a target that the instrument cannot reach: too far, or through a lumen that is
    narrower than the instrument.

    info: trajectory_hash (text), distance [m], branch, success, reason of an end (text), and the largest forces [N].
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 7.5}

    def __init__(self, world, target, *, instrument=0, action="velocity", scale=None, turns=np.pi,
                 observations=("tracking", "target", "hand", "hand_force", "wall_force", "last_action"), points=(3, 2e-3),
                 flatten=False, view="", control_step=2 / 15, horizon=150, tolerance=5e-3, start=None, vary=True,
                 start_turn=0.0, rewards=None, force_limits=None, force_ends=True, render_mode=None):
        if action not in ACTIONS:
            raise InputError("action: '%s' is none of %s" % (action, ", ".join(ACTIONS)))
        _require_known("rewards", rewards or (), REWARDS)
        _require_known("force_limits", force_limits or (), PEAKS)
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise InputError("render_mode: '%s' is none of None, rgb_array" % render_mode)
        self.world = _driven_by_clients(world) if action == "force" else _world(world)
        self.session = self.world.session(clients=action == "force")
        self._sensors = {name: reading.values.size for name, reading in self.session.sensors.items()}
        _require_known("observations", observations, (*OBSERVATIONS, *self._sensors))
        for name in set(self._sensors) & set(OBSERVATIONS):
            raise InputError("observations: '%s' is an observation and a sensor of the scene; rename the sensor" % name)
        self.instrument, self.action, self.view, self.render_mode = instrument, action, view, render_mode
        self.routes = [Route(self.world, one) for one in (target if isinstance(target, list) else [target])]
        self._require_reachable(tolerance)
        self.steps = max(1, round(control_step / self.world.time_step))
        self.horizon, self.tolerance = horizon, tolerance
        self.rewards = {**REWARDS, **(rewards or {})}
        self.force_limits, self.force_ends = dict(force_limits or {}), force_ends
        default = (1.0, 0.005) if action == "force" else (0.04, 3.0)
        self.scale = np.broadcast_to(np.asarray(scale if scale is not None else default, float),
                                     (len(self.world.instruments), 2))
        self.turns, self.vary, self.start_turn = turns, vary, start_turn
        self.starts = self._prepared(start)
        self._names, self._points, self._flatten = tuple(observations), points, flatten
        self._make_spaces()
        self._route = None

    # ---------------------------------------------------------------------------------------------------- Gymnasium

    def reset(self, *, seed=None, options=None):
        """Begins an episode. options: none. Returns observation and info."""
        super().reset(seed=seed)
        self._begin()
        if self._sensors or self.session.faults:
            self.session.noise_seed = int(self.np_random.integers(1, 2**32))
        self._turn()
        self._route = self.routes[int(self.np_random.integers(len(self.routes))) if len(self.routes) > 1 else 0]
        self._count, self._last = 0, np.zeros(self.action_space.shape, np.float32)
        self._peaks = dict.fromkeys(PEAKS, 0.0)
        self._followed, branch = self._distance()
        return self.observe(), self._info(self._followed, branch, False, "")

    def step(self, action):
        """Performs an action [instrument, 2]. Returns observation, reward, terminated, truncated, info."""
        peaks = advance([self.session], **self.prepare(action), threads=1)
        return self.conclude(peaks[0])

    def render(self):
        """X-ray image, uint8 [pixels, pixels, 3]; None without a render_mode."""
        if self.render_mode is None:
            return None
        return np.repeat(self.session.image(self.view)[..., np.newaxis], 3, axis=2)

    def close(self):
        """Ends the session. A second call has no effect."""
        self.session.close()

    # ------------------------------------------------------------------------------------------- parts of a step

    def prepare(self, action):
        """First part of step(): arguments of advance() for an action. VectorEnv then steps many sessions at a time."""
        if self._route is None:
            raise UsageError("the environment has not begun; call reset()")
        action = np.asarray(action, np.float32)
        if action.shape != self.action_space.shape or not np.isfinite(action).all():
            raise InputError("action: has shape %s or is not finite; expected finite numbers of shape %s"
                             % (list(action.shape), list(self.action_space.shape)))
        self._last = np.clip(action, -1.0, 1.0)
        self._insertion = self.session.hands["insertion"].copy()
        if self.action != "force":
            return {"commands": self.commands(self._last)[np.newaxis]}
        for number, values in enumerate(self._last.astype(float) * self.scale):
            self.session.command(number, "servo_jf", values)
        return {"n": self.steps}

    def commands(self, action):
        """Positions of the handles that perform an action, [step, instrument, 3], as for Session.step()."""
        now, motion = self.session.reached, np.asarray(action, float)
        times = self.world.time_step * np.arange(1, self.steps + 1)[:, np.newaxis, np.newaxis]
        if self.action == "velocity":
            moved = motion * self.scale * times
        else:
            largest = self.session.stops[:, 1:]
            goal = np.hstack([(motion[:, :1] + 1.0) / 2.0 * largest, motion[:, 1:] * self.turns])
            moved = np.clip(goal - now, -self.scale * times, self.scale * times)
        commands = np.zeros((self.steps, len(now), 3))
        commands[:, :, :2] = now + moved
        commands[:, :, 2] = self.session.hands["pressure"]
        return commands

    def conclude(self, peaks):
        """Second part of step(): its result, from the largest forces that advance() returned."""
        self._count += 1
        self._peaks = {name: float(peaks[name]) for name in PEAKS}
        before = self._followed
        distance, branch = self._distance()
        moved = np.abs(self.session.hands["insertion"] - self._insertion).max()
        bound = 1.5 * moved + 1e-3
        self._followed += float(np.clip(distance - before, -bound, bound))
        excess = {name: self._peaks[name] - limit for name, limit in self.force_limits.items()
                  if self._peaks[name] > limit}
        success = distance <= self.tolerance
        terminated = success or bool(excess and self.force_ends)
        truncated = self._count >= self.horizon and not terminated
        reward = (self.rewards["progress"] * (before - self._followed) + self.rewards["step"]
                  + self.rewards["target"] * success - self.rewards["force"] * sum(excess.values()))
        reason = "target" if success else next(iter(excess), "") if terminated else "horizon" if truncated else ""
        return self.observe(), float(reward), bool(terminated), truncated, self._info(distance, branch, success, reason)

    def observe(self):
        """Present observation, as reset() and step() return it."""
        sensors = self.session.sensors if self._sensors else {}
        parts = {name: self._reading(sensors[name]) if name in sensors else getattr(self, "_see_" + name)()
                 for name in self._names}
        if not self._flatten:
            return parts
        return np.concatenate([part.ravel() for part in parts.values()])

    # ----------------------------------------------------------------------------------------------- observations

    @staticmethod
    def _reading(reading):
        return np.append(reading.values, reading.valid).astype(np.float32)

    def _tracked(self):
        return self.session.track(self._points[0], self._points[1], self.instrument)

    def _see_tracking(self):
        return self._tracked().astype(np.float32)

    def _see_tracking2d(self):
        return self._projected(self._tracked())

    def _see_target(self):
        return self._route.target.astype(np.float32)

    def _see_target2d(self):
        return self._projected(self._route.target[np.newaxis])[0]

    def _see_hand(self):
        hands = self.session.hands
        return np.stack([hands["insertion"], hands["rotation"]], 1).astype(np.float32)

    def _see_hand_force(self):
        hands = self.session.hands
        return np.stack([hands["force"], hands["torque"]], 1).astype(np.float32)

    def _see_wall_force(self):
        return np.array([self._peaks["wall_force"], self._peaks["tip_force"]], np.float32)

    def _see_last_action(self):
        return self._last

    def _see_image(self):
        return self.session.image(self.view)

    def _projected(self, points):
        """Points on the detector, [point, 2], from -1 to 1 within the image."""
        pixels = points @ self._camera[:, :3].T + self._camera[:, 3]
        return (pixels[:, :2] / pixels[:, 2:] / self._middle - 1.0).astype(np.float32)

    # --------------------------------------------------------------------------------------------------- preparation

    def _require_reachable(self, tolerance):
        largest = self.session.stops[self.instrument][1]
        radius = self.world.radii[self.instrument]
        name = self.world.instruments[self.instrument]
        for route in self.routes:
            if route.length - tolerance > largest:
                raise InputError("target: cannot be reached: it lies %.0f mm along the centreline, and '%s' can be inserted "
                                 "by %.0f mm" % (1e3 * route.length, name, 1e3 * largest))
            if route.radius <= radius:
                raise InputError("target: cannot be reached: the lumen narrows to a radius of %.2f mm, and '%s' has %.2f mm"
                                 % (1e3 * route.radius, name, 1e3 * radius))

    def _prepared(self, start):
        """States with which episodes begin; empty for the beginning of the scene."""
        if start is None:
            return []
        if isinstance(start, (bytes, list)):
            return [start] if isinstance(start, bytes) else list(start)
        with self.world.session() as session:  # pushed at the full scale of a velocity, at most 0.05 m/s
            speed = min(0.05, self.scale[self.instrument][0]) if self.action != "force" else 0.05
            now = session.reached
            largest = session.stops[self.instrument][1]
            if not now[self.instrument][0] <= start <= largest:
                raise InputError("start: an insertion of %g m is not between %g and %g m"
                                 % (start, now[self.instrument][0], largest))
            command = np.hstack([now, session.hands["pressure"][:, np.newaxis]])
            steps = int(np.ceil((start - now[self.instrument][0]) / (speed * self.world.time_step))) + 1
            commands = np.repeat(command[np.newaxis], steps, 0)
            commands[:, self.instrument, 0] = np.minimum(
                start, now[self.instrument][0] + speed * self.world.time_step * np.arange(1, steps + 1))
            session.step(commands)
            return [self._of_clients(session)]

    def _of_clients(self, session):
        """State of a session without clients, for this environment's own session."""
        if self.action != "force":
            return session.save()
        self.session.load(session.save())
        return self.session.save()

    def _make_spaces(self):
        count, float32 = len(self.world.instruments), np.float32
        self.action_space = _gym.Box(-1.0, 1.0, (count, 2), float32)
        shapes = {"tracking": (self._points[0], 3), "tracking2d": (self._points[0], 2), "target": (3,), "target2d": (2,),
                  "hand": (count, 2), "hand_force": (count, 2), "wall_force": (2,)}
        shapes.update({name: (size + 1,) for name, size in self._sensors.items()})
        spaces = {name: _gym.Box(-np.inf, np.inf, shape, float32) for name, shape in shapes.items() if name in self._names}
        if "last_action" in self._names:
            spaces["last_action"] = _gym.Box(-1.0, 1.0, (count, 2), float32)
        self._camera, self._middle = None, None
        if "image" in self._names or "tracking2d" in self._names or "target2d" in self._names or self.render_mode:
            self._camera = self.world.camera(self.view)
            pixels = self.session.image(self.view).shape
            self._middle = (pixels[0] - 1) / 2
            if "image" in self._names:
                spaces["image"] = _gym.Box(0, 255, pixels, np.uint8)
        spaces = {name: spaces[name] for name in self._names}
        if not self._flatten:
            self.observation_space = _gym.Dict(spaces)
            return
        if "image" in spaces:
            raise InputError("flatten: an image is no part of a vector; use flatten=False")
        self.observation_space = _gym.Box(*(np.concatenate([getattr(space, end).ravel() for space in spaces.values()])
                                            for end in ("low", "high")), dtype=float32)

    # -------------------------------------------------------------------------------------------------------- episode

    def _begin(self):
        if self.starts:
            number = int(self.np_random.integers(len(self.starts))) if len(self.starts) > 1 else 0
            self.session.load(self.starts[number])
            return
        for _ in range(100):
            try:
                self.session.reset(int(self.np_random.integers(1, 2**32)) if self.vary else 0)
                return
            except InputError:  # the varied start would lie in the wall
                if not self.vary:
                    raise
        raise InputError("start: none of 100 varied starts lies within the vessel; use vary=False")

    def _turn(self):
        """Turns all handles by a random angle, at the full scale of a velocity, at least 3 rad/s."""
        if self.start_turn == 0.0:
            return
        turn = float(self.np_random.uniform(-self.start_turn, self.start_turn))
        speed = 3.0 if self.action == "force" else max(3.0, self.scale[:, 1].max())
        command = np.hstack([self.session.reached, self.session.hands["pressure"][:, np.newaxis]])
        steps = int(np.ceil(abs(turn) / (speed * self.world.time_step)))
        commands = np.repeat(command[np.newaxis], steps, 0)
        commands[:, :, 1] += turn * (np.arange(1, steps + 1) / max(steps, 1))[:, np.newaxis]
        self.session.step(commands)

    def _distance(self):
        """Distance of the tip from the target along the centreline [m], and name of its branch."""
        branch = self.session.branch(self.instrument)
        return self._route.distance(self.session.tips["position"][self.instrument], branch.index), branch.name

    def _info(self, distance, branch, success, reason):
        return {"trajectory_hash": self.session.trajectory_hash, "distance": float(distance), "branch": branch,
                "success": bool(success), "reason": reason, **self._peaks}


def _require_known(option, names, known):
    for name in names:
        if name not in known:
            raise InputError("%s: '%s' is none of %s" % (option, name, ", ".join(known)))


def _world(world):
    return world if isinstance(world, World) else World(world, centreline=True)


def _driven_by_clients(world):
    """World whose instruments clients drive."""
    world = _world(world)
    listed = "\ninstruments:" in "\n" + world.yaml
    keys = ["instruments.%d.drive.source" % k for k in range(len(world.instruments))] if listed else ["drive.source"]
    return world.vary(**dict.fromkeys(keys, "topic"))
