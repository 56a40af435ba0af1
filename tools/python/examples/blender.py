"""Cut an object in Blender, and play a simulation as a point cache.

    pip install bpy && pip install ./tools/python && python blender.py FOLDER      # headless
    blender --python blender.py -- FOLDER      # where Blender's own Python has tearmesh and numpy

FOLDER gets a point cache and a .blend file. In the console of Blender, `cut_object(obj, point, normal)` cuts any mesh.
"""

import struct
import sys
from pathlib import Path

import bpy
import numpy as np
import tearmesh


def arrays(mesh):
    """The points and triangles of a mesh of Blender, and the texture coordinates of their corners, or None."""
    points = np.empty(3 * len(mesh.vertices))
    mesh.vertices.foreach_get("co", points)
    mesh.calc_loop_triangles()
    faces, loops = np.empty((2, 3 * len(mesh.loop_triangles)), dtype=np.int32)
    mesh.loop_triangles.foreach_get("vertices", faces)
    mesh.loop_triangles.foreach_get("loops", loops)
    uv = None
    if mesh.uv_layers.active:
        uv = np.empty(2 * len(mesh.loops))
        mesh.uv_layers.active.uv.foreach_get("vector", uv)
        uv = uv.reshape(-1, 2)[loops].reshape(-1, 3, 2)
    return points.reshape(-1, 3), faces.reshape(-1, 3), uv


def mesh_of(name, made):
    """A mesh of Blender. Do not merge it by distance: that would close the cut."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(made.points.tolist(), [], made.faces.tolist())
    if getattr(made, "uv", None) is not None:
        mesh.uv_layers.new().uv.foreach_set("vector", made.uv.ravel())
    return mesh


def cut_object(obj, point, normal):
    """Cuts the mesh of an object along a plane, in its own coordinates, and returns the cut."""
    points, faces, uv = arrays(obj.data)
    cut = tearmesh.cut(points, faces, plane=(point, normal), uv=uv)
    obj.data = mesh_of(obj.data.name, cut)
    return cut


def write_pc2(path, samples):
    """A point cache for the modifier Mesh Cache: where every vertex is, frame by frame from frame 1."""
    head = struct.pack("<12siiffi", b"POINTCACHE2", 1, len(samples[0]), 1.0, 1.0, len(samples))
    path.write_bytes(head + np.asarray(samples, dtype="<f4").tobytes())


def main(folder, frames=40):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=24, y_subdivisions=24, size=1.0)
    obj = bpy.context.object
    cut = cut_object(obj, (0, 0.1, 0), (0.2, 1, 0))
    # It hangs by its upper edge, and what was cut off falls: a cut alone changes no vertex any more.
    sim = tearmesh.Simulation(cut.points, cut.faces, roots=cut.roots, stretch=None, gravity=(0, -9.81, 1))
    sim.hold(np.flatnonzero(cut.points[:, 1] > 0.499))
    samples = []
    for _ in range(frames):
        samples.append(sim.points)
        sim.advance(1 / 24)
    cache = folder / "cloth.pc2"
    write_pc2(cache, samples)
    modifier = obj.modifiers.new("Cloth", "MESH_CACHE")
    modifier.cache_format, modifier.filepath, modifier.frame_start = "PC2", str(cache), 1
    bpy.context.scene.frame_set(frames // 2)
    shown = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    played = np.abs(arrays(shown)[0] - samples[frames // 2 - 1]).max()
    print(f"{len(cut.points)} vertices, {cut.pieces.max() + 1} pieces, played to {played:.1e}")
    assert played < 1e-5, "Blender shows what was simulated"
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "cloth.blend"))


if __name__ == "__main__":
    main(Path(sys.argv[-1]).resolve())
