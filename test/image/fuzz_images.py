#!/usr/bin/env python3
"""Mutated images through volume_import: PROGRAM FOLDER COUNT SEED. COUNT files each of NIfTI, NRRD and MetaImage.

No reader ends by a signal or reaches its limit of 20 s, and exit code 0 means a complete volume of finite numbers. A file that
fails stays in FOLDER. Equal seeds give equal files."""
import concurrent.futures
import gzip
import math
import os
import random
import re
import struct
import subprocess
import sys
import zlib

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import image_files as files

PROGRAM, FOLDER, COUNT, SEED = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
NUMBERS = ("0", "-1", "1e30", "-1e300", "nan", "inf", "2147483648", "99999999999999999999", "1e-30", "65536", "", "3 3", "x")
WORDS = ("LOCAL", "LIST", "%s%n", "slice%d.raw 0 9999 1", "True", "False", "MET_DOUBLE", "MET_STRING", "float", "gzip", "hex", "big",
         "none", "left-posterior-superior-time", "(1,0,0)", "raw", "int64", "block", "../../../etc/passwd", "/dev/zero", "/dev/stdin")


def originals():
    """Valid files: {extension of the format: contents}."""
    raw = struct.pack("<%dh" % len(files.values()), *files.values())
    path = os.path.join(FOLDER, "original")

    def content(writer, *arguments, **options):
        writer(path, *arguments, **options)
        with open(path, "rb") as file:
            return file.read()

    in_ras = [-files.ORIGIN[0], -files.ORIGIN[1], files.ORIGIN[2]]
    nifti = [content(files.write_nifti), content(files.write_nifti, qform=in_ras, kind="f", order=">"),
             content(files.write_nifti, kind="d", slope=2.0, stored=[v / 2 for v in files.values()])]
    nrrd = content(files.write_nrrd)
    packed = zlib.compress(raw)
    header = {"CompressedData": "True", "CompressedDataSize": str(len(packed))}
    return {
        ".nii": nifti,
        ".nii.gz": [gzip.compress(nifti[0], mtime=0)],
        ".nrrd": [nrrd, content(files.write_nrrd, "right-anterior-superior"),
                  nrrd.replace(b"encoding: raw", b"encoding: gzip").split(b"\n\n")[0] + b"\n\n" + gzip.compress(raw, mtime=0)],
        ".mha": [content(files.write_mha), content(files.write_mha, header, packed),
                 content(files.write_mha, {"BinaryData": "False"}, " ".join(str(v) for v in files.values()).encode())],
    }


def changed_bytes(data, chance, end):
    """A few bytes become others, mostly in the header, which ends at `end`."""
    data = bytearray(data)
    for _ in range(chance.choice((1, 1, 2, 4, 16))):
        at = chance.randrange(min(end, len(data)) if chance.random() < 0.8 else len(data))
        data[at] = chance.choice((0, 1, 127, 128, 255, chance.randrange(256)))
    return bytes(data)


def changed_number(data, chance):
    """A binary field of four bytes becomes an extreme number."""
    at = 4 * chance.randrange(min(88, len(data) // 4))
    number = chance.choice((struct.pack("<f", chance.choice((0.0, -1.0, 1e38, math.nan, math.inf, 1e-38))),
                            struct.pack("<i", chance.choice((0, -1, 2**31 - 1, -(2**31), 65535)))))
    return data[:at] + number + data[at + 4:]


def changed_text(data, chance):
    """A word or number of a text header becomes another one, or a line goes, or comes twice."""
    lines = data.split(b"\n")
    texts = [k for k, line in enumerate(lines[:20]) if len(line) < 400 and line.isascii()]
    at = chance.choice(texts or [0])
    kind = chance.random()
    if kind < 0.15:
        del lines[at]
    elif kind < 0.3:
        lines.insert(at, lines[chance.choice(texts or [0])])
    else:
        values = list(re.finditer(rb"[-+\w.%]+", lines[at]))
        if values:
            value = chance.choice(values)
            text = chance.choice(NUMBERS + WORDS).encode()
            lines[at] = lines[at][: value.start()] + text + lines[at][value.end():]
    return b"\n".join(lines)


def mutated(data, extension, chance):
    if extension == ".nii.gz" and chance.random() < 0.7:  # damaged before compression
        return gzip.compress(mutated(gzip.decompress(data), ".nii", chance), mtime=0)
    is_text = extension in (".nrrd", ".mha")
    for _ in range(chance.choice((1, 1, 2, 3))):
        kind = chance.random()
        if kind < 0.1:
            data = data[: chance.randrange(len(data) + 1)]
        elif kind < 0.15:
            at = chance.randrange(len(data) + 1)
            data = data[:at] + bytes(chance.randrange(256) for _ in range(chance.choice((1, 4, 100)))) + data[at:]
        elif kind < 0.75 and is_text:
            data = changed_text(data, chance)
        elif kind < 0.6 and extension == ".nii":
            data = changed_number(data, chance)
        else:
            data = changed_bytes(data, chance, 352)
        if not data:
            return b"\0"
    return data


def defect_of_volume(path):
    with open(path, "rb") as file:
        data = file.read()
    if len(data) < 160 or data[:8] != b"evsvol01":
        return "no volume"
    size = struct.unpack_from("<3i", data, 8)
    numbers = struct.unpack_from("<16d", data, 24)
    if not all(map(math.isfinite, numbers)) or min(size) < 2 or min(numbers[:3]) <= 0:
        return "grid of %s" % (numbers,)
    return "" if len(data) == 160 + 2 * size[0] * size[1] * size[2] else "incomplete volume"


def run(task):
    """One file. Returns its format, its result ("" for a failure that is none) and whether it was accepted."""
    extension, number, data = task
    path = os.path.join(FOLDER, "%s_%d%s" % (SEED, number, extension))
    out = path + ".vol"
    with open(path, "wb") as file:
        file.write(data)
    command = [PROGRAM, path, "--out", out, "--time", "20", "--memory", "0.5"] + [[], ["--modality", "other"]][number % 2]
    try:
        result = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=60, check=False,
                                stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        return extension, path + ": more than 60 s", False
    failure = ""
    if result.returncode not in (0, 1) or "by signal" in result.stderr or "was not read within" in result.stderr:
        failure = "exit code %d: %s" % (result.returncode, result.stderr.strip()[-300:])
    elif result.returncode == 1 and os.path.basename(path) not in result.stderr:
        failure = "no message: %s" % result.stderr
    elif result.returncode == 1 and os.path.exists(out):
        failure = "refused, with an output"
    elif result.returncode == 0:
        failure = defect_of_volume(out)
    for name in [out] + ([] if failure else [path]):
        if os.path.exists(name):
            os.remove(name)
    return extension, failure and "%s: %s" % (path, failure), result.returncode == 0


def main():
    tasks = []
    for group in ((".nii", ".nii", ".nii.gz"), (".nrrd",), (".mha",)):
        for number in range(COUNT):
            chance = random.Random("%d %s %d" % (SEED, group[0], number))
            extension = chance.choice(group)
            tasks.append((extension, number, mutated(chance.choice(VALID[extension]), extension, chance)))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(run, tasks))
    for extension in sorted(VALID):
        mine = [r for r in results if r[0] == extension]
        print("%-8s %4d files, %4d accepted, %d failures" % (extension, len(mine), sum(r[2] for r in mine), sum(bool(r[1]) for r in mine)))
    failures = [r[1] for r in results if r[1]]
    print("\n".join(failures[:30]))
    return 1 if failures else 0


VALID = originals()
sys.exit(main())
