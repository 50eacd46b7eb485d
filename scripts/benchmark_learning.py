#!/usr/bin/python3
"""Searches a grid beside svm-train, and makes docs/benchmarks/learning.md.

usage: benchmark_learning.py grid FOLDER SVM_GRID_PROGRAM AT_ONCE   writes FOLDER/grid-AT_ONCE.json
       benchmark_learning.py page FOLDER                           of these and FOLDER/times.json
"""
import json
import os
import re
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

step, work = sys.argv[1:3]
GRID = [(2.0 ** c, 2.0 ** g) for c in range(15, -6, -2) for g in range(3, -16, -2)]


def one(pair):
    command = ["svm-train", "-q", "-v", "5", "-c", repr(pair[0]), "-g", repr(pair[1]), os.path.join(work, "set")]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return float(re.search(r"Accuracy = ([\d.]+)%", text)[1]) / 100


def search(program, at_once):
    command = [program, os.path.join(work, "set"), str(at_once)]
    ours = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    start = time.monotonic()
    with ThreadPoolExecutor(at_once) as pool:
        rates = list(pool.map(one, GRID))
    seconds = time.monotonic() - start
    best = max(range(len(GRID)), key=lambda i: rates[i])
    theirs = {"seconds": seconds, "C": GRID[best][0], "gamma": GRID[best][1], "rate": rates[best]}
    with open(os.path.join(work, f"grid-{at_once}.json"), "w", encoding="utf-8") as file:
        json.dump({"ours": ours, "svm-train": theirs}, file)


if step == "grid":
    search(sys.argv[3], int(sys.argv[4]))
    sys.exit()

with open(os.path.join(work, "times.json"), encoding="utf-8") as file:
    report = json.load(file)
context = report["context"]
medians = {}
for run in report["benchmarks"]:
    if run.get("aggregate_name") == "median":
        medians[re.sub(r"(/real_time|_median|/repeats:\d+)", "", run["name"])] = run["real_time"]

print("# Times of maps and machines\n")
print("`scripts/benchmark-learning.sh` writes this page.\n")
with open("/proc/cpuinfo", encoding="utf-8") as file:
    model = next(line.split(":", 1)[1].strip() for line in file if line.startswith("model name"))
print(f"{model}, {context['num_cpus']} processors, load {context['load_avg'][0]:.1f} at the start. Medians of 3 runs, "
      "milliseconds.\n")

print("## Self-organizing map, 12 × 6, 50 epochs\n")
print("| training | vectors | numbers | threads | ms |\n|:--|--:|--:|--:|--:|")
for name, value in medians.items():
    match = re.fullmatch(r"som/(\w+)/threads:(\d+)/items:(\d+)/numbers:(\d+)", name)
    if match:
        print(f"| {match[1]} | {match[3]} | {match[4]} | {match[2]} | {value:.0f} |")
print("\n## Other steps\n")
print("| step | threads | ms |\n|:--|--:|--:|")
for threads in (1, 2):
    print(f"| best units of 10 000 vectors of 306 numbers among 72 | {threads} | {medians[f'units/threads:{threads}']:.1f} |")
for count in (72, 1000):
    print(f"| agglomeration of {count} vectors of 306 numbers | 1 | {medians[f'agglomerate_units/items:{count}']:.1f} |")
print("| training an SVM, 907 vectors of 45 numbers, 12 classes | 1 | "
      f"{medians['svm_training/plain/threads:1']:.0f} |")
for threads in (1, 2):
    print("| the same with probabilities | "
          f"{threads} | {medians[f'svm_training/with_probabilities/threads:{threads}']:.0f} |")
for threads in (1, 2):
    print(f"| predicting the 907 | {threads} | {medians[f'svm_prediction/threads:{threads}']:.1f} |")

print("\n## Grid search\n")
print(f"C = 2^−5 … 2^15 with γ = 2^−15 … 2^3, {len(GRID)} pairs, five-fold cross-validation of 400 generated vectors of "
      "45 numbers in 5 classes, beside `svm-train -v 5` of libsvm, called once for each pair, as its grid.py does. One "
      "run of each, the second right after the first. Folds differ, so the best pair may, too.\n")
print("| at once | Shape3D s | svm-train s | ratio | Shape3D best C, γ, rate | svm-train best |\n|--:|--:|--:|--:|:--|:--|")
for count in (1, 2):
    with open(os.path.join(work, f"grid-{count}.json"), encoding="utf-8") as file:
        runs = json.load(file)
    mine, other = runs["ours"], runs["svm-train"]
    texts = [f"{r['C']:g}, {r['gamma']:g}, {100 * r['rate']:.1f} %" for r in (mine, other)]
    print(f"| {count} | {mine['seconds']:.2f} | {other['seconds']:.2f} | {mine['seconds'] / other['seconds']:.2f} "
          f"| {texts[0]} | {texts[1]} |")
