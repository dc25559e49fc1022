"""Recorded sessions as arrays, without ROS."""

import bz2
import ctypes
import ctypes.util
import functools
import heapq
import os
import re
import struct

import numpy as np

try:
    from ._core import InputError
except ImportError:  # without the compiled part, which nothing else here needs

    class InputError(ValueError):
        """Input that cannot be used; the text names the file and what would be right."""

_VERSION = b"#ROSBAG V2.0\n"
_MESSAGE, _CHUNK, _CONNECTION = 2, 5, 7  # kinds of records
# Names of bags of version 0.1, and the present ones.
_TOPICS = {"vessel/pressing": "vessel/balloon_load", "vessel/moved": "vessel/wall_displacement"}
_FIELDS = {"new_tries": "retries"}
_READING = ("sequence", "step", "delivered_step", "time", "valid", "values")
_NUMBERS = {"bool": "?", "byte": "b", "char": "B", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i",
            "uint32": "I", "int64": "q", "uint64": "Q", "float32": "f", "float64": "d"}


class Bag:
    """Bag of the session node, or any bag of ROS 1 (format 2.0).

    path  of the file. Its index is not used, so that a truncated bag is read up to its end

    steps       numbers of the recorded steps, [step]
    commands    of the steps, [step, instrument, 3]: insertion [m], rotation [rad], pressure [Pa], as for Session.step()
    forces      rendered on the hands, [step, instrument, 2]: force [N], torque [N m]
    hashes      of the state after each step, texts of 16 hexadecimal digits
    pose_times  simulated times of the recorded poses [s], [pose]
    poses       of the wire, a list of arrays [node, 3], patient frame [m]
    sensors     by name, a dictionary of arrays per sample: sequence, step, delivered_step, time [s], valid [sample], and
                values [sample, value]; empty without sensors
    scene       complete text of the scene
    info        identity of the recording, a dictionary: seed, time_step, physics_number, commit, ...
    topics      number of messages per topic
    damage      first damage of the file; empty without one

    Raises InputError for a file that cannot be read or is no bag, and AttributeError for parts that it does not hold.
    """

    def __init__(self, path):
        self.path = os.fspath(path)
        self.damage = ""
        try:
            with open(self.path, "rb") as file:
                content = file.read()
        except OSError as error:
            raise InputError("%s: cannot be read (%s)" % (self.path, error.strerror)) from error
        if not content.startswith(_VERSION):
            raise InputError("%s: is no bag of version 2.0; give the session.bag of a results folder" % self.path)
        self._connections, self._messages = {}, {}
        try:
            self._read_records(memoryview(content)[len(_VERSION):])
        except _Damage as damage:
            self.damage = str(damage)
        self.topics = dict.fromkeys((topic for topic, _, _ in self._connections.values()), 0)
        for number, (topic, _, _) in self._connections.items():
            self.topics[topic] += len(self._messages.get(number, ()))

    def read(self, topic):
        """Messages of a topic, one by one: (time of the bag [s], fields as a dictionary). Arrays of numbers are numpy's.
        Names of topics are matched at their end: "drive/applied" finds "/left/drive/applied". Topics and fields that
        former versions named otherwise have their present names; former names of topics are accepted, too."""
        topic = _present(topic)
        found = [name for name in self.topics if name.strip("/") == topic.strip("/")]
        found = found or [name for name in self.topics if name.endswith("/" + topic.strip("/"))]
        if len(found) != 1:
            raise InputError("%s: %s topic %s; it has %s" % (self.path, "several matches of" if found else "no", topic,
                                                           ", ".join(sorted(self.topics)) or "none"))
        streams = [self._stream(number) for number, (name, _, _) in self._connections.items() if name == found[0]]
        yield from heapq.merge(*streams, key=lambda message: message[0])  # several nodes may publish a topic

    @functools.cached_property
    def info(self):
        return self._only("session/info")

    @property
    def scene(self):
        return self.info["scene_yaml"]

    @property
    def steps(self):
        return np.array([step["step"] for step in self._applied], np.uint64)

    @property
    def commands(self):
        return self._columns("insertion", "rotation", "pressure")

    @property
    def forces(self):
        return self._columns("hand_force", "hand_torque")

    @property
    def hashes(self):
        return ["%016x" % step["state_hash"] for step in self._applied]

    @property
    def pose_times(self):
        return np.array([pose["time"] for pose in self._states])

    @property
    def poses(self):
        return [pose["nodes"] for pose in self._states]

    @functools.cached_property
    def sensors(self):
        names = sorted(topic for topic in self.topics if re.search(r"(^|/)sensors/[^/]+$", topic))
        readings = {topic.rpartition("/")[2]: [reading for _, reading in self.read(topic)] for topic in names}
        return {name: {field: np.array([reading[field] for reading in of_name]) for field in _READING}
                for name, of_name in readings.items()}

    def __repr__(self):
        return "<Bag '%s', %d messages>" % (self.path, sum(self.topics.values()))

    # ------------------------------------------------------------------------------------------------------- parts

    @functools.cached_property
    def _applied(self):
        by_step = {step["step"]: step for _, step in self._all("drive/applied")}  # a later recording of a step replaces it
        return [by_step[number] for number in sorted(by_step)]

    @functools.cached_property
    def _states(self):
        return [state for _, state in self._all("rod/state_visual")]

    def _stream(self, number):
        """Messages of a connection, as of read()."""
        _, kind, definition = self._connections[number]
        layouts = _layouts(kind, definition)
        for time, data in self._messages.get(number, ()):
            yield time, _decoded(layouts, kind, data)

    def _columns(self, *names):
        rows = [[step[name] for name in names] for step in self._applied]
        return np.array(rows, float).reshape(len(rows), len(names), -1).transpose(0, 2, 1)

    def _only(self, topic):
        for _, message in self._all(topic):
            return message
        raise AttributeError("%s: holds no message of %s" % (self.path, topic))

    def _all(self, topic):
        try:
            return list(self.read(topic))
        except InputError as error:
            raise AttributeError(str(error)) from error

    # ----------------------------------------------------------------------------------------------------- records

    def _read_records(self, rest):
        while rest:
            header, rest = _block(rest)
            data, rest = _block(rest)
            fields = _fields(header)
            kind = fields.number("op", "B")
            if kind == _CHUNK:
                self._read_chunk(fields, data)
            elif kind == _CONNECTION:
                self._connect(fields, data)

    def _read_chunk(self, fields, data):
        try:
            content = memoryview(_decompressed(fields.text("compression"), data, fields.number("size", "I")))
            while content:
                header, content = _block(content)
                data, content = _block(content)
                inner = _fields(header)
                if inner.number("op", "B") == _CONNECTION:
                    self._connect(inner, data)
                elif inner.number("op", "B") == _MESSAGE:
                    time = inner.number("time", "Q")  # seconds in the low half, nanoseconds in the high one
                    self._messages.setdefault(inner.number("conn", "I"), []).append(
                        ((time & 0xFFFFFFFF) + 1e-9 * (time >> 32), data))
        except _Damage as damage:  # the chunk is omitted
            self.damage = self.damage or str(damage)

    def _connect(self, fields, data):
        description = _fields(data)
        self._connections.setdefault(fields.number("conn", "I"), (
            _present(fields.text("topic")), description.text("type"), description.text("message_definition")))


def _present(topic):
    """Present name of a topic; its namespace is kept."""
    for former, present in _TOPICS.items():
        if ("/" + topic).endswith("/" + former):
            return topic[:-len(former)] + present
    return topic


class _Damage(Exception):
    """Damaged record; the text describes it."""


def _block(data):
    """A text with its length in front, and the rest."""
    if len(data) < 4:
        raise _Damage("the bag ends inside a record")
    size = struct.unpack_from("<I", data)[0]
    if size > len(data) - 4:
        raise _Damage("the bag ends inside a record")
    return data[4:4 + size], data[4 + size:]


class _Fields(dict):
    def __missing__(self, name):
        raise _Damage("a record has no field '%s'" % name)

    def text(self, name):
        return bytes(self[name]).decode(errors="replace")

    def number(self, name, letter):
        if len(self[name]) != struct.calcsize("<" + letter):
            raise _Damage("the field '%s' of a record has a wrong length" % name)
        return struct.unpack("<" + letter, self[name])[0]


def _fields(header):
    fields = _Fields()
    while header:
        field, header = _block(header)
        name, equals, value = bytes(field).partition(b"=")
        if not equals:
            raise _Damage("a field of a record has no value")
        fields[name.decode(errors="replace")] = value
    return fields


# --------------------------------------------------------------------------------------------------------- compression


def _decompressed(kind, data, size):
    if kind == "none":
        return data
    if kind == "bz2":
        try:
            return bz2.decompress(data)
        except (OSError, ValueError) as error:
            raise _Damage("a chunk cannot be decompressed") from error
    if kind != "lz4" or size > 256 * (len(data) + 1):
        raise _Damage("a chunk has an unknown compression or an impossible size")
    return _lz4_frame(data, size)


def _lz4_frame(data, size):
    """Content of an LZ4 frame of independent blocks, as ROS writes it."""
    if len(data) < 7 or struct.unpack_from("<I", data)[0] != 0x184D2204:
        raise _Damage("a chunk is no LZ4 frame")
    flags = data[4]
    at = 7 + (8 if flags & 8 else 0)
    content = ctypes.create_string_buffer(size or 1)
    done = 0
    while at + 4 <= len(data):
        length = struct.unpack_from("<I", data, at)[0]
        at += 4
        if length == 0:
            break
        block = bytes(data[at:at + (length & 0x7FFFFFFF)])
        if length & 0x80000000:  # not compressed
            if done + len(block) > size:
                raise _Damage("a chunk cannot be decompressed")
            ctypes.memmove(ctypes.addressof(content) + done, block, len(block))
            written = len(block)
        else:
            written = _lz4().LZ4_decompress_safe(block, ctypes.byref(content, done), len(block), size - done)
        if written < 0:
            raise _Damage("a chunk cannot be decompressed")
        done += written
        at += (length & 0x7FFFFFFF) + (4 if flags & 16 else 0)
    if done != size:
        raise _Damage("a chunk cannot be decompressed")
    return content.raw[:size]


@functools.lru_cache(maxsize=None)
def _lz4():
    try:
        return ctypes.CDLL(ctypes.util.find_library("lz4") or "liblz4.so.1")
    except OSError as error:
        raise InputError("the bag is compressed with LZ4, whose library is missing: install liblz4-1") from error


# ------------------------------------------------------------------------------------------------------------ messages


def _layouts(kind, definition):
    """Fields (type, array length or None, name) of a type and of those that it holds; None as length: no array; -1: any."""
    layouts = {}
    for part in re.split(r"^=+\nMSG: ", "MSG: " + kind + "\n" + definition, flags=re.MULTILINE):
        name, _, body = part.replace("MSG: ", "", 1).partition("\n")
        fields = []
        for line in body.splitlines():
            line = line.split("#")[0].strip()
            match = re.match(r"([\w/]+)(\[(\d*)\])?\s+(\w+)$", line)  # constants have a `=`
            if match:
                length = None if match[2] is None else int(match[3]) if match[3] else -1
                fields.append((match[1], length, _FIELDS.get(match[4], match[4])))
        layouts[name.strip()] = fields
    return layouts


def _layout(layouts, kind, around):
    """Name of a type as the definition has it."""
    if kind in layouts:
        return kind
    if kind == "Header":
        return "std_msgs/Header"
    return around.split("/")[0] + "/" + kind


def _flat_type(layouts, kind, around):
    """numpy type of a message that holds nothing but numbers of one type, and their count, e.g. of a point; else None."""
    if kind in _NUMBERS:
        return _NUMBERS[kind], 1
    name = _layout(layouts, kind, around) if kind not in ("string", "time", "duration") else None
    fields = layouts.get(name, ())
    if not fields or any(length is not None or inner not in _NUMBERS for inner, length, _ in fields):
        return None
    return (_NUMBERS[fields[0][0]], len(fields)) if len({inner for inner, _, _ in fields}) == 1 else None


def _decoded(layouts, kind, data):
    fields, at = _decode(layouts, kind, data, 0)
    if at != len(data):
        raise InputError("a message of %s is longer than its definition" % kind)
    return fields


def _decode(layouts, kind, data, at):
    fields = {}
    try:
        for inner, length, name in layouts[kind]:
            if length is None:
                fields[name], at = _value(layouts, inner, kind, data, at)
                continue
            if length < 0:
                length, at = struct.unpack_from("<I", data, at)[0], at + 4
            if length > len(data):
                raise ValueError("array beyond the message")
            flat = _flat_type(layouts, inner, kind)
            if flat:
                letter, count = flat
                fields[name] = np.frombuffer(data, np.dtype(letter).newbyteorder("<"), length * count, at).reshape(
                    (length, count) if count > 1 else length).astype(letter)
                at += length * count * struct.calcsize("<" + letter)
                continue
            values = []
            for _ in range(length):
                value, at = _value(layouts, inner, kind, data, at)
                values.append(value)
            fields[name] = values
    except (struct.error, ValueError, KeyError, RecursionError) as error:
        raise InputError("a message of %s does not fit its definition" % kind) from error
    return fields, at


def _value(layouts, kind, around, data, at):
    if kind in _NUMBERS:
        return struct.unpack_from("<" + _NUMBERS[kind], data, at)[0], at + struct.calcsize("<" + _NUMBERS[kind])
    if kind == "string":
        size = struct.unpack_from("<I", data, at)[0]
        if size > len(data) - at - 4:
            raise ValueError("text beyond the message")
        return bytes(data[at + 4:at + 4 + size]).decode(errors="replace"), at + 4 + size
    if kind in ("time", "duration"):
        seconds, nanoseconds = struct.unpack_from("<II" if kind == "time" else "<ii", data, at)
        return seconds + 1e-9 * nanoseconds, at + 8
    return _decode(layouts, _layout(layouts, kind, around), data, at)
