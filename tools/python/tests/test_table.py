"""Numbers at the border: every export of the module, by every kind of number that people pass without meaning to.

`ROWS` has a block for each function and method, and a line for each kind: what is called, and what comes of it. That is
an exception with a part of its text, or an expression that holds of `it`, the result. `MAKERS` and `PROPERTIES` do the same for attributes. What the module exports is asked of the
module, so a new export fails until it has its lines.
"""

import pickle

import numpy as np
import pytest
import tearmesh

from conftest import grid

KINDS = {
    "missed": "a result of a cut, a pick or a hand that met nothing",
    "stale": "a number or an array from before a change",
    "nan": "no number where a float belongs",
    "-1": "a negative id, count or size",
    "2^31": "a whole number beyond ids: 2³¹, 2³², 2⁶³ + 5, and what is no integer: True, 1.5",
    "whole": "whole numbers where floats belong, and ids of every dtype",
    "far": "coordinates of a map: 5e5 and 4.5e6",
    "tiny": "lengths of 1e-12 and of 1e-200",
}

# What takes a list of vertices.
VERTICES = """
    missed | sim.VERB(sim.pick(*ABOVE_AWAY)) | ValueError vertices must be integers, not object
    missed | sim.VERB([]) | it is None
    stale  | sim.VERB([gone(sim)]) | ValueError the mesh has no vertex v
    nan    | sim.VERB([nan]) | ValueError vertices must be integers, not float64
    -1     | sim.VERB([-1]) | ValueError vertices contains -1
    2^31   | sim.VERB([2**31]) | ValueError 2147483648
    2^31   | sim.VERB([2**32]) | ValueError vertices contains 4294967296
    2^31   | sim.VERB([2**32 - 1]) | ValueError 4294967295
    2^31   | sim.VERB([2**63 + 5]) | ValueError vertices contains 9223372036854775813
    2^31   | sim.VERB([1, True]) | TypeError vertices contains True
    2^31   | sim.VERB([1, np.True_]) | TypeError vertices contains
    2^31   | sim.VERB(np.ones(25, bool)) | ValueError vertices must be integers, not bool
    2^31   | sim.VERB([1.5]) | ValueError vertices must be integers, not float64
    2^31   | sim.VERB(3) | ValueError vertices must be an array of shape [n]
    whole  | [sim.VERB(np.arange(3, dtype=dtype)) for dtype in INTEGERS] | len(it) == 8
    far    | sim.VERB([500_000]) | ValueError the mesh has no vertex v500000
    tiny   | sim.VERB([1e-200]) | ValueError vertices must be integers, not float64
"""

ROWS = {
    "check": """
        missed | check(missed.faces, len(missed.points)) | it == []
        stale  | check(sliced.faces, len(P)) | 'there are 25 vertices' in it[0]
        nan    | check(F * nan, 25) | ValueError faces must be integers, not float64
        nan    | check(F, nan) | TypeError n must be an integer, not nan
        -1     | check(F - 1, 25) | ValueError faces contains -1
        -1     | check(F, -1) | ValueError n must be a number of vertices, not -1
        2^31   | check(F, 2**31) | it == []
        2^31   | check(F, 2**32) | ValueError n must be a number of vertices, not 4294967296
        2^31   | check(F, 2**63 + 5) | ValueError not 9223372036854775813
        2^31   | check(F, True) | TypeError n must be an integer, not True
        2^31   | check(F, 1.5) | TypeError n must be an integer, not 1.5
        2^31   | check([[0, 1, 2**31 - 1]], 2**31) | ValueError faces contains 2147483647, but only 1 triangles
        2^31   | check([[0, 1, 2**31]], 2**31) | ValueError faces contains 2147483648, but only 1 triangles
        2^31   | check([[0, 1, 2**32]], 9) | ValueError faces contains 4294967296
        2^31   | check([[-1, 1, 2**63 + 5]], 9) | ValueError faces contains -1
        2^31   | check([[0, 1, 2**63 + 5]], 9) | ValueError faces contains 9223372036854775813
        2^31   | check([[0, 1, 2**64 + 5]], 9) | ValueError faces contains 18446744073709551621
        2^31   | check([[0, True, 2]], 9) | TypeError faces contains True
        2^31   | check([[0, 1.5, 2]], 9) | ValueError faces must be integers, not float64
        whole  | [check(F.astype(dtype), dtype(25)) for dtype in INTEGERS] | it == [[]] * 8
        whole  | check(F.astype(bool), 25) | ValueError faces must be integers, not bool
        far    | check(F, 4_500_000) | it == []
        tiny   | check(F, 1e-200) | TypeError n must be an integer, not 1e-200
    """,
    "pieces": """
        missed | pieces(missed.faces, 25, roots=missed.roots) | set(it) == {0}
        stale  | pieces(sliced.faces, len(P)) | ValueError there are 25 vertices
        stale  | pieces(F, 25, roots=sliced.roots) | ValueError roots must be an array of shape [25]
        nan    | pieces(F, nan) | TypeError n must be an integer, not nan
        nan    | pieces(F, 25, roots=np.full(25, nan)) | ValueError roots must be integers, not float64
        -1     | pieces(F, -1) | ValueError n must be a number of vertices, not -1
        -1     | pieces(F, 25, roots=np.arange(25) - 1) | ValueError roots contains -1
        2^31   | pieces(F, 2**31) | set(it) == {0}
        2^31   | pieces(F, 2**63 + 5) | ValueError not 9223372036854775813
        2^31   | pieces(F, True) | TypeError n must be an integer, not True
        2^31   | pieces([[0, 1, 2**31 - 1]], 2**31) | ValueError faces contains 2147483647, but only 1 triangles
        2^31   | pieces(F, 25, roots=[2**31] * 25) | ValueError 2147483648
        2^31   | pieces(F, 25, roots=[2**32] * 25) | ValueError roots contains 4294967296
        2^31   | pieces(F, 25, roots=[True] * 25) | TypeError roots contains True
        whole  | [set(pieces(F.astype(dtype), dtype(25))) for dtype in INTEGERS] | it == [{0}] * 8
        far    | pieces(F, 4_500_000) | set(it) == {0}
        tiny   | pieces(F, 1e-12) | TypeError n must be an integer, not 1e-12
    """,
    "cut": """
        missed | cut(missed.points, missed.faces, PLANE, roots=missed.roots) | it.pieces.max() == 1
        missed | cut(P, F, AWAY) | it.missed and np.array_equal(it.points, P) and np.array_equal(it.faces, F)
        missed | cut(P, F, rays=RAYS_AWAY, layers='first') | it.missed
        stale  | cut(P, sliced.faces, PLANE) | ValueError there are 25 vertices
        stale  | cut(sliced.points, sliced.faces, PLANE, roots=np.arange(25)) | ValueError roots must be an array of shape
        stale  | cut(sliced.points, sliced.faces, PLANE, roots=sliced.roots, uv=P) | ValueError values per vertex begin
        nan    | cut(P * nan, F, PLANE) | ValueError not usable
        nan    | cut(P, F, ((nan, 0, 0), (1, 0, 0))) | ValueError
        nan    | cut(P, F, ((0, 0, 0), (1, nan, 0))) | ValueError
        nan    | cut(P, F, rays=(((0, nan, 5), (0, 0, -1)), ((1, 0, 5), (0, 0, -1)))) | ValueError
        nan    | cut(P, F, PLANE, gap=nan) | ValueError gap must be a length of 0 or more, not NaN
        nan    | cut(P, F, PLANE, snap=nan) | ValueError snap must be from 0 to 0.49, not NaN
        nan    | cut(P, F, PLANE, weld=nan) | ValueError weld must be a distance of 0 or more, not NaN
        nan    | cut(P, F, PLANE, uv=hole).uv | np.isnan(it).any() and np.isfinite(it[1:25]).all()
        -1     | cut(P, F - 1, PLANE) | ValueError faces contains -1
        -1     | cut(P, F, PLANE, gap=-1) | ValueError gap must be a length of 0 or more, not -1
        -1     | cut(P, F, PLANE, snap=-1) | ValueError snap must be from 0 to 0.49, not -1
        -1     | cut(P, F, PLANE, weld=-1) | ValueError weld must be a distance of 0 or more, not -1
        -1     | cut(P, F, PLANE, roots=np.arange(25) - 1) | ValueError roots contains -1
        2^31   | cut(P, F + 2**31, PLANE) | ValueError 2147483648
        2^31   | cut(P, F.astype('u8') + np.uint64(2**63 + 5), PLANE) | ValueError faces contains 9223372036854775813
        2^31   | cut(P, F, PLANE, roots=[2**32] * 25) | ValueError roots contains 4294967296
        2^31   | cut(P, F, ((2**31, 0, 0), (1, 0, 0))) | it.missed
        2^31   | cut(P, F, PLANE, gap=2**31) | finite(it.points)
        2^31   | cut(P, F, PLANE, weld=True) | it.pieces.max() == 1
        2^31   | cut([['0', '1', '2']], F, PLANE) | ValueError points must be numbers, not <U1
        2^31   | cut(P > 0, F, PLANE) | ValueError points must be numbers, not bool
        2^31   | cut(P + 1j, F, PLANE) | ValueError points must be numbers, not complex128
        whole  | cut((4 * P).astype(int), F, ((1, 0, 0), (1, 0, 0)), gap=0, snap=0, weld=0) | it.pieces.max() == 1
        whole  | [len(cut(P, F.astype(dtype), PLANE).faces) for dtype in INTEGERS] | len(set(it)) == 1
        far    | cut(100 * P + MAP, F, (MAP + (31, 0, 0), (1, 0.2, 0))) | same_cut(it, sliced)
        far    | cut(P, F, (MAP, (1, 0, 0))) | it.missed
        tiny   | cut(1e-12 * P, F, ((0.31e-12, 0, 0), (1, 0.2, 0))) | same_cut(it, sliced)
        tiny   | cut(1e-200 * P, F, ((0.31e-200, 0, 0), (1, 0.2, 0))) | same_cut(it, sliced)
        tiny   | cut(P, F, (PLANE[0], (1e-12, 0.2e-12, 0))) | same_cut(it, sliced)
        tiny   | cut(P, F, (PLANE[0], (1e-200, 0.2e-200, 0))) | same_cut(it, sliced)
        tiny   | cut(P, F, PLANE, gap=1e-200) | same_cut(it, sliced)
    """,
    "mend": """
        missed | mend(missed.points, missed.faces, missed.roots) | np.array_equal(it.points, P)
        stale  | mend(P, F, sliced.roots) | ValueError roots must be an array of shape [25]
        stale  | mend(P, sliced.faces, np.arange(25)) | ValueError
        nan    | mend(P * nan, F, np.arange(25)) | ValueError not usable
        nan    | mend(sliced.points, sliced.faces, sliced.roots, max_distance=nan) | ValueError max_distance must be a distance of 0 or more, not NaN
        -1     | mend(P, F, np.arange(25) - 1) | ValueError roots contains -1
        -1     | mend(sliced.points, sliced.faces, sliced.roots, max_distance=-1) | ValueError not -1
        2^31   | mend(P, F, [2**31] * 25) | ValueError 2147483648
        2^31   | mend(P, F, np.full(25, 2**63 + 5, 'u8')) | ValueError roots contains 9223372036854775813
        2^31   | mend(P, F, [True] * 25) | TypeError roots contains True
        2^31   | mend(sliced.points, sliced.faces, sliced.roots, max_distance=2**31) | it.pieces.max() == 0
        whole  | [len(mend(P, F, np.arange(25, dtype=dtype)).faces) for dtype in INTEGERS] | it == [32] * 8
        whole  | mend((4 * P).astype(int), F, np.arange(25), max_distance=0) | len(it.points) == 25
        far    | mend(sliced.points + MAP, sliced.faces, sliced.roots) | it.pieces.max() == 0
        tiny   | mend(1e-200 * sliced.points, sliced.faces, sliced.roots) | it.pieces.max() == 0
        tiny   | mend(sliced.points, sliced.faces, sliced.roots, max_distance=1e-200) | it.pieces.max() == 0
    """,
    "read_obj": """
        missed | read_obj(written(missed)) | np.array_equal(it.points, P)
        stale  | read_obj('gone.obj') | FileNotFoundError
        nan    | read_obj(saved('v nan 0 0')) | ValueError line 1, column 3
        -1     | read_obj(saved('v 0 0 0\\nf -1 -2 -3')) | ValueError line 2
        2^31   | read_obj(saved('v 0 0 0\\nf 1 2 9223372036854775813')) | ValueError line 2
        2^31   | read_obj(True) | TypeError
        whole  | read_obj(saved('v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nf 1 2 3')) | len(it.faces) == 1
        far    | read_obj(written(at_map)) | np.array_equal(it.points, at_map.points)
        tiny   | read_obj(saved('v 0 0 0\\nv 1e-200 0 0\\nv 0 1e-200 0\\nf 1 2 3')) | it.points.max() == 1e-200
    """,
    "write_obj": """
        missed | write_obj('a.obj', missed.points, missed.faces, roots=missed.roots) | it is None
        stale  | write_obj('a.obj', P, sliced.faces) | ValueError there are 25 vertices
        stale  | write_obj('a.obj', sliced.points, sliced.faces, roots=sliced.roots, uv=P[:, :2]) | ValueError uv must be
        nan    | write_obj('a.obj', P * nan, F) | ValueError not usable
        nan    | write_obj('a.obj', P, F, uv=P[:, :2] * nan) | ValueError uv contains NaN
        -1     | write_obj('a.obj', P, F - 1) | ValueError faces contains -1
        2^31   | write_obj('a.obj', P, F + 2**31) | ValueError 2147483648
        2^31   | write_obj('a.obj', P, F, roots=[2**32] * 25) | ValueError roots contains 4294967296
        2^31   | write_obj(True, P, F) | TypeError
        whole  | write_obj('a.obj', (4 * P).astype(int), F, uv=(4 * P[:, :2]).astype(int)) | len(read_obj('a.obj').uv) == 32
        far    | write_obj('a.obj', P + MAP, F) | np.array_equal(read_obj('a.obj').points, P + MAP)
        tiny   | write_obj('a.obj', P * 1e-200, F) | np.array_equal(read_obj('a.obj').points, P * 1e-200)
    """,
    "TornMesh": """
        missed | TornMesh() | TypeError
        stale  | TornMesh(sliced) | TypeError
        nan    | TornMesh(nan) | TypeError
        -1     | TornMesh(-1) | TypeError
        2^31   | TornMesh(2**31) | TypeError
        whole  | TornMesh(1) | TypeError
        far    | TornMesh(MAP) | TypeError
        tiny   | TornMesh(1e-200) | TypeError
    """,
    "TornMesh.map": """
        missed | missed.map(P) | np.array_equal(it, P)
        stale  | sliced.map(sliced.points) | ValueError values per vertex begin with the shape [25]
        stale  | sliced.map(sliced.faces, 'face') | ValueError values per face begin with the shape [32]
        stale  | sliced.map(sliced.points[sliced.faces], 'corner') | ValueError values per corner begin with
        nan    | sliced.map(hole) | np.isnan(it[0]).all() and np.isfinite(it[1:25]).all()
        nan    | sliced.map([None] * 25, how='mix') | ValueError only numbers can be mixed
        -1     | sliced.map(np.full(25, -1)) | set(it) == {-1}
        2^31   | sliced.map(np.full(25, 2**63 + 5, 'u8')) | set(it) == {2**63 + 5}
        2^31   | sliced.map(P, 2**31) | TypeError
        whole  | [sliced.map(np.arange(25, dtype=dtype)).dtype for dtype in INTEGERS] | it == INTEGERS
        whole  | sliced.map(np.arange(25), how='mix') | it.dtype == float
        far    | sliced.map(P + MAP) | np.allclose(it, sliced.points + MAP, rtol=0, atol=1e-8)
        tiny   | sliced.map(P * 1e-200) | np.allclose(it * 1e200, sliced.points)
    """,
    "Simulation": """
        missed | Simulation(missed.points, missed.faces, roots=missed.roots) | steps(it)
        stale  | Simulation(P, sliced.faces) | ValueError there are 25 vertices
        stale  | Simulation(sliced.points, sliced.faces, roots=sliced.roots, strengths=np.ones(25)) | ValueError 25 strengths
        nan    | Simulation(P * nan, F) | ValueError not usable
        nan    | [refused(name) for name in FLOATS] | it == ['ValueError'] * len(FLOATS)
        nan    | Simulation(P, F, strengths=[nan] * 25) | ValueError strength
        nan    | Simulation(P, F, stretch=None, strengths=[nan] * 25) | ValueError strengths makes no difference where nothing
        nan    | Simulation(P, F, stretch=None, weakening=nan) | ValueError weakening makes no difference where nothing tears
        nan    | Simulation(P, F, stretch=nan, toughness=4) | ValueError stretch must be a number of 0 or more, not NaN
        nan    | Simulation(P, F, friction=nan) | ValueError friction must be a number of 0 or more, not NaN
        nan    | Simulation(P, F, damping=nan, method='xpbd') | ValueError damping
        nan    | Simulation(P, F, gravity=(0, nan, 0)) | ValueError gravity
        nan    | Simulation(P, F, colliders=[((0, 0, nan), 1)]) | ValueError
        nan    | Simulation(P, F, colliders=[((0, 0, 0), nan)]) | ValueError
        nan    | Simulation(P, F, colliders=[((0, 0, 0), (nan, 0, 1))]) | ValueError
        -1     | Simulation(P, F - 1) | ValueError faces contains -1
        -1     | [refused(name, -1) for name in FLOATS] | it == ['ValueError'] * len(FLOATS)
        -1     | Simulation(P, F, strengths=[-1] * 25) | ValueError strength
        -1     | Simulation(P, F, colliders=[((0, 0, -9), -1)]) | ValueError radius
        2^31   | Simulation(P, F + 2**31) | ValueError 2147483648
        2^31   | Simulation(P, F, roots=[2**63 + 5] * 25) | ValueError roots contains 9223372036854775813
        2^31   | Simulation(P, F, step=2**31) | sane_or_failed(it)
        whole  | Simulation((4 * P).astype(int), F.astype(np.int8), density=1, gravity=(0, -10, 0), drag=1) | steps(it)
        far    | Simulation(100 * P + MAP, F) | steps(it)
        tiny   | Simulation(1e-12 * P, F) | steps(it)
        tiny   | Simulation(1e-200 * P, F) | ValueError
    """,
    "Simulation.of_scene": """
        missed | Simulation.of_scene(missed.points, missed.faces, scene(), roots=missed.roots) | steps(it)
        missed | Simulation.of_scene(P, F, scene('[[cut]]\\nrays = ["9,0,1:0,0,-1", "9,1,1:0,0,-1"]')) | steps(it)
        stale  | Simulation.of_scene(P, sliced.faces, scene()) | ValueError there are 25 vertices
        stale  | Simulation.of_scene(P, F, scene(), uv=sliced.points[sliced.faces][..., :2]) | ValueError uv must be
        stale  | Simulation.of_scene(P, F, 'gone.toml') | FileNotFoundError
        nan    | Simulation.of_scene(P * nan, F, scene()) | ValueError not usable
        nan    | Simulation.of_scene(P, F, scene(VT), uv=UV * nan) | ValueError f0 has no place in texture coordinates
        nan    | Simulation.of_scene(P, F, scene('seconds = nan')) | ValueError line 1
        -1     | Simulation.of_scene(P, F - 1, scene()) | ValueError faces contains -1
        -1     | Simulation.of_scene(P, F, scene('seconds = -1')) | ValueError line 1
        -1     | Simulation.of_scene(P, F, scene(VT), uv=-UV) | steps(it)
        -1     | Simulation.of_scene(P, F, scene(VT), uv=UV * (-1, 1)) | ValueError f0 is flipped in texture coordinates
        2^31   | Simulation.of_scene(P, F + 2**31, scene()) | ValueError 2147483648
        2^31   | Simulation.of_scene(P, F, scene('[[hold]]\\nvertices = [2147483648]')) | ValueError
        2^31   | Simulation.of_scene(P, F, scene('[[hold]]\\nvertices = [4294967296]')) | ValueError
        2^31   | Simulation.of_scene(P, F, True) | TypeError
        whole  | Simulation.of_scene((4 * P).astype(int), F, scene(VT), uv=(4 * UV).astype(int)) | steps(it)
        far    | Simulation.of_scene(100 * P + MAP, F, scene()) | steps(it)
        far    | Simulation.of_scene(P, F, scene(VT), uv=UV + MAP[:2]) | steps(it)
        tiny   | Simulation.of_scene(P, F, scene(VT), uv=UV * 1e-200) | ValueError f0 has no area in texture coordinates
    """,
    "Simulation.advance": """
        missed | sim.advance(sim.time) | it == 0
        stale  | sim.advance(failed(sim, 'advance', -1)) | it > 0 and steps(sim)
        nan    | sim.advance(nan) | ValueError seconds must be a time of 0 or more, not NaN
        nan    | sim.advance(inf) | ValueError seconds must be a time of 0 or more, not inf
        nan    | sim.advance(0.1, nan) | TypeError steps_max must be an integer, not nan
        -1     | sim.advance(-1) | ValueError seconds must be a time of 0 or more, not -1
        -1     | sim.advance(0.1, -1) | ValueError steps_max must be a number of steps, not -1
        2^31   | sim.advance(0.01, 2**63 + 5) | it > 0
        2^31   | sim.advance(0.01, 2**64 + 5) | ValueError steps_max must be a number of steps, not 18446744073709551621
        2^31   | sim.advance(0.01, True) | TypeError steps_max must be an integer, not True
        2^31   | sim.advance(0.01, 1.5) | TypeError steps_max must be an integer, not 1.5
        2^31   | sim.advance(2**63 + 5, 1), sim.advance(0), steps(sim) | it == (1, 0, True)
        2^31   | sim.advance(1e308, 1), sim.advance(0), steps(sim) | it == (1, 0, True)
        whole  | [sim.advance(0.5, dtype(3)) for dtype in INTEGERS] | it == [3] * 8
        whole  | sim.advance(1, 5) | it == 5
        far    | sim.advance(4.5e6, 2) | it == 2
        tiny   | sim.advance(1e-12), sim.advance(1e-200) | it == (0, 0)
    """,
    "Simulation.step": """
        missed | sim.step(0) | it == 0
        stale  | sim.step(failed(sim, 'step', -1)) | it == 1
        nan    | sim.step(nan) | TypeError count must be an integer, not nan
        -1     | sim.step(-1) | ValueError count must be a number of steps, not -1
        2^31   | sim.step(2**32) | ValueError count must be a number of steps, not 4294967296
        2^31   | sim.step(2**63 + 5) | ValueError count must be a number of steps, not 9223372036854775813
        2^31   | sim.step(True) | TypeError count must be an integer, not True
        2^31   | sim.step(1.5) | TypeError count must be an integer, not 1.5
        whole  | [sim.step(dtype(3)) for dtype in INTEGERS] | it == [3] * 8
        far    | at_map_sim.step(3) | it == 3 and steps(at_map_sim)
        tiny   | sim.step(1e-12) | TypeError count must be an integer, not 1e-12
    """,
    "Simulation.hold": VERTICES.replace("VERB", "hold"),
    "Simulation.free": VERTICES.replace("VERB", "free"),
    "Simulation.reaction": VERTICES.replace("VERB", "reaction").replace("it is None", "not it.any()"),
    "Simulation.pick": """
        missed | sim.pick(*ABOVE_AWAY) | it is None
        stale  | gone(sim) and sim.pick(*ABOVE) | it[0] < len(sim.points) and it[1] < len(sim.faces)
        nan    | sim.pick((nan, 0, 0), (0, 0, -1)) | ValueError
        nan    | sim.pick((0, 0, 0), (0, 0, nan)) | ValueError
        -1     | sim.pick((-1, -1, -1), (-1, -1, -1)) | it is None
        2^31   | sim.pick((2**31, 0, 1), (0, 0, -1)) | it is None
        2^31   | sim.pick((2**63 + 5, 0, 1), (0, 0, -1)) | it is None
        2^31   | sim.pick(True, (0, 0, -1)) | TypeError
        whole  | sim.pick((0, 0, 5), (0, 0, -1)) | it[0] == 0
        far    | at_map_sim.pick(MAP + (50, 50, 5), (0, 0, -1)) | it[0] == 12 and abs(sum(it[2]) - 1) < 1e-9
        tiny   | sim.pick((0.52, 0.52, 5), (0, 0, -1e-200)) | it[0] == 12
        tiny   | sim.pick((0.52, 0.52, 1e-200), (0, 0, -1e-12)) | it[0] == 12
    """,
    "Simulation.grab": """
        missed | sim.grab(sim.pick(*ABOVE_AWAY)) | TypeError vertex must be an integer, not None
        stale  | sim.grab(gone(sim)) | ValueError the mesh has no vertex v
        nan    | sim.grab(nan) | TypeError vertex must be an integer, not nan
        nan    | sim.grab(3, nan) | ValueError radius_m cannot be NaN
        -1     | sim.grab(-1) | ValueError vertex must be the index of a vertex, not -1
        -1     | sim.grab(3, -1) | ValueError radius_m cannot be -1
        2^31   | sim.grab(2**31 - 1) | ValueError the mesh has no vertex v2147483647
        2^31   | sim.grab(2**31) | ValueError vertex must be the index of a vertex, not 2147483648
        2^31   | sim.grab(2**32) | ValueError vertex must be the index of a vertex, not 4294967296
        2^31   | sim.grab(2**63 + 5) | ValueError vertex must be the index of a vertex, not 9223372036854775813
        2^31   | sim.grab(True) | TypeError vertex must be an integer, not True
        2^31   | sim.grab(np.True_) | TypeError vertex must be an integer, not
        2^31   | sim.grab(1.5) | TypeError vertex must be an integer, not 1.5
        2^31   | sim.grab(np.float64(1)) | TypeError vertex must be an integer, not
        2^31   | sim.grab('1') | TypeError vertex must be an integer, not '1'
        whole  | [sim.grab(dtype(v), 1) for v, dtype in enumerate(INTEGERS)] | it == [*range(8)]
        far    | at_map_sim.grab(3, 5e5) | it == 0 and steps(at_map_sim)
        tiny   | sim.grab(3, 1e-12), sim.grab(4, 1e-200) | it == (0, 1) and steps(sim)
    """,
    "Simulation.lead": """
        missed | sim.lead(sim.pick(*ABOVE_AWAY), (0, 0, 0)) | TypeError hand must be an integer, not None
        stale  | sim.lead(released(sim), (0, 0, 0)) | ValueError hand 0 does not hold anything
        nan    | sim.lead(sim.grab(3), (0, nan, 0)) | ValueError to cannot be NaN
        -1     | sim.lead(-1, (0, 0, 0)) | ValueError no such hand: -1
        2^31   | sim.lead(2**31, (0, 0, 0)) | ValueError no such hand: 2147483648
        2^31   | sim.lead(2**32, (0, 0, 0)) | ValueError no such hand: 4294967296
        2^31   | sim.lead(2**63 + 5, (0, 0, 0)) | ValueError no such hand: 9223372036854775813
        2^31   | sim.grab(3), sim.lead(False, (0, 0, 0)) | TypeError hand must be an integer, not False
        2^31   | sim.lead(0.5, (0, 0, 0)) | TypeError hand must be an integer, not 0.5
        whole  | sim.grab(3), [sim.lead(dtype(0), (1, 1, 1)) for dtype in INTEGERS] | steps(sim)
        far    | sim.lead(sim.grab(3), MAP) | it is None and steps(sim)
        tiny   | sim.lead(sim.grab(3), (1e-200, 1e-12, 0)) | it is None and steps(sim)
    """,
    "Simulation.release": """
        missed | sim.release(sim.pick(*ABOVE_AWAY)) | TypeError hand must be an integer, not None
        stale  | sim.release(released(sim)) | ValueError hand 0 does not hold anything
        nan    | sim.release(nan) | TypeError hand must be an integer, not nan
        -1     | sim.release(-1) | ValueError no such hand: -1
        2^31   | sim.release(2**31) | ValueError no such hand: 2147483648
        2^31   | sim.release(2**63 + 5) | ValueError no such hand: 9223372036854775813
        2^31   | sim.grab(3), sim.release(False) | TypeError hand must be an integer, not False
        2^31   | sim.release(1.5) | TypeError hand must be an integer, not 1.5
        whole  | [sim.release(dtype(sim.grab(3))) for dtype in INTEGERS] | it == [None] * 8
        far    | sim.release(500_000) | ValueError no such hand: 500000
        tiny   | sim.release(1e-200) | TypeError hand must be an integer, not 1e-200
    """,
    "Simulation.cut": """
        missed | sim.cut(AWAY) | it == 0 and len(sim.points) == 25 and sim.events()[0][3] == 0 and steps(sim)
        stale  | gone(sim) and sim.cut(PLANE) | it == 1 and sim.pieces.max() == 1 and steps(sim)
        nan    | sim.cut(((nan, 0, 0), (1, 0, 0))) | ValueError
        nan    | sim.cut(PLANE, snap=nan) | ValueError snap must be from 0 to 0.49, not NaN
        -1     | sim.cut(PLANE, snap=-1) | ValueError snap must be from 0 to 0.49, not -1
        2^31   | sim.cut(((2**31, 0, 0), (1, 0, 0))) | it == 0 and len(sim.points) == 25
        2^31   | sim.cut(True) | TypeError
        whole  | sim.cut(((0, 0, 0), (1, -1, 0)), snap=0) | it == 0 and sim.pieces.max() == 1 and steps(sim)
        far    | at_map_sim.cut((MAP + (31, 0, 0), (1, 0.2, 0))) | at_map_sim.pieces.max() == 1 and steps(at_map_sim)
        far    | sim.cut((MAP, (1, 0, 0))) | it == 0 and len(sim.points) == 25
        tiny   | sim.cut((PLANE[0], (1e-200, 0.2e-200, 0))) | sim.pieces.max() == 1 and steps(sim)
    """,
    "Simulation.heal": """
        missed | sim.heal(sim.cut(AWAY)) | it == 0
        missed | sim.heal() | it == 0
        stale  | healed(sim) | it == 0 and steps(sim)
        nan    | sim.heal(nan) | TypeError cut must be an integer, not nan
        -1     | sim.heal(-1) | ValueError no such cut: -1
        2^31   | sim.heal(2**31) | ValueError no such cut: 2147483648
        2^31   | sim.heal(2**63 + 5) | ValueError no such cut: 9223372036854775813
        2^31   | sim.cut(PLANE), sim.heal(False) | TypeError cut must be an integer, not False
        2^31   | sim.heal(1.5) | TypeError cut must be an integer, not 1.5
        whole  | sim.cut(PLANE), [sim.heal(dtype(0)) for dtype in INTEGERS] | it[1][0] > 0 and steps(sim)
        far    | at_map_sim.cut((MAP + (31, 0, 0), (1, 0.2, 0))), at_map_sim.heal() | it[1] > 0 and steps(at_map_sim)
        tiny   | sim.heal(1e-200) | TypeError cut must be an integer, not 1e-200
    """,
    "Simulation.set_wind": """
        missed | sim.set_wind(None) | it is None and steps(sim)
        stale  | sim.set_wind((0, 0, 3)), sim.set_wind(None) | steps(sim)
        nan    | sim.set_wind((0, nan, 0)) | ValueError NaN
        nan    | sim.set_wind((0, 1, 0), nan) | ValueError coefficient must be a number of 0 or more, not NaN
        nan    | sim.set_wind(None, nan) | ValueError coefficient must be a number of 0 or more, not NaN
        -1     | sim.set_wind((0, 1, 0), -1) | ValueError coefficient must be a number of 0 or more, not -1
        2^31   | sim.set_wind(True) | TypeError
        2^31   | sim.set_wind((2**63 + 5, 0, 0)) | it is None and sane_or_failed(sim)
        whole  | sim.set_wind((0, 0, 3), 1) | it is None and steps(sim)
        far    | sim.set_wind(MAP) | it is None and sane_or_failed(sim)
        tiny   | sim.set_wind((1e-200, 1e-12, 0), 1e-200) | it is None and steps(sim)
    """,
    "Simulation.events": """
        missed | sim.cut(AWAY) == 0 and sim.events() | it == [('cut', 0.0, 0, 0)]
        stale  | sim.cut(PLANE) == 0 and sim.events() and sim.events() | it == []
        nan    | failed(sim, 'advance', nan) and sim.events() | it == []
        -1     | sim.events(-1) | TypeError
        2^31   | sim.events(2**31) | TypeError
        whole  | sim.events(1) | TypeError
        far    | at_map_sim.cut((MAP + (31, 0, 0), (1, 0, 0))) == 0 and at_map_sim.events() | it[0][:3] == ('cut', 0.0, 0)
        tiny   | sim.events(1e-200) | TypeError
    """,
    "Simulation.map": """
        missed | sim.cut(AWAY) == 0 and sim.map(P) | np.array_equal(it, P)
        stale  | gone(sim) and sim.map(P) | ValueError values per vertex begin with the shape
        stale  | sim.cut(PLANE) == 0 and sim.map(sim.points) | ValueError values per vertex begin with the shape [25]
        nan    | sim.cut(PLANE) == 0 and sim.map(hole) | np.isnan(it[0]).all() and np.isfinite(it[1:25]).all()
        -1     | sim.map(np.full(25, -1)) | set(it) == {-1}
        2^31   | sim.map(np.full(25, 2**63 + 5, 'u8')) | set(it) == {2**63 + 5}
        2^31   | sim.map(P, True) | TypeError
        whole  | sim.cut(PLANE) == 0 and sim.map(np.arange(25), how='mix') | len(it) == len(sim.points)
        far    | sim.cut(PLANE) == 0 and sim.map(P + MAP) | np.allclose(it, sim.points + MAP, rtol=0, atol=1e-8)
        tiny   | sim.cut(PLANE) == 0 and sim.map(P * 1e-200) | np.allclose(it * 1e200, sim.points)
    """,
}

# What an attribute is read from, by kind. What refuses to make one, above, leaves nothing to read.
MAKERS = {
    "TornMesh": {
        "missed": "missed",
        "stale": "pickle.loads(pickle.dumps(sliced))",
        "whole": "cut((4 * P).astype(int), F.astype('u1'), ((1, 0, 0), (1, 0, 0)), uv=F[:25, :2])",
        "far": "at_map",
        "tiny": "cut(1e-12 * P, F, ((0.31e-12, 0, 0), (1, 0.2, 0)))",
    },
    "Simulation": {
        "missed": "(sim.cut(AWAY), sim)[1]",
        "stale": "(gone(sim), sim)[1]",
        "whole": "Simulation((4 * P).astype(int), F.astype('u1'))",
        "far": "at_map_sim",
        "tiny": "Simulation(1e-12 * P, F)",
    },
}

# The shape and the dtype of an attribute, where `n` and `m` are the numbers of points and faces; or what it is.
PROPERTIES = {
    "TornMesh.points": "(n, 3) float64",
    "TornMesh.faces": "(m, 3) int64",
    "TornMesh.roots": "(n,) int64",
    "TornMesh.pieces": "(m,) int64",
    "TornMesh.sides": "(m,) int8",
    "TornMesh.uv": "it is None or it.shape == (n, 2) and finite(it)",
    "TornMesh.seam": "all(line.shape[1] == 2 and 0 <= line.min() and line.max() < n for line in it)",
    "TornMesh.missed": "it in (True, False)",
    "Simulation.points": "(n, 3) float64",
    "Simulation.velocities": "(n, 3) float64",
    "Simulation.faces": "(m, 3) int64",
    "Simulation.roots": "(n,) int64",
    "Simulation.pieces": "(m,) int64",
    "Simulation.time": "0 <= it < 10",
    "Simulation.step_length": "0 < it < 1",
    "Simulation.open_pairs": "it >= 0",
}


P, F = grid(4)
UV = P[F][..., :2]
PLANE, AWAY = ((0.31, 0, 0), (1, 0.2, 0)), ((9, 0, 0), (1, 0, 0))
MAP = np.array([5e5, 4.5e6, 0])
TOP = range(20, 25)
INTEGERS = [np.dtype(kind).type for kind in ["i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8"]]
FLOATS = ["density", "modulus", "damping", "stretch", "toughness", "weakening", "drag", "friction", "ripple", "step"]


def finite(array):
    return bool(np.isfinite(array).all())


def is_sane(made):
    """Whether a mesh or a cloth is whole: finite points, faces that name them, and an entry for each."""
    n, m = len(made.points), len(made.faces)
    return (
        finite(made.points)
        and made.points.shape == (n, 3)
        and made.faces.shape == (m, 3)
        and (m == 0 or 0 <= made.faces.min() and made.faces.max() < n)
        and made.roots.shape == (n,)
        and made.pieces.shape == (m,)
    )


def steps(sim):
    """Whether a cloth is whole, and can go on."""
    return is_sane(sim) and sim.step(3) == 3 and is_sane(sim)


def sane_or_failed(sim):
    """Whether a cloth goes on, or says that it cannot, and is whole afterwards."""
    try:
        sim.step(3)
    except RuntimeError:
        pass
    return is_sane(sim)


def same_cut(cut, other):
    """Whether a cut of another size has the same faces and sides."""
    return all(np.array_equal(getattr(cut, name), getattr(other, name)) for name in ["faces", "sides", "roots"])


def refused(name, number=np.nan):
    """The name of the exception for a number that a cloth is made with."""
    try:
        tearmesh.Simulation(P, F, colliders=[((0, 0, -9), 1.0)], **{name: number})
    except Exception as error:
        return type(error).__name__
    return name


def failed(sim, verb, *given):
    """What a call that is refused leaves: the cloth, which goes on."""
    with pytest.raises(ValueError):
        getattr(sim, verb)(*given)
    return 1


def gone(sim):
    """A vertex that the cloth had until its cut was healed."""
    assert sim.cut(PLANE) == 0
    last = len(sim.points) - 1
    sim.heal(0)
    sim.advance(1.5)
    assert len(sim.points) <= last
    return last


def healed(sim):
    """What is left to heal of a cut that was healed."""
    gone(sim)
    return sim.heal(0)


def released(sim):
    """The number of a hand that let go."""
    hand = sim.grab(3)
    sim.release(hand)
    return hand


def lines(text):
    """The rows of a block: kind, call, outcome."""
    return [[cell.strip() for cell in line.split(" | ")] for line in text.strip().splitlines()]


@pytest.fixture
def names(tmp_path, monkeypatch):
    """What the calls of the table are made of, new for each."""
    monkeypatch.chdir(tmp_path)
    hole = P.copy()
    hole[0] = np.nan
    sim = tearmesh.Simulation(P, F)
    at_map_sim = tearmesh.Simulation(100 * P + MAP, F)
    for cloth in [sim, at_map_sim]:
        cloth.hold(TOP)

    def saved(text, name="saved.obj"):
        (tmp_path / name).write_text(text + "\n")
        return name

    def written(torn):
        tearmesh.write_obj("written.obj", torn.points, torn.faces, roots=torn.roots)
        return "written.obj"

    return vars(tearmesh) | globals() | {
        "nan": np.nan,
        "inf": np.inf,
        "hole": hole,
        "sim": sim,
        "at_map_sim": at_map_sim,
        "sliced": tearmesh.cut(P, F, PLANE),
        "missed": tearmesh.cut(P, F, AWAY),
        "at_map": tearmesh.cut(100 * P + MAP, F, (MAP + (31, 0, 0), (1, 0.2, 0))),
        "ABOVE": ((0.52, 0.52, 5), (0, 0, -1)),
        "ABOVE_AWAY": ((9, 9, 5), (0, 0, -1)),
        "RAYS_AWAY": (((9, 0, 5), (0, 0, -1)), ((9, 1, 5), (0, 0, -1))),
        "VT": "[fabric]\nvt_m = 1",
        "saved": saved,
        "scene": lambda text="": saved(text, "scene.toml"),
        "written": written,
    }


ALL = [(name, *line) for name, text in ROWS.items() for line in lines(text)]


@pytest.mark.parametrize(("name", "kind", "call", "outcome"), ALL, ids=lambda cell: cell)
def test_row(names, name, kind, call, outcome):
    exception, _, text = outcome.partition(" ")
    if exception in ("ValueError", "TypeError", "FileNotFoundError"):
        before = names["sim"].points
        with pytest.raises(Exception) as error:
            eval(call, names)
        assert error.type.__name__ == exception and text in str(error.value)
        if "gone(" not in call and "sim.cut" not in call:
            assert np.array_equal(names["sim"].points, before)
        assert steps(names["sim"])
        return
    it = eval(call, names)
    assert eval(outcome, names | {"it": it}), it
    if isinstance(it, (tearmesh.TornMesh, tearmesh.Simulation)):
        assert is_sane(it)


def properties():
    for name, outcome in PROPERTIES.items():
        owner, attribute = name.split(".")
        for kind, maker in MAKERS[owner].items():
            yield name, kind, f"{maker}.{attribute}", outcome


@pytest.mark.parametrize(("name", "kind", "call", "outcome"), [*properties()], ids=lambda cell: cell)
def test_property(names, name, kind, call, outcome):
    maker, _, attribute = call.rpartition(".")
    made = eval(maker, names)
    it = getattr(made, attribute)
    sizes = {"n": len(made.points), "m": len(made.faces), "it": it}
    if outcome.startswith("("):
        shape, _, dtype = outcome.rpartition(" ")
        assert it.shape == eval(shape, sizes) and it.dtype == dtype and finite(it)
    else:
        assert eval(outcome, names | sizes)


def exports():
    """Every public function, class, method and attribute of the module."""
    public = {name: value for name, value in vars(tearmesh).items() if not name.startswith("_")}
    # The extension that is the module.
    del public["tearmesh"]
    for name, value in public.items():
        yield name
        if isinstance(value, type):
            yield from (f"{name}.{part}" for part in vars(value) if not part.startswith("_"))


def test_every_export_has_every_kind():
    cells = {(name, kind) for name, kind, *_ in ALL}
    # Nothing is made of nan, -1 and 2^31, as the rows above show.
    cells |= {(name, kind) for name in PROPERTIES for kind in KINDS if kind in MAKERS[name.split(".")[0]]}
    cells |= {(name, kind) for name in PROPERTIES for kind in ["nan", "-1", "2^31"]}
    wanted = {(name, kind) for name in exports() for kind in KINDS}
    assert cells == wanted, sorted(cells ^ wanted)
