#!/usr/bin/python3
"""Writes the seeds of the fuzz targets: small inputs that reach every part of what is fuzzed.

    make_seeds.py FOLDER

FOLDER/<target>/<name> is an input. They are made from the definitions of the formats; the script needs nothing
but Python.
"""

import os
import sys

import mesh_seeds
import volume_seeds
import zmc_seeds


def main():
    folder = sys.argv[1]
    for module in (zmc_seeds, volume_seeds, mesh_seeds):
        for target, name, data in module.seeds():
            os.makedirs(os.path.join(folder, target), exist_ok=True)
            with open(os.path.join(folder, target, name), "wb") as file:
                file.write(data)


if __name__ == "__main__":
    main()
