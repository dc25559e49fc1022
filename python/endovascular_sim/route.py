"""Ways through the branches of a vessel."""

import numpy as np

from ._core import InputError


class Route:
    """Way along the centreline from the introducer to a target in a branch.

    world   World with a vessel and a centreline
    target  (branch, depth): name or index of a branch, and the distance from its ostium along it [m]

    Raises InputError for an unknown branch, and for a depth beyond its end.

    length   of the way [m]
    target   position in the patient frame [m], [3]
    branch   index of the target's branch
    points   of the way, [point, 3] [m]
    radius   least radius of the lumen on the way [m]
    """

    def __init__(self, world, target):
        self._branches = [_Line(branch) for branch in world.branches]
        if not self._branches:
            raise InputError("target: the world has no centreline; make it with World(..., centreline=True)")
        for line in self._branches:
            line.junction = self._branches[line.parent].project(line.points[0])[0] if line.parent >= 0 else 0.0
        name, depth = target
        self.branch = self._index(name)
        line = self._branches[self.branch]
        arc = line.ostium + float(depth)
        if not 0.0 <= arc <= line.length:
            raise InputError("target: a depth of %g m does not lie in branch '%s': give %.3f to %.3f m"
                             % (depth, line.name, -line.ostium, line.length - line.ostium))
        self.target = line.at(arc)
        entry, _ = world.entry
        foots = [line.project(entry) for line in self._branches]
        first = min(range(len(foots)), key=lambda k: foots[k][1])
        self._to_target = self._walk(self.branch, arc)
        self.length = self._distance(first, foots[first][0])
        pieces = self._pieces(first, foots[first][0])
        self.points = np.concatenate([self._branches[b].between(*ends)[0] for b, *ends in pieces])
        self.radius = min(self._branches[b].between(*ends)[1].min() for b, *ends in pieces)

    def distance(self, point, branch):
        """Distance to the target along the centreline [m].

        point   [3], patient frame [m]
        branch  that holds the point, as Session.branch().index; -1, outside of the vessel: the distance is `length`
        """
        if branch < 0:
            return self.length
        return self._distance(branch, self._branches[branch].project(point)[0])

    def _index(self, name):
        names = [line.name for line in self._branches]
        if name in names:
            return names.index(name)
        if isinstance(name, (int, np.integer)) and 0 <= name < len(names):
            return int(name)
        raise InputError("target: no branch %r; the vessel has %s" % (name, ", ".join(names)))

    def _walk(self, branch, arc):
        """Way to the root: per branch the arc length at which the way enters it, and the distance up to there."""
        walk, done = {}, 0.0
        while branch >= 0:
            walk[branch] = (arc, done)
            done += arc
            arc, branch = self._branches[branch].junction, self._branches[branch].parent
        return walk

    def _distance(self, branch, arc):
        for common, (here, done) in self._walk(branch, arc).items():
            if common in self._to_target:
                there, rest = self._to_target[common]
                return done + abs(here - there) + rest
        raise InputError("target: no way leads from the introducer to branch '%s'" % self._branches[self.branch].name)

    def _pieces(self, branch, arc):
        """Parts (branch, from, to) of the way from a point to the target."""
        pieces = []
        for common, (here, _) in self._walk(branch, arc).items():
            if common in self._to_target:
                break
            pieces.append((common, here, 0.0))
        down = []
        for other, (there, _) in self._to_target.items():
            if other == common:
                return [*pieces, (common, here, there), *reversed(down)]
            down.append((other, 0.0, there))
        raise AssertionError("the common branch is on both ways")


class _Line:
    """Centreline of a branch."""

    def __init__(self, branch):
        self.name, self.parent, self.ostium = branch["name"], branch["parent"], branch["ostium"]
        self.points, self.radii = branch["points"], branch["radii"]
        self._steps = np.diff(self.points, axis=0)
        self._squares = np.maximum((self._steps**2).sum(1), 1e-30)
        self.arcs = np.concatenate([[0.0], np.cumsum(np.sqrt(self._squares))])
        self.length = self.arcs[-1]

    def project(self, point):
        """Arc length of the nearest point [m], and the distance from it [m]."""
        offsets = point - self.points[:-1]
        shares = np.clip(np.einsum("ij,ij->i", offsets, self._steps) / self._squares, 0.0, 1.0)
        gaps = ((offsets - shares[:, np.newaxis] * self._steps)**2).sum(1)
        nearest = int(gaps.argmin())
        return (self.arcs[nearest] + shares[nearest] * np.sqrt(self._squares[nearest]), float(np.sqrt(gaps[nearest])))

    def at(self, arc):
        return np.array([np.interp(arc, self.arcs, self.points[:, k]) for k in range(3)])

    def between(self, begin, end):
        """Points and radii between two arc lengths, in this order."""
        inner = self.arcs[(self.arcs > min(begin, end)) & (self.arcs < max(begin, end))]
        arcs = np.concatenate([[begin], inner if begin <= end else inner[::-1], [end]])
        return np.stack([self.at(arc) for arc in arcs]), np.interp(arcs, self.arcs, self.radii)
