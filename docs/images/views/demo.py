"""Wire in the aortic arch, with the names of the branches and the X-ray image."""

from pictures import played, view


def take(folder, out, overrides):
    def change(config):
        view(config, "Tip", 0.26)
    played(folder, out, change, 18.0, ["drive.insertion.points=[[0,0],[17.85,0.63]]", "fluoroscopy.primary_angle=0.698", *overrides])
