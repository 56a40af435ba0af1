import numpy as np
import pytest
import tearmesh

TOP = np.arange(16 * 17, 17 * 17)

SCENE = """
seconds = 1
[fabric]
density_kg_per_m2 = 0.3
[wind]
velocity_m_per_s = [0, 0, 2]
[[hold]]
across = [0, 1]
along = [1, 1]
[[cut]]
rays = ["0.5,0.9,1:0,0,-1", "0.5,0.1,1:0,0,-1"]
[[collider]]
body = "rock.obj"
cell_m = 0.05
[[strength]]
vertices = [1]
factor = 2
"""
ROCK = "v 0 0 -3\nv 1 0 -3\nv 0 1 -3\nv 0 0 -2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def test_a_scene_file_begins_as_the_command_plays_it(sheet, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    (tmp_path / "rock.obj").write_text(ROCK)
    sim = tearmesh.Simulation.of_scene(*sheet, path)
    assert [event[0] for event in sim.events()] == ["cut"]
    splits = len(sim.points) - len(sheet[0])
    assert splits > 10
    at_rest = sim.points
    sim.advance(0.1)
    assert (sim.points[TOP] == at_rest[TOP]).all()
    assert sim.points[:, 2].max() > 0.001
    assert abs(sim.reaction(TOP)[1]) > 0.1


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[wind]\nvelocity = 1\n", "line 2"),
        ("base = 'none'\n", "it is none of hang, flag, rip, trouser, fall"),
        ("base = '\N{LATIN SMALL LETTER E WITH ACUTE}'\n".encode("latin-1"), "utf-8"),
        ("[[hold]]\n[tear]\nnever = true\nthreshold = 2\n", "hold.*; .*tear"),
        ("[[hold]]\nvertices = [9999]\n", "v9998"),
        ("[fabric]\nvt_m = 1\n", "uv"),
        ("[[cut]]\nrays = ['0,0,1:0,0', '1,0,1:0,0,-1']\n", "line 2"),
        ("[[collider]]\nbody = 'broken.obj'\n[[collider]]\nbody = 'none.obj'\n", "broken.obj: .*line 1.*; .*none.obj: No such"),
    ],
)
def test_a_scene_file_is_refused_with_what_is_wrong(sheet, tmp_path, text, said):
    path = tmp_path / "scene.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    (tmp_path / "broken.obj").write_text("v 1\n")
    with pytest.raises(ValueError, match=rf"(?s)\.(toml|obj): .*{said}|{said}"):
        tearmesh.Simulation.of_scene(*sheet, path)


def test_a_scene_file_that_is_not_there_is_an_os_error(sheet, tmp_path):
    with pytest.raises(OSError):
        tearmesh.Simulation.of_scene(*sheet, tmp_path / "none.toml")


def test_a_wind_that_begins_later_is_left_to_the_program(sheet, tmp_path):
    path = tmp_path / "scene.toml"
    rest = "gravity_m_per_s2 = 0\nripple_m = 0\n[[hold]]\nacross = [0, 1]\nalong = [1, 1]\n[wind]\nvelocity_m_per_s = [0, 0, 9]\n"
    path.write_text(rest + "from_s = 5\n")
    sim = tearmesh.Simulation.of_scene(*sheet, path)
    sim.advance(0.1)
    assert np.array_equal(sim.points, sheet[0])
    path.write_text(rest)
    assert sim.step_length == tearmesh.Simulation.of_scene(*sheet, path).step_length


@pytest.mark.parametrize(
    ("place", "said"),
    [
        ((0.0, 0.0), "f40 has no area in texture coordinates"),
        ((9.0, -9.0), "f40 is flipped in texture coordinates"),
        ((np.nan, 0.0), "f40 has no place in texture coordinates"),
    ],
)
def test_texture_coordinates_are_refused_in_the_words_of_the_command(sheet, tmp_path, place, said):
    path = tmp_path / "scene.toml"
    path.write_text("[fabric]\nvt_m = 0.5\n")
    uv = sheet[0][sheet[1]][:, :, :2]
    uv[40] = [uv[40, 0], uv[40, 1], uv[40, 0] + place]
    with pytest.raises(ValueError, match=said):
        tearmesh.Simulation.of_scene(*sheet, path, uv=uv)


def test_texture_coordinates_are_the_shape_at_rest(sheet, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text("[fabric]\nvt_m = 0.5\n[[hold]]\nalong = [1, 1]\nacross = [0, 1]\n[tear]\nnever = true\n")
    points, faces = sheet
    sim = tearmesh.Simulation.of_scene(points, faces, path, uv=points[faces][:, :, :2])
    # Stretched to twice its length, it pulls hard.
    sim.step()
    assert abs(sim.reaction(TOP)[1]) > 100
