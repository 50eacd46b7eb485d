#!/usr/bin/python3
"""Turns a project archive of InVesalius into a volume that shape3d reads.

usage: unpack-skull.py Cranium.inv3 FOLDER

Writes FOLDER/skull.raw (the samples as they are), FOLDER/skull.mhd (their dimensions and spacing from
main.plist) and FOLDER/skull.json: the thresholds and volumes of the masks and surfaces in the archive.

The archive stores the rows of a slice from the bottom of the picture to the top, that is from posterior
to anterior: in left-posterior-superior coordinates the second axis runs backwards.
"""
import json
import pathlib
import plistlib
import sys
import tarfile


def main(archive, folder):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    with tarfile.open(archive) as tar:
        members = {pathlib.PurePosixPath(m.name).name: m for m in tar.getmembers() if m.isfile()}

        def read(name):
            if name not in members:
                sys.exit(f"error: {archive} has no {name}")
            return tar.extractfile(members[name]).read()

        project = plistlib.loads(read("main.plist"))
        matrix = project["matrix"]
        if matrix["dtype"] != "int16":
            sys.exit(f"error: {archive} holds {matrix['dtype']} samples, expected int16")
        dims = list(reversed(matrix["shape"]))
        samples = read(matrix["filename"])
        if len(samples) != 2 * dims[0] * dims[1] * dims[2]:
            sys.exit(f"error: {archive} holds {len(samples)} bytes of samples, expected {dims} x 2")
        parts = []
        for key in sorted(project["masks"]):
            mask = plistlib.loads(read(project["masks"][key]))
            surface = plistlib.loads(read(project["surfaces"][key]))
            parts.append({"threshold": mask["threshold_range"][0], "volume": surface["volume"]})

    (folder / "skull.raw").write_bytes(samples)
    spacing = " ".join(repr(s) for s in project["spacing"])
    (folder / "skull.mhd").write_text(
        "ObjectType = Image\nNDims = 3\n"
        f"DimSize = {' '.join(map(str, dims))}\n"
        f"ElementSpacing = {spacing}\n"
        "TransformMatrix = 1 0 0 0 -1 0 0 0 1\n"
        "AnatomicalOrientation = RAI\n"
        "ElementType = MET_SHORT\nElementByteOrderMSB = False\nElementDataFile = skull.raw\n")
    (folder / "skull.json").write_text(json.dumps({"parts": parts}, indent=2) + "\n")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip().splitlines()[2])
    main(sys.argv[1], sys.argv[2])
