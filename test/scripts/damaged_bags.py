"""Damaged bags of a session: each damage is named, no program crashes, and none is taken for complete.
Arguments: REPOSITORY PROGRAMS FOLDER."""

import os
import struct
import sys

import bag_sessions

import endovascular_sim as evs

CHUNK = 5  # kind of a record


def records(content):
    """Positions of the records: (kind, begin, begin of the data, end)."""
    at = len(b"#ROSBAG V2.0\n")
    while at < len(content):
        header = struct.unpack_from("<I", content, at)[0]
        fields = content[at + 4:at + 4 + header]
        data = at + 4 + header
        end = data + 4 + struct.unpack_from("<I", content, data)[0]
        yield fields[fields.index(b"op=") + 3], at, data + 4, end
        at = end


def zeroed(content, begin, end):
    return content[:begin] + bytes(end - begin) + content[end:]


def with_swapped_steps(content, chunks, folder):
    """Copy with two neighbouring chunks swapped, so that steps stand in the wrong order."""
    path = folder + "/swapped.bag"
    for (_, first, _, middle), (_, _, _, end) in zip(chunks[1:-1], chunks[2:]):
        copy = content[:first] + content[middle:end] + content[first:middle] + content[end:]
        with open(path, "wb") as stream:
            stream.write(copy)
        steps = [message["step"] for _, message in evs.Bag(path).read("drive/applied")]
        if steps != sorted(steps):
            return copy
    raise AssertionError("no chunks with steps")


def damages(content, folder):
    """Damaged copies by their names."""
    chunks = [record for record in records(content) if record[0] == CHUNK]
    assert len(chunks) > 8, "the bag has %d chunks" % len(chunks)
    middle, last = chunks[len(chunks) // 2], chunks[-2]
    first, second = chunks[3], chunks[4]
    copies = {
        "cut at 60 %": content[:len(content) * 6 // 10],
        "end lost": content[:-200],
        "hole in the middle": content[:middle[1]] + content[middle[3]:],
        "bytes cut out": content[:len(content) // 2] + content[len(content) // 2 + 30000:],
        "zeros in the middle": zeroed(content, middle[2], middle[3]),
        "zeros near the end": zeroed(content, (last[2] + last[3]) // 2, last[3]),
        "zeros over two chunks": zeroed(content, first[2] + 10, second[3]),
        "swapped chunks": with_swapped_steps(content, chunks, folder),
        "empty": b"",
        "no bag": b"PNG" + content[:1000],
    }
    assert all(copy != content for copy in copies.values())
    return copies


def check(programs, name, path, out):
    """Examines one damaged bag with every program."""
    codes = {}
    for words in (["bag_check"], ["replay"], ["replay", "--out", out, "--no-plots", "--no-pictures"], ["bag_export", "--out", out + "_csv"]):
        code, output, message = bag_sessions.run(programs + "/" + words[0], path, *words[1:])
        assert 0 <= code <= 3, "%s: %s ends with %d\n%s" % (name, words[0], code, message)
        assert output or message, "%s: %s says nothing" % (name, words[0])
        codes[" ".join(words[:2])] = code
        if words[0] == "bag_check":
            survey = output
    return codes, survey


def main():
    repository, programs, folder = sys.argv[1:]
    results = bag_sessions.record(repository, folder + "/whole", repository + "/config/scenes/demo.yaml", "duration=6")
    with open(results + "/session.bag", "rb") as stream:
        content = stream.read()
    steps = len(evs.Bag(results + "/session.bag").steps)
    for k, (name, copy) in enumerate(damages(content, folder).items()):
        path = "%s/damaged_%d.bag" % (folder, k)
        with open(path, "wb") as stream:
            stream.write(copy)
        codes, survey = check(programs, name, path, "%s/out_%d" % (folder, k))
        print("%-22s %s" % (name, codes))
        # Swapped chunks hold every message: the steps are put in order, and the order is named.
        is_whole = name == "swapped chunks" and "wrong order" in survey
        assert is_whole or codes["bag_check"] != 0, "%s: bag_check finds no damage\n%s" % (name, survey)
        assert is_whole or codes["replay"] != 0, "%s: replay takes it for complete" % name
        if codes["replay"] == 0:
            assert len(evs.Bag(path).steps) == steps, name
        if not copy.startswith(b"#ROSBAG"):
            assert set(codes.values()) == {1}, codes
    assert not os.path.exists("core"), "a program crashed"


main()
