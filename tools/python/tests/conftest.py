import numpy as np
import pytest


def grid(cells, size=1.0):
    """A square sheet in the plane z = 0: as `tearmesh::shapes::grid` makes it."""
    n = cells + 1
    y, x = np.mgrid[0:n, 0:n] / cells * size
    points = np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3)
    corner = np.arange(n * n).reshape(n, n)
    a, b = corner[:-1, :-1], corner[:-1, 1:]
    d, c = corner[1:, :-1], corner[1:, 1:]
    faces = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    return points, faces


@pytest.fixture
def sheet():
    return grid(16)
