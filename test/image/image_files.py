"""Image files of one small volume in all formats of volume_import, and damaged ones. Independent of ITK: only struct.

Voxel (i, j, k) has the value i + 10 j + 100 k - 1000 HU; axes, spacings and origin are uneven, so that any mistake in the
order or the signs of the axes moves voxels."""
import math
import os
import struct

SIZE = (7, 6, 5)
SPACING = (0.7, 0.9, 1.25)  # mm
ORIGIN = (-12.5, 31.0, 407.25)  # LPS [mm]


def rotation():
    """Unit vectors of i, j and k in LPS: a turn about z, then about x."""
    a, b = 0.3, -0.2
    about_z = [[math.cos(a), -math.sin(a), 0], [math.sin(a), math.cos(a), 0], [0, 0, 1]]
    about_x = [[1, 0, 0], [0, math.cos(b), -math.sin(b)], [0, math.sin(b), math.cos(b)]]
    matrix = [[sum(about_x[r][n] * about_z[n][c] for n in range(3)) for c in range(3)] for r in range(3)]
    return [[matrix[r][c] for r in range(3)] for c in range(3)]


def position(i, j, k):
    """Position of a voxel, LPS [mm]."""
    axes = rotation()
    return [ORIGIN[r] + sum(axes[c][r] * SPACING[c] * n for c, n in enumerate((i, j, k))) for r in range(3)]


def value(i, j, k):
    return i + 10 * j + 100 * k - 1000


def values():
    return [value(i, j, k) for k in range(SIZE[2]) for j in range(SIZE[1]) for i in range(SIZE[0])]


def write(path, *parts):
    with open(path, "wb") as file:
        for part in parts:
            file.write(part)


# DICOM: explicit value representation, little endian


def element(group, number, kind, data):
    if isinstance(data, str):
        data = data.encode()
    data += b" " if len(data) % 2 and kind != "UI" else b"\0" if len(data) % 2 else b""
    long_form = kind in ("OB", "OW", "SQ", "UN")
    return (
        struct.pack("<HH", group, number)
        + kind.encode()
        + (struct.pack("<HI", 0, len(data)) if long_form else struct.pack("<H", len(data)))
        + data
    )


def decimal(numbers):
    return "\\".join("%.10g" % n for n in numbers)


def slice_file(k, origin, axes, series="1.2.3.4", without=(), size=SIZE, pixels=None, bits=16, spacing=None,
               frames=None):
    """DICOM file of a slice. `without`: elements left out, as (group, number)."""
    pixels = [value(i, j, k % 100) + 1024 for j in range(size[1]) for i in range(size[0])] if pixels is None else pixels
    elements = [
        (0x0008, 0x0016, "UI", "1.2.840.10008.5.1.4.1.1.2"),
        (0x0008, 0x0018, "UI", series + "." + str(k + 1)),
        (0x0008, 0x0060, "CS", "CT"),
        (0x0010, 0x0010, "PN", "Doe^Jane"),
        (0x0010, 0x0020, "LO", "ID4711"),
        (0x0010, 0x0030, "DA", "19620314"),
        (0x0020, 0x000D, "UI", "1.2.3"),
        (0x0020, 0x000E, "UI", series),
        (0x0020, 0x0013, "IS", str(k + 1)),
        (0x0020, 0x0032, "DS", decimal(origin)),
        (0x0020, 0x0037, "DS", decimal(list(axes[0]) + list(axes[1]))),
        (0x0028, 0x0002, "US", struct.pack("<H", 1)),
        (0x0028, 0x0004, "CS", "MONOCHROME2"),
        *([(0x0028, 0x0008, "IS", str(frames))] if frames else []),
        (0x0028, 0x0010, "US", struct.pack("<H", size[1])),
        (0x0028, 0x0011, "US", struct.pack("<H", size[0])),
        (0x0028, 0x0030, "DS", spacing if isinstance(spacing, str) else decimal(spacing or (SPACING[1], SPACING[0]))),
        (0x0028, 0x0100, "US", struct.pack("<H", bits)),
        (0x0028, 0x0101, "US", struct.pack("<H", bits)),
        (0x0028, 0x0102, "US", struct.pack("<H", bits - 1)),
        (0x0028, 0x0103, "US", struct.pack("<H", 1 if bits == 16 else 0)),
        (0x0028, 0x1052, "DS", "-1024" if bits == 16 else "0"),
        (0x0028, 0x1053, "DS", "1"),
        (0x7FE0, 0x0010, "OW", struct.pack("<%d%s" % (len(pixels), "h" if bits == 16 else "B"), *pixels)),
    ]
    meta = element(0x0002, 0x0010, "UI", "1.2.840.10008.1.2.1")
    meta = element(0x0002, 0x0000, "UL", struct.pack("<I", len(meta))) + meta
    return bytes(128) + b"DICM" + meta + b"".join(element(*e) for e in elements if (e[0], e[1]) not in without)


def write_series(folder, slices=None, shift=(0.0, 0.0, 0.0), series="1.2.3.4", without=(), heights=None, bits=16,
                 spacing=None, turned=(-1, 0.0), skewed=False, axis_scale=1.0, instances=0, pixels=None):
    """Folder of a series; the names of its files are not in the order of the slices. `shift`: of each slice [mm].
    `heights`: of the slices along their normal, in their regular distance. `turned`: number and angle [degrees] of a slice that
    is turned in its plane; `skewed`: only its rows. `axis_scale`: length of the vectors of the axes. `instances`: number of the first image."""
    os.makedirs(folder, exist_ok=True)
    for n, k in enumerate(range(SIZE[2]) if slices is None else slices):
        axes = [[axis_scale * x for x in axis] for axis in rotation()]
        if n == turned[0]:
            c, s = math.cos(math.radians(turned[1])), math.sin(math.radians(turned[1]))
            row, column = axes[:2]
            axes[0] = [c * a + s * b for a, b in zip(row, column)]
            axes[1] = column if skewed else [c * b - s * a for a, b in zip(row, column)]
        height = k if heights is None else heights[n]
        origin = [a + b * k for a, b in zip(position(0, 0, height), shift)]
        if bits == 8:
            pixels = [(i + 7 * k) % 256 for i in range(SIZE[0] * SIZE[1])]
        name = "image_%s_%d" % (series, (3 * n) % 5 + instances)
        write(os.path.join(folder, name),
              slice_file(k + instances, origin, axes, series, without, pixels=pixels, bits=bits, spacing=spacing))


# files with a whole volume


def write_mha(path, header=None, data=None, data_file="LOCAL", equals=" = "):
    axes = rotation()
    lines = {
        "ObjectType": "Image",
        "NDims": "3",
        "BinaryData": "True",
        "BinaryDataByteOrderMSB": "False",
        "TransformMatrix": " ".join("%.12g" % n for axis in axes for n in axis),
        "Offset": " ".join("%.12g" % n for n in ORIGIN),
        "ElementSpacing": " ".join("%.12g" % n for n in SPACING),
        "DimSize": "%d %d %d" % SIZE,
        "ElementType": "MET_SHORT",
    }
    lines.update(header or {})
    lines["ElementDataFile"] = data_file
    text = "".join(key + equals + text + "\n" for key, text in lines.items() if text is not None)
    data = struct.pack("<%dh" % len(values()), *values()) if data is None else data
    write(path, text.encode(), data)


def write_nrrd(path, space="left-posterior-superior", data=None, kind="short", units=None):
    signs = {"left-posterior-superior": (1, 1, 1), "right-anterior-superior": (-1, -1, 1), None: (1, 1, 1)}[space]

    def vector(numbers):
        return "(" + ",".join("%.12g" % (s * n) for s, n in zip(signs, numbers)) + ")"

    axes = rotation()
    lines = ["NRRD0004", "type: " + kind, "dimension: 3", "sizes: %d %d %d" % SIZE, "endian: little", "encoding: raw"]
    if space:
        lines += [
            "space: " + space,
            "space directions: " + " ".join(vector([n * SPACING[c] for n in axes[c]]) for c in range(3)),
            "space origin: " + vector(ORIGIN),
        ]
        lines += ["space units: " + " ".join('"%s"' % units for _ in range(3))] if units else []
    else:
        lines.append("spacings: %g %g %g" % SPACING)
    data = struct.pack("<%dh" % len(values()), *values()) if data is None else data
    write(path, ("\n".join(lines) + "\n\n").encode(), data)


def nifti_rows(shear=0.0):
    """Rows of the sform, in RAS [mm]. `shear`: shift of each slice along j [mm]."""
    axes = rotation()
    columns = [[SPACING[c] * n for n in axes[c]] for c in range(3)]
    columns[2] = [n + shear * m for n, m in zip(columns[2], axes[1])]
    return [[s * columns[c][r] for c in range(3)] + [s * ORIGIN[r]] for r, s in ((0, -1), (1, -1), (2, 1))]


def nifti_quaternion():
    """Quaternion (b, c, d) of the axes in RAS, and the sign of k."""
    axes = rotation()
    matrix = [[s * axes[c][r] for c in range(3)] for r, s in ((0, -1), (1, -1), (2, 1))]
    real = math.sqrt(max(0.0, 1 + matrix[0][0] + matrix[1][1] + matrix[2][2])) / 2
    if real < 1e-3:  # a turn by nearly 180 degrees about z
        d = math.sqrt(1 + matrix[2][2] - matrix[0][0] - matrix[1][1]) / 2
        return [(matrix[0][2] + matrix[2][0]) / 4 / d, (matrix[1][2] + matrix[2][1]) / 4 / d, d]
    return [(matrix[r][c] - matrix[c][r]) / 4 / real for r, c in ((2, 1), (0, 2), (1, 0))]


def write_nifti(path, oriented=True, dimensions=SIZE, slope=1.0, stored=None, rows=None, qform=None, unit=2, scale=1.0,
                kind="h", order="<", intercept=0.0):
    """NIfTI with the affine of sform, in RAS; `rows`: another one. `qform`: origin in RAS [mm], with a qform of the same axes.
    `unit`: code of the unit, `scale`: of lengths in this unit. `kind` and `order` of the values: as of struct."""
    rows = nifti_rows() if rows is None else rows
    size = list(dimensions) + [1] * (7 - len(dimensions))
    types = {"B": 2, "h": 4, "i": 8, "f": 16, "d": 64, "b": 256, "H": 512, "I": 768, "q": 1024}
    header = struct.pack(order + "i10s18sihcB", 348, b"", b"", 0, 0, b"r", 0)
    header += struct.pack(order + "8h", len(dimensions), *size)
    header += struct.pack(order + "3f4h", 0, 0, 0, 0, types[kind], 8 * struct.calcsize(kind), 0)
    header += struct.pack(order + "8f", 1, *(scale * n for n in SPACING), 0, 0, 0, 0)
    header += struct.pack(order + "3fhcB", 352, slope, intercept, 0, b"\0", unit)
    header += struct.pack(order + "4f2i", 0, 0, 0, 0, 0, 0)
    header += struct.pack(order + "80s24s2h", b"Doe^Jane ID4711", b"", 1 if qform else 0, 2 if oriented else 0)
    quaternion = nifti_quaternion() + [scale * n for n in qform] if qform else [0] * 6
    header += struct.pack(order + "6f", *quaternion)
    header += struct.pack(order + "12f", *(scale * n for row in rows for n in row))
    header += struct.pack("<16s4s", b"", b"n+1\0")
    assert len(header) == 348
    stored = values() if stored is None else stored
    write(path, header, bytes(4), struct.pack("%s%d%s" % (order, len(stored), kind), *stored))


def read_volume(path):
    """Values of a volume of volume_import by their position: {value: (x, y, z)} in LPS [mm]; and its modality."""
    with open(path, "rb") as file:
        data = file.read()
    magic, i, j, k, modality = struct.unpack_from("<8s3iI", data)
    assert magic == b"evsvol01", magic
    numbers = struct.unpack_from("<16d", data, 24)
    spacing, origin, axes, scale = numbers[0:3], numbers[3:6], numbers[6:15], numbers[15]
    stored = struct.unpack_from("<%dh" % (i * j * k), data, 160)
    places = {}
    for n, number in enumerate(stored):
        index = (n % i, n // i % j, n // (i * j))
        places[round(number * scale, 6)] = [
            1e3 * (origin[r] + sum(axes[3 * c + r] * spacing[c] * index[c] for c in range(3))) for r in range(3)
        ]
    return places, modality
