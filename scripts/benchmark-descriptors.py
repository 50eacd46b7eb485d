#!/usr/bin/python3
"""Makes docs/benchmarks/descriptors.md of the JSON of shape3d_descriptors_bench: medians of real time."""
import json
import re
import sys

with open(sys.argv[1], encoding="utf-8") as file:
    report = json.load(file)
context = report["context"]
medians = {}
for run in report["benchmarks"]:
    single = run.get("run_type") == "iteration"  # one iteration has no aggregates
    if run.get("aggregate_name") == "median" or single:
        name = re.sub(r"(/real_time|_median|/repeats:\d+|/iterations:\d+)", "", run["name"])
        medians.setdefault(name, (run["real_time"], run.get("triangles")))

print("# Times of the descriptors of solid space\n")
print("`scripts/benchmark-descriptors.sh` writes this page.\n")
with open("/proc/cpuinfo", encoding="utf-8") as file:
    model = next(line.split(":", 1)[1].strip() for line in file if line.startswith("model name"))
print(f"{model}, {context['num_cpus']} processors, load {context['load_avg'][0]:.1f} at the start. Medians of 5 "
      "runs, milliseconds.\n")

body = next(count for name, (_, count) in medians.items() if name.startswith("describe/"))
print(f"## One mesh of {body:.0f} triangles, 64³\n")
print("Voxels, transform and invariants; a generated body of about the number of triangles of the median model of the "
      "Princeton Shape Benchmark.\n")
print("| descriptor | 1 thread | 2 threads | ratio |\n|:--|--:|--:|--:|")
for name, (time, _) in medians.items():
    match = re.fullmatch(r"describe/(\w+)/threads:1", name)
    if match:
        two = medians[f"describe/{match[1]}/threads:2"][0]
        print(f"| {match[1].replace('_', ' ')} | {time:.2f} | {two:.2f} | {time / two:.2f} |")


def growth(title, pattern, head):
    print(f"\n## {title}\n\n| {head} | ms |\n|:--|--:|")
    for name, (time, triangles) in medians.items():
        match = re.fullmatch(pattern, name)
        if match:
            label = " ".join(match.groups())
            if triangles:
                label = f"{match[1]}, {triangles:.0f}"
            print(f"| {label} | {time:.2f} |")


growth("Voxels by the number of triangles, 64³, 1 thread", r"voxelize_triangles/(\w+)/\d+", "voxels, triangles")
growth("The whole by the side of the grid, K = 3, 1 thread", r"whole_side/(\w+)/(\d+)", "voxels, side")
growth("The transform by degree, 64³, 1 thread", r"transform_degree/K:(\d+)", "K")
growth("Preparation, once for all meshes", r"(svd|voxel)_preparation(?:/K:(?:\d+))?", "route")
if len(sys.argv) > 2:
    with open(sys.argv[2], encoding="utf-8") as file:
        print("\n" + file.read(), end="")
