#!/usr/bin/python3
"""Makes docs/results/coarse-to-fine.md; see coarse-to-fine.sh.

    coarse_to_fine.py BUILD DATA WORK
"""
import json
import os
import pathlib
import shlex
import subprocess
import sys

import numpy as np

build, data, work = (pathlib.Path(x).resolve() for x in sys.argv[1:4])
shape3d, bench = build / "apps/shape3d/shape3d", build / "benchmarks/shape3d_search_bench"
runner = shlex.split(os.environ.get("SHAPE3D_BENCH_RUNNER", ""))
SHORTLISTS = (20, 50, 100, 200)
TOP = 10


def describe(name, files, spec):
    """Vectors of the files, and milliseconds a mesh (wall, all processors); kept for the next run."""
    table, report = work / f"{name}.npy", work / f"{name}.json"
    if not (table.exists() and report.exists()):
        print(name, file=sys.stderr, flush=True)
        listing = work / f"{name}.txt"
        listing.write_text("".join(f"{f}\n" for f in files))
        table.unlink(missing_ok=True)
        subprocess.run(runner + list(map(str, [shape3d, "describe", "--list", listing, "--descriptor", spec, "-o", table,
                                               "--json", report, "--quiet", "--keep-going"])), check=True,
                       stderr=subprocess.DEVNULL)
    told, rows = json.loads(report.read_text()), np.load(table)
    vectors = rows[rows.dtype.names[3]]
    return rows["file"].tolist(), vectors, 1e3 * told["seconds"] / max(1, told["described"])


def bench_of(name):
    """Milliseconds of a query among 100 000 such vectors, two threads."""
    kept = work / f"{name}.bench.json"
    if not kept.exists():
        kept.write_bytes(subprocess.run(runner + list(map(str, [bench, work / f"{name}.npy", 100000])),
                                        stdout=subprocess.PIPE, check=True).stdout)
    return json.loads(kept.read_text())["exact"]["2"]["median_ms"]


def ranking(vectors):
    """Of each row the others by distance."""
    squares = (vectors ** 2).sum(1)
    distances = squares[:, None] + squares[None, :] - 2 * vectors @ vectors.T
    np.fill_diagonal(distances, -1)
    return np.argsort(distances, axis=1, kind="stable")[:, 1:]


def recalls(coarse, fine):
    """Shares of the fine nearest TOP, and of the fine nearest one, that the shortlists hold."""
    fine, coarse = ranking(fine)[:, :TOP], ranking(coarse)
    return [(np.mean([np.isin(f, c[:n]).mean() for f, c in zip(fine, coarse)]),
             np.mean([f[0] in c[:n] for f, c in zip(fine, coarse)])) for n in SHORTLISTS]


def cells(values):
    return " | ".join(f"{100 * ten:.1f} / {100 * one:.1f}" for ten, one in values)


print("# Search from coarse to fine\n")
print("`scripts/coarse-to-fine.sh` writes this page. Section 4.4 of the dissertation has a coarse mesh and a short vector (a small K) "
      "for a first look, a dense mesh and a long vector for the second; it gives no figures. Here each model looks for the others: "
      "by coarse vectors for a shortlist, then among it by fine vectors. *Recall*: the share of the 10 nearest by fine vectors that "
      "are still found / how often the nearest one is, percent. `shape3d search --coarse SPEC --shortlist N` is such a search.\n")
heads = " | ".join(f"recall, {n}" for n in SHORTLISTS)

# Hyperspherical harmonics on the Princeton training half.
files = sorted((data / "psb/db").rglob("*.off"))
fine_spec = "hsh:K=15,invariants=roots,power=0.5"
names, fine, fine_ms = describe("psb_fine", files, fine_spec)
scan = bench_of("psb_fine")
print(f"## Princeton Shape Benchmark, training half, {len(names)} models\n")
print(f"Fine: `{fine_spec}`, {fine.shape[1]} numbers, 64³ voxels; {fine_ms:.1f} ms a mesh to describe; a query among 100 000 "
      f"vectors takes {scan:.2f} ms.\n")
print(f"| coarse | numbers | describe, ms a mesh | time won in describing | a query among 100 000, ms | time won in the query | {heads} |")
print("|:--|--:|--:|--:|--:|--:|" + "--:|" * len(SHORTLISTS))
for spec in ("hsh:K=2,voxels=16", "hsh:K=3,voxels=16", "hsh:K=4,voxels=32", "hsh:K=8,voxels=32", "hsh:K=8"):
    name = "psb_" + "".join(c if c.isalnum() else "_" for c in spec)
    coarse_names, coarse, ms = describe(name, files, spec)
    assert coarse_names == names
    query = bench_of(name)
    print(f"| `{spec}` | {coarse.shape[1]} | {ms:.2f} | {fine_ms / ms:.1f} × | {query:.2f} | {scan / query:.0f} × | "
          f"{cells(recalls(coarse, fine))} |")
print("\nTime won in describing is that of a collection whose models are described finely only when they come to a shortlist; of a "
      "query, that of comparing all models by coarse vectors instead of fine ones. The shortlist itself costs nothing beside it: "
      f"100 distances of {fine.shape[1]} numbers take less than 0.1 ms.\n")

# Spherical normal images: the mesh gets coarser, too.
dense = sorted((data / "shrec11_500").glob("*/train/*.obj"))
coarse_folders = {}
for target in (100, 200):
    folder = work / f"shrec_{target}"
    folder.mkdir(exist_ok=True)
    for mesh in dense:
        out = folder / (mesh.stem + ".off")
        if not out.exists():
            subprocess.run(list(map(str, [shape3d, "simplify", mesh, "-o", out, "--triangles", target, "--cost", "hoppe", "--quiet"])),
                           stderr=subprocess.DEVNULL, check=False)
    coarse_folders[target] = folder
fine_spec = "sni:K=16,form=roots"
names, fine, fine_ms = describe("shrec_fine", dense, fine_spec)
place = {pathlib.Path(f).stem: i for i, f in enumerate(names)}
print(f"## SHREC'11, {len(names)} non-rigid models, spherical normal images\n")
print(f"Fine: `{fine_spec}`, {fine.shape[1]} numbers, of meshes of 500 triangles, {fine_ms:.1f} ms a mesh (with the spherical map). Meshes "
      "that have no spherical map (genus above 0) are left out; coarse meshes are made by collapsing edges by Hoppe's energy (progressive "
      "meshes). Most bodies with thin limbs have no map when only 100 or 200 triangles are left of them: those rows are about the few models "
      "that have, and a shortlist that holds half of them or more says little. The gain in time is in the map, of which the coarse mesh has less.\n")
print(f"| coarse | triangles | numbers | models | describe, ms a mesh | time won | {heads} |")
print("|:--|--:|--:|--:|--:|--:|" + "--:|" * len(SHORTLISTS))
for target, spec in ((100, "sni:K=4,form=roots"), (200, "sni:K=4,form=roots"), (200, "sni:K=8,form=roots"), (500, "sni:K=4,form=roots"),
                     (500, "sni:K=8,form=roots")):
    meshes = sorted(coarse_folders[target].glob("*.off")) if target != 500 else dense
    name = f"shrec_{target}_" + "".join(c if c.isalnum() else "_" for c in spec)
    found, coarse, ms = describe(name, meshes, spec)
    both = [(i, place[pathlib.Path(f).stem]) for i, f in enumerate(found) if pathlib.Path(f).stem in place]
    rows, fine_rows = [i for i, _ in both], [j for _, j in both]
    print(f"| `{spec}` | {target} | {coarse.shape[1]} | {len(both)} | {ms:.1f} | {fine_ms / ms:.1f} × | "
          f"{cells(recalls(coarse[rows], fine[fine_rows]))} |")
