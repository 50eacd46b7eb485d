#!/usr/bin/python3
"""Runs scikit-image's Lewiner marching cubes on a volume, once for each line that it reads.

usage: lewiner.py FILE TYPE NX NY NZ ISOVALUE

FILE holds the samples, native byte order, x fastest. Prints "ready" and the version, then for each
line of the input: wall seconds, processor seconds, triangles, vertices, bytes of the result,
resident bytes before the call, and the highest number of resident bytes during it.
The call's own parts, conversion to float32 and normals among them, cannot be left out.
"""
import sys
import time

import numpy
import skimage
from skimage.measure import marching_cubes


def status(field):
    with open("/proc/self/status") as lines:
        for line in lines:
            if line.startswith(field + ":"):
                return 1024 * int(line.split()[1])
    raise KeyError(field)


def main():
    path, kind, nx, ny, nz, isovalue = sys.argv[1:]
    volume = numpy.fromfile(path, dtype=kind).reshape(int(nz), int(ny), int(nx))
    warm = numpy.zeros((4, 4, 4), numpy.float32)
    warm[1:3, 1:3, 1:3] = 1
    marching_cubes(warm, 0.5)
    print("ready", skimage.__version__, flush=True)
    for _ in sys.stdin:
        with open("/proc/self/clear_refs", "w") as reset:
            reset.write("5")
        before = status("VmRSS")
        cpu = time.process_time()
        wall = time.perf_counter()
        result = marching_cubes(volume, float(isovalue), method="lewiner")
        wall = time.perf_counter() - wall
        cpu = time.process_time() - cpu
        size = sum(array.nbytes for array in result)
        print(wall, cpu, len(result[1]), len(result[0]), size, before, status("VmHWM"), flush=True)
        del result


if __name__ == "__main__":
    main()
