"""Follow a cut with texture coordinates, bone weights, bones and materials.

    python bones.py          # prints what followed

A sleeve is a tube with two bones. Its texture has a seam: the corners of one vertex have different coordinates there.
"""

import numpy as np
import tearmesh


def sleeve(around=24, along=20):
    """A tube of radius 0.1 m and a length of 1 m, and the texture coordinates of its corners."""
    angle, height = np.meshgrid(np.arange(around) / around, np.arange(along + 1) / along)
    x, y = 0.1 * np.cos(2 * np.pi * angle), 0.1 * np.sin(2 * np.pi * angle)
    points = np.stack([x, y, height], axis=-1).reshape(-1, 3)
    column, row = (part.ravel() for part in np.meshgrid(np.arange(around), np.arange(along)))
    corners = [(column, row), (column + 1, row), (column + 1, row + 1), (column, row + 1)]
    vertex = [r * around + c % around for c, r in corners]
    texture = [np.stack([c / around, r / along], axis=-1) for c, r in corners]  # 1.0, not 0.0, behind the seam
    triangles = [(0, 1, 2), (0, 2, 3)]
    faces = np.concatenate([np.stack([vertex[i] for i in t], axis=1) for t in triangles])
    uv = np.concatenate([np.stack([texture[i] for i in t], axis=1) for t in triangles])
    return points, faces, uv


def main():
    points, faces, uv = sleeve()
    lower = 1 - points[:, 2]
    weights = np.stack([lower, 1 - lower], axis=1)  # of the two bones, for each vertex
    nearest_bone = np.argmax(weights, axis=1)
    material = (points[faces][:, :, 2].mean(axis=1) > 0.5).astype(np.uint8)  # of each face

    cut = tearmesh.cut(points, faces, plane=((0, 0, 0.43), (0.3, 0, 1)), uv=uv)
    weights = cut.map(weights)  # floats are interpolated
    nearest_bone = cut.map(nearest_bone)  # numbers of anything are copied from the nearest
    material = cut.map(material, per="face")

    print(f"{len(points)} -> {len(cut.points)} vertices, {len(faces)} -> {len(cut.faces)} faces")
    print(f"pieces: {cut.pieces.max() + 1}, seams: {len(cut.seam)} of {len(cut.seam[0]) - 1} edges")
    assert np.allclose(weights.sum(axis=1), 1) and np.allclose(weights[:, 1], cut.points[:, 2])
    assert np.allclose(cut.uv[:, :, 1], cut.points[cut.faces][:, :, 2])
    width = np.ptp(cut.uv[:, :, 0], axis=1)
    print(f"widest face in the texture: {width.max():.4f} of it")  # 1/24: no face goes back across the seam
    assert width.max() < 0.05 and set(nearest_bone) == set(material) == {0, 1}

    # An engine's vertex buffer has a vertex for each place and texture coordinate.
    rows = np.concatenate([cut.faces.reshape(-1, 1), cut.uv.reshape(-1, 2)], axis=1)
    buffer, index = np.unique(rows, axis=0, return_inverse=True)
    print(f"vertex buffer: {len(buffer)} of {len(cut.points)} vertices, index buffer: {index.size}")


if __name__ == "__main__":
    main()
