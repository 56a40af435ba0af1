"""One rival of the subcommand `cut`: cuts a mesh by a plane, and keeps both sides.

Usage: cut.py RIVAL FOLDER, with `points` (f64, three a vertex), `triangles` (u32, three a face)
and `plane` (f64: a point and a unit normal) in the folder, all little-endian.

It first says `ready VERSION`, or `missing` where the package is not installed. For each line
`cut` that it reads, it cuts once and says how many seconds of CPU time the cutting call took;
the mesh is made before, and thrown away after. For the line `check` it cuts once more and says
what came out: see `check`.
"""

import gc
import importlib
import importlib.metadata
import os
import sys
import time

import numpy as np


class MeshLib:
    """Single precision. `trimWithPlane` cuts in place, and gives the other side beside."""

    packages = ["meshlib.mrmeshpy", "meshlib.mrmeshnumpy"]
    distribution = "meshlib"

    def __init__(self, points, triangles, origin, normal):
        self.mr, self.numpy = map(importlib.import_module, self.packages)
        self.mesh = self.numpy.meshFromFacesVerts(triangles.astype(np.int32), points)
        self.params = self.mr.TrimWithPlaneParams()
        normal = self.mr.Vector3f(*normal)
        self.params.plane = self.mr.Plane3f(normal, self.mr.dot(normal, self.mr.Vector3f(*origin)))

    def prepared(self):
        front = self.mr.copyMesh(self.mesh)
        back = self.mr.Mesh()
        other = self.mr.TrimOptionalOutput()
        other.otherPart = back
        return front, back, other

    def cut(self, prepared):
        front, back, other = prepared
        self.mr.trimWithPlane(front, self.params, other)
        return front, back

    def sides(self, result):
        for mesh in result:
            mesh.pack()
        return [(self.numpy.getNumpyVerts(m), self.numpy.getNumpyFaces(m.topology)) for m in result]


class Trimesh:
    """Double precision. `slice_plane` gives one side, so it is called twice."""

    packages = ["trimesh"]
    distribution = "trimesh"

    def __init__(self, points, triangles, origin, normal):
        self.trimesh = importlib.import_module("trimesh")
        self.arrays = points, triangles.astype(np.int64)
        self.plane = origin, normal

    def prepared(self):
        points, triangles = self.arrays
        return self.trimesh.Trimesh(points.copy(), triangles.copy(), process=False)

    def cut(self, mesh):
        origin, normal = self.plane
        return [mesh.slice_plane(origin, n, cap=False) for n in (normal, -normal)]

    def sides(self, result):
        return [(side.vertices, side.faces) for side in result]


class VtkPlane:
    """Double precision. `vtkPolyDataPlaneClipper` gives one side, so it runs twice."""

    packages = ["vtkmodules.vtkFiltersCore", "vtkmodules.util.numpy_support"]
    distribution = "vtk"

    def __init__(self, points, triangles, origin, normal):
        core, self.support = map(importlib.import_module, self.packages)
        data = importlib.import_module("vtkmodules.vtkCommonDataModel")
        common = importlib.import_module("vtkmodules.vtkCommonCore")
        common.vtkSMPTools.SetBackend("Sequential")
        self.core = core
        self.points = common.vtkPoints()
        self.points.SetData(self.support.numpy_to_vtk(points, deep=True))
        cells = data.vtkCellArray()
        corners = self.support.numpy_to_vtkIdTypeArray(triangles.astype(np.int64).ravel(), deep=True)
        cells.SetData(3, corners)
        self.mesh = data.vtkPolyData()
        self.mesh.SetPoints(self.points)
        self.mesh.SetPolys(cells)
        self.planes = []
        for sign in (1, -1):
            plane = data.vtkPlane()
            plane.SetOrigin(*origin)
            plane.SetNormal(*(sign * normal))
            self.planes.append(plane)

    def prepared(self):
        clips = []
        for plane in self.planes:
            clip = self.core.vtkPolyDataPlaneClipper()
            clip.SetInputData(self.mesh)
            clip.SetPlane(plane)
            clip.CappingOff()
            clip.ClippingLoopsOff()
            clips.append(clip)
        return clips

    def cut(self, clips):
        for clip in clips:
            clip.Update()
        return [clip.GetOutput() for clip in clips]

    def sides(self, outputs):
        sides = []
        for side in outputs:
            points = self.support.vtk_to_numpy(side.GetPoints().GetData())
            polygons = side.GetPolys()
            starts = self.support.vtk_to_numpy(polygons.GetOffsetsArray())
            corners = self.support.vtk_to_numpy(polygons.GetConnectivityArray())
            sides.append((points, fans(starts, corners)))
        return sides


class VtkClip(VtkPlane):
    """Double precision. Both outputs of the older filter, `vtkClipPolyData`."""

    def prepared(self):
        clip = self.core.vtkClipPolyData()
        clip.SetInputData(self.mesh)
        clip.SetClipFunction(self.planes[0])
        clip.GenerateClippedOutputOn()
        clip.SetOutputPointsPrecision(2)
        return clip

    def cut(self, clip):
        clip.Update()
        return [clip.GetOutput(), clip.GetClippedOutput()]


def fans(starts, corners):
    """Polygons as triangles round their first corner."""
    triangles = []
    sizes = np.diff(starts)
    for size in np.unique(sizes):
        first = starts[:-1][sizes == size]
        for i in range(1, size - 1):
            triangles.append(np.column_stack([corners[first], corners[first + i], corners[first + i + 1]]))
    return np.concatenate(triangles)


RIVALS = {"meshlib": MeshLib, "trimesh": Trimesh, "vtk-plane": VtkPlane, "vtk-clip": VtkClip}


def area(points, triangles):
    a, b, c = (points[triangles[:, i]].astype(np.float64) for i in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def boundary(points, triangles):
    """The edges with one face, as rows of six coordinates, the ends in order of position."""
    # Points with the same bits are one.
    points, index = np.unique(np.ascontiguousarray(points), axis=0, return_inverse=True)
    triangles = index.ravel()[triangles]
    edges = np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    edges = np.sort(edges[edges[:, 0] != edges[:, 1]], axis=1)
    edges, counts = np.unique(edges, axis=0, return_counts=True)
    return points[edges[counts == 1]].reshape(-1, 6)


def check(sides, points, triangles, origin, normal):
    """`key=value` words: the faces of both sides; the seam edges of one side without a partner of
    the same bits on the other; the largest distance of a seam vertex from the plane; the area
    against that of the mesh, in the precision of the rival."""
    dtype = sides[0][0].dtype
    edges = [boundary(*side) for side in sides]
    reach = 1e-2 * (area(points, triangles) / len(triangles)) ** 0.5
    offsets = [(e.reshape(-1, 2, 3).astype(np.float64) - origin) @ normal for e in edges]
    seams = [e[(np.abs(o) <= reach).all(axis=1)] for e, o in zip(edges, offsets)]
    both, counts = np.unique(np.concatenate(seams), axis=0, return_counts=True)
    deviation = max(np.abs((s.reshape(-1, 3).astype(np.float64) - origin) @ normal).max() for s in seams)
    before = area(points.astype(dtype), triangles)
    after = sum(area(*side) for side in sides)
    return {
        "faces": sum(len(triangles) for _, triangles in sides),
        "seam": max(map(len, seams)),
        "cracks": int((counts == 1).sum()),
        "deviation": deviation,
        "area": after / before - 1,
    }


def main():
    name, folder = sys.argv[1:]
    # One core, so one thread, whatever the rival's own threads do.
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    rival = RIVALS[name]
    try:
        for package in rival.packages:
            importlib.import_module(package)
    except ImportError:
        print("missing", flush=True)
        return
    points = np.fromfile(os.path.join(folder, "points"), "<f8").reshape(-1, 3)
    triangles = np.fromfile(os.path.join(folder, "triangles"), "<u4").reshape(-1, 3)
    plane = np.fromfile(os.path.join(folder, "plane"), "<f8").reshape(2, 3)
    contestant = rival(points, triangles, *plane)
    print("ready", importlib.metadata.version(rival.distribution), flush=True)
    for line in sys.stdin:
        prepared = contestant.prepared()
        gc.collect()
        gc.disable()
        start = time.process_time()
        result = contestant.cut(prepared)
        seconds = time.process_time() - start
        gc.enable()
        if line.strip() == "cut":
            print(seconds, flush=True)
        else:
            facts = check(contestant.sides(result), points, triangles, *plane)
            print(*(f"{key}={value:.17g}" for key, value in facts.items()), flush=True)
        del result, prepared


if __name__ == "__main__":
    main()
