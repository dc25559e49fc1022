"""Writes the inside of a level set as a mask: LEVEL_SET.mha MASK.mha. MetaImage of float, compressed or not."""
import sys
import zlib

import numpy

with open(sys.argv[1], "rb") as file:
    data = file.read()
mark = b"ElementDataFile = LOCAL\n"
begin = data.index(mark) + len(mark)
lines = dict(line.split(" = ", 1) for line in data[:begin].decode().splitlines())
values = data[begin:]
if lines.pop("CompressedData", "False") == "True":
    lines.pop("CompressedDataSize", None)
    values = zlib.decompress(values)
assert lines["ElementType"] == "MET_FLOAT", lines["ElementType"]
lines["ElementType"] = "MET_UCHAR"
lines["ElementDataFile"] = lines.pop("ElementDataFile")
with open(sys.argv[2], "wb") as file:
    file.write("".join("%s = %s\n" % field for field in lines.items()).encode())
    file.write((numpy.frombuffer(values, "<f4") < 0.0).astype(numpy.uint8).tobytes())
