import numpy as np
import pytest
import tearmesh

PLANE = ((0.31, 0, 0), (1, 0.2, 0))
SLIT = (((0.3, 0.4, 5), (0, 0, -1)), ((0.7, 0.45, 5), (0, 0, -1)))


def test_a_cut_has_sides_pieces_and_a_seam(sheet):
    points, faces = sheet
    before = points.copy(), faces.copy()
    cut = tearmesh.cut(points, faces, plane=PLANE)
    assert (points == before[0]).all() and (faces == before[1]).all()
    n, m = len(cut.points), len(cut.faces)
    assert (cut.points.shape, cut.points.dtype) == ((n, 3), np.float64)
    assert (cut.faces.shape, cut.faces.dtype) == ((m, 3), np.int64)
    assert (cut.roots.shape, cut.pieces.shape, cut.sides.shape) == ((n,), (m,), (m,))
    assert (cut.roots.dtype, cut.pieces.dtype, cut.sides.dtype) == (np.int64, np.int64, np.int8)
    assert set(cut.pieces) == {0, 1} and cut.uv is None
    middle = cut.points[cut.faces].mean(axis=1) - PLANE[0]
    assert (np.sign(middle @ PLANE[1]) == cut.sides).all()
    (line,) = cut.seam
    front, back = line.T
    assert line.shape[1] == 2 and not (front == back).any()
    assert (cut.points[front] == cut.points[back]).all()
    assert np.abs((cut.points[front] - PLANE[0]) @ PLANE[1]).max() < 0.01  # the snap
    assert set(cut.sides[np.isin(cut.faces, front).any(axis=1)]) == {1}


def test_a_slit_has_one_piece_and_ends_at_tips(sheet):
    cut = tearmesh.cut(*sheet, rays=np.array(SLIT), snap=0)
    assert not cut.pieces.any() and set(cut.sides) == {-1, 0, 1}
    (line,) = cut.seam
    assert (line[0, 0] == line[0, 1]) and (line[-1, 0] == line[-1, 1])
    ends = cut.points[line[[0, -1], 0]]
    assert np.allclose(np.sort(ends[:, 0]), [0.3, 0.7])


def test_first_layers_leave_those_behind(sheet):
    points, faces = sheet
    two = np.concatenate([points, points - (0, 0, 1)]), np.concatenate([faces, faces + len(points)])
    rays = (((0.5, -1, 5), (0, 0, -1)), ((0.5, 2, 5), (0, 0, -1)))
    assert tearmesh.cut(*two, rays=rays).pieces.max() == 3
    assert tearmesh.cut(*two, rays=rays, layers="first").pieces.max() == 2


def test_a_gap_parts_the_sides(sheet):
    cut = tearmesh.cut(*sheet, plane=PLANE, gap=0.01)
    front, back = cut.seam[0].T
    apart = cut.points[front] - cut.points[back]
    assert np.allclose(np.linalg.norm(apart, axis=1), 0.01)


def test_what_follows_per_vertex_corner_and_face(sheet):
    points, faces = sheet
    cut = tearmesh.cut(points, faces, plane=PLANE, uv=points[:, :2])
    assert np.array_equal(cut.uv, cut.points[:, :2])
    assert np.array_equal(cut.map(points), cut.points)
    narrow = cut.map(points.astype(np.float32))
    assert narrow.dtype == np.float32 and np.allclose(narrow, cut.points, atol=1e-6)
    corners = points[faces]
    assert np.allclose(cut.map(corners, "corner"), cut.points[cut.faces])
    assert np.array_equal(tearmesh.cut(points, faces, PLANE, uv=corners).uv, cut.map(corners, "corner"))
    number = cut.map(np.arange(len(faces)), "face")
    middle = cut.points[cut.faces].mean(axis=1)
    first = points[faces[number, 0]]
    assert number.dtype.kind == "i" and np.linalg.norm(middle - first, axis=1).max() < 0.1
    nearest = cut.map(np.arange(len(points)))
    assert np.linalg.norm(points[nearest] - cut.points, axis=1).max() < 0.05
    names = cut.map(np.array(["left", "right"])[(points[:, 0] > 0.5).astype(int)])
    assert names.dtype.kind == "U" and names.shape == (len(cut.points),)
    assert cut.map(np.zeros((len(faces), 3, 2, 2)), "corner").shape == (len(cut.faces), 3, 2, 2)


def test_a_torn_mesh_is_cut_again_and_mended(sheet):
    points, faces = sheet
    once = tearmesh.cut(points, faces, plane=PLANE)
    twice = tearmesh.cut(once.points, once.faces, plane=((0, 0.52, 0), (0, 1, 0)), roots=once.roots)
    assert twice.pieces.max() == 3
    assert np.array_equal(tearmesh.pieces(twice.faces, len(twice.points), roots=twice.roots), twice.pieces)
    whole = tearmesh.mend(twice.points, twice.faces, twice.roots, uv=twice.points[:, :2])
    assert not whole.pieces.any() and whole.seam == [] and not whole.sides.any()
    assert np.array_equal(whole.roots, np.arange(len(whole.points)))
    assert np.array_equal(whole.uv, whole.points[:, :2])
    assert tearmesh.check(whole.faces, len(whole.points)) == []
    gap = tearmesh.cut(points, faces, rays=SLIT, gap=0.01)
    with pytest.raises(ValueError, match="apart"):
        tearmesh.mend(gap.points, gap.faces, gap.roots, max_distance=0.001)
    assert np.allclose(tearmesh.mend(gap.points, gap.faces, gap.roots).points[: len(points)], points, atol=1e-3)


def test_files_keep_what_is_torn(sheet, tmp_path):
    points, faces = sheet
    cut = tearmesh.cut(points / 3, faces, plane=((0.11, 0, 0), (1, 0.2, 0)), uv=points[faces][..., :2])
    path = tmp_path / "cut.obj"
    tearmesh.write_obj(path, cut.points, cut.faces, roots=cut.roots, uv=cut.uv)
    read = tearmesh.read_obj(path)
    for name in ["points", "faces", "roots", "uv", "pieces"]:
        assert np.array_equal(getattr(read, name), getattr(cut, name)), name
    assert list(tmp_path.iterdir()) == [path]
    tearmesh.write_obj(str(path), points, faces)
    assert tearmesh.read_obj(path).uv is None


def test_bad_files_are_refused_by_line(tmp_path):
    path = tmp_path / "bad.obj"
    path.write_text("v 0 0 0\nv 1 0,5 0\n")
    with pytest.raises(ValueError, match=r"bad\.obj: line 2, column 5: cannot read number `0,5`"):
        tearmesh.read_obj(path)
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n")
    with pytest.raises(ValueError, match="line 8: edge 1-2 has 3 faces"):
        tearmesh.read_obj(path)
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\ncurv2 1\n")
    with pytest.warns(UserWarning, match="curv2"):
        tearmesh.read_obj(path)
    with pytest.raises(FileNotFoundError):
        tearmesh.read_obj(tmp_path / "none.obj")
    with pytest.raises(FileNotFoundError):
        tearmesh.write_obj(tmp_path / "none/a.obj", *SHEET)


SHEET = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]]), np.array([[0, 1, 2], [0, 2, 3]])


@pytest.mark.parametrize(
    ("given", "text"),
    [
        (dict(points=np.zeros((4, 2))), r"points must be an array of shape \[n, 3\], not \[4, 2\]"),
        (dict(points=SHEET[0] * np.nan), r"4 vertices have a coordinate that is not usable: v0"),
        (dict(points=SHEET[0] * 1e99), "not usable"),
        (dict(points="words"), "points must be numbers, not <U5"),
        (dict(faces=[[0, 1, 2, 3]]), r"faces must be an array of shape \[n, 3\], not \[1, 4\]"),
        (dict(faces=SHEET[1] + 0.5), "faces must be integers, not float64"),
        (dict(faces=SHEET[1] - 1), "faces contains -1, which is not a vertex index"),
        (dict(faces=SHEET[1] + 1), "f1 names vertex 4 at corner 2, but there are 4 vertices"),
        (dict(faces=[[0, 1, 2], [1, 0, 3], [0, 1, 3]]), "two faces lie back to back on v0, v1, v3: f1, f2"),
        (dict(roots=[0, 1, 2]), r"roots must be an array of shape \[4\], not \[3\]"),
        (dict(roots=[0, 1, 2, 2]), "v3|v2"),
        (dict(plane=None), "give either a plane or rays"),
        (dict(rays=SLIT), "give either a plane or rays"),
        (dict(plane=((0, 0, 0), (0, 0, 0))), "normal"),
        (dict(plane=((0, 0, 0), (1, 0))), "expected a sequence of length 3"),
        (dict(plane=None, rays=(SLIT[0], SLIT[0])), "the two rays are the same line"),
        (dict(layers="first"), "layers"),
        (dict(layers="some"), "layers"),
        (dict(gap=-1.0), "gap must be a length of 0 or more, not -1"),
        (dict(gap=float("nan")), "gap"),
        (dict(snap=0.5), "snap must be from 0 to 0.49, not 0.5"),
        (dict(uv=np.zeros((5, 2))), r"values per vertex begin with the shape \[4\], not \[5, 2\]"),
    ],
)
def test_what_cannot_be_cut_is_refused(given, text):
    points, faces = SHEET
    arguments = dict(points=points, faces=faces, plane=((0.3, 0, 0), (1, 0, 0))) | given
    with pytest.raises(ValueError, match=text):
        tearmesh.cut(**arguments)


def test_defects_are_listed():
    assert tearmesh.check(SHEET[1], 4) == []
    (crowded,) = tearmesh.check([[0, 1, 2], [1, 0, 3], [0, 1, 4]], 5)[:1]
    assert "v0" in crowded and "v1" in crowded
    cut = tearmesh.cut(*SHEET, plane=((0.3, 0, 0), (1, 0, 0)))
    for per, values in [("side", np.zeros(4)), ("corner", np.zeros((2, 4))), ("face", np.zeros(()))]:
        with pytest.raises(ValueError, match="per"):
            cut.map(values, per)


def test_trimesh_takes_a_cut_unprocessed_or_with_a_gap(sheet):
    trimesh = pytest.importorskip("trimesh")
    cut = tearmesh.cut(*sheet, plane=PLANE)
    pieces = lambda points, **process: trimesh.Trimesh(points, cut.faces, **process).body_count
    assert pieces(cut.points, process=False) == 2
    assert pieces(cut.points) == 1  # it merges equal points, and so heals the cut
    assert pieces(tearmesh.cut(*sheet, plane=PLANE, gap=0.001).points) == 2


def test_pyvista_takes_a_cut(sheet):
    pyvista = pytest.importorskip("pyvista")
    cut = tearmesh.cut(*sheet, plane=PLANE)
    mesh = pyvista.PolyData.from_regular_faces(cut.points, cut.faces)
    assert mesh.connectivity()["RegionId"].max() == 1


def soup(columns):
    """A strip of squares, each triangle with vertices of its own."""
    places = []
    for x in range(columns):
        a, b, c, d = [(x + i, j, 0.0) for j in (0, 1) for i in (0, 1)]
        places += [a, b, d, a, d, c]
    points = np.array(places, float)
    return points, np.arange(len(points)).reshape(-1, 3)


def test_seams_that_coincide_stay_closed_in_a_cut_and_are_welded_on_request():
    points, faces = soup(4)
    plane = ((0.0, 0.1, 0.0), (-0.2, 1.0, 0.0))
    torn = tearmesh.cut(points, faces, plane=plane, snap=0.2)
    assert len(torn.points) > len(points)
    edges = {}
    for face in torn.faces:
        for a, b in zip(face, np.roll(face, -1)):
            ends = tuple(torn.points[a]), tuple(torn.points[b])
            edges[ends] = edges.get(ends, 0) + 1
    open_edges = [ends for ends in edges if ends[::-1] not in edges]
    assert all(abs(p[1] - q[1]) < 1e-12 and p[1] in (0, 1) or p[0] == q[0] and p[0] in (0, 4) for p, q in open_edges)

    welded = tearmesh.cut(points, faces, plane=((2.5, 0, 0), (1, 0, 0)), weld=0.0)
    assert len(set(welded.pieces)) == 2
    loose = tearmesh.cut(points, faces, plane=((2.5, 0, 0), (1, 0, 0)))
    assert len(set(loose.pieces)) > 8
    with pytest.raises(ValueError, match="weld must be a distance of 0 or more, not -1"):
        tearmesh.cut(points, faces, plane=plane, weld=-1.0)
