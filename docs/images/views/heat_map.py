"""Forces on the wall of the iliac artery, the wire in it, and the path of its tip."""

from pictures import UPPER, LOWER, display, played, view


def take(folder, out, overrides):
    def change(config):
        view(config, "Tip", 0.15)
        display(config, "Vessel")["Forces"]["Full Scale"] = 0.1
        path = display(config, "Path of the tip")
        path["Enabled"] = path["Value"] = True
    played(folder, out, change, 6.0, ["drive.insertion.points=[[0,0],[0.5,0],[4.2,0.13]]", *overrides], box=(16, UPPER, 698, LOWER))
