#!/usr/bin/python3
"""The work of scripts/segmentation-results.sh: runs the programs of a build folder, measures, and
writes docs/results/segmentation.md.

Dice and distances in samples are computed here with SciPy, apart from the program's own.
"""
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys

import nibabel
import numpy
from scipy import ndimage

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = pathlib.Path(sys.argv[1]).resolve()
WORK = ROOT / "build" / "segmentation"
RESULTS = ROOT / "docs" / "results"
DATA = os.environ.get("SHAPE3D_DATA")
PARTS = ["phantom", "nodules", "stability", "real", "boxes", "methods", "itk"]
NOISES = ["gaussian", "poisson", "rayleigh"]


def run(program, *arguments):
    """Standard output of a program of the build folder."""
    found = [p for p in BUILD.rglob(program) if p.is_file()]
    if not found:
        return None
    command = [str(found[0]), *map(str, arguments)]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        raise RuntimeError(" ".join(command) + "\n" + result.stderr)
    return result.stdout


def segment(volume, *arguments, name="run"):
    """Report of `shape3d segment` and the path of its label map."""
    labels, report = WORK / f"{name}.nii.gz", WORK / f"{name}.json"
    run("shape3d", "segment", volume, "-o", labels, "--json", report, "--quiet", *arguments)
    return json.loads(report.read_text()), labels


def samples(path):
    return numpy.asarray(nibabel.load(path).dataobj)


def surface(mask):
    """Samples of a mask beside one outside it; the border of the volume is no surface."""
    return mask & ~ndimage.binary_erosion(mask, border_value=1)


def dice_of(mask, truth):
    both = numpy.count_nonzero(mask & truth)
    return 2 * both / (numpy.count_nonzero(mask) + numpy.count_nonzero(truth))


def agreement(mask, truth):
    """Dice and the 95 % Hausdorff distance in samples."""
    mask, truth = mask.astype(bool), truth.astype(bool)
    dice = dice_of(mask, truth)
    a, b = surface(mask), surface(truth)
    if not a.any() or not b.any():
        return dice, None
    to_b, to_a = ndimage.distance_transform_edt(~b), ndimage.distance_transform_edt(~a)
    return dice, max(numpy.percentile(to_b[a], 95), numpy.percentile(to_a[b], 95))


def phantom(noise="gaussian", hu=25, seed=1):
    """Paths of image, tissue and labels, and the description of a phantom; made once."""
    name = f"phantom-{noise}-{hu}-{seed}"
    image, tissue, labels = (WORK / f"{name}{part}.nii.gz" for part in ("", "-tissue", "-labels"))
    description = WORK / f"{name}.description"
    if not description.exists():
        text = run("shape3d_lung_phantom_volume", image, "--tissue", tissue, "--labels", labels,
                   "--noise", noise, "--hu", hu, "--seed", seed)
        description.write_text(text)
    return image, tissue, labels, json.loads(description.read_text())


def part_phantom():
    rows = []
    for noise in NOISES:
        for hu in (25, 150):
            image, tissue, _, about = phantom(noise, hu)
            truth = samples(tissue) > 0
            plain = agreement(samples(image) >= about["half_level"], truth)
            report, labels = segment(image, name=f"out-{noise}-{hu}")
            ours = agreement(samples(labels) > 0, truth)
            rows.append({
                "noise": noise, "hu": hu, "plain": plain, "ours": ours,
                "level": report["calibration"]["levels"][0],
                "half_level": about["half_level"],
                "smoothing": report["model"]["smoothing"],
                "status": report["status"], "iterations": report["evolution"]["iterations"],
                "estimation": report["seconds"]["estimation"],
                "evolution": report["seconds"]["evolution"]})
            print(rows[-1], file=sys.stderr)
    return rows


def nodule_box(about, nodule, dims, margin=7):
    """A box of samples round a nodule."""
    spacing = about["spacing"]
    box = []
    for axis in range(3):
        reach = nodule["radius"] / spacing[0] + margin
        box += [max(0, int(nodule["centre"][axis] - reach)),
                min(dims[axis], int(nodule["centre"][axis] + reach) + 1)]
    return box


def part_nodules():
    rows = []
    for seed in (1, 2, 3):
        image, _, labels, about = phantom(seed=seed)
        truth = samples(labels)
        for nodule in about["nodules"]:
            box = nodule_box(about, nodule, truth.shape)
            name = f"nodule-{seed}-{nodule['label']}"
            dice = {}
            # By its box; by its radius, the box being the program's; and without the opening.
            region = ["--roi", ",".join(map(str, box))]
            for method, more in (("nodule", ["--nodule", *region]),
                                 ("sphere", ["--nodule", "--radius", f"{nodule['radius']:.2f}"]),
                                 ("connected", ["--keep-connected", "--classes", "2", *region])):
                middle = ",".join(f"{c:.2f}" for c in nodule["centre"])
                try:
                    _, path = segment(image, "--seed-point", middle, *more, name=name)
                except RuntimeError as error:
                    if "nothing is inside" not in str(error):
                        raise
                    dice[method] = 0.0
                    continue
                dice[method] = dice_of(samples(path) > 0, truth == nodule["label"])
            rows.append({"seed": seed, "kind": nodule["kind"], "radius": nodule["radius"], **dice})
            print(rows[-1], file=sys.stderr)
    return rows


def data(relative):
    path = pathlib.Path(DATA or "/nonexistent") / relative
    return path if path.exists() else None


def part_stability():
    rows = {}
    image = phantom()[0]
    cases = [("phantom", image, [], "Phantom, 25 HU of Gaussian noise")]
    chest = data("table31/T3_512x512x62_lungpetctdx-A0001.mhd")
    if chest:
        cases.append(("chest", chest, ["--roi", "110,400,120,500,0,62"], "Chest CT, region of 290 x 380 x 62"))
    for name, path, roi, title in cases:
        text = run("shape3d_segmentation_stability", path, *roi, "--picture",
                   RESULTS / f"stability-{name}.png", "--title", title)
        rows[name] = json.loads(text)
    return rows


REAL = [
    ("chest CT, lungs", "cip_ct-64_64x64x79", "cip_wholeLung-64_64x64x79_mask",
     ["--inside", "dark", "--classes", "2", "--roi", "2,63,7,54,5,78", "--seed-point", "15,30,40",
      "--keep-connected"]),
    *[("head MR, lateral ventricles", "itksnap_MRIcrop_78x110x64",
       "itksnap_MRIcrop_78x110x64_labels",
       ["--inside", "0", "--classes", "3", *scope, "--roi", "3,71,3,105,28,61", "--seed-point",
        "38,64,30", "--keep-connected", "--truth-label", "1,2,3,6"])
      for scope in ([], ["--no-calibration"], ["--max-scope", "0.15"])],
    ("sarcoma CT", "sts_STS_041_CT_153x163x53", "sts_STS_041_CT_153x163x53_GTV", []),
    ("sarcoma MR 002", "sts_STS_002_MR_115x90x35", "sts_STS_002_MR_115x90x35_GTV", []),
    ("sarcoma MR 003", "sts_STS_003_MR_121x138x47", "sts_STS_003_MR_121x138x47_GTV", []),
    ("sarcoma MR 041", "sts_STS_041_MR_90x109x45", "sts_STS_041_MR_90x109x45_GTV", []),
]


def part_real():
    rows = []
    for title, image, truth, options in REAL:
        path = data(f"truth/{image}.mhd")
        if not path:
            continue
        report, _ = segment(path, "--truth", data(f"truth/{truth}.mhd"), *options, name=image)
        rows.append({"title": title, "options": " ".join(options), "dims": report["input"]["dims"],
                     "status": report["status"], "volume": report["segmentation"]["volume"],
                     "truth_volume": report["truth"]["volume"], **report["agreement"]})
        print(rows[-1], file=sys.stderr)
    return rows


# Files whose slices are those of their series without the first.
BOXES = {"Lung_Dx-A0001": "table31/T3_512x512x62_lungpetctdx-A0001.mhd",
         "Lung_Dx-A0002": "table31/T2_512x512x28_lungpetctdx-A0002.mhd"}


def read_mhd(path):
    """Samples (x, y, z) of a MetaImage with a raw file."""
    header = dict(line.split(" = ", 1) for line in path.read_text().splitlines() if " = " in line)
    kinds = {"MET_SHORT": "<i2", "MET_UCHAR": "u1", "MET_USHORT": "<u2"}
    dims = [int(n) for n in header["DimSize"].split()]
    raw = numpy.fromfile(path.parent / header["ElementDataFile"].strip(),
                         kinds[header["ElementType"].strip()])
    return raw.reshape(dims, order="F")


def part_boxes():
    """The tumour boxes of two chest CTs: a region round all boxes of a patient, the component that
    holds the middle of the boxes' tumour, and the share of the boxes it is found in."""
    import csv
    table = data("annotations/lungpetctdx/boxes.csv")
    if not table:
        return None
    rows = list(csv.DictReader(table.open()))
    result = []
    for patient, file in BOXES.items():
        path = data(file)
        boxes = [[int(row[k]) for k in ("xmin", "ymin", "xmax", "ymax")] +
                 [int(row["slice_index_zsorted_full_series"]) - 1]
                 for row in rows if row["patient"] == patient]
        dims = read_mhd(path).shape
        low = [min(b[0] for b in boxes) - 12, min(b[1] for b in boxes) - 12,
               max(0, min(b[4] for b in boxes) - 1)]
        high = [max(b[2] for b in boxes) + 13, max(b[3] for b in boxes) + 13,
                min(dims[2], max(b[4] for b in boxes) + 2)]
        roi = ",".join(str(v) for axis in range(3) for v in (low[axis], high[axis]))
        _, labels = segment(path, "--roi", roi, "--classes", "2", name=f"boxes-{patient}")
        mask = samples(labels) > 0
        # A box holds a component when one covers a tenth of it or more.
        found = 0
        shares = []
        for x0, y0, x1, y1, z in boxes:
            if not 0 <= z < dims[2]:
                shares.append(0.0)
                continue
            part = mask[x0:x1 + 1, y0:y1 + 1, z]
            named, count = ndimage.label(part)
            largest = max((numpy.count_nonzero(named == n + 1) for n in range(count)), default=0)
            shares.append(largest / part.size)
            found += largest >= 0.1 * part.size
        result.append({"patient": patient, "file": file, "boxes": len(boxes), "found": found,
                       "roi": roi, "median_share": statistics.median(shares)})
        print(result[-1], file=sys.stderr)
    return result


def part_methods():
    """Combined, intensity and gradient side by side on the chest CT (Figs. 3.1, 3.3, 3.6)."""
    chest = data("table31/T3_512x512x62_lungpetctdx-A0001.mhd")
    image = chest or phantom()[0]
    roi = "110,190,200,280,14,42" if chest else "40,120,140,220,10,38"
    rows = []
    for method in ("combined", "intensity", "gradient"):
        plots = WORK / f"plots-{method}"
        # The dissertation's case: a model from too few iterations of stochastic EM.
        report, _ = segment(image, "--roi", roi, "--method", method, "--chain", 3, "--runs", 1,
                            "--seed", 3, "--plot", plots, name=f"method-{method}")
        for name in ("slices", "histogram", "overlap"):
            if (plots / f"{name}.png").exists():
                shutil.copy(plots / f"{name}.png", RESULTS / f"method-{method}-{name}.png")
        rows.append({"method": method, "status": report["status"],
                     "volume": report["segmentation"]["volume"],
                     "components": report["segmentation"]["components"],
                     "iterations": report["evolution"]["iterations"]})
        print(rows[-1], file=sys.stderr)
    return {"image": str(image.name), "roi": roi, "rows": rows}


def part_itk():
    text = run("shape3d_levelset_itk", "--threads", 1)
    return json.loads(text) if text else None


def load(part):
    path = WORK / f"part-{part}.json"
    return json.loads(path.read_text()) if path.exists() else None


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def number(value, digits):
    return "–" if value is None else f"{value:.{digits}f}"


def phantom_text(rows):
    return (
        "## Phantom\n\n"
        "290 × 380 × 62 samples: wall, lungs, trees of vessels, nodules; -800 HU in the lungs and\n"
        "0 HU in tissue, whose border is at -400 HU. Front: the box. Distances (95 % Hausdorff) in\n"
        "samples, computed by SciPy; threshold: the samples of -400 HU and more. Smoothing: the\n"
        "Gaussian that the noise asks for, in samples.\n\n" +
        table(["noise", "HU", "threshold: Dice", "HD95", "shape3d: Dice", "HD95",
               "calibrated level, HU", "smoothing", "iterations"],
              [[r["noise"], r["hu"], number(r["plain"][0], 4), number(r["plain"][1], 2),
                number(r["ours"][0], 4), number(r["ours"][1], 2), number(r["level"], 0),
                number(r["smoothing"], 2), r["iterations"]] for r in rows]))


def nodules_text(rows):
    lines = []
    for kind in dict.fromkeys(r["kind"] for r in rows):
        of = [r for r in rows if r["kind"] == kind]
        line = [kind, len(of)]
        for method in ("nodule", "sphere"):
            line += [number(statistics.mean(r[method] for r in of), 3),
                     number(min(r[method] for r in of), 3)]
        lines.append([*line, number(statistics.mean(r["connected"] for r in of), 3)])
    return ("## Nodules\n\n"
            "Three phantoms with 25 HU of noise. `--nodule` with `--seed-point` at the middle: in a\n"
            "region that is the nodule and 7 samples round it (`--roi`), and with `--radius` in the\n"
            "region that the program takes. Beside it `--keep-connected` with two classes in the first\n"
            "region, which keeps what the nodule touches. Dice with the nodule alone.\n\n" +
            table(["nodule", "number", "by region: Dice, mean", "least", "by radius: Dice, mean",
                   "least", "all that is connected, mean"], lines))


def stability_text(parts):
    lines = []
    for name, r in parts.items():
        with_, without = r["calibrated"], r["estimated"]
        lines.append([name, number(without["mean"], 1), number(without["deviation"], 3),
                      number(with_["mean"], 1), number(with_["deviation"], 3),
                      number(with_["deviation"] / without["deviation"], 3),
                      number(with_["range"] / without["range"], 3)])
    first = next(iter(parts.values()))
    return (f"## Stability\n\n{first['seeds']} seeds of stochastic EM with {first['chain']} iterations "
            f"and {first['classes']} classes, too few on purpose.\nVolumes inside in ml.\n\n" +
            table(["image", "as estimated: mean", "deviation", "calibrated: mean", "deviation",
                   "ratio of deviations", "ratio of ranges"], lines) +
            "".join(f"\n![Volume and level by seed, {name}](stability-{name}.png)\n"
                    for name in parts))


def real_text(rows):
    return ("## Volumes with outlines drawn by others\n\n" +
            "In the MR the boundary of grey and white matter is the strongest edge: with the default\n"
            "scope the level goes there. `--no-calibration` leaves it where the classes of the darkest\n"
            "and the next part, without knowledge of the outline. `--max-scope 0.15` was chosen knowing\n"
            "the outline: within it S(w) still rises, so that the level is that of its end, and the\n"
            "scope decides, not S(w); its Dice is what the method can reach there, not what it finds.\n\n" +
            table(["volume", "options", "status", "Dice", "HD95, mm", "mean distance, mm",
                   "volume / truth"],
                  [[r["title"], f"`{r['options']}`" if r["options"] else "", r["status"],
                    number(r["dice"], 3), number(r["hausdorff95"], 1),
                    number(r["mean_distance"], 2), number(r["volume"] / r["truth_volume"], 2)]
                   for r in rows]))


def boxes_text(rows):
    return ("## Tumour boxes\n\n"
            "Chest CT of Lung-PET-CT-Dx with boxes that physicians drew slice by slice. Region: all\n"
            "boxes of a patient and 12 samples round them, two classes. A box counts as found when\n"
            "one component covers a tenth of it or more.\n\n" +
            table(["patient", "boxes", "found", "median share of a box that the component covers"],
                  [[r["patient"], r["boxes"], f"{r['found']} ({100 * r['found'] / r['boxes']:.0f} %)",
                    number(r["median_share"], 2)] for r in rows]))


def methods_text(part):
    lines = [[r["method"], r["status"], r["iterations"], number(r["volume"] / 1000, 2), r["components"]]
             for r in part["rows"]]
    return (f"## Methods side by side\n\n`{part['image']}`, region {part['roi']}, a model from 3\n"
            "iterations of stochastic EM (Figs. 3.1, 3.3 and 3.6).\n\n" +
            table(["method", "status", "iterations", "volume, ml", "components"], lines) +
            "".join(f"\n{r['method']}:\n\n![Slices, {r['method']}](method-{r['method']}-slices.png)\n"
                    for r in part["rows"]))


def itk_text(r):
    ours, itk = r["shape3d"], r["itk"]
    return (f"## Beside ITK {itk['version']}\n\n"
            f"ThresholdSegmentationLevelSetImageFilter with the true level, the same start box, no\n"
            f"curvature, {r['threads']} thread, in the same process on the phantom "
            f"({' × '.join(map(str, r['dims']))}).\n\n" +
            table(["", "iterations", "evolution, s", "Dice", "HD95, samples"],
                  [["shape3d (median of 3)", ours["iterations"], number(ours["evolution"], 2),
                    number(ours["dice"], 4), number(ours["hausdorff95_samples"], 2)],
                   ["ITK", itk["iterations"], number(itk["evolution"], 1), number(itk["dice"], 4),
                    number(itk["hausdorff95_samples"], 2)]]) +
            f"\nITK takes {r['ratio_evolution']:.0f} times as long for the evolution; {r['ratio_total']:.0f} "
            "times as long as estimation and evolution together.\n")


def write_page():
    texts = []
    for part in PARTS:
        found = load(part)
        if found:
            texts.append(globals()[f"{part}_text"](found))
    head = ("# Segmentation: results\n\n"
            "Made by `scripts/segmentation-results.sh`; the real volumes are below `SHAPE3D_DATA`.\n"
            "[Times](../benchmarks/levelset.md) are on a page of their own.\n\n")
    (RESULTS / "segmentation.md").write_text(head + "\n".join(texts))


def main():
    WORK.mkdir(parents=True, exist_ok=True)
    for part in sys.argv[2:] or PARTS:
        if part not in PARTS:
            sys.exit(f"segmentation-results: unknown part '{part}', expected " + ", ".join(PARTS))
        result = globals()[f"part_{part}"]()
        if result is not None:
            (WORK / f"part-{part}.json").write_text(json.dumps(result, indent=1))
    write_page()


if __name__ == "__main__":
    main()
