"""Bags of sessions, read without ROS."""

import ctypes
import ctypes.util
import pathlib
import random
import struct
import tempfile
import unittest

import numpy as np
from support import REPOSITORY, evs

FORMER_SESSION = REPOSITORY / "test/data/recorded_session/session.bag"
SESSION = REPOSITORY / "test/fuzz/corpus/bag/session"


def record(fields, data):
    header = b"".join(struct.pack("<I", len(name) + 1 + len(value)) + name + b"=" + value for name, value in fields.items())
    return struct.pack("<I", len(header)) + header + struct.pack("<I", len(data)) + data


def lz4_frame(content):
    """Frame with one compressed and one plain block."""
    library = ctypes.CDLL(ctypes.util.find_library("lz4") or "liblz4.so.1")
    half = len(content) // 2
    packed = ctypes.create_string_buffer(2 * len(content) + 64)
    size = library.LZ4_compress_default(content[:half], packed, half, len(packed))
    return (struct.pack("<IBBB", 0x184D2204, 0x60, 0x40, 0) + struct.pack("<I", size) + packed.raw[:size]
            + struct.pack("<I", len(content) - half | 0x80000000) + content[half:] + struct.pack("<I", 0))


DEFINITION = (b"std_msgs/Header header\nint8 KIND=3\nfloat64[] values # numbers\ngeometry_msgs/Point[] points\n"
              b"string[2] words\nuint8 KIND2=4\n================\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\n"
              b"string frame_id\n================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n")
DATA = (struct.pack("<IIII", 7, 5, 500000000, 1) + b"m" + struct.pack("<Idd", 2, 0.5, -1.5)
        + struct.pack("<Iddd", 1, 1.0, 2.0, 3.0) + struct.pack("<I", 1) + b"a" + struct.pack("<I", 0))


def small_bag(pack=lambda content: content, name=b"none", topic=b"/ns/topic", definition=DEFINITION, data=DATA):
    """Bag of one topic; by default with nested fields, arrays and constants."""
    connection = record({b"op": b"\x07", b"conn": struct.pack("<I", 4), b"topic": topic},
                        b"".join(struct.pack("<I", len(field)) + field for field in
                                 (b"type=test/Kind", b"message_definition=" + definition, b"md5sum=0")))
    message = record({b"op": b"\x02", b"conn": struct.pack("<I", 4), b"time": struct.pack("<II", 9, 0)}, data)
    content = connection + message
    return b"#ROSBAG V2.0\n" + record({b"op": b"\x05", b"compression": name, b"size": struct.pack("<I", len(content))},
                                      pack(content))


class Bags(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name) / "written.bag"

    def written(self, content):
        self.path.write_bytes(content)
        return evs.Bag(self.path)

    def test_hold_steps_commands_forces_and_poses(self):
        bag = evs.Bag(SESSION)
        count = len(bag.steps)
        self.assertGreater(count, 0)
        np.testing.assert_array_equal(bag.steps, bag.steps[0] + np.arange(count, dtype=np.uint64))
        self.assertEqual(bag.commands.shape[::2], (count, 3))
        self.assertEqual(bag.forces.shape[::2], (count, 2))
        self.assertEqual(len(bag.hashes[0]), 16)
        self.assertEqual(bag.info["scene_yaml"], bag.scene)
        self.assertEqual(bag.damage, "")

    def test_hold_the_poses_of_the_wire(self):
        definition = b"float64 time\ngeometry_msgs/Point[] nodes\n====\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z"
        data = struct.pack("<dI6d", 0.5, 2, *range(6))
        bag = self.written(small_bag(topic=b"/rod/state_visual", definition=definition, data=data))
        np.testing.assert_array_equal(bag.pose_times, [0.5])
        np.testing.assert_array_equal(bag.poses[0], [[0, 1, 2], [3, 4, 5]])

    def test_hold_the_readings_of_sensors(self):
        definition = b"uint64 sequence\nuint64 step\nuint64 delivered_step\nfloat64 time\nbool valid\nfloat64[] values"
        data = struct.pack("<QQQd?I2d", 3, 7, 9, 0.007, True, 2, 0.1, -0.2)
        bag = self.written(small_bag(topic=b"/left/sensors/encoder", definition=definition, data=data))
        self.assertEqual(list(bag.sensors), ["encoder"])
        encoder = bag.sensors["encoder"]
        np.testing.assert_array_equal(encoder["values"], [[0.1, -0.2]])
        self.assertEqual([encoder[name][0] for name in ("sequence", "step", "delivered_step", "time", "valid")],
                         [3, 7, 9, 0.007, True])
        self.assertEqual(evs.Bag(SESSION).sensors, {})

    def test_of_a_former_version_have_the_present_names(self):
        bag = evs.Bag(FORMER_SESSION)
        self.assertEqual(bag.topics["/vessel/wall_displacement"], 13)
        self.assertEqual([time for time, _ in bag.read("vessel/moved")],
                         [time for time, _ in bag.read("vessel/wall_displacement")])
        retries = [step["retries"] for _, step in bag.read("procedure/step")]
        self.assertEqual(retries, [0, 0, 0, 0])
        self.assertEqual(len(bag.steps), 200)

    def test_are_read_with_every_compression(self):
        import bz2
        for bag in (small_bag(), small_bag(bz2.compress, b"bz2"), small_bag(lz4_frame, b"lz4")):
            [(time, message)] = self.written(bag).read("topic")
            self.assertEqual(time, 9.0)
            self.assertEqual(message["header"], {"seq": 7, "stamp": 5.5, "frame_id": "m"})
            np.testing.assert_array_equal(message["values"], [0.5, -1.5])
            np.testing.assert_array_equal(message["points"], [[1.0, 2.0, 3.0]])
            self.assertEqual(message["words"], ["a", ""])

    def test_are_read_up_to_a_truncation(self):
        content = SESSION.read_bytes()
        for size in range(20, len(content), 997):
            bag = self.written(content[:size])
            self.assertIn("ends inside a record", bag.damage)
            repr(bag)

    def test_with_damage_raise_errors_of_the_package_only(self):
        content, flips = SESSION.read_bytes(), random.Random(2)
        for _ in range(150):
            damaged = bytearray(content)
            for _ in range(flips.randrange(1, 6)):
                damaged[flips.randrange(13, len(damaged))] ^= 1 << flips.randrange(8)
            try:
                bag = self.written(bytes(damaged))
                for topic in bag.topics:
                    list(bag.read(topic))
            except evs.InputError:
                pass

    def test_of_other_kinds_are_refused(self):
        with self.assertRaisesRegex(evs.InputError, "no bag"):
            self.written(b"#ROSBAG V1.1\n")
        with self.assertRaisesRegex(evs.InputError, "cannot be read"):
            evs.Bag("nowhere.bag")
        bag = self.written(small_bag())
        with self.assertRaisesRegex(AttributeError, "drive/applied"):
            bag.steps  # noqa: B018
        with self.assertRaisesRegex(evs.InputError, "/ns/topic"):
            list(bag.read("nothing"))


if __name__ == "__main__":
    unittest.main()
