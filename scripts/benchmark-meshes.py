#!/usr/bin/python3
"""Makes the tables of docs/benchmarks/meshes.md from results of shape3d_mesh_bench (JSON)."""
import json
import math
import pathlib
import re
import statistics
import subprocess
import sys

TARGETS = {"collapse/quadrics": 50e3, "collapse/lindstrom_turk": 50e3, "collapse/hoppe": 50e3,
           "refine": 200e3, "refine_and_copy": 200e3, "decode": 200e3}
WHAT = {"align_body": "pose", "inspect_body": "inspection", "curvature_of_body": "curvature",
        "collapse/quadrics": "collapses, quadrics",
        "collapse/lindstrom_turk": "collapses, Lindstrom and Turk",
        "collapse/hoppe": "collapses, Hoppe's energy",
        "refine": "splits", "refine_and_copy": "splits, and V and F copied",
        "encode": "to bytes", "decode": "from bytes"}
ITEMS = {"align_body": "triangles", "inspect_body": "triangles", "curvature_of_body": "vertices"}


def cpu():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown"


def runs_of(path):
    """Seconds, items a second and counters of each benchmark and size, over the repetitions."""
    groups = {}
    for run in json.loads(pathlib.Path(path).read_text())["benchmarks"]:
        if run.get("run_type") != "iteration":
            continue
        name = re.sub(r"/(level:\d+|iterations:\d+|repeats:\d+)", "", run["name"])
        key = (name, int(run["triangles"]))
        groups.setdefault(key, []).append(run)
    return groups


def number(x):
    for size, letter in ((1e6, "M"), (1e3, "k")):
        if x >= size:
            return f"{x / size:.3g} {letter}"
    return f"{x:.3g}"


def table(path):
    print("| what | triangles | ms, median [quartiles] | per second | of the target | bytes/vertex |")
    print("|:--|--:|--:|--:|--:|--:|")
    for (name, triangles), runs in runs_of(path).items():
        times = sorted(run["real_time"] for run in runs)
        quartiles = statistics.quantiles(times, n=4) if len(times) > 1 else [times[0]] * 3
        rate = statistics.median(run["items_per_second"] for run in runs)
        items = ITEMS.get(name, "splits" if name in ("refine", "refine_and_copy", "encode", "decode")
                          else "collapses")
        target = f"{rate / TARGETS[name]:.2f}" if name in TARGETS else ""
        size = f"{runs[0]['bytes/vertex']:.1f}" if "bytes/vertex" in runs[0] else ""
        print(f"| {WHAT[name]} | {triangles} | {statistics.median(times):.3g} "
              f"[{quartiles[0]:.3g}, {quartiles[2]:.3g}] | {number(rate)} {items} | {target} | {size} |")
    print()


def main():
    context = json.loads(pathlib.Path(sys.argv[1]).read_text())["context"]
    compiler = subprocess.run(["c++", "--version"], capture_output=True, text=True,
                              check=True).stdout.splitlines()[0]
    print(f"""# Meshes: pose, inspection, curvature, levels of detail

Written by `scripts/benchmark-meshes.sh`, which runs everything again.

- Processor: {cpu()}, {context["num_cpus"]} threads; load at the start {context["load_avg"][0]:.1f}. Build: {compiler}, release.
- One thread. Figures are medians of three repetitions; quartiles in brackets.
- Collapses go down to a hundredth of the triangles. Targets: 50 000 collapses and 200 000 splits a second.
- The limit of the collapses is CGAL's edge_collapse: after each it collects the edges of all neighbours in a
  std::set and asks for their costs anew, about thirty, of which a quadric changes six (the others are kept).
  Of the time 14 % goes into quadrics' costs, 7 % into eigenvalues, the rest into that.
- Vertices and triangles as doubles and 32-bit numbers are 48 bytes a vertex.
""")
    for path in sys.argv[1:]:
        name = pathlib.Path(path).stem
        print("## A sphere with bumps\n" if name == "generated" else f"## {name}\n")
        table(path)
    growth = {}
    for (name, triangles), runs in runs_of(sys.argv[1]).items():
        growth.setdefault(name, []).append(
            (triangles, statistics.median(run["real_time"] for run in runs)))
    print("## Growth\n\nPower of the number of triangles between the smallest and the largest body "
          "above.\n\n| what | power |\n|:--|--:|")
    for name, points in growth.items():
        (n0, t0), (n1, t1) = points[0], points[-1]
        print(f"| {WHAT[name]} | {math.log(t1 / t0) / math.log(n1 / n0):.2f} |")


if __name__ == "__main__":
    main()
