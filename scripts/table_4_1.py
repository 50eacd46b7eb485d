#!/usr/bin/python3
"""Table 4.1 of the dissertation anew, as Markdown.

    table_4_1.py SHAPE3D [BUNNY.off]

Makes a ball and a cube, has `SHAPE3D describe` compute their spherical normal images' amplitudes |C_l^m| with K = 1,
and sets them beside the printed numbers and beside what symmetry demands.
"""

import math
import os
import subprocess
import sys
import tempfile

import numpy as np

SIZE = 256
PRINTED = {
    "ball": [0.00243288, 0.00178926, 1.24949, 0.000376667, 0.000429478, 1.5204],
    "cube": [2.62533e-17, 6.59502e-17, 0.8149, 5.03471e-17, 8.03768e-17, 1.19423],
    "bunny": [0.558153, 0.09185, 0.661967, 0.297591, 0.0311241, 1.001],
}
# √(2π/3), and √(3/8π) 2√2 arccos(1/3); N_z has √2 times as much in C_1^0, and nothing in C_1^1.
DEMANDED = {
    "ball": math.sqrt(2 * math.pi / 3),
    "cube": math.sqrt(3 / (8 * math.pi)) * 2 * math.sqrt(2) * math.acos(1 / 3),
}
ROWS = [f"{component} {name}" for component in ("N_x", "N_y", "N_z") for name in ("C_0^0", "C_1^0", "C_1^1")]


def grid_cube(n):
    """Points of the surface of [−1, 1]³ on a grid of n² squares a face, and their triangles."""
    ids, points, triangles = {}, [], []

    def vertex(p):
        if p not in ids:
            ids[p] = len(points)
            points.append(p)
        return ids[p]

    for axis in range(3):
        for side in (-1, 1):
            for i in range(n):
                for j in range(n):
                    quad = []
                    for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                        p = [0, 0, 0]
                        p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = side * n, 2 * a - n, 2 * b - n
                        quad.append(vertex(tuple(p)))
                    if side < 0:
                        quad.reverse()
                    # A pattern that each mirror plane of the cube keeps: diagonals towards the corners.
                    if (2 * i < n) == (2 * j < n):
                        triangles += [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]
                    else:
                        triangles += [[quad[0], quad[1], quad[3]], [quad[1], quad[2], quad[3]]]
    return np.array(points, float) / n, triangles


def write_off(path, points, triangles):
    with open(path, "w") as file:
        print(f"OFF\n{len(points)} {len(triangles)} 0", file=file)
        for p in points:
            print(*(repr(float(x)) for x in p), file=file)
        for t in triangles:
            print(3, *t, file=file)


def describe(program, folder, meshes, spec):
    table = os.path.join(folder, "table.npy")
    subprocess.run(
        [program, "describe", *meshes, "--descriptor", spec, "-o", table, "--restart", "--quiet"], check=True
    )
    rows = np.load(table)
    return dict(zip(meshes, rows[rows.dtype.names[3]]))


def main():
    program = os.path.abspath(sys.argv[1])
    bunny = sys.argv[2] if len(sys.argv) > 2 else ""
    with tempfile.TemporaryDirectory() as folder:
        points, triangles = grid_cube(24)
        turn = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))[0]
        turn *= np.linalg.det(turn)
        meshes = {name: os.path.join(folder, name + ".off") for name in ("ball", "cube", "turned cube")}
        write_off(meshes["ball"], points / np.linalg.norm(points, axis=1)[:, None], triangles)
        write_off(meshes["cube"], points, triangles)
        write_off(meshes["turned cube"], points @ turn.T, triangles)
        if bunny:
            meshes["bunny"] = os.path.abspath(bunny)
        spec = f"sni:K=1,form=amplitudes,components=3,size={SIZE}"
        plain = [meshes[name] for name in meshes if name != "bunny"]
        found = describe(program, folder, plain, spec + ",align=none")
        if bunny:
            found.update(describe(program, folder, [meshes["bunny"]], spec + ",align=cpca"))
        roots = describe(program, folder, list(meshes.values()), f"sni:K=1,form=roots,size={SIZE}")

    columns = [name for name in ("ball", "cube", "turned cube", "bunny") if name in meshes]
    print("# Table 4.1 anew: amplitudes of spherical normal images with K = 1")
    print()
    print("`SHAPE3D_DATA=<folder> scripts/table-4.1.sh` writes this page, with `shape3d describe --descriptor")
    print(f"{spec}`. The ball and the cube are meshes of {len(triangles)} triangles, {len(points)} vertices; the cube")
    print("also in a random pose. Their maps to the sphere are those of `mapping::spherical_map`.", end="")
    if bunny:
        print(f"\nThe bunny is `{os.path.basename(bunny)}`, aligned (`align=cpca`) as the dissertation's was.", end="")
    print("\n")
    head, line = "| |", "| --- |"
    for name in columns:
        if name in PRINTED:
            head += f" {name}, printed |"
            line += " --: |"
        head += f" {name} |"
        line += " --: |"
        if name in DEMANDED:
            head += f" {name}, demanded |"
            line += " --: |"
    print(head)
    print(line)
    for row, label in enumerate(ROWS):
        cells = [label.replace("C_", "\\|C_") + "\\|"]
        for name in columns:
            if name in PRINTED:
                cells.append(f"{PRINTED[name][row]:.4g}" if row < 6 else "–")
            cells.append(f"{found[meshes[name]][row]:.4f}")
            if name in DEMANDED:
                value = DEMANDED[name]
                demanded = {2: value, 5: value, 7: math.sqrt(2) * value}.get(row, 0)
                cells.append(f"{demanded:.4f}")
        print("| " + " | ".join(cells) + " |")
    print()
    print("Roots of the eigenvalues of G_1, which do not depend on the pose:")
    print()
    for name in columns:
        print(f"- {name}: " + ", ".join(f"{x:.4f}" for x in roots[meshes[name]][3:6]))
    print()
    print("What symmetry demands: on the ball N = x. The cube's map keeps its rotations, so that the degree 1,")
    print("a 3 × 3 matrix, commutes with them and is a multiple of the identity, in every pose; its value follows")
    print("from the faces' central projections (docs/notes/spherical-harmonics.md, section 4). The printed")
    print("amplitudes differ between N_x and N_y, by 22 % for the ball and 47 % for the cube: the map behind them")
    print("was not centred, or its samples were not weighted by area.")
    worst = max(
        abs(found[meshes[name]][row] / DEMANDED[name] - 1)
        for name in ("ball", "cube")
        for row in (2, 5)
    )
    print(f"\nThe largest deviation of the ball's and the cube's |C_1^1| from what is demanded is {100 * worst:.2g} %.")


main()
