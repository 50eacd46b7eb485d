#!/usr/bin/python3
"""Writes small volume files, good and bad, and what reading them must give.

    make_volumes.py nifti|nrrd|metaimage|dicom FOLDER

FOLDER/expected.json has two lists:
  good  {file, series?, format, dims, type, values, points, warnings}: `values` names a file of little-endian
        float64 samples, x fastest; `points` are rows i j k x y z, the place of voxels in LPS and millimetres;
        `warnings` has a text for each warning.
  bad   {file, series?, says}: `says` are texts that the error must contain.
NIfTI files are read back with nibabel and DICOM files with pydicom: their values and places are those these
libraries find in the finished files. NRRD and MetaImage files are written byte by byte from the definitions
of the formats, with places from the numbers that went into the header.
"""

import gzip
import json
import os
import struct
import sys
import zlib

import numpy as np

DIMS = (5, 4, 3)  # i, j, k
TYPES = ["int8", "uint8", "int16", "uint16", "int32", "float32", "float64"]


class Folder:
    def __init__(self, path):
        self.path = path
        self.good = []
        self.bad = []

    def __truediv__(self, name):
        return os.path.join(self.path, name)

    def write(self, name, data):
        with open(self / name, "wb") as file:
            file.write(data)

    def read(self, name):
        with open(self / name, "rb") as file:
            return file.read()

    def expect(self, name, fmt, values, kind, affine, warnings=(), series=None):
        """values[i, j, k]; affine: 4 x 4, voxel to LPS."""
        values = np.asarray(values, np.float64)
        values_name = f"{len(self.good)}.values"
        self.write(values_name, values.astype("<f8").tobytes(order="F"))
        corner = np.array(values.shape) - 1
        indices = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 2, 1), tuple(corner.tolist())]
        points = [list(p) + (affine @ [*p, 1.0])[:3].tolist() for p in indices]
        self.good.append({"file": name, "format": fmt, "dims": list(values.shape), "type": kind,
                          "values": values_name, "points": points, "warnings": list(warnings),
                          "series": series or ""})

    def expect_error(self, name, *says, series=None):
        self.bad.append({"file": name, "says": list(says), "series": series or ""})

    def finish(self):
        with open(self / "expected.json", "w") as file:
            json.dump({"good": self.good, "bad": self.bad}, file)


def samples(kind, dims=DIMS, seed=1):
    """Values over the whole range of a type, both ends included."""
    rng = np.random.default_rng(seed)
    dtype = np.dtype(kind)
    if dtype.kind == "f":
        return rng.normal(0.0, 1000.0, dims).astype(dtype)
    info = np.iinfo(dtype)
    values = rng.integers(info.min, info.max, dims, dtype=dtype, endpoint=True)
    values.flat[3], values.flat[7] = info.min, info.max
    return values


def rotation(axis, degrees):
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    a = np.radians(degrees)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(a) * k + (1 - np.cos(a)) * k @ k


def affine(columns, origin):
    result = np.eye(4)
    result[:3, :3] = columns
    result[:3, 3] = origin
    return result


OBLIQUE = affine(rotation((1, 2, 3), 35.0) @ np.diag([0.7, 0.9, 2.5]), (-12.5, 33.25, 7.0))
MIRRORED = affine(rotation((3, -1, 2), 160.0) @ np.diag([0.5, -1.5, 4.0]), (100.0, -3.0, 0.125))
SHEARED = affine(rotation((1, 0, 1), 20.0) @ np.array([[1.0, 0.2, 0.0], [0, 1.1, -0.4], [0, 0, 3.0]]),
                 (1.0, 2.0, 3.0))
RAS_TO_LPS = np.diag([-1.0, -1.0, 1.0, 1.0])


# --- NIfTI ---------------------------------------------------------------------------------------

def patch(data, offset, fmt, *values):
    packed = struct.pack(fmt, *values)
    return data[:offset] + packed + data[offset + len(packed):]


def nifti(folder):
    import nibabel as nib

    def expect(name, kind, warnings=(), scale=1.0):
        image = nib.load(folder / name)
        values = np.asarray(image.dataobj, np.float64)
        while values.ndim > 3:
            values = values[..., 0]
        world = np.diag([scale, scale, scale, 1.0]) @ RAS_TO_LPS @ image.affine
        folder.expect(name, "NIfTI", values, kind, world, warnings)

    # Every type, every orientation, compressed and not.
    for n, kind in enumerate(TYPES):
        world = [OBLIQUE, MIRRORED, SHEARED][n % 3]
        name = f"{kind}.nii" + (".gz" if n % 2 else "")
        nib.save(nib.Nifti1Image(samples(kind), world, dtype=kind), folder / name)
        expect(name, kind)
    # Types that are converted.
    for name, kind, top, result in [("u32", "uint32", 2**31 - 1, "int32"), ("u32big", "uint32", 2**32 - 1, "float64"),
                                    ("i64", "int64", -2**31, "int32"), ("i64big", "int64", 2**53, "float64"),
                                    ("u64", "uint64", 77, "int32"), ("u64big", "uint64", 2**60, "float64")]:
        values = np.arange(60).reshape(DIMS).astype(kind)
        values[1, 2, 1] = top
        nib.save(nib.Nifti1Image(values, OBLIQUE, dtype=kind), folder / f"{name}.nii")
        expect(f"{name}.nii", result)
    # Other byte order, other version, two files.
    for kind in ["int16", "int32", "float64"]:
        header = nib.Nifti1Header(endianness=">")
        header.set_data_dtype(kind)
        nib.save(nib.Nifti1Image(samples(kind), OBLIQUE, header), folder / f"big_{kind}.nii")
        expect(f"big_{kind}.nii", kind)
        header = nib.Nifti2Header(endianness=">" if kind == "int32" else "<")
        header.set_data_dtype(kind)
        nib.save(nib.Nifti2Image(samples(kind), MIRRORED, header), folder / f"two_{kind}.nii.gz")
        expect(f"two_{kind}.nii.gz", kind)
    nib.save(nib.Nifti1Pair(samples("int16"), OBLIQUE), folder / "pair.hdr")
    expect("pair.hdr", "int16")
    nib.save(nib.Nifti1Pair(samples("int16"), OBLIQUE), folder / "packed.hdr.gz")
    expect("packed.hdr.gz", "int16")
    # The name says nothing, the content does.
    folder.write("no_extension", folder.read("int16.nii"))
    expect_values = nib.load(folder / "int16.nii")
    folder.expect("no_extension", "NIfTI", expect_values.get_fdata(), "int16", RAS_TO_LPS @ expect_values.affine)

    # qform: both hands; beside an sform it does not count; neither.
    for n, world in enumerate([OBLIQUE, MIRRORED]):
        image = nib.Nifti1Image(samples("int16"), None)
        image.set_sform(None, 0)
        image.set_qform(world, 1)
        nib.save(image, folder / f"qform{n}.nii")
        expect(f"qform{n}.nii", "int16")
        image.set_sform(SHEARED, 1)
        nib.save(image, folder / f"both{n}.nii")
        expect(f"both{n}.nii", "int16")
    plain = folder.read("int16.nii")
    neither = patch(plain, 252, "<hh", 0, 0)
    folder.write("neither.nii", neither)
    folder.expect("neither.nii", "NIfTI", samples("int16"), "int16",
                  RAS_TO_LPS @ affine(np.diag(struct.unpack_from("<3f", plain, 80)), (0, 0, 0)),
                  ["neither sform nor qform"])
    # qfac 0 counts as 1.
    folder.write("qfac0.nii", patch(folder.read("qform0.nii"), 76, "<f", 0.0))
    folder.expect("qfac0.nii", "NIfTI", samples("int16"), "int16",
                  RAS_TO_LPS @ nib.load(folder / "qform0.nii").affine)

    # Scales. `kind` of the result follows from the scaled values.
    ct = (np.arange(60).reshape(DIMS) * 69).astype("uint16")  # 0 … 4071
    for name, values, slope, inter, result in [
            ("ct", ct, 1.0, -1024.0, "int16"), ("up", ct, 1.0, 60000.0, "uint16"),
            ("wide", ct, 100.0, 0.0, "int32"), ("beyond", ct, 1e6, 0.0, "float64"),
            ("half", ct, 0.5, -3.25, "float32"), ("none", ct, 0.0, 5.0, "uint16"),
            ("nan", ct, float("nan"), float("nan"), "uint16"),
            ("same", samples("int8") // 2, 2.0, 0.0, "int8"),
            ("small", samples("uint8"), 2.0, -100.0, "int16"),
            ("fraction32", samples("int32"), 0.25, 0.0, "float64"),
            ("real", samples("float32"), 3.0, 1.0, "float32"),
            ("real64", samples("float64"), 3.0, 1.0, "float64"),
            ("overflow", samples("float32"), 1e38, 0.0, "float64"),
            ("longs", samples("int32").astype("int64"), 1.0, 1.0, "float64")]:
        nib.save(nib.Nifti1Image(values, OBLIQUE, dtype=values.dtype), folder / "scratch.nii")
        folder.write(f"scale_{name}.nii", patch(folder.read("scratch.nii"), 112, "<ff", slope, inter))
        expect(f"scale_{name}.nii", result)
    folder.write("scale_wide.nii.gz", gzip.compress(folder.read("scale_wide.nii")))
    expect("scale_wide.nii.gz", "int32")

    # Units; one frame; samples that are not finite.
    folder.write("metre.nii", patch(plain, 123, "B", 1))
    expect("metre.nii", "int16", scale=1000.0)
    folder.write("micron.nii", patch(plain, 123, "B", 3))
    expect("micron.nii", "int16", scale=0.001)
    nib.save(nib.Nifti1Image(samples("int16")[..., None], OBLIQUE), folder / "frame.nii")
    expect("frame.nii", "int16")
    holes = samples("float32")
    holes[1, 1, 1], holes[2, 2, 2], holes[3, 3, 0] = np.nan, np.inf, -np.inf
    nib.save(nib.Nifti1Image(holes, OBLIQUE), folder / "holes.nii")
    expect("holes.nii", "float32")

    # Bad ones. int16.nii: 352 bytes and 120 of samples.
    def bad(name, data, *says):
        folder.write(name, data)
        folder.expect_error(name, *says)

    packed = gzip.compress(plain, mtime=0)
    bad("empty.nii", b"", "is 0 bytes long", "348")
    bad("short.nii", plain[:100], "found 100 of 348 bytes")
    bad("cut.nii", plain[:-7], "holds 113 bytes of data", "expected 120 bytes")
    bad("long.nii", plain + b"xyz", "holds 123 bytes of data", "expected 120 bytes")
    bad("cut.nii.gz", packed[:-60], "compressed data are cut off", "expected 120 bytes")
    bad("nosum.nii.gz", packed[:-8], "compressed data are cut off")
    bad("sum.nii.gz", patch(packed, len(packed) - 8, "<I", 1), "compressed data are damaged", "incorrect data check")
    bad("long.nii.gz", gzip.compress(plain + b"x"), "compressed data hold more than the 120 bytes")
    bad("lie.nii.gz", gzip.compress(patch(plain, 42, "<hhh", 5, 4, 4)), "found 120 bytes", "expected 160 bytes")
    bad("bomb.nii.gz", gzip.compress(patch(plain, 42, "<hhh", 32767, 32767, 32767)), "cannot hold the",
        str(32767**3 * 2))
    bad("damaged.nii.gz", packed[:12] + bytes([packed[12] ^ 0xFF]) + packed[13:])
    bad("zero.nii", patch(plain, 44, "<h", 0), "dimensions 5 x 0 x 3", "0 along j")
    bad("minus.nii", patch(plain, 46, "<h", -3), "dimensions 5 x 4 x -3", "-3 along k")
    bad("thin.nii", patch(plain[:352 + 40], 46, "<h", 1), "5 x 4 x 1", "one sample thick along k")
    bad("flat.nii", patch(plain, 40, "<h", 2), "has 2 axes")
    bad("rank.nii", patch(plain, 40, "<h", 9), "dim[0] is 9")
    bad("lying.nii", patch(plain, 42, "<h", 6), "holds 120 bytes of data", "expected 144 bytes")
    bad("frames.nii", patch(plain, 40, "<5h", 4, 5, 4, 3, 7), "holds 7 frames")
    bad("vector.nii", patch(plain, 40, "<6h", 5, 5, 4, 3, 1, 3), "holds 3 components a voxel")
    for value in [0.0, -1.5, float("nan"), float("inf")]:
        bad(f"spacing{value}.nii", patch(plain, 84, "<f", value), "spacing pixdim[2] is",
            {0.0: "0;", -1.5: "-1.5;"}.get(value, str(value)))
    for code, text in [(1, "binary"), (32, "complex"), (128, "RGB"), (2304, "RGBA"), (1536, "float128"), (99, "99")]:
        bad(f"type{code}.nii", patch(plain, 70, "<h", code), text, "expected one real number a voxel")
    bad("sform0.nii", patch(plain, 280, "<12f", *[0.0] * 12), "step from sample to sample along i is (-0, -0, 0)")
    bad("sformnan.nii", patch(plain, 280, "<f", float("nan")), "step from sample to sample along i", "nan")
    bad("plane.nii", patch(plain, 280, "<12f", 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0), "direction is singular")
    bad("origin.nii", patch(plain, 292, "<f", float("inf")), "origin", "not finite")
    bad("analyze.nii", patch(plain, 344, "4s", b"\0" * 4), "NIfTI magic", "ANALYZE")
    bad("size.nii", patch(plain, 0, "<i", 349), "its first number is 349")
    bad("offset.nii", patch(plain, 108, "<f", 100.0), "vox_offset is 100", "at least 352")
    bad("offset_far.nii", patch(plain, 108, "<f", 4096.0), "is 472 bytes long", "begin at byte 4096")
    bad("units.nii", patch(plain, 123, "B", 5), "xyzt_units 5")
    bad("quaternion.nii", patch(folder.read("qform0.nii"), 256, "<3f", 1, 1, 0), "quaternion (1, 1, 0)")
    bad("intercept.nii", patch(plain, 112, "<ff", 1.0, float("inf")), "slope 1 and intercept inf")
    huge = np.full(DIMS, 2**53 + 1, "int64")
    nib.save(nib.Nifti1Image(huge, OBLIQUE, dtype="int64"), folder / "i64huge.nii")
    folder.expect_error("i64huge.nii", "int64 value 9007199254740993 has no exact double")
    bad("lonely.hdr", folder.read("pair.hdr"), "lonely.img", "no such file")
    bad("wrong_name.nii", folder.read("pair.hdr"), "expected its name to end in .hdr")


# --- NRRD ----------------------------------------------------------------------------------------

def vector(v):
    return "(" + ",".join(repr(float(x)) for x in v) + ")"


def text_samples(values):
    return " ".join(repr(x) for x in values.ravel(order="F").tolist())


def nrrd(folder):
    def header(fields, magic="NRRD0004"):
        return (magic + "\n" + "".join(f"{k}: {v}\n" for k, v in fields.items())).encode()

    def place(world, space="left-posterior-superior"):
        return {"space": space,
                "space directions": " ".join(vector(world[:3, n]) for n in range(3)),
                "space origin": vector(world[:3, 3])}

    def fields(kind, **more):
        result = {"type": kind, "dimension": 3, "sizes": "5 4 3", "encoding": "raw", "endian": "little"}
        result.update(more)
        return result

    words = {"int8": "signed char", "uint8": "unsigned char", "int16": "short", "uint16": "uint16_t",
             "int32": "int", "float32": "float", "float64": "double"}
    # Every type in every encoding and byte order.
    for n, kind in enumerate(TYPES):
        values = samples(kind)
        for encoding in ["raw", "gzip", "ascii"]:
            for endian in ["little", "big"]:
                name = f"{kind}_{encoding}_{endian}.nrrd"
                world = [OBLIQUE, MIRRORED, SHEARED][n % 3]
                head = header({**fields(words[kind], encoding=encoding, endian=endian), **place(world)})
                stored = values.astype(np.dtype(kind).newbyteorder("<" if endian == "little" else ">"))
                data = stored.tobytes(order="F")
                if encoding == "gzip":
                    data = gzip.compress(data)
                if encoding == "ascii":
                    data = text_samples(values).encode()
                folder.write(name, head + b"\n" + data)
                folder.expect(name, "NRRD", values, kind, world)
    # Worlds.
    values = samples("int16")
    data = values.tobytes(order="F")
    turn = {"right-anterior-superior": np.diag([-1.0, -1, 1, 1]), "left-anterior-superior": np.diag([1.0, -1, 1, 1]),
            "left-posterior-superior": np.eye(4), "RAS": np.diag([-1.0, -1, 1, 1]), "LAS": np.diag([1.0, -1, 1, 1]),
            "LPS": np.eye(4)}
    for space, to_lps in turn.items():
        folder.write(f"{space}.nrrd", header({**fields("short"), **place(OBLIQUE, space)}) + b"\n" + data)
        folder.expect(f"{space}.nrrd", "NRRD", values, "int16", to_lps @ OBLIQUE)
    folder.write("scanner.nrrd", header({**fields("short"), **place(OBLIQUE, "scanner-xyz")}) + b"\n" + data)
    folder.expect("scanner.nrrd", "NRRD", values, "int16", OBLIQUE, ["taken for LPS"])
    folder.write("units.nrrd", header({**fields("short"), **place(OBLIQUE), "space units": '"cm" "cm" "cm"'})
                 + b"\n" + data)
    folder.expect("units.nrrd", "NRRD", values, "int16", np.diag([10.0, 10, 10, 1]) @ OBLIQUE)
    folder.write("unknown_units.nrrd", header({**fields("short"), **place(OBLIQUE),
                                               "space units": '"mm" "furlong" "mm"'}) + b"\n" + data)
    folder.expect("unknown_units.nrrd", "NRRD", values, "int16", OBLIQUE, ["\"furlong\""])
    folder.write("dimension.nrrd", header({**fields("short"), "space dimension": 3,
                                           "space directions": place(OBLIQUE)["space directions"]}) + b"\n" + data)
    folder.expect("dimension.nrrd", "NRRD", values, "int16", affine(OBLIQUE[:3, :3], (0, 0, 0)))
    # No space: spacings, axis ends, nothing.
    folder.write("spacings.nrrd", header({**fields("short"), "spacings": "0.5 1.5 2"}) + b"\n" + data)
    folder.expect("spacings.nrrd", "NRRD", values, "int16", np.diag([0.5, 1.5, 2.0, 1.0]))
    folder.write("mins.nrrd", header({**fields("short"), "axis mins": "10 20 30", "axis maxs": "20 28 36",
                                      "centerings": "cell cell node"}) + b"\n" + data)
    folder.expect("mins.nrrd", "NRRD", values, "int16", affine(np.diag([2.0, 2.0, 3.0]), (11, 21, 30)))
    folder.write("plain.nrrd", header(fields("short")) + b"\n" + data)
    folder.expect("plain.nrrd", "NRRD", values, "int16", np.eye(4), ["has no spacing"])
    # Layout of the header.
    lines = header({**fields("short"), **place(OBLIQUE)})
    folder.write("crlf.nrrd", lines.replace(b"\n", b"\r\n") + b"\r\n" + data)
    folder.expect("crlf.nrrd", "NRRD", values, "int16", OBLIQUE)
    folder.write("notes.nrrd", lines + b"# a comment: with colon\nkey:=value: type: float\ncontent: x\n\n" + data)
    folder.expect("notes.nrrd", "NRRD", values, "int16", OBLIQUE)
    spaced = {**fields("short"), **place(OBLIQUE)}
    spaced["space directions"] = spaced["space directions"].replace(",", " , ").replace("(", "( ")
    folder.write("blanks.nrrd", header(spaced) + b"\n" + data)
    folder.expect("blanks.nrrd", "NRRD", values, "int16", OBLIQUE)
    for n, sizes in enumerate(["1 5 4 3", "5 4 3 1"]):
        four = {**fields("short", dimension=4, sizes=sizes), **place(OBLIQUE)}
        directions = four["space directions"]
        four["space directions"] = "none " + directions if n == 0 else directions + " none"
        four["kinds"] = "list domain domain domain" if n == 0 else "domain domain domain time"
        folder.write(f"four{n}.nrrd", header(four) + b"\n" + data)
        folder.expect(f"four{n}.nrrd", "NRRD", values, "int16", OBLIQUE)
    folder.write("four2.nrrd", header({**fields("short", dimension=4, sizes="5 4 3 1"), "spacings": "1 2 3 nan"})
                 + b"\n" + data)
    folder.expect("four2.nrrd", "NRRD", values, "int16", np.diag([1.0, 2.0, 3.0, 1.0]))
    # Data elsewhere.
    folder.write("apart.raw", data)
    folder.write("apart.raw.gz", gzip.compress(b"12345678" + data))
    folder.write("skipped.raw", b"first line\nsecond\n#!" + data)
    folder.write("apart.txt", text_samples(values).replace(" ", ",\n").encode())
    for k in range(3):
        folder.write(f"slice_{k + 7:03d}.raw", values[:, :, k].tobytes(order="F"))
    base = {**fields("short"), **place(OBLIQUE)}
    for name, more, after in [
            ("apart", {"data file": "apart.raw"}, b""),
            ("apart_gz", {"encoding": "gzip", "byte skip": 8, "datafile": "apart.raw.gz"}, b""),
            ("skips", {"line skip": 2, "byte skip": 2, "data file": "skipped.raw"}, b""),
            ("at_end", {"byteskip": -1, "data file": "skipped.raw"}, b""),
            ("apart_txt", {"encoding": "txt", "data file": "apart.txt"}, b""),
            ("listed", {"data file": "LIST"}, b"slice_007.raw\nslice_008.raw\nslice_009.raw\n"),
            ("pattern", {"data file": "slice_%03d.raw 7 9 1"}, b""),
            ("pattern2", {"data file": "slice_%03d.raw 7 9 1 2"}, b"")]:
        folder.write(f"{name}.nhdr", header({**base, **more}) + after)
        folder.expect(f"{name}.nhdr", "NRRD", values, "int16", OBLIQUE)
    back = np.eye(4)
    back[:3, :3] = OBLIQUE[:3, :3] @ np.diag([1, 1, -1])
    back[:3, 3] = OBLIQUE[:3, 3] + 2 * OBLIQUE[:3, 2]
    folder.write("down.nhdr", header({**fields("short"), **place(back), "data file": "slice_%03d.raw 9 7 -1"}))
    folder.expect("down.nhdr", "NRRD", values[:, :, ::-1], "int16", back)

    # Bad ones.
    def bad(name, head, *says, payload=data, end=b"\n"):
        folder.write(name, (head if isinstance(head, bytes) else header(head)) + end + payload)
        folder.expect_error(name, *says)

    bad("magic.nrrd", b"NRRD0009\n", "begins with \"NRRD0009\"")
    bad("type.nrrd", {**base, "type": "block"}, "field \"type\" is \"block\"")
    bad("no_type.nrrd", {k: v for k, v in base.items() if k != "type"}, "no field \"type\"")
    bad("rank.nrrd", {**base, "dimension": 0}, "field \"dimension\" is \"0\"")
    bad("sizes.nrrd", {**base, "sizes": "5 4"}, "field \"sizes\" is \"5 4\"", "3 entries")
    bad("words.nrrd", {**base, "sizes": "5 4 x"}, "expected integers")
    bad("zero.nrrd", {**base, "sizes": "5 0 3"}, "5 x 0 x 3", "0 along j")
    bad("minus.nrrd", {**base, "sizes": "-5 4 3"}, "-5 along i")
    bad("huge.nrrd", {**base, "sizes": "9000000000 9000000000 9000000000"}, "more samples than can be addressed")
    bad("thin.nrrd", {**base, "sizes": "5 12 1"}, "one sample thick along k")
    bad("two.nrrd", {"type": "short", "dimension": 2, "sizes": "5 12", "encoding": "raw", "endian": "little"},
        "has 2 axes in space")
    bad("frames.nrrd", {**fields("short", dimension=4, sizes="5 4 3 7")}, "holds 7 frames")
    bad("rgb.nrrd", {**fields("short", dimension=4, sizes="3 5 4 3"), "kinds": "RGB-color domain domain domain"},
        "holds 3 components a voxel")
    bad("picture.nrrd", {**fields("short", sizes="3 5 4"), "kinds": "RGB-color domain domain"},
        "holds 3 components a voxel")
    bad("cut.nrrd", base, "holds 113 bytes of data", "expected 120 bytes", payload=data[:-7])
    bad("long.nrrd", base, "holds 121 bytes of data", "expected 120 bytes", payload=data + b"x")
    bad("no_end.nrrd", base, "has no end", payload=b"", end=b"")
    bad("cut_gz.nrrd", {**base, "encoding": "gzip"}, "cut off", "expected 120 bytes", payload=gzip.compress(data)[:-50])
    bad("not_gz.nrrd", {**base, "encoding": "gzip"}, "compressed data are damaged")
    bad("few.nrrd", {**base, "encoding": "ascii"}, "holds 59 numbers", "expected 60",
        payload=text_samples(values.ravel(order="F")[:-1]).encode())
    bad("fewer.nrrd", {**base, "encoding": "ascii"}, "expected 60 numbers", payload=b"1 2 3")
    bad("more.nrrd", {**base, "encoding": "ascii"}, "goes on with \"17\"", payload=(text_samples(values) + " 17").encode())
    bad("word.nrrd", {**base, "encoding": "ascii"}, "number 4 is \"four\"", "expected int16",
        payload=b"1 2 3 four " + b"5 " * 60)
    bad("range.nrrd", {**base, "encoding": "ascii"}, "number 2 is \"32768\"", payload=b"1 32768 " + b"5 " * 60)
    bad("bzip2.nrrd", {**base, "encoding": "bzip2"}, "field \"encoding\" is \"bzip2\"", "expected raw, gzip or ascii")
    bad("endian.nrrd", {k: v for k, v in base.items() if k != "endian"}, "no field \"endian\"")
    bad("space.nrrd", {**base, "space": "somewhere"}, "field \"space\" is \"somewhere\"")
    bad("direction.nrrd", {**base, "space directions": "(1,0,0) (0,0,0) (0,0,1)"},
        "step from sample to sample along j is (0, 0, 0)")
    bad("nan.nrrd", {**base, "space directions": "(1,0,0) (0,nan,0) (0,0,1)"}, "(0, nan, 0)")
    bad("plane.nrrd", {**base, "space directions": "(1,0,0) (0,1,0) (1,1,0)"}, "direction is singular")
    bad("form.nrrd", {**base, "space directions": "(1,0) (0,1,0) (1,1,0)"}, "field \"space directions\"", "vectors")
    bad("origin.nrrd", {**base, "space origin": "(0,0)"}, "field \"space origin\" is \"(0,0)\"")
    bad("origin_nan.nrrd", {**base, "space origin": "(0,nan,0)"}, "origin (0, nan, 0) is not finite")
    bad("spacing0.nrrd", {**fields("short"), "spacings": "1 0 1"}, "spacing 0 along axis 2")
    bad("spacing-1.nrrd", {**fields("short"), "spacings": "1 1 -1"}, "spacing -1 along axis 3")
    bad("twice.nrrd", header(base) + b"type: short\n", "two fields \"type\"")
    bad("colon.nrrd", header(base) + b"no colon\n", "header line \"no colon\"")
    bad("line.nrrd", {**base, "line skip": -1}, "field \"line skip\" is \"-1\"")
    bad("byte.nrrd", {**base, "byte skip": -2}, "field \"byte skip\" is \"-2\"")
    for name, more, *says in [
            ("gone", {"data file": "not_there.raw"}, "not_there.raw", "no such file"),
            ("folder", {"data file": "."}, "is a directory"),
            ("past", {"byte skip": 500, "data file": "apart.raw"}, "begin at byte 500"),
            ("lines", {"line skip": 50, "data file": "skipped.raw"}, "ends inside the lines before the data"),
            ("late", {"byte skip": -1, "data file": "slice_007.raw"}, "is 40 bytes long", "120 bytes of data"),
            ("few_files", {"data file": "slice_%03d.raw 7 8 1"}, "slice_007.raw", "expected 60 bytes"),
            ("seven", {"data file": "slice_%03d.raw 1 7 1"}, "7 data files cannot share 60 samples"),
            ("step", {"data file": "slice_%03d.raw 7 9 0"}, "by 0"),
            ("many", {"data file": "slice_%03d.raw 0 9000000000000000000 1"}, "data files", "100000"),
            ("pattern_s", {"data file": "slice_%s.raw 7 9 1"}, "expected one %d"),
            ("nothing", {"data file": "LIST"}, "names 0 data files")]:
        folder.write(f"bad_{name}.nhdr", header({**base, **more}))
        folder.expect_error(f"bad_{name}.nhdr", *says)


# --- MetaImage -----------------------------------------------------------------------------------

def metaimage(folder):
    def header(**fields):
        return "".join(f"{k} = {v}\n" for k, v in fields.items() if v is not None).encode()

    def base(kind, world=OBLIQUE, **more):
        spacing = np.linalg.norm(world[:3, :3], axis=0)
        axes = world[:3, :3] / spacing
        result = dict(ObjectType="Image", NDims=3, BinaryData="True", BinaryDataByteOrderMSB="False",
                      CompressedData="False", TransformMatrix=" ".join(repr(x) for x in axes.T.ravel().tolist()),
                      Offset=" ".join(repr(x) for x in world[:3, 3].tolist()),
                      ElementSpacing=" ".join(repr(x) for x in spacing.tolist()), DimSize="5 4 3",
                      ElementType=kind)
        result.update(more)
        result["ElementDataFile"] = result.pop("ElementDataFile", "LOCAL")
        return result

    words = {"int8": "MET_CHAR", "uint8": "MET_UCHAR", "int16": "MET_SHORT", "uint16": "MET_USHORT",
             "int32": "MET_INT", "float32": "MET_FLOAT", "float64": "MET_DOUBLE"}
    # Every type, byte order, compressed and not, in one file and in two.
    for n, kind in enumerate(TYPES):
        values = samples(kind)
        world = [OBLIQUE, MIRRORED, SHEARED][n % 3]
        for big in [False, True]:
            for compressed in [False, True]:
                name = f"{kind}_{'big' if big else 'little'}_{'z' if compressed else 'raw'}"
                data = values.astype(np.dtype(kind).newbyteorder(">" if big else "<")).tobytes(order="F")
                more = dict(BinaryDataByteOrderMSB=str(big))
                if compressed:
                    data = zlib.compress(data)
                    more.update(CompressedData="True", CompressedDataSize=len(data))
                folder.write(f"{name}.mha", header(**base(words[kind], world, **more)) + data)
                folder.expect(f"{name}.mha", "MetaImage", values, kind, world)
                data_name = name + (".zraw" if compressed else ".raw")
                folder.write(data_name, data)
                folder.write(f"{name}.mhd", header(**base(words[kind], world, **more, ElementDataFile=data_name)))
                folder.expect(f"{name}.mhd", "MetaImage", values, kind, world)
    values = samples("int16")
    data = values.tobytes(order="F")
    for name, word, stored in [("met_long", "MET_LONG", "int32"), ("uint", "MET_UINT", "uint32"),
                               ("longlong", "MET_LONG_LONG", "int64"), ("ulong", "MET_ULONG_LONG", "uint64")]:
        positive = np.abs(values.astype("int32"))
        folder.write(f"{name}.mha", header(**base(word)) + positive.astype(stored).tobytes(order="F"))
        folder.expect(f"{name}.mha", "MetaImage", positive, "int32", OBLIQUE)
    # Synonyms, defaults, units, a fourth axis, text.
    axes = base("MET_SHORT")["TransformMatrix"]
    folder.write("synonyms.mha", header(**base("MET_SHORT", TransformMatrix=None, Offset=None, Rotation=axes,
                                               Position="1 2 3", BinaryDataByteOrderMSB=None,
                                               ElementByteOrderMSB="False")) + data)
    folder.expect("synonyms.mha", "MetaImage", values, "int16", affine(OBLIQUE[:3, :3], (1, 2, 3)))
    folder.write("size.mha", header(**base("MET_SHORT", TransformMatrix=None, Offset=None, ElementSpacing=None,
                                           ElementSize="2 3 4")) + data)
    folder.expect("size.mha", "MetaImage", values, "int16", np.diag([2.0, 3.0, 4.0, 1.0]))
    folder.write("bare.mha", b"NDims = 3\nDimSize = 5 4 3\nElementType = MET_SHORT\nElementDataFile = LOCAL\n" + data)
    folder.expect("bare.mha", "MetaImage", values, "int16", np.eye(4), ["no ElementSpacing"])
    folder.write("cm.mha", header(**base("MET_SHORT", DistanceUnits="cm")) + data)
    folder.expect("cm.mha", "MetaImage", values, "int16", np.diag([10.0, 10, 10, 1]) @ OBLIQUE)
    axes4 = np.eye(4)
    axes4[:3, :3] = (OBLIQUE[:3, :3] / np.linalg.norm(OBLIQUE[:3, :3], axis=0)).T
    spacing = base("MET_SHORT")["ElementSpacing"]
    folder.write("four.mha", header(**base("MET_SHORT", NDims=4, DimSize="5 4 3 1",
                                           TransformMatrix=" ".join(repr(x) for x in axes4.ravel().tolist()),
                                           Offset="1 2 3 0", ElementSpacing=spacing + " 1")) + data)
    folder.expect("four.mha", "MetaImage", values, "int16", affine(OBLIQUE[:3, :3], (1, 2, 3)))
    folder.write("text.mha", header(**base("MET_SHORT", BinaryData="False")) + text_samples(values).encode())
    folder.expect("text.mha", "MetaImage", values, "int16", OBLIQUE)
    folder.write("slope.mha", header(**base("MET_SHORT", ElementToIntensityFunctionSlope="0.5",
                                            ElementToIntensityFunctionOffset="10")) + data)
    folder.expect("slope.mha", "MetaImage", values * 0.5 + 10, "float32", OBLIQUE)
    # Data elsewhere.
    folder.write("skipped.raw", b"0123456789" + data)
    for k in range(3):
        folder.write(f"s{k + 1}.raw", values[:, :, k].tobytes(order="F"))
    for name, more, after in [("skip", dict(HeaderSize=10, ElementDataFile="skipped.raw"), b""),
                              ("at_end", dict(HeaderSize=-1, ElementDataFile="skipped.raw"), b""),
                              ("pattern", dict(ElementDataFile="s%d.raw 1 3 1"), b""),
                              ("listed", dict(ElementDataFile="LIST"), b"s1.raw\ns2.raw\ns3.raw\n")]:
        folder.write(f"{name}.mhd", header(**base("MET_SHORT", **more)) + after)
        folder.expect(f"{name}.mhd", "MetaImage", values, "int16", OBLIQUE)

    # Bad ones.
    def bad(name, *says, payload=data, **more):
        folder.write(name, header(**base("MET_SHORT", **more)) + payload)
        folder.expect_error(name, *says)

    bad("zero.mha", "5 x 0 x 3", "0 along j", DimSize="5 0 3")
    bad("minus.mha", "-4 along j", DimSize="5 -4 3")
    bad("thin.mha", "one sample thick along k", DimSize="5 12 1")
    bad("two.mha", "has 2 axes", NDims=2, DimSize="5 12")
    bad("rank.mha", "field \"NDims\" is \"x\"", NDims="x")
    bad("dims.mha", "field \"DimSize\" is \"5 4\"", "3 integers", DimSize="5 4")
    bad("huge.mha", "more samples than can be addressed", DimSize="9000000000 9000000000 9000000000")
    bad("frames.mha", "holds 7 frames", NDims=4, DimSize="5 4 3 7")
    bad("rgb.mha", "holds 3 components a voxel", ElementNumberOfChannels=3)
    bad("array.mha", "field \"ElementType\" is \"MET_FLOAT_ARRAY\"", ElementType="MET_FLOAT_ARRAY")
    bad("object.mha", "field \"ObjectType\" is \"Tube\"", ObjectType="Tube")
    bad("spacing0.mha", "spacing 0 along axis 2", ElementSpacing="1 0 1")
    bad("spacing-1.mha", "spacing -1 along axis 3", ElementSpacing="1 1 -1")
    bad("spacingnan.mha", "spacing nan along axis 1", ElementSpacing="nan 1 1")
    bad("spacinginf.mha", "inf", ElementSpacing="inf 1 1")
    bad("plane.mha", "direction is singular", TransformMatrix="1 0 0 0 1 0 1 1 0")
    bad("matrix.mha", "field \"TransformMatrix\"", "9 numbers", TransformMatrix="1 0 0")
    bad("offset.mha", "origin (0, nan, 0) is not finite", Offset="0 nan 0")
    bad("units.mha", "field \"DistanceUnits\" is \"inch\"", DistanceUnits="inch")
    bad("cut.mha", "holds 113 bytes of data", "expected 120 bytes", payload=data[:-7])
    bad("long.mha", "holds 121 bytes of data", "expected 120 bytes", payload=data + b"x")
    bad("cutz.mha", "cut off", "expected 120 bytes", CompressedData="True", payload=zlib.compress(data)[:-9])
    bad("notz.mha", "compressed data are damaged", CompressedData="True", payload=b"abcdefgh" * 9)
    bad("bool.mha", "field \"CompressedData\" is \"maybe\"", CompressedData="maybe")
    bad("gone.mhd", "not_there.raw", "no such file", ElementDataFile="not_there.raw", payload=b"")
    bad("past.mhd", "begin at byte 500", HeaderSize=500, ElementDataFile="skipped.raw", payload=b"")
    bad("header.mhd", "field \"HeaderSize\" is \"-2\"", HeaderSize=-2, ElementDataFile="skipped.raw", payload=b"")
    for name, text, *says in [("no_data.mhd", b"NDims = 3\nDimSize = 5 4 3\n", "no field \"ElementDataFile\""),
                              ("line.mhd", b"NDims = 3\nDimSize 5 4 3\n", "header line \"DimSize 5 4 3\""),
                              ("empty.mhd", b"", "no field \"ElementDataFile\""),
                              ("twice.mhd", b"NDims = 3\nNDims = 3\n", "two fields \"NDims\"")]:
        folder.write(name, text)
        folder.expect_error(name, *says)


# --- DICOM ---------------------------------------------------------------------------------------

def dicom(folder):
    import pydicom
    from pydicom.dataset import Dataset, FileDataset, FileMetaDataset
    from pydicom.sequence import Sequence
    from pydicom.uid import (CTImageStorage, EnhancedCTImageStorage, ExplicitVRBigEndian, ExplicitVRLittleEndian,
                             ImplicitVRLittleEndian, RLELossless, generate_uid)

    root = "1.2.826.0.1.3680043.8.498."

    def uid(*parts):
        return generate_uid(prefix=root, entropy_srcs=[str(p) for p in parts])

    def new_file(path, storage, syntax, instance):
        meta = FileMetaDataset()
        meta.MediaStorageSOPClassUID = storage
        meta.MediaStorageSOPInstanceUID = instance
        meta.TransferSyntaxUID = syntax
        data = FileDataset(path, {}, file_meta=meta, preamble=b"\0" * 128)
        data.is_little_endian = syntax != ExplicitVRBigEndian
        data.is_implicit_VR = syntax == ImplicitVRLittleEndian
        data.SOPClassUID = storage
        data.SOPInstanceUID = instance
        return data

    def decimal(numbers):
        return [f"{x:.13g}"[:16] for x in numbers]

    def set_pixels(data, pixels, bits_stored=None):
        """pixels[j, i] or [frame, j, i]."""
        bits = pixels.dtype.itemsize * 8
        data.SamplesPerPixel = 1
        data.PhotometricInterpretation = "MONOCHROME2"
        data.Rows, data.Columns = pixels.shape[-2:]
        data.BitsAllocated = bits
        data.BitsStored = bits_stored or bits
        data.HighBit = data.BitsStored - 1
        data.PixelRepresentation = int(pixels.dtype.kind == "i")
        order = "<" if data.is_little_endian else ">"
        data.PixelData = pixels.astype(pixels.dtype.newbyteorder(order)).tobytes()
        data["PixelData"].VR = "OW" if bits > 8 else "OB"

    def write_slice(directory, name, series, n, world, pixels, slope=None, intercept=None,
                    syntax=ExplicitVRLittleEndian, position=None, number=1, description="", change=None,
                    bits_stored=None):
        os.makedirs(folder / directory, exist_ok=True)
        path = folder / os.path.join(directory, name)
        data = new_file(path, CTImageStorage, syntax, uid("instance", directory, series, n))
        data.Modality = "CT"
        data.PatientName = "Test^Volume"
        data.StudyInstanceUID = uid("study", directory)
        data.SeriesInstanceUID = uid("series", directory, series)
        data.SeriesNumber = number
        data.SeriesDescription = description
        data.InstanceNumber = n + 1
        steps = world[:3, :3]
        spacing = np.linalg.norm(steps, axis=0)
        data.ImageOrientationPatient = decimal([*(steps[:, 0] / spacing[0]), *(steps[:, 1] / spacing[1])])
        data.ImagePositionPatient = decimal(world[:3, 3] + n * steps[:, 2] if position is None else position)
        data.PixelSpacing = decimal([spacing[1], spacing[0]])
        data.SliceThickness = decimal([spacing[2]])[0]
        if slope is not None:
            data.RescaleSlope, data.RescaleIntercept = str(slope), str(intercept)
        set_pixels(data, pixels, bits_stored)
        if change:
            change(data)
        if syntax == RLELossless:
            data.file_meta.TransferSyntaxUID = ExplicitVRLittleEndian
            data.compress(RLELossless)
        data.save_as(path, write_like_original=False)

    def expect(directory, names, kind, warnings=(), target=None, series=None):
        """Values and places of the named files by pydicom, ordered along the normal."""
        slices = [pydicom.dcmread(folder / os.path.join(directory, name)) for name in names]
        rows = np.array(slices[0].ImageOrientationPatient[:3], float)
        columns = np.array(slices[0].ImageOrientationPatient[3:], float)
        normal = np.cross(rows, columns)
        slices.sort(key=lambda s: np.dot(normal, np.array(s.ImagePositionPatient, float)))
        places = [np.array(s.ImagePositionPatient, float) for s in slices]
        values = np.stack([s.pixel_array.astype(float) * float(s.get("RescaleSlope", 1))
                           + float(s.get("RescaleIntercept", 0)) for s in slices], axis=-1).swapaxes(0, 1)
        row_spacing, column_spacing = (float(x) for x in slices[0].PixelSpacing)
        world = affine(np.stack([rows * column_spacing, columns * row_spacing,
                                 (places[-1] - places[0]) / (len(places) - 1)], axis=1), places[0])
        folder.expect(target or directory, "DICOM series", values, kind, world, warnings, series)

    def volume(kind, dims=(5, 4, 6), seed=2):
        return samples(kind, dims, seed).transpose(2, 1, 0)  # [k, j, i]

    def series(directory, world=OBLIQUE, kind="int16", names=None, count=6, **more):
        pixels = volume(kind, (5, 4, count))
        names = names or [f"{n:02d}.dcm" for n in range(count)]
        for n, name in enumerate(names):
            write_slice(directory, name, more.get("series", 0), n, world, pixels[n],
                        **{k: v for k, v in more.items() if k != "series"})
        return names

    # Oblique and mirrored stacks whose file names are in no order; other files beside them.
    shuffled = ["c", "f.dcm", "a.IMA", "e", "b.dcm", "d"]
    for directory, world in [("oblique", OBLIQUE), ("other", affine(rotation((3, -1, 2), 160.0) @
                                                                    np.diag([0.5, 1.5, 4.0]), (100, -3, 0.125)))]:
        names = series(directory, world, names=shuffled)
        folder.write(f"{directory}/readme.txt", b"not an image\n" * 30)
        folder.write(f"{directory}/empty", b"")
        folder.write(f"{directory}/noise.bin", bytes(range(256)) * 8)
        os.makedirs(folder / f"{directory}/deeper", exist_ok=True)
        expect(directory, names, "int16")
    expect("oblique", shuffled, "int16", target="oblique/e")
    # Against the normal: the files' order is the other way round.
    down = OBLIQUE.copy()
    down[:3, 2] = -down[:3, 2]
    expect("down", series("down", down), "int16")
    # Types, transfer syntaxes, scales.
    for kind in ["int8", "uint8", "uint16", "int32"]:
        expect(kind, series(kind, kind=kind), kind)
    for name, syntax in [("implicit", ImplicitVRLittleEndian), ("big_endian", ExplicitVRBigEndian), ("rle", RLELossless)]:
        expect(name, series(name, syntax=syntax), "int16")
    ct = (np.arange(120).reshape(6, 4, 5) * 34).astype("uint16")  # 0 … 4046
    for name, slopes, intercept, kind in [("ct", [1] * 6, -1024, "int16"), ("pet", [0.5, 0.25, 1, 2, 0.125, 3], 0, "float32"),
                                          ("steps", [1, 2, 3, 4, 5, 6], 10, "uint16")]:
        names = [f"{n}.dcm" for n in range(6)]
        for n in range(6):
            write_slice(name, names[n], 0, n, OBLIQUE, ct[n], slopes[n], intercept, bits_stored=12)
        expect(name, names, kind)
    # A tilted gantry; positions with three decimals; one slice noticeably off.
    tilted = affine(np.array([[0.8, 0, 0], [0, 0.8, -1.2], [0, 0, 3.0]]), (-100, -90, 40))
    expect("tilt", series("tilt", tilted), "int16", ["sheared by 21.8014 degrees"])
    names = []
    for n in range(6):
        names.append(f"{n}.dcm")
        write_slice("rounded", names[-1], 0, n, OBLIQUE, ct[n],
                    position=np.round(OBLIQUE[:3, 3] + n * OBLIQUE[:3, 2], 3))
    expect("rounded", names, "uint16")
    names = []
    for n in range(6):
        names.append(f"{n}.dcm")
        shift = 0.03 if n == 2 else 0.0
        write_slice("jitter", names[-1], 0, n, OBLIQUE, ct[n], position=OBLIQUE[:3, 3] + (n + shift) * OBLIQUE[:3, 2])
    expect("jitter", names, "uint16", ["2.dcm is 0.075 mm off"])
    # Copies of a file count once.
    names = series("copies")
    folder.write("copies/copy.dcm", folder.read("copies/02.dcm"))
    expect("copies", names, "int16", ["1 file is a copy"])
    # Two series and a report.
    one = series("two_series", series=1, number=4, description="Thorax")
    two = series("two_series", MIRRORED @ np.diag([1.0, -1, 1, 1]), series=2, number=2, names=["x1", "x2", "x3", "x4"],
                 count=4, description="Bone")
    report = new_file(folder / "two_series/report.dcm", "1.2.840.10008.5.1.4.1.1.88.11", ExplicitVRLittleEndian, uid("sr"))
    report.Modality = "SR"
    report.SeriesInstanceUID = uid("report")
    report.save_as(folder / "two_series/report.dcm", write_like_original=False)
    uid1, uid2 = uid("series", "two_series", 1), uid("series", "two_series", 2)
    listing = [f"1: {uid2}  CT \"Bone\", 4 slices of 5 x 4", f"2: {uid1}  CT \"Thorax\", 6 slices of 5 x 4"]
    expect("two_series", one, "int16", series="2")
    expect("two_series", one, "int16", series=uid1)
    expect("two_series", two, "int16", series="1")
    expect("two_series", two, "int16", target="two_series/x3")
    expect("two_series", two, "int16", target="two_series/00.dcm", series=uid2)
    folder.expect_error("two_series", "holds 2 DICOM series", "--series", *listing)
    folder.expect_error("two_series", "holds no DICOM series \"3\"", *listing, series="3")
    folder.expect_error("two_series", "holds no DICOM series \"1.2.3\"", series="1.2.3")
    folder.expect_error("two_series/report.dcm", "is not a DICOM image")

    # One file of many frames, in an order of its own, each with a scale.
    def enhanced(directory, order, world=OBLIQUE, slope=lambda n: "1", name="frames.dcm"):
        os.makedirs(folder / directory, exist_ok=True)
        pixels = volume("int16")
        data = new_file(folder / f"{directory}/{name}", EnhancedCTImageStorage, ExplicitVRLittleEndian,
                        uid("enhanced", directory, name))
        data.Modality = "CT"
        data.SeriesInstanceUID = uid("series", directory)
        steps, spacing = world[:3, :3], np.linalg.norm(world[:3, :3], axis=0)
        set_pixels(data, pixels[order])
        data.NumberOfFrames = len(order)
        measures, orientation = Dataset(), Dataset()
        measures.PixelSpacing = decimal([spacing[1], spacing[0]])
        measures.SliceThickness = "2.5"
        orientation.ImageOrientationPatient = decimal([*(steps[:, 0] / spacing[0]), *(steps[:, 1] / spacing[1])])
        shared = Dataset()
        shared.PixelMeasuresSequence = Sequence([measures])
        shared.PlaneOrientationSequence = Sequence([orientation])
        data.SharedFunctionalGroupsSequence = Sequence([shared])
        frames = []
        for n in order:
            frame, position, scale = Dataset(), Dataset(), Dataset()
            position.ImagePositionPatient = decimal(world[:3, 3] + n * steps[:, 2])
            frame.PlanePositionSequence = Sequence([position])
            scale.RescaleSlope, scale.RescaleIntercept, scale.RescaleType = slope(n), "-5", "HU"
            frame.PixelValueTransformationSequence = Sequence([scale])
            frames.append(frame)
        data.PerFrameFunctionalGroupsSequence = Sequence(frames)
        data.save_as(folder / f"{directory}/{name}", write_like_original=False)
        again = pydicom.dcmread(folder / f"{directory}/{name}")
        stack = sorted(range(len(order)), key=lambda f: order[f])
        values = np.stack([again.pixel_array[f].astype(float)
                           * float(again.PerFrameFunctionalGroupsSequence[f].PixelValueTransformationSequence[0].RescaleSlope)
                           - 5 for f in stack], axis=-1).swapaxes(0, 1)
        places = [np.array(again.PerFrameFunctionalGroupsSequence[f].PlanePositionSequence[0].ImagePositionPatient, float)
                  for f in stack]
        cosines = np.array(again.SharedFunctionalGroupsSequence[0].PlaneOrientationSequence[0].ImageOrientationPatient,
                           float)
        steps = np.stack([cosines[:3] * float(measures.PixelSpacing[1]), cosines[3:] * float(measures.PixelSpacing[0]),
                          (places[-1] - places[0]) / (len(places) - 1)], axis=1)
        return values, affine(steps, places[0])

    values, world = enhanced("enhanced", [3, 0, 5, 1, 4, 2])
    for target in ["enhanced", "enhanced/frames.dcm"]:
        folder.expect(target, "DICOM series", values, "int32", world)
    values, world = enhanced("enhanced_scales", [3, 0, 5, 1, 4, 2], slope=lambda n: str(0.5 + n))
    folder.expect("enhanced_scales", "DICOM series", values, "float32", world)
    enhanced("enhanced_gap", [0, 1, 2, 4, 5])
    folder.expect_error("enhanced_gap", "1 slice is missing", "frames.dcm frame 3 and frames.dcm frame 4")

    # Bad ones.
    os.makedirs(folder / "nothing", exist_ok=True)
    folder.expect_error("nothing", "holds no DICOM images")
    folder.write("nothing/readme.txt", b"x" * 500)
    folder.expect_error("nothing", "holds no DICOM images")
    series("missing")
    os.remove(folder / "missing/03.dcm")
    folder.expect_error("missing", "1 slice is missing", "between 02.dcm and 04.dcm, 5 mm apart", "2.5 mm")
    series("missing_more", count=12)
    for n in [2, 3, 8]:
        os.remove(folder / f"missing_more/{n:02d}.dcm")
    folder.expect_error("missing_more", "3 slices are missing", "2 between 01.dcm and 04.dcm, 7.5 mm apart",
                        "1 between 07.dcm and 09.dcm")
    for n in range(6):
        place = OBLIQUE[:3, 3] + (n + (0.3 if n == 4 else 0.0)) * OBLIQUE[:3, 2]
        write_slice("uneven", f"{n}.dcm", 0, n, OBLIQUE, ct[n], position=place)
    folder.expect_error("uneven", "unevenly spaced", "3.25 mm between 3.dcm and 4.dcm", "2.5 mm apart")
    for n in range(12):
        place = OBLIQUE[:3, 3] + (n if n < 6 else 5 + (n - 5) * 1.04) * OBLIQUE[:3, 2]
        write_slice("drift", f"{n:02d}.dcm", 0, n, OBLIQUE, ct[n % 6], position=place)
    folder.expect_error("drift", "unevenly spaced", "mm off an even stack")
    for n in range(6):
        place = OBLIQUE[:3, 3] + n * OBLIQUE[:3, 2] + (2.0 if n == 3 else 0.0) * OBLIQUE[:3, 0]
        write_slice("sideways", f"{n}.dcm", 0, n, OBLIQUE, ct[n], position=place)
    folder.expect_error("sideways", "3.dcm is 1.4 mm off an even stack")
    series("single", count=1)
    folder.expect_error("single", "holds 1 slice")
    for phase in range(2):
        for n in range(3):
            write_slice("phases", f"{phase}{n}.dcm", 0, n, OBLIQUE, ct[n],
                        change=lambda d, phase=phase, n=n: setattr(d, "SOPInstanceUID", uid("phase", phase, n)))
    folder.expect_error("phases", "holds 2 frames (4-D)")
    series("doubled")
    write_slice("doubled", "again.dcm", 0, 2, OBLIQUE, ct[2].astype("int16"),
                change=lambda d: setattr(d, "SOPInstanceUID", uid("again")))
    folder.expect_error("doubled", "several slices at one place", "02.dcm", "again.dcm")

    def one_different(directory, *says, **more):
        series(directory)
        pixels = more.pop("pixels", volume("int16")[5])
        write_slice(directory, "05.dcm", 0, 5, more.pop("world", OBLIQUE), pixels, **more)
        folder.expect_error(directory, "05.dcm", *says)

    one_different("rows", "is 5 x 3 int16", "5 x 4 int16", pixels=volume("int16")[5][:3])
    one_different("types", "is 5 x 4 uint16", pixels=volume("uint16")[5])
    turned = OBLIQUE.copy()
    turned[:3, :2] = rotation((1, 2, 3), 36.0)[:, :2] @ np.diag([0.7, 0.9])
    one_different("turned", "differ in orientation", world=turned)
    one_different("spacing", "differ in pixel spacing", "0.9 x 0.7", "0.9 x 0.8",
                  change=lambda d: setattr(d, "PixelSpacing", ["0.9", "0.8"]))

    def all_changed(directory, *says, **change):
        def apply(data):
            for name, value in change.items():
                if value is None:
                    delattr(data, name)
                else:
                    setattr(data, name, value)
        series(directory, change=apply)
        folder.expect_error(directory, *says)

    all_changed("spacing0", "pixel spacing 0;", PixelSpacing=["0.9", "0"])
    all_changed("spacing-1", "pixel spacing -1;", PixelSpacing=["-1", "0.9"])
    all_changed("no_spacing", "has no PixelSpacing", PixelSpacing=None)
    all_changed("no_position", "has no ImagePositionPatient", ImagePositionPatient=None)
    all_changed("no_orientation", "has no ImageOrientationPatient", ImageOrientationPatient=None)
    all_changed("skewed", "not two orthogonal unit vectors", ImageOrientationPatient=["1", "0", "0", "0.5", "1", "0"])
    all_changed("rgb", "holds 3 components a voxel", SamplesPerPixel=3, PhotometricInterpretation="RGB")
    all_changed("palette", "\"PALETTE COLOR\"", PhotometricInterpretation="PALETTE COLOR")
    all_changed("bits", "has 12 bits allocated", BitsAllocated=12)
    all_changed("high_bit", "stores 12 bits up to bit 15 of 16", BitsStored=12, HighBit=15)
    all_changed("slope0", "slope 0 and intercept 0", RescaleSlope="0", RescaleIntercept="0")
    all_changed("few_pixels", "holds 30 bytes of pixel data", "expected 40", PixelData=b"\0" * 30)
    all_changed("many_pixels", "holds 50 bytes of pixel data", "expected 40", PixelData=b"\0" * 50)
    all_changed("fewer_rows", "holds 40 bytes of pixel data", "expected 30", Rows=3)
    all_changed("zero_rows", "has 0 rows", Rows=0)
    all_changed("unpositioned", "has no ImagePositionPatient", NumberOfFrames=1, ImagePositionPatient=["1", "2"])

    # Pixels of another kind.
    def float_pixels(data):
        del data.PixelData
        data.FloatPixelData = np.zeros(20, "float32").tobytes()
        data.BitsAllocated = data.BitsStored = 32
        data.HighBit = 31
    series("floats", change=float_pixels)
    folder.expect_error("floats")

    # Cut files: in the pixels, at them, in the header, in its first group, in the preamble, to nothing.
    series("whole")
    whole = folder.read("whole/02.dcm")
    pixels_at = whole.index(b"\xe0\x7f\x10\x00")
    rows_at = whole.index(b"\x28\x00\x10\x00")
    for name, length, *says in [("pixels", len(whole) - 7, "02.dcm", "holds 33 bytes of pixel data", "expected 40"),
                                ("tag", pixels_at, "02.dcm", "ends before its pixel data"),
                                ("in_tag", pixels_at + 5, "02.dcm"),
                                ("rows", rows_at, "02.dcm"), ("series", 500, "02.dcm"), ("meta", 200, "02.dcm"),
                                ("preamble", 100, "02.dcm", "is not DICOM"), ("zero", 0, "02.dcm", "is not DICOM")]:
        directory = f"cut_{name}"
        series(directory)
        folder.write(f"{directory}/02.dcm", folder.read(f"{directory}/02.dcm")[:length])
        folder.expect_error(directory, *says)
    series("cut_rle", syntax=RLELossless)
    folder.write("cut_rle/02.dcm", folder.read("cut_rle/02.dcm")[:-12])
    folder.expect_error("cut_rle", "02.dcm", "is cut off")
    # Damaged compressed pixels. An RLE frame: number of segments, 15 offsets, segments.
    def damaged_rle(directory, change, *says):
        series(directory, syntax=RLELossless)
        data = folder.read(f"{directory}/02.dcm")
        item = data.rindex(b"\xfe\xff\x00\xe0")
        size, = struct.unpack_from("<I", data, item + 4)
        frame = change(data[item + 8:item + 8 + size])
        folder.write(f"{directory}/02.dcm",
                     data[:item + 4] + struct.pack("<I", len(frame)) + frame + data[item + 8 + size:])
        folder.expect_error(directory, "02.dcm", "its pixel data are damaged", *says)

    damaged_rle("rle_count", lambda f: patch(f, 0, "<I", 77), "77 RLE segments; expected 2")
    damaged_rle("rle_zeros", lambda f: bytes(len(f)), "0 RLE segments; expected 2")
    damaged_rle("rle_offset", lambda f: patch(f, 8, "<I", 5000), "an RLE segment from byte 64 to 5000")
    damaged_rle("rle_inside", lambda f: patch(f, 4, "<I", 8), "an RLE segment from byte 8")
    damaged_rle("rle_short", lambda f: f[:-10], "an RLE segment of ", "expected 20")
    damaged_rle("rle_tiny", lambda f: f[:20], "an RLE frame of 20 bytes")
    # JPEG that begins well and goes on with noise: its decoder crashes or complains.
    from pydicom.encaps import encapsulate
    noise = np.random.default_rng(3).integers(0, 256, 500, dtype="uint8").tobytes()
    for syntax, begin in [("1.2.840.10008.1.2.4.70", b"\xff\xd8\xff\xc3"), ("1.2.840.10008.1.2.4.80", b"\xff\xd8\xff\xf7"),
                          ("1.2.840.10008.1.2.4.90", b"\xff\x4f\xff\x51")]:
        def make_noise(data):
            data.file_meta.TransferSyntaxUID = syntax
            data.PixelData = encapsulate([begin + noise])
            data["PixelData"].is_undefined_length = True
        series(f"noise{syntax}", change=make_noise)
        folder.expect_error(f"noise{syntax}", "its pixel data cannot be read")
    # JPEG 2000, where the encoder is installed.
    try:
        import io
        from PIL import Image, features
        if features.check("jpg_2000"):
            pixels = (np.arange(3 * 48 * 64).reshape(3, 48, 64) * 7 % 4000).astype("uint16")
            def jpeg_2000(data, n):
                code = io.BytesIO()
                Image.fromarray(pixels[n]).save(code, format="JPEG2000", irreversible=False, no_jp2=True)
                data.file_meta.TransferSyntaxUID = "1.2.840.10008.1.2.4.90"
                data.PixelData = encapsulate([code.getvalue()])
                data["PixelData"].is_undefined_length = True
            for n in range(3):
                write_slice("j2k", f"{n}.dcm", 0, n, OBLIQUE, pixels[n], 1, -1024,
                            change=lambda data, n=n: jpeg_2000(data, n))
            folder.expect("j2k", "DICOM series", pixels.transpose(2, 1, 0) - 1024.0, "int16", OBLIQUE)
    except ImportError:
        pass
    # A transfer syntax nobody knows, and films.
    for syntax in ["1.2.3", "1.2.840.10008.1.2.4.100"]:
        series(f"syntax{syntax}", syntax=RLELossless)
        for n in range(6):
            data = pydicom.dcmread(folder / f"syntax{syntax}/{n:02d}.dcm")
            data.file_meta.TransferSyntaxUID = syntax
            data.save_as(folder / f"syntax{syntax}/{n:02d}.dcm", write_like_original=False)
        folder.expect_error(f"syntax{syntax}", f"has transfer syntax \"{syntax}\", which is not read")
    # RLE that calls itself JPEG 2000.
    series("not_jpeg", syntax=RLELossless)
    for n in range(6):
        data = pydicom.dcmread(folder / f"not_jpeg/{n:02d}.dcm")
        data.file_meta.TransferSyntaxUID = "1.2.840.10008.1.2.4.90"
        data.save_as(folder / f"not_jpeg/{n:02d}.dcm", write_like_original=False)
    folder.expect_error("not_jpeg", "do not begin like JPEG")
    deflated = pydicom.dcmread(folder / "whole/00.dcm")
    deflated.file_meta.TransferSyntaxUID = "1.2.840.10008.1.2.1.99"
    os.makedirs(folder / "deflated", exist_ok=True)
    deflated.save_as(folder / "deflated/00.dcm", write_like_original=False)
    folder.expect_error("deflated", "00.dcm", "deflated")


def main():
    kind, path = sys.argv[1:]
    folder = Folder(path)
    {"nifti": nifti, "nrrd": nrrd, "metaimage": metaimage, "dicom": dicom}[kind](folder)
    folder.finish()


if __name__ == "__main__":
    main()
