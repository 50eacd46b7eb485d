#!/usr/bin/python3
"""Google Benchmark's JSON of shape3d_spherical_bench as the page docs/benchmarks/spherical-harmonics.md.

    benchmark_spherical.py RESULT.json
"""

import json
import platform
import re
import statistics
import sys

ROUTES = ("quadrature", "fft", "svd")
SAMPLINGS = ("point", "area")


def cpu_model():
    with open("/proc/cpuinfo") as file:
        for line in file:
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.machine()


def main():
    with open(sys.argv[1]) as file:
        result = json.load(file)
    runs = {}
    for run in result["benchmarks"]:
        if run["run_type"] == "iteration":
            runs.setdefault(run["run_name"], []).append(run)

    def median(name):
        return statistics.median(run["real_time"] for run in runs[name])

    def arguments(name):
        return {key: int(value) for key, value in re.findall(r"/(\w+):(\d+)", name) if key != "iterations"}

    load = result["context"].get("load_avg") or [0]
    print("# Cost of spherical images and their harmonics")
    print()
    print("`scripts/benchmark-spherical.sh` writes this page. Medians of 5 runs in random order, milliseconds of wall")
    print(f"time; {cpu_model()}, {result['context']['num_cpus']} processors, load {load[0]:.1f} at the start"
          f"{': busy, ratios say more than times' if load[0] > 1 else ''}.")
    print()
    print("The mesh is an octahedron on the sphere of 8n² triangles, crowded 8 : 1 by its map. Images of 64 rows have")
    print("8192 pixels; times include the check of the map.")
    print()
    print("## Images")
    print()
    print("| image | triangles | rows | sampling | threads | ms |")
    print("| --- | --: | --: | --- | --: | --: |")
    for name in runs:
        kind = name.split("/")[0]
        if kind in ("sni", "sgi", "sci"):
            a = arguments(name)
            print(f"| {kind} | {int(runs[name][0]['triangles'])} | {a['size']} | {SAMPLINGS[a['area']]} | {a['threads']} "
                  f"| {median(name):.2f} |")
        elif kind == "check_map":
            print(f"| check of the map | {int(runs[name][0]['triangles'])} | – | – | 1 | {median(name):.2f} |")
    print()
    print("## Transforms of three components, one thread")
    print()
    print("| rows | K | quadrature | fft | svd | quadrature / fft |")
    print("| --: | --: | --: | --: | --: | --: |")
    table = {}
    for name in runs:
        if name.startswith("transform/"):
            a = arguments(name)
            table.setdefault((a["size"], a["K"]), {})[ROUTES[a["route"]]] = median(name)
    for (size, K), row in sorted(table.items()):
        cells = [f"{row[route]:.3f}" if route in row else "–" for route in ROUTES]
        ratio = f"{row['quadrature'] / row['fft']:.0f}" if "quadrature" in row else "–"
        print(f"| {size} | {K} | " + " | ".join(cells) + f" | {ratio} |")
    print()
    print("The pseudo-inverse of `svd` is made once for a size and K:")
    print()
    print("| rows | K | matrix | ms |")
    print("| --: | --: | --- | --: |")
    for name in runs:
        if name.startswith("prepare_svd/"):
            a = arguments(name)
            print(f"| {a['size']} | {a['K']} | {2 * a['size'] ** 2} × {(a['K'] + 1) ** 2} | {median(name):.0f} |")
    print()
    print("## What the limit is")
    print()
    print("`area` integrates each edge exactly and costs by edges and the cells they cross: about ten elementary")
    print("functions an edge. `point` costs by triangles and pixels. With an FFT the transform is bound by the")
    print("n (K+1)²/2 products of Legendre functions, which are made anew for each row rather than kept: at these")
    print("sizes making them costs what reading them would. The plain sum multiplies that by the 2n columns.")


main()
