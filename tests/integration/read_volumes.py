#!/usr/bin/python3
"""Reads the volumes of a data folder without VTK and describes them as JSON.

    read_volumes.py FOLDER OUT.json

For each file: dims, type, minimum, maximum, mean, the CRC-32 of the samples (little-endian, x fastest) and the
places of the first and the last voxel in LPS and millimetres.
"""

import glob
import gzip
import json
import os
import re
import struct
import sys
import zlib

import numpy as np

MET = {"MET_UCHAR": "u1", "MET_CHAR": "i1", "MET_SHORT": "i2", "MET_USHORT": "u2", "MET_INT": "i4", "MET_FLOAT": "f4"}
NRRD = {"short": "i2", "uint8_t": "u1", "unsigned char": "u1", "unsigned short": "u2", "ushort": "u2", "uint16": "u2"}


def numbers(text):
    return [float(x) for x in text.split()]


def read_metaimage(path):
    with open(path, "rb") as file:
        data = file.read()
    end = data.index(b"\n", data.index(b"ElementDataFile")) + 1
    fields = dict(re.split(r"\s*=\s*", line, maxsplit=1) for line in data[:end].decode().splitlines())
    dims = [int(x) for x in fields["DimSize"].split()]
    body = data[end:]
    if fields["ElementDataFile"] != "LOCAL":
        with open(os.path.join(os.path.dirname(path), fields["ElementDataFile"]), "rb") as file:
            body = file.read()
    if fields["CompressedData"] == "True":
        body = zlib.decompress(body)
    samples = np.frombuffer(body, "<" + MET[fields["ElementType"]])
    axes = np.array(numbers(fields["TransformMatrix"])).reshape(3, 3).T
    return dims, samples, axes * numbers(fields["ElementSpacing"]), numbers(fields["Offset"])


def read_nrrd(path):
    with open(path, "rb") as file:
        data = file.read()
    end = data.index(b"\n\n") + 2
    fields = dict(line.split(": ", 1) for line in data[:end].decode().splitlines()[1:] if re.match(r"[a-z ]+: ", line))
    assert fields["space"] == "left-posterior-superior"
    body = gzip.decompress(data[end:]) if fields["encoding"] in ("gzip", "gz") else data[end:]
    order = ">" if fields.get("endian") == "big" else "<"
    samples = np.frombuffer(body, order + NRRD[fields["type"]])
    vectors = [[float(x) for x in v.split(",")] for v in re.findall(r"\(([^)]*)\)", fields["space directions"])]
    origin = [float(x) for x in fields["space origin"].strip("()").split(",")]
    return [int(x) for x in fields["sizes"].split()], samples, np.array(vectors).T, origin


def read_vti(path):
    with open(path, "rb") as file:
        data = file.read()
    head = data[:data.index(b"<AppendedData")].decode()
    assert 'byte_order="LittleEndian"' in head and 'header_type="UInt64"' in head and "vtkZLibDataCompressor" in head
    extent = [int(x) for x in re.search(r'WholeExtent="([^"]*)"', head).group(1).split()]
    dims = [extent[2 * n + 1] - extent[2 * n] + 1 for n in range(3)]
    at = data.index(b"_", data.index(b"<AppendedData")) + 1
    count, = struct.unpack_from("<Q", data, at)
    sizes = struct.unpack_from(f"<{count}Q", data, at + 24)
    at += 24 + 8 * count
    body = b""
    for size in sizes:
        body += zlib.decompress(data[at:at + size])
        at += size
    assert 'type="UInt8"' in head
    spacing = numbers(re.search(r'Spacing="([^"]*)"', head).group(1))
    return dims, np.frombuffer(body, "u1"), np.diag(spacing), numbers(re.search(r'Origin="([^"]*)"', head).group(1))


def read_dicom(folder):
    import pydicom
    slices = [pydicom.dcmread(path) for path in glob.glob(os.path.join(folder, "*.dcm"))]
    slices.sort(key=lambda s: float(s.ImagePositionPatient[2]))
    values = [s.pixel_array * int(s.RescaleSlope) + int(s.RescaleIntercept) for s in slices]
    samples = np.stack(values).astype("<i2").ravel()
    axes = np.array([float(x) for x in slices[0].ImageOrientationPatient]).reshape(2, 3).T
    rows, columns = (float(x) for x in slices[0].PixelSpacing)
    first, last = (np.array([float(x) for x in s.ImagePositionPatient]) for s in (slices[0], slices[-1]))
    steps = np.column_stack([axes[:, 0] * columns, axes[:, 1] * rows, (last - first) / (len(slices) - 1)])
    return [slices[0].Columns, slices[0].Rows, len(slices)], samples, steps, first


def main():
    root, out = sys.argv[1:]
    found = []
    for pattern, read in [("*/*.mhd", read_metaimage), ("*/*.mha", read_metaimage), ("*/*.nrrd", read_nrrd),
                          ("*/*.vti", read_vti), ("*/dicom*", read_dicom)]:
        for path in sorted(glob.glob(os.path.join(root, pattern))):
            dims, samples, steps, origin = read(path)
            assert samples.size == dims[0] * dims[1] * dims[2]
            last = np.array(origin) + steps @ (np.array(dims) - 1)
            kind = {"i": "int", "u": "uint", "f": "float"}[samples.dtype.kind] + str(8 * samples.itemsize)
            found.append({"file": os.path.relpath(path, root), "dims": dims, "type": kind,
                          "minimum": float(samples.min()), "maximum": float(samples.max()),
                          "mean": float(samples.mean(dtype=np.float64)), "crc": zlib.crc32(samples.tobytes()),
                          "first": [float(x) for x in origin], "last": last.tolist()})
    with open(out, "w") as file:
        json.dump(found, file)


if __name__ == "__main__":
    main()
