"""Force against opening of a trouser test, for several toughnesses, each with the spread over meshes.

A strip is slit halfway. One leg is held, and the other is pulled up by hands, out of the plane. Each toughness is
tried on sheets whose inner vertices are moved at random, as tearing depends on the mesh. The line is the mean
of these runs, and the band reaches from the least to the greatest of them. A slow tear without losses would take
half a newton for each J/m, as a metre of opening tears half a metre; a quick one on a coarse mesh takes more.

    python toughness.py toughness.png          # needs matplotlib
"""

import sys

import matplotlib
import numpy as np
import tearmesh

matplotlib.use("Agg")
import matplotlib.pyplot as plt

LENGTH, WIDTH, CELLS = 0.3, 0.15, (24, 12)  # metres, and cells along them
SPEED, DURATION, FRAME = 0.5, 1.1, 1 / 60  # metres a second, seconds


def strip(rng):
    """A strip in the plane z = 0, whose inner vertices are not quite on a grid."""
    columns, rows = CELLS
    x, y = np.meshgrid(np.arange(columns + 1.0), np.arange(rows + 1.0))
    inner = (x > 0) & (x < columns) & (y > 0) & (y < rows) & (y != rows / 2)
    x, y = x + inner * rng.uniform(-0.2, 0.2, x.shape), y + inner * rng.uniform(-0.2, 0.2, y.shape)
    points = np.stack([x / columns * LENGTH, y / rows * WIDTH, 0 * x], axis=-1).reshape(-1, 3)
    corner = np.arange((columns + 1) * (rows + 1)).reshape(rows + 1, columns + 1)
    a, b, c, d = corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]
    return points, np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)


def run(toughness, seed):
    """Forces in newtons, frame by frame."""
    points, faces = strip(np.random.default_rng(seed))
    slit = ((-1, WIDTH / 2, 1), (0, 0, -1)), ((LENGTH / 2, WIDTH / 2, 1), (0, 0, -1))
    slit = tearmesh.cut(points, faces, rays=slit, snap=0.1)
    sim = tearmesh.Simulation(
        slit.points, slit.faces, roots=slit.roots, toughness=toughness, gravity=(0, 0, 0), drag=5.0
    )
    on_edge = (slit.points[:, 0] == 0) & np.isin(np.arange(len(slit.points)), slit.faces)
    upper = np.isin(np.arange(len(slit.points)), slit.faces[slit.points[slit.faces][:, :, 1].mean(axis=1) > WIDTH / 2])
    led, held = np.flatnonzero(on_edge & upper), np.flatnonzero(on_edge & ~upper)
    sim.hold(held)
    hands = [sim.grab(int(v), 0.0) for v in led]
    forces = []
    for frame in range(round(DURATION / FRAME)):
        for v, hand in zip(led, hands):
            sim.lead(hand, slit.points[v] + (0, 0, SPEED * FRAME * (frame + 1)))
        parts = []
        for _ in range(4):  # The force of one step trembles.
            sim.advance(FRAME / 4)
            parts.append(np.linalg.norm(sim.reaction(led)))
        forces.append(np.mean(parts))
    return forces


def main(path="toughness.png", toughnesses=(2.0, 4.0, 8.0), seeds=5):
    opening = SPEED * FRAME * np.arange(1, round(DURATION / FRAME) + 1)
    for toughness in toughnesses:
        forces = np.array([run(toughness, seed) for seed in range(seeds)])
        line = plt.plot(100 * opening, forces.mean(axis=0), label=f"{toughness:g} J/m")[0]
        band = forces.min(axis=0), forces.max(axis=0)
        plt.fill_between(100 * opening, *band, color=line.get_color(), alpha=0.2, linewidth=0)
        tearing = forces[:, opening > 0.42].mean(axis=1)
        print(f"{toughness:g} J/m: {tearing.mean():.2f} N while it tears, {tearing.min():.2f} to {tearing.max():.2f}")
    plt.xlabel("opening [cm]")
    plt.ylabel("force [N]")
    plt.legend(title="toughness")
    plt.savefig(path, dpi=120)


if __name__ == "__main__":
    main(*sys.argv[1:2], **({"toughnesses": (4.0,), "seeds": 2} if "--quick" in sys.argv else {}))
