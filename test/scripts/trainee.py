"""Person at the panel who follows the page of a lesson: sees the step, the branch of the tips and the bend of the foremost one, and uses
the keys. The steps and their goals are those of the scene's procedure."""
import math

import numpy
import rospy
import yaml
from endovascular_sim.msg import HeartPhase, MotionControls, SessionSample, VesselCentreline

STALLED = 2.0  # simulated time without progress after which the person pulls back [s]
PROGRESS = 2e-3  # motion of a tip that counts as progress [m]
LIMIT = 240.0  # wall time of one motion [s]


def arc_lengths(points):
    """Arc length of each point of a polyline from the first one [m]."""
    return numpy.concatenate([[0.0], numpy.cumsum(numpy.linalg.norm(numpy.diff(points, axis=0), axis=1))])


def atmospheres(pressure):
    """Pressure of a procedure, in Pa or with its unit, as the panel takes it [atm]."""
    number, _, unit = str(pressure).partition(" ")
    return float(number) * {"": 1.0 / 101325.0, "Pa": 1.0 / 101325.0, "bar": 1e5 / 101325.0, "atm": 1.0}[unit]


class Trainee:
    """@param session RvizSession of a lesson
    @param procedure path of its procedure
    @param instruments names, in the order of the scene"""

    def __init__(self, session, procedure, instruments):
        self.session, self.instruments = session, instruments
        with open(procedure, encoding="utf-8") as file:
            self.steps = yaml.safe_load(file)["steps"]
        self.sample = self.branches = None
        self.count = 0  # messages of ProcedureStep that were examined
        self.hyperaemia = False
        rospy.Subscriber("hemodynamics/phase", HeartPhase, lambda heart: setattr(self, "hyperaemia", bool(heart.hyperaemia)), queue_size=1)
        self.breath_held = False  # asked for
        rospy.Subscriber("motion/controls", MotionControls, lambda controls: setattr(self, "breath_held", controls.breath_held), queue_size=1)
        rospy.Subscriber("session/sample", SessionSample, lambda message: setattr(self, "sample", message), queue_size=1)
        rospy.Subscriber("vessel/centreline", VesselCentreline, self._take_branches, queue_size=1)
        session.wait(60, lambda: self.sample is not None and self.branches is not None, "samples and the centreline")

    def _take_branches(self, message):
        self.branches = {branch.name: (numpy.array([(p.x, p.y, p.z) for p in branch.points]), numpy.array(branch.radii))
                         for branch in message.branches}

    # What the person sees.

    def number(self):
        """Number of the present step, from 1."""
        return self.session.step.step_of_procedure

    def is_done(self):
        step = self.session.step
        return step.outcome == 1 and step.step_of_procedure == step.steps_of_procedure

    def tip(self, k):
        point = self.sample.tip[k]
        return numpy.array((point.x, point.y, point.z))

    def branch_of(self, point):
        """Name of the branch whose wall is the nearest."""
        return min(self.branches, key=lambda name: (numpy.linalg.norm(self.branches[name][0] - point, axis=1)
                                                    - self.branches[name][1]).min())

    def insertion(self, k):
        return self.session.state.insertion[k]

    def rotation(self, k):
        return self.session.state.rotation[k]

    def bend_to(self, goal):
        """Angle about the tip's axis from its bend to a point [rad], and the distance of that point [m]."""
        nodes = numpy.array([(p.x, p.y, p.z) for p in self.session.state.nodes])
        behind = nodes[numpy.linalg.norm(nodes - nodes[-1], axis=1) > 0.012]
        if len(behind) < 3:
            return 0.0, math.inf
        axis = behind[-1] - behind[-3]
        axis = axis / numpy.linalg.norm(axis)
        across = [v - v.dot(axis) * axis for v in (nodes[-1] - behind[-1], goal - behind[-1])]
        return math.atan2(axis.dot(numpy.cross(*across)), across[0].dot(across[1])), float(numpy.linalg.norm(goal - nodes[-1]))

    # What the person does.

    def key_until(self, key, condition, name):
        self.session.hold_key_until(key, LIMIT, condition, name)

    def turn(self, k, angle):
        """Turns the handle by an angle, positive by the key right."""
        begin = self.rotation(k)
        self.key_until("Right" if angle > 0 else "Left", lambda: abs(self.rotation(k) - begin) >= abs(angle), "a twist")

    def steer(self, k, branch):
        """Turns the bend of the foremost tip towards a branch that is near."""
        points = self.branches[branch][0]
        ends = [points[0], points[-1]]
        near = min((0, 1), key=lambda end: numpy.linalg.norm(ends[end] - self.tip(k)))
        ordered = points if near == 0 else points[::-1]
        inside = ordered[min(len(ordered) - 1, numpy.searchsorted(arc_lengths(ordered), 0.012))]
        for _ in range(8):
            angle, distance = self.bend_to(inside)
            if distance > 0.08 or abs(angle) < 0.4:
                return
            self.turn(k, 0.7 * angle)
            rospy.sleep(0.5)

    def push_until_something(self, k, number):
        """Pushes until the step is over, the tip enters a wrong branch, or nothing moves. @return what happened"""
        wrong = self.session.step.wrong_branches
        mark = [self.tip(k), self.sample.time]
        happened = []

        def look():
            if self.number() != number or self.is_done():
                happened.append("done")
            elif self.session.step.wrong_branches > wrong:
                happened.append("wrong branch")
            elif numpy.linalg.norm(self.tip(k) - mark[0]) > PROGRESS:
                mark[:] = [self.tip(k), self.sample.time]
            elif self.sample.time - mark[1] > STALLED:
                happened.append("stalled")
            return happened

        self.key_until("Up", look, "an event of the push in step %d" % number)
        return happened[0]

    def advance(self, k, number, goal, back, angle):
        """Pushes an instrument to the goal of a step; pulls back and twists where it does not advance."""
        for _ in range(25):
            if goal:
                self.steer(k, goal)
            happened = self.push_until_something(k, number)
            if happened == "done":
                return
            print("step %d: %s, in %s" % (number, happened, self.branch_of(self.tip(k))), flush=True)
            begin = self.insertion(k)
            self.key_until("Down", lambda: self.insertion(k) < begin - back, "a pull")
            self.turn(k, angle)
        raise AssertionError("step %d: not done after 25 attempts" % number)

    def withdraw(self, k, number):
        self.key_until("Down", lambda: self.number() != number or self.is_done(), "the withdrawal of step %d" % number)

    def inject(self, number, volume, rate):
        """Fills the syringe and injects by the buttons of the panel: the puff, or the volume and rate that stand in its boxes."""
        self.session.click("refill_syringe")
        self.session.click("puff" if (volume, rate) == (3e-6, 3e-6) else "inject")
        self.session.wait(LIMIT, lambda: self.number() != number or self.is_done(), "step %d" % number)

    def do_step(self):
        """Does the present step as its hint says."""
        number = self.number()
        step = self.steps[number - 1]
        if "inflate" in step:
            pressure = atmospheres(step["pressure"])
            if pressure < 0.0:  # the vacuum has a button of its own
                self.session.click("deflate")
            else:
                self.session.set_pressure(pressure)
            self.session.wait(LIMIT, lambda: self.number() != number or self.is_done(), "step %d" % number)
            return
        if "inject" in step:
            self.inject(number, float(step["volume"]), float(step["rate"]))
            return
        if "wait" in step:
            if "hyperaemia" in step and self.hyperaemia != step["hyperaemia"]:
                self.session.click("adenosine")
            if "breath" in step and self.breath_held != (step["breath"] == "hold"):
                self.session.click("hold_breath")
            self.session.wait(LIMIT, lambda: self.number() != number or self.is_done(), "step %d" % number)
            return
        name = step.get("advance") or step.get("withdraw")
        k = self.instruments.index(name)
        if "withdraw" in step:
            self.withdraw(k, number)
            return
        retry = step.get("retry", {})
        goal = step["until"].get("tip_in") if step.get("steer") else None
        self.advance(k, number, goal, retry.get("back", 0.02), retry.get("turn", 1.0))

    def do_steps(self, last=None):
        """Does all steps up to a number."""
        while not self.is_done() and (last is None or self.number() <= last):
            number = self.number()
            self.do_step()
            print("step %d done at %.1f s" % (number, self.sample.time), flush=True)
            self.session.wait(30, lambda: self.number() != number or self.is_done(), "the next step")
            rospy.sleep(1.0)  # reads the hint; the panel chooses the instrument
