import threading

import numpy as np
import pytest
import tearmesh

TOP = np.arange(16 * 17, 17 * 17)


@pytest.fixture
def sim(sheet):
    sim = tearmesh.Simulation(*sheet)
    sim.hold(TOP)
    return sim


def test_a_pull_tears_and_says_so(sim, sheet):
    heat = np.linspace(0, 1, len(sheet[0]))
    vertex, face, weights = sim.pick((0.5, 0.5, 5), (0, 0, -1))
    assert vertex in sheet[1][face] and abs(sum(weights) - 1) < 1e-12
    assert sim.pick((9, 9, 5), (0, 0, -1)) is None
    hand = sim.grab(vertex)
    events = []
    for frame in range(40):
        sim.lead(hand, (0.5, 0.5 - frame / 40, frame / 40))
        assert sim.advance(1 / 60) > 0
        heat = sim.map(heat)
        events += sim.events()
    assert len(heat) == len(sim.points) == len(sim.roots) == len(sim.velocities)
    assert len(sim.points) > len(sheet[0]) and len(sim.faces) == len(sheet[1]) == len(sim.pieces)
    tore = [event for event in events if event[0] == "tore"]
    assert len(tore) == len(events) == len(sim.points) - len(sheet[0])
    assert all(0 < time < 0.7 and force > 0 for _, time, _, _, force in tore)
    assert abs(sim.time - 40 / 60) <= sim.step_length
    sim.release(hand)
    assert np.isfinite(sim.points).all()


def test_points_are_a_copy(sim):
    before = sim.points
    kept = before.copy()
    sim.step(10)
    assert np.array_equal(before, kept) and not np.array_equal(before, sim.points)


def test_a_cut_falls_off_and_heals(sim):
    assert sim.cut(plane=((0, 0.41, 0), (0, 1, 0))) == 0
    assert sim.pieces.max() == 1
    (cut,) = sim.events()
    assert cut[0] == "cut" and cut[2] == 0 and cut[3] > 10
    assert sim.heal(0) > 10 and sim.open_pairs > 10
    sim.advance(1.5)
    kind, _, sewn, left, _ = sim.events()[-1]
    assert (kind, left) == ("healed", 0) and sewn > 10
    assert sim.open_pairs == 0 and sim.pieces.max() == 0 and sim.heal() == 0


def test_what_hangs_pulls_by_its_weight(sheet):
    sim = tearmesh.Simulation(*sheet, stretch=None, drag=20.0, density=0.2)
    sim.hold(TOP)
    sim.advance(3)
    assert np.allclose(sim.reaction(TOP), (0, 0.2 * 9.81, 0), atol=0.02)
    sim.set_wind((0, 0, 3))
    sim.advance(0.1)
    assert sim.points[:, 2].max() > 0.01
    sim.set_wind(None)


def test_a_flat_sheet_buckles_unless_it_has_no_ripple(sheet):
    points, faces = sheet
    flat, buckled = (tearmesh.Simulation(points, faces, ripple=ripple) for ripple in (0.0, None))
    for sim in (flat, buckled):
        sim.hold(TOP)
        sim.advance(0.1)
    assert np.all(flat.points[:, 2] == 0.0) and np.any(buckled.points[:, 2] != 0.0)


def test_a_falling_sheet_lands(sheet):
    points, faces = sheet
    flat = points[:, [0, 2, 1]]
    colliders = [((0.5, -0.4, 0.5), 0.3), ((0, -0.6, 0), (0, 1, 0))]
    sim = tearmesh.Simulation(flat, faces[:, ::-1], method="xpbd", colliders=colliders)
    sim.advance(0.6)
    assert sim.points[:, 1].min() >= -0.6 - 1e-9
    assert np.linalg.norm(sim.points - (0.5, -0.4, 0.5), axis=1).min() >= 0.3 - 1e-9
    slope = [((0, -0.01, 0), (-0.3, 1, 0))]
    slid = [tearmesh.Simulation(flat, faces[:, ::-1], colliders=slope, friction=mu) for mu in (0.0, 0.9)]
    [sim.advance(0.5) for sim in slid]
    assert slid[0].points[:, 0].mean() < slid[1].points[:, 0].mean() - 0.05


def test_perforations_tear_first(sheet):
    points, faces = sheet
    strengths = np.where(np.abs(points[:, 1] - 0.5) < 0.02, 0.2, 1.0)
    sim = tearmesh.Simulation(points, faces, strengths=strengths, toughness=2.0, weakening=0.5)
    sim.hold(TOP)
    hands = [sim.grab(v, 0.0) for v in range(17)]
    while not sim.pieces.any() and sim.time < 2:
        for v, hand in enumerate(hands):
            sim.lead(hand, points[v] - (0, 0.5 * sim.time, 0))
        sim.advance(1 / 60)
    tore = [event[2] for event in sim.events() if event[0] == "tore"]
    assert sim.pieces.any() and strengths[tore[0]] == 0.2


def test_bad_input_is_refused_and_changes_nothing(sim, sheet):
    before = sim.points
    hand = sim.grab(40)
    for call, text in [
        (lambda: sim.hold([10**6]), "the mesh has no vertex v1000000"),
        (lambda: sim.hold([-1]), "vertices contains -1, which is not a vertex index"),
        (lambda: sim.hold([40]), "v40 is in hand 0"),
        (lambda: sim.hold([[1]]), "shape"),
        (lambda: sim.free([0.5]), "integers"),
        (lambda: sim.grab(TOP[0]), "v272 is held, and cannot be grabbed"),
        (lambda: sim.grab(10**6), "no vertex"),
        (lambda: sim.grab(1, -1.0), "radius_m cannot be -1"),
        (lambda: sim.lead(hand, (0, float("nan"), 0)), "to cannot be NaN"),
        (lambda: sim.lead(7, (0, 0, 0)), "hand"),
        (lambda: sim.release(7), "hand"),
        (lambda: sim.cut(), "give either a plane or rays"),
        (lambda: sim.heal(3), "cut"),
        (lambda: sim.advance(-1), "-1"),
        (lambda: sim.advance(float("nan")), "NaN"),
        (lambda: sim.set_wind((0, float("inf"), 0)), "inf"),
        (lambda: sim.reaction([10**6]), "v1000000"),
        (lambda: sim.map(np.zeros(3)), "shape"),
        (lambda: tearmesh.Simulation(*sheet, method="euler"), "method is one of"),
        (lambda: tearmesh.Simulation(*sheet, density=-1), "density|mass"),
        (lambda: tearmesh.Simulation(*sheet, stretch=0.5), "threshold"),
        (lambda: tearmesh.Simulation(*sheet, strengths=[1.0]), "1 strengths for 289 vertices"),
        (lambda: tearmesh.Simulation(*sheet, step=0.0), "step"),
        (lambda: tearmesh.Simulation(*sheet, drag=-1.0), "drag"),
    ]:
        with pytest.raises(ValueError, match=text):
            call()
    sim.release(hand)
    with pytest.raises(ValueError, match="hand 0 does not hold anything"):
        sim.release(hand)
    assert np.array_equal(sim.points, before)


def test_a_step_lets_other_threads_run(sheet):
    sim = tearmesh.Simulation(*sheet)
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    before = counted[0]
    sim.step(2000)
    during = counted[0] - before
    done.set()
    thread.join()
    assert during > 1000


def test_a_simulation_in_use_is_not_entered_twice(sheet):
    sim = tearmesh.Simulation(*sheet)
    thread = threading.Thread(target=lambda: sim.step(20000))
    thread.start()
    refused = 0
    while thread.is_alive():
        try:
            sim.points
        except RuntimeError:
            refused += 1
    thread.join()
    assert refused > 0
