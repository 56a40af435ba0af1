"""Calls of Python that cut a sheet by a plane, side by side: the table of README.md, by medians of one run.

    pip install ./tools/python trimesh shapely scipy pyvista meshlib
    python tools/python/bench.py            # 100,000 and 1,000,000 faces; or give numbers of faces

Each gets the same wavy sheet with texture coordinates in arrays, and returns the arrays of both sides.
"""

import statistics
import sys
import time

import numpy as np
import tearmesh

POINT, NORMAL = np.array([0.4987, 0.0, 0.0]), np.array([1.0, 0.13, 0.21])
RUNS = 9


def sheet(faces):
    n = round((faces / 2) ** 0.5) + 1
    y, x = np.mgrid[0:n, 0:n] / (n - 1)
    points = np.stack([x, y, 0.05 * np.sin(9 * x) * np.cos(7 * y)], axis=-1).reshape(-1, 3)
    corner = np.arange(n * n).reshape(n, n)
    a, b, c, d = corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]
    return points, np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3), points[:, :2].copy()


def by_tearmesh(points, faces, uv):
    cut = tearmesh.cut(points, faces, plane=(POINT, NORMAL), uv=uv)
    return [(cut.points, cut.faces[cut.sides == side], cut.uv) for side in (1, -1)]


def by_trimesh(points, faces, uv):
    import trimesh

    mesh = trimesh.Trimesh(points, faces, process=False)
    mesh.visual = trimesh.visual.TextureVisuals(uv=uv)
    parts = [mesh.slice_plane(POINT, side * NORMAL) for side in (1, -1)]
    return [(part.vertices, part.faces, part.visual.uv) for part in parts]


def by_pyvista(points, faces, uv):
    import pyvista

    mesh = pyvista.PolyData.from_regular_faces(points, faces)
    mesh.point_data["uv"] = uv
    parts = mesh.clip(normal=NORMAL, origin=POINT, return_clipped=True)
    parts = [part.triangulate() for part in parts]
    return [(part.points, part.regular_faces, part.point_data["uv"]) for part in parts]


def by_meshlib(points, faces, uv):
    from meshlib import mrmeshnumpy, mrmeshpy

    mesh = mrmeshnumpy.meshFromFacesVerts(faces, points)
    vector = lambda numbers: mrmeshpy.Vector3f(*map(float, numbers))
    plane = mrmeshpy.Plane3f.fromDirAndPt(vector(NORMAL), vector(POINT))
    parts = []
    for side in (plane, -plane):
        part, settings = mrmeshpy.Mesh(mesh), mrmeshpy.TrimWithPlaneParams()
        settings.plane = side
        mrmeshpy.trimWithPlane(part, settings)
        part.pack()
        parts.append((mrmeshnumpy.getNumpyVerts(part), mrmeshnumpy.getNumpyFaces(part.topology), None))
    return parts


def followed(parts):
    """Whether texture coordinates, which are x and y here, came along."""
    if any(uv is None for *_, uv in parts):
        return "lost"
    error = max(np.abs(uv - points[:, :2]).max() for points, _, uv in parts)
    return "kept" if error < 1e-5 else f"off by {error:.0e}"


def closed(parts, edge):
    """How many edges the seam has on each side, and how many of both sides lie on each other: to a billionth."""
    seams = []
    for points, faces, _ in parts:
        edges = np.sort(np.asarray(faces)[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        edges, uses = np.unique(edges, axis=0, return_counts=True)
        ends = np.asarray(points, dtype=float)[edges[uses == 1]]
        near = np.abs((ends - POINT) @ NORMAL).max(axis=1) < 0.1 * edge
        near &= ~(ends[:, :, 1] == 0).all(axis=1) & ~(ends[:, :, 1] == 1).all(axis=1)  # the rim of the sheet
        seams.append({tuple(sorted(map(tuple, pair))) for pair in np.round(ends[near], 9).tolist()})
    return f"{len(seams[0] & seams[1])} of {len(seams[0])} and {len(seams[1])}"


def main(sizes):
    print("| faces | call | ms | texture coordinates | edges of the seam that both sides have |")
    print("|---|---|---|---|---|")
    calls = [("`tearmesh.cut`", by_tearmesh), ("trimesh `slice_plane`, twice", by_trimesh)]
    calls += [("PyVista `clip`", by_pyvista), ("MeshLib `trimWithPlane`, twice", by_meshlib)]
    for size in sizes:
        points, faces, uv = sheet(size)
        times = {name: [] for name, _ in calls}
        for _ in range(RUNS):
            for name, cut in calls:  # They take turns, so that all of them suffer from other load.
                start = time.perf_counter()
                parts = cut(points, faces, uv)
                times[name].append(1000 * (time.perf_counter() - start))
        for name, cut in calls:
            parts = cut(points, faces, uv)
            facts = followed(parts), closed(parts, (2 / len(faces)) ** 0.5)
            print(f"| {len(faces):,} | {name} | {statistics.median(times[name]):.0f} | {' | '.join(facts)} |")


if __name__ == "__main__":
    main([int(size) for size in sys.argv[1:]] or [100_000, 1_000_000])
