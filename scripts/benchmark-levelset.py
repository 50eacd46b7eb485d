#!/usr/bin/python3
"""Times of `shape3d segment` on a phantom and a chest CT, and of ITK's filter beside the library.

    scripts/benchmark-levelset.py [times] [curvature] [limit] [itk]
                               measures and writes docs/benchmarks/levelset.md; a part that is not
                               named keeps its last run; without any name all are measured
    SHAPE3D_BUILD=<folder>     a build with SHAPE3D_BUILD_BENCHMARKS=ON (default build/bench)
    SHAPE3D_DATA=<folder>      with table31/T3_512x512x62_lungpetctdx-A0001.mhd: adds the chest CT
    SHAPE3D_NOTE=<text>        said of the machine, for example that it was busy
    SHAPE3D_ROUNDS=<number>    of which the medians are taken (default 3)
    SHAPE3D_ITK=<size>         a cube of so many samples for the run beside ITK, which takes minutes
                               on the whole phantom (the default)
"""
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = pathlib.Path(os.environ.get("SHAPE3D_BUILD", ROOT / "build" / "bench"))
CHEST = pathlib.Path(os.environ.get("SHAPE3D_DATA", "/nonexistent")) / \
    "table31/T3_512x512x62_lungpetctdx-A0001.mhd"
WORK = ROOT / "build" / "levelset-benchmark"
ITK_SIZE = os.environ.get("SHAPE3D_ITK")
ITK_STEPS = 2000
ROUNDS = int(os.environ.get("SHAPE3D_ROUNDS", "3"))


def program(name):
    found = [p for p in BUILD.rglob(name) if p.is_file()]
    if not found:
        sys.exit(f"benchmark-levelset: {name} is not in {BUILD}; build it there")
    return str(found[0])


def segment(folder, volume, threads, *options):
    """Medians of estimation and evolution in seconds, steps, and the peak of memory in MiB."""
    runs = []
    for _ in range(ROUNDS):
        process = subprocess.Popen(
            [program("shape3d"), "segment", volume, "-o", folder / "l.nrrd", "--json",
             folder / "r.json", "--quiet", "--threads", str(threads), *options])
        _, status, usage = os.wait4(process.pid, 0)
        if status != 0:
            sys.exit("benchmark-levelset: shape3d segment failed")
        report = json.loads((folder / "r.json").read_text())
        runs.append((report["seconds"]["estimation"], report["seconds"]["evolution"],
                     report["evolution"]["iterations"], usage.ru_maxrss / 1024))
    return [statistics.median(column) for column in zip(*runs)]


def measure(threads, *options):
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        phantom = folder / "phantom.nii"
        subprocess.run([program("shape3d_lung_phantom_volume"), phantom, "--noise", "gaussian",
                        "--hu", "25", "--seed", "1"], check=True, stdout=subprocess.DEVNULL)
        cases = [("phantom", phantom, [])]
        if CHEST.exists():
            cases.append(("chest CT", CHEST, ["--roi", "110,400,120,500,0,62"]))
        for title, volume, region in cases:
            for count in threads:
                rows.append((title, count, *segment(folder, volume, count, *region, *options)))
                print(*rows[-1], file=sys.stderr, flush=True)
    return {"rounds": ROUNDS, "rows": rows}


def times():
    return measure((1, 2))


def curvature():
    return measure((2,), "--curvature", "0.05")


def limit():
    """Computed nodes and time of the evolution at one thread, and the rate of a copy."""
    text = subprocess.run([program("shape3d_levelset_bench"), "--benchmark_format=json",
                           "--benchmark_filter=copy|evolution/(phantom|real)/.*threads:1/"],
                          check=True, stdout=subprocess.PIPE, text=True).stdout
    found = {}
    for run in json.loads(text)["benchmarks"]:
        if run["name"] == "copy":
            found["copy"] = run["bytes_per_second"]
        elif not run.get("error_occurred"):
            found[run["name"].split("/")[1]] = {"nodes": run["nodes"],
                                                "seconds": run["real_time"] / 1000}
    return found


def itk():
    size = ["--size", ITK_SIZE] if ITK_SIZE else []
    text = subprocess.run([program("shape3d_levelset_itk"), "--threads", "1", "--rounds",
                           str(ROUNDS), "--iterations", str(ITK_STEPS), *size], check=True,
                          stdout=subprocess.PIPE, text=True).stdout
    return {"rounds": ROUNDS, "limit": ITK_STEPS, **json.loads(text)}


def main():
    WORK.mkdir(parents=True, exist_ok=True)
    parts = {"times": times, "curvature": curvature, "limit": limit, "itk": itk}
    for name in sys.argv[1:]:
        if name not in parts:
            sys.exit(f"benchmark-levelset: {name}: expected some of {', '.join(parts)}")
    found = {}
    for name, run in parts.items():
        file = WORK / f"{name}.json"
        if name in sys.argv[1:] or len(sys.argv) == 1:
            file.write_text(json.dumps(run(), indent=1))
        found[name] = json.loads(file.read_text()) if file.exists() else None
    write_page(found)


def medians(part):
    return "single runs" if part["rounds"] == 1 else f"medians of {part['rounds']}"


def rows_text(part):
    text = ("| region | threads | estimation, s | evolution, s | steps | peak, MiB |\n"
            "| --- | --- | --- | --- | --- | --- |\n")
    for title, threads, estimation, evolution, steps, peak in part["rows"]:
        text += (f"| {title} | {threads} | {estimation:.2f} | {evolution:.2f} | {steps:.0f} | "
                 f"{peak:.0f} |\n")
    return text


def write_page(found):
    cpu = next((line.split(":", 1)[1].strip() for line in open("/proc/cpuinfo")
                if line.startswith("model name")), "")
    note = os.environ.get("SHAPE3D_NOTE")
    text = f"""# Time of the segmentation

`scripts/benchmark-levelset.py` writes this page: {cpu}, {os.cpu_count()} processors{'; ' + note if note else ''}.

"""
    if found["times"]:
        text += f"""`shape3d segment` with three classes on regions of 290 × 380 × 62 samples of 16 bits, from the box;
{medians(found['times'])}. Estimation is all before the evolution; the peak is that of the whole process, with
the volume that it read and the label map that it wrote. Steps are those on all grids.

{rows_text(found['times'])}"""
    if found["curvature"]:
        text += f"""
## With curvature

`--curvature 0.05`, minimal; {medians(found['curvature'])}.

{rows_text(found['curvature'])}"""
    if found["limit"]:
        text += limit_text(found["limit"])
    if found["itk"]:
        text += itk_text(found["itk"])
    (ROOT / "docs" / "benchmarks" / "levelset.md").write_text(text)


def limit_text(found):
    copy = found["copy"]
    text = f"""
## What limits the evolution

One thread. A node that is computed costs some 20 bytes a step: 12 for the step itself (ψ and F read, ψ
written), 8 for its share of the distances that are made again every fourth step. A copy of 64 MiB in the
same run moves {copy / 1e9:.1f} GB/s.

| region | nodes × steps, 10⁶ | evolution, s | ns a node and step | GB/s | share of the copy |
| --- | --- | --- | --- | --- | --- |
"""
    for name, title in (("phantom", "phantom"), ("real", "chest CT")):
        if name not in found:
            continue
        nodes, seconds = found[name]["nodes"], found[name]["seconds"]
        rate = 20 * nodes / seconds
        text += (f"| {title} | {nodes / 1e6:.0f} | {seconds:.2f} | {1e9 * seconds / nodes:.1f} | "
                 f"{rate / 1e9:.2f} | {100 * rate / copy:.0f} % |\n")
    return text + """
The rate of memory is not the limit (nor is its latency: fetching rows ahead gains nothing). The time, that of
starting and of going from grid to grid included, goes into arithmetic (square roots, divisions and minima, eight
nodes at a time) and into finding the rows and tiles to compute; docs/notes/levelset.md has the shares.
"""


def itk_text(itk):
    ours, other = itk["shape3d"], itk["itk"]
    per_step = (other["evolution"] / other["iterations"]) / (ours["evolution"] / ours["iterations"])
    limited = other["iterations"] >= itk["limit"]
    text = f"""
## Beside ITK {other['version']}

ThresholdSegmentationLevelSetImageFilter with the true level, which it is given, and no curvature; both start
from the box one sample within the border (ITK needs zero crossings between samples). One thread, processor
seconds, in one process, on a phantom of {' × '.join(map(str, itk['dims']))} samples; the library: {medians(itk)}, ITK: one run,
{'stopped after ' + str(itk['limit']) + ' steps, before it came to rest' if limited else f"to rest (RMS change {other['rms']:.4f})"}. ITK's front changed {100 * other['moved']:.0f} % of the samples; the Dice of both
results with each other is {itk['dice_of_both']:.4f}.

| | steps | evolution, s | ms a step | Dice | HD95, samples |
| --- | --- | --- | --- | --- | --- |
"""
    for title, r in (("shape3d", ours), ("ITK", other)):
        text += (f"| {title} | {r['iterations']} | {r['evolution']:.2f} | "
                 f"{1000 * r['evolution'] / r['iterations']:.1f} | {r['dice']:.4f} | "
                 f"{r['hausdorff95_samples']:.2f} |\n")
    text += (f"\nITK takes {itk['ratio_evolution']:.0f} times as long for the evolution"
             f"{', as far as it came' if limited else ''}, {per_step:.0f} times as long a step, and "
             f"{itk['ratio_total']:.0f} times\nas long as estimation and evolution together.\n")
    return text


if __name__ == "__main__":
    main()
