"""Shaded pictures of a vessel and its instruments, in parallel projection from the front.

Surfaces are sampled more densely than the pixels, and each pixel keeps its nearest sample. Coordinates: patient frame [m].
"""

import numpy as np

SAMPLE = 0.6                                     # distance of the samples of a surface [pixel]
FINER = 2                                        # pixels are computed finer and averaged
LIGHT = np.array([-0.4, -0.75, 0.55]) / np.linalg.norm([-0.4, -0.75, 0.55])
WALL = np.array([0.86, 0.47, 0.42])
HIDING = 0.45                                    # opacity of a vessel in front of another one that holds an instrument


class Layer:
    """Colours and depths of the nearest samples [m, larger is farther]; pixels without a sample have infinite depth."""

    def __init__(self, pixels):
        self.pixels = pixels
        self.depth = np.full(pixels * pixels, np.inf)
        self.colour = np.ones((pixels * pixels, 3))
        self.rim = np.zeros(pixels * pixels)

    def add(self, columns, rows, depth, colour, rim=None):
        """Keeps the samples that are nearer than those of their pixels."""
        inside = (columns >= 0) & (columns < self.pixels) & (rows >= 0) & (rows < self.pixels)
        place = (rows * self.pixels + columns)[inside]
        order = np.argsort(-depth[inside], kind="stable")  # the nearest sample is written last
        place, chosen = place[order], np.flatnonzero(inside)[order]
        chosen, place = chosen[depth[chosen] < self.depth[place]], place[depth[chosen] < self.depth[place]]
        self.depth[place] = depth[chosen]
        self.colour[place] = colour[chosen]
        if rim is not None:
            self.rim[place] = rim[chosen]


def shaded(colour, normals):
    """Colour of a matt surface with a highlight under a light from the upper left."""
    lit = np.clip(normals @ LIGHT, 0.0, 1.0)[:, None]
    return np.clip(colour * (0.45 + 0.6 * lit) + 0.25 * lit ** 24, 0.0, 1.0)


class ScenePicture:
    """Square view from the front: x to the right, z upwards, the viewer at negative y."""

    def __init__(self, centre, half_width, pixels):
        self.centre = np.asarray(centre)
        self.half = half_width
        self.pixels = pixels * FINER
        self.scale = self.pixels / (2.0 * half_width)
        self.far_wall, self.near_wall, self.tubes = (Layer(self.pixels) for _ in range(3))

    def add_wall(self, vertices, faces, normals):
        """Adds a closed surface with outward normals; its far and its near side are layers of their own."""
        across = self._projected(vertices)
        seen = (across[faces].max(axis=1) > 0).all(axis=1) & (across[faces].min(axis=1) < self.pixels).all(axis=1)
        faces = faces[seen]
        corners = across[faces]
        edges = np.linalg.norm(corners - corners[:, [1, 2, 0]], axis=2).max(axis=1)
        parts = np.maximum(1, np.ceil(edges / SAMPLE)).astype(int)
        for n in np.unique(parts):
            some = faces[parts == n]
            first, second = (each.ravel() for each in np.meshgrid(np.arange(n + 1), np.arange(n + 1)))
            share = np.stack([first, second, n - first - second], axis=1)[first + second <= n] / n
            self._add_wall_samples(np.einsum("sk,fkc->fsc", share, vertices[some]).reshape(-1, 3),
                                   np.einsum("sk,fkc->fsc", share, normals[some]).reshape(-1, 3))

    def add_tube(self, line, radius, colour, least=0.0, in_front=0.0):
        """Adds a tube about a polyline; its radius is at least `least` pixels of the final picture.

        `in_front` [m] brings it nearer, so that an instrument is seen in the lumen of another one."""
        line = np.asarray(line)
        if len(line) < 2:
            return
        drawn = max(radius * self.scale, least * FINER)
        steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
        keep = np.append(True, steps > 0)
        line, arc = line[keep], np.append(0.0, np.cumsum(steps[steps > 0]))
        at = np.linspace(0.0, arc[-1], max(2, int(arc[-1] * self.scale / SAMPLE) + 1))
        points = np.stack([np.interp(at, arc, line[:, k]) for k in range(3)], axis=1)
        tangents = np.gradient(points, axis=0)
        tangents /= np.maximum(np.linalg.norm(tangents, axis=1, keepdims=True), 1e-30)
        side = np.stack([tangents[:, 2], np.zeros(len(at)), -tangents[:, 0]], axis=1)
        length = np.linalg.norm(side, axis=1, keepdims=True)
        side = np.where(length > 1e-9, side / np.maximum(length, 1e-9), [1.0, 0.0, 0.0])
        front = np.cross(tangents, side)
        front *= -np.sign(front[:, 1:2] + 1e-30)
        share = np.linspace(-1.0, 1.0, max(3, int(2 * drawn / SAMPLE) + 1))
        normals = (side[:, None] * share[None, :, None] +
                   front[:, None] * np.sqrt(1.0 - share ** 2)[None, :, None]).reshape(-1, 3)
        surface = np.repeat(points, len(share), axis=0) + normals * drawn / self.scale
        columns, rows = np.floor(self._projected(surface)).astype(int).T
        self.tubes.add(columns, rows, surface[:, 1] - in_front, shaded(np.asarray(colour), normals))

    def image(self):
        """The picture, rows from the top, values from 0 to 1."""
        result = np.ones((self.pixels * self.pixels, 3))
        far, tubes, near = self.far_wall, self.tubes, self.near_wall
        self._blend(result, far, 0.8)
        self._blend(result, tubes, 1.0)
        self._blend(result, far, np.where(tubes.depth > far.depth, HIDING, 0.0) * np.isfinite(tubes.depth))
        self._blend(result, near, 0.16 + 0.5 * near.rim)
        square = result.reshape(self.pixels // FINER, FINER, self.pixels // FINER, FINER, 3)
        return square.mean(axis=(1, 3))[::-1]

    def _projected(self, points):
        """Column and row of points [pixel]."""
        return (points[:, [0, 2]] - self.centre[[0, 2]]) * self.scale + 0.5 * self.pixels

    def _add_wall_samples(self, points, normals):
        columns, rows = np.floor(self._projected(points)).astype(int).T
        towards = -normals[:, 1]
        rim = (1.0 - np.clip(np.abs(towards), 0.0, 1.0)) ** 2
        # Farther parts are paler.
        fog = np.clip((points[:, 1:2] - self.centre[1]) / (3.0 * self.half), -0.3, 0.45)
        for layer, side in ((self.far_wall, towards < 0), (self.near_wall, towards >= 0)):
            facing = np.where(towards[side, None] < 0, -normals[side], normals[side])
            colour = shaded(WALL, facing)
            colour = np.clip(colour + np.maximum(fog[side], 0.0) * (1.0 - colour), 0.0, 1.0)
            layer.add(columns[side], rows[side], points[side, 1], colour, rim[side])

    @staticmethod
    def _blend(result, layer, opacity):
        share = (np.isfinite(layer.depth) * opacity)[:, None]
        result += share * (layer.colour - result)
