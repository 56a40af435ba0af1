"""The same script gives the same bytes as in Rust: tests/cloth/wheel.rs makes the digests."""

from pathlib import Path

import numpy as np
import tearmesh

from conftest import grid

EXPECTED = Path(__file__).parents[3] / "tests/data/wheel.txt"
PLANE = ((0.31, 0.4, 0.0), (1.0, 0.3, 0.0))


def line(name, made):
    digest = 0xCBF29CE484222325
    arrays = [made.points.astype("<f8"), made.faces.astype("<u4"), made.roots.astype("<u4")]
    for byte in b"".join(array.tobytes() for array in arrays):
        digest = (digest ^ byte) * 0x100000001B3 & (2**64 - 1)
    return f"{name} {digest:016x}\n"


def test_cut_and_simulation_have_the_digests_of_the_library():
    points, faces = grid(16)
    cut = line("cut", tearmesh.cut(points, faces, PLANE))
    sim = tearmesh.Simulation(points, faces)
    sim.hold(np.arange(272, 289))
    sim.cut(PLANE)
    sim.advance(0.1)
    hand = sim.grab(152)
    sim.lead(hand, (0.5, -1.5, 0.5))
    sim.advance(0.5)
    assert cut + line("simulation", sim) == EXPECTED.read_text()
