#!/usr/bin/python3
"""Writes the page of chapter 5 from the reports of reproduce-chapter-5.sh: chapter_5.py FOLDER."""
import json
import os
import sys


def report(name):
    with open(os.path.join(sys.argv[1], name, "report.json")) as file:
        return json.load(file)


def percent(share):
    return "–" if share is None else f"{100 * share:.1f}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|:--|" + "--:|" * (len(head) - 1)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def retrieval(group, of="micro"):
    head = ["method", "NN", "1st tier", "2nd tier", "E", "DCG", "precision at recall 0.1"]
    rows = []
    for one in group["retrieval"]:
        m = one[of]
        rows.append([one["name"]] + [percent(m[key]) for key in (
            "nearest_neighbour", "first_tier", "second_tier", "e_measure", "dcg")] +
            [percent(m["precision"][1])])
    return table(head, rows)


def method(group, name):
    return next(one for one in group["retrieval"] if one["name"] == name)


def at_tenth(group, name):
    return method(group, name)["micro"]["precision"][1]


def rates(groups):
    names = [one["name"] for one in groups[0]["classification"]]
    rows = []
    for i, name in enumerate(names):
        rows.append([name] + [percent(g["classification"][i]["correct_rate"]) for g in groups])
    rows.append(["always the largest class"] +
                [percent(g["classification"][0]["majority_rate"]) for g in groups])
    return table(["trained on"] + [g["name"] for g in groups], rows)


def pairs(group, wanted):
    rows = []
    for one in group["paired_tests"]:
        for first, second in wanted:
            sign = 1 if (one["first"], one["second"]) == (first, second) else -1
            if sign < 0 and (one["second"], one["first"]) != (first, second):
                continue
            a, b = one["first_only"], one["second_only"]
            a, b = (a, b) if sign > 0 else (b, a)
            rows.append([f"{first} − {second}", a, b,
                         f"{100 * (a - b) / group['classification'][0]['models']:+.1f}",
                         f"{one['p']:.2g}"])
    return table(["difference of CCR", "only the first is right", "only the second is right",
                  "percent", "p"], rows)


def main():
    base, by_class = report("base-model"), report("base-class")
    coarse2, coarse3 = report("coarse2"), report("coarse3")
    weighted, loo, pose = report("weighted"), report("leave-one-out"), report("pose")
    out = sys.stdout.write
    out(f"""# Chapter 5: classification and matching of general shapes

`scripts/reproduce-chapter-5.sh` writes this page with `shape3d evaluate`.

Training half of the Princeton Shape Benchmark: {coarse2['test']['models']} of its 907 models ({len(coarse2['test']['left_out'])} have no file here), each of which looks for its class
among all others. The dissertation trains on this half and tests on the other, which is kept back here: what is
fitted for a model (support vector machines with their parameters and principal components, learnt metrics, class
predictions) has seen the other folds alone. Members of one base class fall in different folds, so figures by
cross-validation are higher than they would be on the other half, whose base classes are others; those with whole
classes held out are nearer to it. Set 1 is coarse3, set 2 is coarse2, whose seventh class, named -1, is
miscellaneous: "without the class -1" its members are no queries and are not trained on, but stay in the library.

## Base classes (90)

Five folds by model, stratified:

{retrieval(base['groups'][0])}
Five folds by class: no class of a query was seen in training. A query looks for its class in its own fold alone (a metric
treats models that it was learnt from otherwise than new ones, which would give folds away), so these figures are of
libraries a fifth as large, and to be compared with each other only:

{retrieval(by_class['groups'][0])}
""")
    best, learned = (method(base["groups"][0], n) for n in ("fusion, scaled", "learned metric, scaled"))
    best_unseen, learned_unseen = (method(by_class["groups"][0], n) for n in ("fusion, scaled", "learned metric, scaled"))
    out(f"""The default of `shape3d evaluate` is "fusion, scaled": it needs no training. Its DCG is {percent(best['micro']['dcg'])} by model, and
{percent(best_unseen['micro']['dcg'])} by class; that of the learnt metric is {percent(learned['micro']['dcg'])} and {percent(learned_unseen['micro']['dcg'])}.
Its parameters (descriptors, 12 neighbours) were chosen on this half. Scaling divides a distance by the mean
distances of both models to their nearest neighbours in the collection; no label is looked at.

![Base classes](../images/chapter-5-base-precision-recall.png)

## Classification (Fig. 5.9)

Correct classification rates in percent, support vector machines with Gaussian kernel, five folds. Set 2:

{rates(coarse2['groups'])}
Set 1:

{rates(coarse3['groups'])}
The dissertation, on the other half, of set 2 with seven classes: CSM 34.95, HSH 45.90, CSM 512 43; set 1: all three
about the rate of the larger class.

![Correct classification rates](../images/chapter-5-correct-classification.png)

Pairs of 45 numbers on the same models, McNemar's exact test:

All seven classes:

{pairs(coarse2['groups'][0], [('HSH 45', 'CSM 45, 5 x 9, weighted'), ('HSH 45', 'CSM 45, 5 x 9'), ('HSH 45', 'CSM 45, 9 x 5'), ('HSH 45, two-sided, binary', 'CSM 45, 5 x 9'), ('HSH 45, two-sided, binary', 'CSM 45, 9 x 5')])}
Without the class -1:

{pairs(coarse2['groups'][1], [('HSH 45', 'CSM 45, 5 x 9, weighted'), ('HSH 45', 'CSM 45, 5 x 9'), ('HSH 45', 'CSM 45, 9 x 5'), ('HSH 45, two-sided, binary', 'CSM 45, 5 x 9'), ('HSH 45, two-sided, binary', 'CSM 45, 9 x 5')])}
CSM 5 x 9 and 9 x 5 and "two-sided, binary" are the dissertation's own settings; "weighted" is the strongest concentric
spheres of 45 numbers that are known here, on the same voxels as HSH 45. Leaving one out:

{rates(loo['groups'])}
![Confusions](../images/chapter-5-confusion.png)

## Matching, set 2 (Figs. 5.11, 5.12)

All seven classes:

{retrieval(coarse2['groups'][0])}
Without the class -1:

{retrieval(coarse2['groups'][1])}
Precision at recall 0.1 in the dissertation, on the other half: random 20, CSM 29, HSH 27. Curves of all classes:

![Set 2](../images/chapter-5-precision-recall.png)

Curves of each class, in the same colours:

![Classes of set 2](../images/chapter-5-precision-recall-classes.png)

## Pose alignment (Fig. 5.13)

Precision at recall 0.1, in percent. The dissertation: 27 without, 30 with pose alignment.

""")
    rows = []
    names = [one["name"] for one in pose["groups"][0]["retrieval"] if one["name"] != "fusion"]
    for plain, posed in zip(names[0::2], names[1::2]):
        rows.append([plain] + [percent(at_tenth(g, n)) for g in pose["groups"] for n in (plain, posed)])
    out(table(["descriptor", "7 classes", "7 classes, aligned", "6 classes", "6 classes, aligned"], rows))
    out("""
These vectors do not depend on rotation: alignment changes no more than how the surface lies in the voxels.

![With and without pose alignment](../images/chapter-5-pose-precision-recall.png)

## Class-weighted distance (5.19, Fig. 5.13)

Of HSH 45. Classes, and probabilities of classes, are predicted by support vector machines that have not seen the
fold of the model, of the query as of the library; W is 1/4 for equal classes and 1 else, and with probabilities its
expectation. The dissertation: 27 without, 37 with weights (+37 % relative).

""")
    rows = []
    for group in weighted["groups"]:
        plain = group["retrieval"][0]
        before = plain["micro"]["precision"][1]
        for one in group["retrieval"]:
            value = one["micro"]["precision"][1]
            rows.append([f"{one['name']}, {group['name']}", percent(value),
                         f"{100 * (value / before - 1):+.0f} %", percent(one["micro"]["dcg"])])
    out(table(["method", "precision at recall 0.1", "relative", "DCG"], rows))
    out(f"""
![Class-weighted distance](../images/chapter-5-weighted-precision-recall.png)

## Matching, set 1 (Fig. 5.14)

{retrieval(coarse3['groups'][0])}
Of two classes so unequal random numbers already find {percent(at_tenth(coarse3['groups'][0], 'random 45'))} % at recall 0.1, and descriptors of shape add little to that: natural
and made things are no classes of shape. What tells them best is how normals are spread (EGI).

![Set 1](../images/chapter-5-set-1-precision-recall.png)

## Descriptors in full

""")
    seen = {}
    for one in coarse2["descriptors"] + pose["descriptors"] + loo["descriptors"]:
        seen.setdefault(one["name"], one)
    for one in seen.values():
        out(f"- {one['name']}: `{one['spec']}`, {one['length']} numbers, {one['distance']}\n")


main()
