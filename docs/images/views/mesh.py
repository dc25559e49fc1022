"""The scene `mesh` in a vessel that the overrides name."""

from pictures import UPPER, LOWER, played


def take(folder, out, overrides):
    played(folder, out, lambda config: None, 9.0, overrides, "mesh", (16, UPPER, 1280, LOWER))
