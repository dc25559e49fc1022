"""Comparison of bags as an independent reader, npm's @foxglove/rosbag, sees them, with bag_check and Python's Bag.

Usage: independent_reader.py PROGRAMS BAG..., with NODE_PATH naming a folder with @foxglove/rosbag and lz4js."""

import json
import os
import subprocess
import sys

import endovascular_sim as evs

HERE = os.path.dirname(os.path.abspath(__file__))


def output(*words):
    """JSON that a program prints. bag_check ends with 3 for a bag of other physics, which it reads nevertheless."""
    done = subprocess.run(words, stdout=subprocess.PIPE, check=False)
    assert done.returncode in (0, 3), words
    return json.loads(done.stdout)


def compare(programs, path):
    """Number of messages that all readers find. Raises AssertionError where they differ."""
    seen = output("node", HERE + "/read_bag.js", path)
    survey, = output(programs + "/bag_check", "--json", "--quick", path)
    bag = evs.Bag(path)
    assert seen["topics"] == {topic["topic"]: topic["messages"] for topic in survey["topics"]}, path
    assert seen["topics"] == {topic: count for topic, count in bag.topics.items() if count}, path
    assert seen["steps"] == bag.steps.tolist(), path
    assert seen["hashes"] == bag.hashes, path
    assert [seen["steps"][0], seen["steps"][-1], len(seen["steps"])] == [survey["steps"][key] for key in ("first", "last", "number")]
    return sum(seen["topics"].values())


def main():
    programs, *paths = sys.argv[1:]
    assert paths, "no bag"
    for path in paths:
        print("%s: %d messages" % (path, compare(programs, path)))


main()
