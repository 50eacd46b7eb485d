#!/usr/bin/python3
"""Times of `shape3d segment` on a phantom and a chest CT, and of ITK's filter beside the library.

    scripts/benchmark-levelset.py [times] [itk]    measures and writes docs/benchmarks/levelset.md;
                               a part that is not named keeps its last run; both without
    SHAPE3D_BUILD=<folder>     a build with SHAPE3D_BUILD_BENCHMARKS=ON (default build/bench)
    SHAPE3D_DATA=<folder>      with table31/T3_512x512x62_lungpetctdx-A0001.mhd: adds the chest CT
    SHAPE3D_NOTE=<text>        said of the machine, for example that it was busy
    SHAPE3D_ITK="SLICES STEPS" of the run beside ITK (default 62 1000, which takes minutes)
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
SLICES, STEPS = os.environ.get("SHAPE3D_ITK", "62 1000").split()
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


def times():
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        phantom = folder / "phantom.nii"
        subprocess.run([program("shape3d_lung_phantom_volume"), phantom, "--noise", "gaussian",
                        "--hu", "25", "--seed", "1"], check=True, stdout=subprocess.DEVNULL)
        cases = [("phantom", phantom, [])]
        if CHEST.exists():
            cases.append(("chest CT", CHEST, ["--roi", "110,400,120,500,0,62"]))
        for title, volume, options in cases:
            for threads in (1, 2):
                rows.append((title, threads, *segment(folder, volume, threads, *options)))
                print(*rows[-1], file=sys.stderr, flush=True)
    return {"rounds": ROUNDS, "rows": rows}


def itk():
    text = subprocess.run([program("shape3d_levelset_itk"), "--threads", "1", "--rounds",
                           str(ROUNDS), "--slices", SLICES, "--iterations", STEPS], check=True,
                          stdout=subprocess.PIPE, text=True).stdout
    return {"rounds": ROUNDS, "limit": int(STEPS), **json.loads(text)}


def main():
    WORK.mkdir(parents=True, exist_ok=True)
    found = {}
    for name, measure in (("times", times), ("itk", itk)):
        file = WORK / f"{name}.json"
        if name in sys.argv[1:] or len(sys.argv) == 1:
            file.write_text(json.dumps(measure(), indent=1))
        found[name] = json.loads(file.read_text()) if file.exists() else None
    write_page(found["times"], found["itk"])


def write_page(measured, beside):
    cpu = next((line.split(":", 1)[1].strip() for line in open("/proc/cpuinfo")
                if line.startswith("model name")), "")
    note = os.environ.get("SHAPE3D_NOTE")
    text = f"""# Time of the segmentation

`scripts/benchmark-levelset.py` writes this page: {cpu}, {os.cpu_count()} processors{'; ' + note if note else ''}.

`shape3d segment` with three classes on regions of 290 × 380 × 62 samples of 16 bits, from the box;
{'single runs' if measured['rounds'] == 1 else f"medians of {measured['rounds']}"}. Estimation is all before the evolution; the peak is that of the whole process, with the volume that it
read and the label map that it wrote.

| region | threads | estimation, s | evolution, s | steps | peak, MiB |
| --- | --- | --- | --- | --- | --- |
"""
    for title, threads, estimation, evolution, steps, peak in measured["rows"]:
        text += f"| {title} | {threads} | {estimation:.2f} | {evolution:.2f} | {steps:.0f} | {peak:.0f} |\n"
    if beside:
        text += itk_text(beside)
    (ROOT / "docs" / "benchmarks" / "levelset.md").write_text(text)


def itk_text(itk):
    ours, other = itk["shape3d"], itk["itk"]
    per_step = (other["evolution"] / other["iterations"]) / (ours["evolution"] / ours["iterations"])
    limited = other["iterations"] >= itk["limit"]
    text = f"""
## Beside ITK {other['version']}

ThresholdSegmentationLevelSetImageFilter with the true level (which it is given), the same start box and
no curvature, one thread, in one process with the library, on a phantom of
{' × '.join(map(str, itk['dims']))} samples; at most {itk['limit']} steps{', which it used up before it came to rest' if limited else ''}.

| | steps | evolution, s | ms a step | Dice | HD95, samples |
| --- | --- | --- | --- | --- | --- |
"""
    for title, r in (("shape3d", ours), ("ITK", other)):
        text += (f"| {title} | {r['iterations']} | {r['evolution']:.2f} | "
                 f"{1000 * r['evolution'] / r['iterations']:.1f} | {r['dice']:.4f} | "
                 f"{r['hausdorff95_samples']:.2f} |\n")
    text += (f"\nITK takes {per_step:.1f} times as long a step, {itk['ratio_evolution']:.1f} times as long for the "
             f"evolution{' as far as it came' if limited else ''}, and\n{itk['ratio_total']:.1f} times as long as "
             "estimation and evolution together.\n")
    return text


if __name__ == "__main__":
    main()
