"""Results that `replay --out` makes from bags alone are those of the sessions. Arguments: REPOSITORY PROGRAMS FOLDER."""

import json
import os
import sys

import numpy as np
from PIL import Image

import bag_sessions

EQUAL = ("scene.yaml", "trajectory.csv", "wall_forces.csv", "vessel_points.csv", "metrics.json", "metrics.html", "instruments.csv")
SCENES = {
    "demo": ("config/scenes/demo.yaml", "duration=6"),  # long enough for X-ray images on a busy machine
    "treatment": ("test/data/scenes/good_treatment_errors.yaml",),
    "procedure": ("test/data/scenes/good_procedure_errors.yaml",),
}
# Noise and C-arm of a rendered picture are not those of the session; a picture without the wire or with another view differs by more.
LARGEST_MEAN_DIFFERENCE = 12.0  # grey levels


def content(path):
    with open(path, "rb") as stream:
        return stream.read()


def compare_reports(live, made):
    reports = [json.loads(content(folder + "/report.json")) for folder in (live, made)]
    for report in reports:
        # Paths of this machine, which the bag does not hold.
        del report["scene"]["file"], report["recording"]["file"]
    for key, value in reports[0].items():
        assert value == reports[1][key], "%s: report.json, %s: %s, replayed %s" % (live, key, value, reports[1][key])
    assert reports[0].keys() == reports[1].keys()


def compare_pictures(live, made):
    names = [sorted(os.listdir(folder + "/fluoroscopy")) for folder in (live, made)]
    assert names[0] == names[1], names
    for name in names[0]:
        images = [np.asarray(Image.open("%s/fluoroscopy/%s" % (folder, name)), float) for folder in (live, made)]
        difference = np.abs(images[0] - images[1]).mean()
        assert difference < LARGEST_MEAN_DIFFERENCE, "%s of %s differs by %.1f grey levels" % (name, live, difference)
    return len(names[0])


def compare(live, made):
    """Compares two folders of results."""
    for name in EQUAL:
        exists = [os.path.exists("%s/%s" % (folder, name)) for folder in (live, made)]
        assert exists[0] == exists[1], "%s: %s is %s" % (live, name, "missing in the replay" if exists[0] else "new in the replay")
        if exists[0]:
            assert content("%s/%s" % (live, name)) == content("%s/%s" % (made, name)), "%s: %s differs" % (live, name)
    compare_reports(live, made)
    return compare_pictures(live, made)


def main():
    repository, programs, folder = sys.argv[1:]
    live = {name: bag_sessions.record(repository, "%s/%s" % (folder, name), repository + "/" + scene, *overrides)
            for name, (scene, *overrides) in SCENES.items()}
    code, out, err = bag_sessions.run(programs + "/replay", folder, "--out", folder + "/made", "--no-plots")
    assert code == 0, out + err
    assert out.count(" 0 different") == len(SCENES), out
    pictures = {name: compare(results, "%s/made/%s/%s/results" % (folder, os.path.basename(folder), name)) for name, results in live.items()}
    assert pictures["demo"] > 0, pictures
    print("pictures compared:", pictures)


main()
