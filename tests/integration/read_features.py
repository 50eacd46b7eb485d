#!/usr/bin/python3
"""Reads a table of feature vectors with numpy and h5py as a user would and prints it as JSON.

    read_features.py TABLE.csv|TABLE.npy|TABLE.h5

{"specs": […], "files": […], "sizes": […], "times": […], "vectors": [[[numbers of a file] …] of a descriptor …]}
"""

import csv
import json
import re
import sys

import h5py
import numpy as np


def read_csv(path):
    specs, lengths = [], []
    with open(path, newline="", encoding="utf-8", errors="surrogateescape") as file:
        lines = file.readlines()
    head = [line for line in lines if line.startswith("#")]
    for line in head:
        match = re.match(r"# descriptor (\w+), (\d+) numbers: (.*)", line)
        if match:
            lengths.append(int(match[2]))
            specs.append(match[3])
    rows = list(csv.reader(lines[len(head) + 1 :]))
    names = lines[len(head)].strip().split(",")
    assert len(names) == 3 + sum(lengths) and all(len(row) == len(names) for row in rows)
    numbers = np.array([[float(x) for x in row[3:]] for row in rows]).reshape(len(rows), sum(lengths))
    ends = np.cumsum([0] + lengths)
    return {
        "specs": specs,
        "files": [row[0] for row in rows],
        "sizes": [int(row[1]) for row in rows],
        "times": [int(row[2]) for row in rows],
        "vectors": [numbers[:, a:b].tolist() for a, b in zip(ends, ends[1:])],
    }


def read_npy(path):
    table = np.load(path)
    specs = list(table.dtype.names[3:])
    return {
        "specs": specs,
        "files": table["file"].tolist(),
        "sizes": table["size"].tolist(),
        "times": table["mtime"].tolist(),
        "vectors": [table[spec].tolist() for spec in specs],
    }


def read_h5(path):
    with h5py.File(path, "r") as file:
        assert file.attrs["kind"] == "shape3d describe" and file.attrs["version"] == 1
        sets = sorted(file["vectors"].values(), key=lambda data: data.attrs["order"])
        return {
            "specs": [data.attrs["spec"] for data in sets],
            "files": [name.decode("utf-8", "surrogateescape") for name in file["file"][:]],
            "sizes": file["size"][:].tolist(),
            "times": file["mtime"][:].tolist(),
            "vectors": [data[:].tolist() for data in sets],
            "failed": [
                [a.decode(), b.decode()] for a, b in zip(file["failed/file"][:], file["failed/reason"][:])
            ],
        }


path = sys.argv[1]
print(json.dumps({"csv": read_csv, "npy": read_npy, "h5": read_h5}[path.rsplit(".", 1)[1]](path)))
