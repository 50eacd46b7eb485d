#!/usr/bin/python3
"""Measures of retrieval from vectors, independently of the library: evaluate_measures.py CLA VECTORS.h5
prints a JSON object. The L1 distance of the first set; ids are the numbers in the names of the files."""
import json
import re
import sys

import h5py
import numpy as np


def classes_of(path):
    of, label = {}, -1
    for line in open(path).read().splitlines()[2:]:
        words = line.split()
        if len(words) == 3:
            label += 1
        elif len(words) == 1:
            of[words[0]] = label
    return of


def main(cla, table):
    of = classes_of(cla)
    with h5py.File(table) as file:
        paths = [p.decode() for p in file["file"]]
        vectors = next(iter(file["vectors"].values()))[:]
    ids = [re.search(r"m(\w+)\.off$", p).group(1) for p in paths]
    order = [ids.index(i) for i in of if i in ids]
    labels = np.array([of[ids[k]] for k in order])
    X = vectors[order]
    sums, queries = np.zeros(6), 0
    curve, counts = np.zeros(20), np.zeros(20)
    for q in range(len(X)):
        d = np.abs(X - X[q]).sum(1)
        others = [k for k in np.lexsort((np.arange(len(X)), d)) if k != q]
        hit = (labels[others] == labels[q]).astype(float)
        R = int(hit.sum())
        if R == 0:
            continue
        queries += 1
        ranks = np.flatnonzero(hit) + 1
        gain = np.concatenate(([1.0], 1 / np.log2(np.arange(2, len(X)))))
        page = hit[:32].sum()
        sums += [hit[0], hit[:R].mean(), hit[: 2 * R].sum() / R,
                 0 if page == 0 else 2 / (32 / page + R / page),
                 (hit * gain).sum() / gain[:R].sum(), np.mean(np.arange(1, R + 1) / ranks)]
        at = np.arange(1, R + 1) / ranks
        for k in range(20):
            recall = (k + 1) / 20
            if recall * R >= 1 - 1e-12:
                curve[k] += np.interp(recall * R, np.arange(1, R + 1), at)
                counts[k] += 1
    names = ["nearest_neighbour", "first_tier", "second_tier", "e_measure", "dcg",
             "mean_average_precision"]
    result = dict(zip(names, sums / queries))
    result["queries"] = queries
    result["precision"] = [c / n if n else None for c, n in zip(curve, counts)]
    print(json.dumps(result))


main(sys.argv[1], sys.argv[2])
