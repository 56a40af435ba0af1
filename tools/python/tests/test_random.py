"""Random sequences of cuts, mending and simulations, held against numpy alone."""

import numpy as np
import pytest
import tearmesh

from conftest import grid


def shaken(rng):
    """A sheet with random points, lifted a little."""
    points, faces = grid(int(rng.integers(3, 9)))
    points = points + rng.normal(size=points.shape) * 0.01
    return points, faces


def area(points, faces):
    a, b, c = points[faces].transpose(1, 0, 2)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def plane_of(rng):
    return rng.uniform(0.2, 0.8, 3) * (1, 1, 0), rng.normal(size=3) * (1, 1, 0.1)


@pytest.mark.parametrize("seed", range(40))
def test_cuts_keep_area_order_and_what_follows(seed):
    rng = np.random.default_rng(seed)
    points, faces = shaken(rng)
    roots, follows = None, rng.random((len(points), 3))
    whole, affine = area(points, faces), rng.normal(size=(3, 3))
    follows = points @ affine
    numbers = np.arange(len(faces))
    first = points, faces
    for _ in range(int(rng.integers(1, 4))):
        per_corner = bool(rng.integers(2))
        given = follows[faces] if per_corner else follows
        cut = tearmesh.cut(points, faces, plane=plane_of(rng), uv=given, roots=roots, snap=rng.choice([0, 0.05, 0.3]))
        # Each face is in the one that it was cut from, and turned as that is.
        numbers = cut.map(numbers, "face")
        normal = np.cross(*(cut.points[cut.faces][:, [1, 2]] - cut.points[cut.faces][:, :1]).transpose(1, 0, 2))
        of_first = first[0][first[1][numbers]]
        first_normal = np.cross(*(of_first[:, [1, 2]] - of_first[:, :1]).transpose(1, 0, 2))
        assert (np.einsum("ij,ij->i", normal, first_normal) > 0).all()
        assert np.isclose(area(cut.points, cut.faces), whole)
        # What is linear in the place follows it.
        places = cut.points[cut.faces] if per_corner else cut.points
        assert np.allclose(cut.uv, places @ affine)
        assert np.allclose(cut.map(follows), cut.points @ affine)
        # Copies lie where their roots do, and edges between pieces of one surface are no edges.
        assert (cut.points == cut.points[cut.roots]).all() and (cut.roots <= np.arange(len(cut.points))).all()
        edges = {(a, b): f for f, (i, j, k) in enumerate(cut.faces) for a, b in [(i, j), (j, k), (k, i)]}
        assert len(edges) == 3 * len(cut.faces)
        for (a, b), f in edges.items():
            if (b, a) in edges:
                assert cut.pieces[f] == cut.pieces[edges[b, a]]
        points, faces, roots = cut.points, cut.faces, cut.roots
        follows = points @ affine
    mended = tearmesh.mend(points, faces, roots, uv=follows)
    assert tearmesh.check(mended.faces, len(mended.points)) == [] and not mended.pieces.any()
    assert np.allclose(mended.uv, mended.points @ affine) and np.isclose(area(mended.points, mended.faces), whole)
    assert len(mended.points) == len(np.unique(roots))


@pytest.mark.parametrize("seed", range(12))
def test_simulations_hold_through_random_verbs(seed):
    rng = np.random.default_rng(1000 + seed)
    points, faces = shaken(rng)
    method = rng.choice(["verlet", "xpbd", "pbd", "implicit"])
    sim = tearmesh.Simulation(points, faces, method=method, stretch=1.2)
    sim.hold(np.flatnonzero(points[:, 1] > 0.95))
    hands, count = [], len(faces)
    places = points.copy()
    for _ in range(25):
        verb = rng.integers(6)
        if verb == 0:
            vertex = int(rng.integers(len(sim.points)))
            try:
                hands.append(sim.grab(vertex))
            except ValueError as error:
                assert "held" in str(error) or "in hand" in str(error)
        elif verb == 1 and hands:
            sim.lead(hands[-1], tuple(rng.uniform(-0.5, 1.5, 3)))
        elif verb == 2 and hands:
            sim.release(hands.pop())
        elif verb == 3:
            sim.cut(plane=plane_of(rng))
            places = sim.map(places)
        elif verb == 4:
            sim.heal()
        else:
            sim.advance(0.02)
            places = sim.map(places)
        assert len(places) == len(sim.points) == len(sim.velocities) == len(sim.roots)
        assert np.isfinite(sim.points).all() and sim.faces.max() < len(sim.points)
        assert len(sim.pieces) == len(sim.faces) >= count
        count = len(sim.faces)
        assert (sim.roots <= np.arange(len(sim.points))).all()
    with pytest.raises(ValueError):
        sim.release(len(hands) + 100)
