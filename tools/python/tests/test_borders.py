"""What comes from elsewhere: whole numbers, files that are links, signals, numbers that are no vertex."""

import copy
import inspect
import os
import pickle
import signal
import stat
import threading
import time

import numpy as np
import pytest
import tearmesh

POINTS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
FACES = [[0, 1, 2], [0, 2, 3]]
PLANE = ((0.3, 0, 0), (1, 0, 0))


def test_whole_numbers_of_uv_are_mixed():
    uv = [[0, 0], [1, 0], [1, 1], [0, 1]]
    cut = tearmesh.cut(POINTS, FACES, plane=PLANE, uv=uv)
    assert cut.uv.dtype == np.float64 and np.allclose(cut.uv, cut.points[:, :2])
    corners = np.array(uv, dtype=np.int8)[FACES]
    assert np.allclose(tearmesh.cut(POINTS, FACES, plane=PLANE, uv=corners).uv, cut.points[cut.faces][..., :2])


def test_how_an_array_follows_can_be_said():
    cut = tearmesh.cut(POINTS, FACES, plane=PLANE)
    heat = [20, 20, 80, 80]
    assert set(cut.map(heat)) == {20, 80}  # by default whole numbers are copied
    mixed = cut.map(heat, how="mix")
    assert np.allclose(mixed, 20 + 60 * cut.points[:, 1]) and mixed.dtype == np.float64
    floats = np.array(heat, dtype=np.float32)
    assert set(cut.map(floats, how="source")) == {20, 80} and cut.map(floats, how="source").dtype == np.float32
    assert cut.map([True, True, False, False], how="mix").min() == 0
    for values, how, said in [(heat, "nearest", "how must be 'mix' or 'source'"), (["a"] * 4, "mix", "only numbers can be mixed")]:
        with pytest.raises(ValueError, match=said):
            cut.map(values, how=how)
    assert cut.map(np.zeros((4, 0))).shape == (len(cut.points), 0)


@pytest.mark.parametrize("per", ["vertex", "corner"])
def test_what_a_cut_returned_is_written(tmp_path, per):
    uv = POINTS[:, :2] if per == "vertex" else POINTS[FACES][..., :2]
    cut = tearmesh.cut(POINTS, FACES, plane=PLANE, uv=uv)
    tearmesh.write_obj(tmp_path / "a.obj", cut.points, cut.faces, roots=cut.roots, uv=cut.uv)
    assert np.array_equal(tearmesh.read_obj(tmp_path / "a.obj").uv, cut.points[cut.faces][..., :2])


def test_files_keep_mode_links_and_pipes(tmp_path):
    path, link, pipe = tmp_path / "a.obj", tmp_path / "l.obj", tmp_path / "pipe"
    tearmesh.write_obj(path, POINTS, FACES)
    path.chmod(0o600)
    tearmesh.write_obj(path, POINTS, FACES)
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    link.symlink_to(path)
    tearmesh.write_obj(link, POINTS * 2, FACES)
    assert link.is_symlink() and tearmesh.read_obj(path).points.max() == 2
    os.mkfifo(pipe)
    read = []
    reader = threading.Thread(target=lambda: read.append(pipe.read_bytes()))
    reader.start()
    tearmesh.write_obj(pipe, POINTS * 2, FACES)
    reader.join()
    assert stat.S_ISFIFO(pipe.stat().st_mode) and read == [path.read_bytes()]
    assert sorted(tmp_path.iterdir()) == [path, link, pipe]


def test_errors_of_files_have_their_name(tmp_path):
    missing = tmp_path / "none.obj"
    for work in [lambda: tearmesh.read_obj(missing), lambda: tearmesh.write_obj(missing / "a.obj", POINTS, FACES)]:
        with pytest.raises(FileNotFoundError) as error:
            work()
        assert str(missing) in str(error.value.filename) and error.value.strerror == "No such file or directory"
    with pytest.raises(FileNotFoundError) as error:
        tearmesh.Simulation.of_scene(POINTS, FACES, tmp_path / "none.toml")
    assert str(error.value.filename).endswith("none.toml")


def test_files_of_other_formats_are_named(tmp_path):
    for name, said in [("a.stl", "an STL"), ("a.PLY", "a PLY")]:
        (tmp_path / name).write_bytes(b"solid x\n" + bytes(80))
        with pytest.raises(ValueError, match=f"this is {said} file, not OBJ; convert it first"):
            tearmesh.read_obj(tmp_path / name)
    (tmp_path / "b.stl").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert len(tearmesh.read_obj(tmp_path / "b.stl").faces) == 1


def test_vertices_parted_for_texture_coordinates_have_two_ways_out():
    tie = [[0, 1, 2], [0, 3, 4]]
    with pytest.raises(ValueError, match="(?s)v0 joins 2 fans.*read_obj.*maintain_order=True"):
        tearmesh.cut(np.random.default_rng(1).random((5, 3)), tie, plane=PLANE)
    with pytest.raises(ValueError) as error:
        tearmesh.cut(POINTS, [[0, 1, 2], [1, 0, 3], [0, 1, 3]], plane=PLANE)
    assert "read_obj" not in str(error.value)


def test_numbers_of_vertices_are_said_as_they_are():
    with pytest.raises(ValueError, match="faces contains 9223372036854775813, which is not a vertex index"):
        tearmesh.check(np.array([[0, 1, 2**63 + 5]], dtype=np.uint64), 3)
    with pytest.raises(ValueError, match="n must be a number of vertices, not -1"):
        tearmesh.check(FACES, -1)
    assert tearmesh.check(FACES, 2**31) == []
    assert "names vertex 3" in tearmesh.check(FACES, 3)[0]
    with pytest.raises(ValueError, match="2147483648"):
        tearmesh.Simulation(POINTS, FACES).hold([2**31])


def test_a_force_counts_each_vertex_once():
    sim = tearmesh.Simulation(POINTS, FACES)
    sim.hold([2, 3])
    sim.advance(0.2)
    assert np.array_equal(sim.reaction([2, 3]), sim.reaction([2, 3, 2, 3]))


def test_seams_are_welded_by_true(tmp_path):
    soup = POINTS[FACES].reshape(-1, 3)
    faces = np.arange(6).reshape(2, 3)
    weld = tearmesh.cut(soup, faces, plane=PLANE, weld=0.0)
    true = tearmesh.cut(soup, faces, plane=PLANE, weld=True)
    false = tearmesh.cut(soup, faces, plane=PLANE, weld=False)
    assert np.array_equal(true.points, weld.points) and true.pieces.max() == 1
    assert false.pieces.max() == 3


def test_ctrl_c_is_heard(sheet):
    def stop(*_):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, stop)
    try:
        sim = tearmesh.Simulation(*sheet)
        began = time.monotonic()
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(KeyboardInterrupt):
            sim.advance(1000.0)
        assert time.monotonic() - began < 1.0 and 0 < sim.time < 1000
        assert sim.advance(0.01) > 0
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_what_is_shown_and_copied(sheet):
    cut = tearmesh.cut(POINTS, FACES, plane=PLANE)
    assert repr(cut) == f"<tearmesh.TornMesh: {len(cut.points)} points, {len(cut.faces)} faces, pieces: 2>"
    assert "289 points, 512 faces, at 0.0" in repr(tearmesh.Simulation(*sheet))
    for again in [copy.copy(cut), copy.deepcopy(cut), pickle.loads(pickle.dumps(cut))]:
        for name in ["points", "faces", "roots", "pieces", "sides"]:
            assert np.array_equal(getattr(again, name), getattr(cut, name)), name
        assert len(again.seam) == 1 and np.array_equal(again.seam[0], cut.seam[0]) and again.uv is None
    with pytest.raises(ValueError, match="it was unpickled"):
        pickle.loads(pickle.dumps(cut)).map([0.0] * 4)
    with pytest.raises(TypeError):
        pickle.dumps(tearmesh.Simulation(*sheet))


def test_a_cut_that_misses_says_so():
    assert tearmesh.cut(POINTS, FACES, plane=((5, 0, 0), (1, 0, 0))).missed
    assert not tearmesh.cut(POINTS, FACES, plane=PLANE).missed


def test_signatures_are_whole():
    for owner in [tearmesh, tearmesh.Simulation, tearmesh.TornMesh]:
        for name, value in vars(owner).items():
            if callable(value) and not name.startswith("_") and not isinstance(value, type):
                assert "..." not in str(inspect.signature(value)), name
    assert inspect.signature(tearmesh.cut).parameters["snap"].default == 0.05
