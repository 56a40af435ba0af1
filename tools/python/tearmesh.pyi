"""Types of the module; `help(tearmesh)` has the texts: shapes, units, and what is refused."""

from os import PathLike
from typing import Literal, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]
Triple = Sequence[float] | NDArray[np.floating]
Plane = tuple[Triple, Triple] | NDArray[np.floating]
Rays = tuple[tuple[Triple, Triple], tuple[Triple, Triple]] | NDArray[np.floating]
Per = Literal["vertex", "corner", "face"]
Layers = Literal["all", "first"]
Method = Literal["verlet", "implicit", "xpbd", "pbd", "provot"]

__version__: str

class TornMesh:
    @property
    def points(self) -> Floats: ...
    @property
    def faces(self) -> Ids: ...
    @property
    def roots(self) -> Ids: ...
    @property
    def pieces(self) -> Ids: ...
    @property
    def uv(self) -> NDArray | None: ...
    @property
    def sides(self) -> NDArray[np.int8]: ...
    @property
    def seam(self) -> list[Ids]: ...
    def map(self, values: ArrayLike, per: Per = "vertex") -> NDArray: ...

def check(faces: ArrayLike, n: int) -> list[str]: ...
def pieces(faces: ArrayLike, n: int, *, roots: ArrayLike | None = None) -> Ids: ...
def cut(
    points: ArrayLike,
    faces: ArrayLike,
    plane: Plane | None = None,
    rays: Rays | None = None,
    *,
    uv: ArrayLike | None = None,
    layers: Layers = "all",
    gap: float = 0.0,
    snap: float = 0.05,
    roots: ArrayLike | None = None,
) -> TornMesh: ...
def mend(
    points: ArrayLike,
    faces: ArrayLike,
    roots: ArrayLike,
    *,
    uv: ArrayLike | None = None,
    max_distance: float = ...,
) -> TornMesh: ...
def read_obj(path: str | PathLike[str]) -> TornMesh: ...
def write_obj(
    path: str | PathLike[str],
    points: ArrayLike,
    faces: ArrayLike,
    *,
    roots: ArrayLike | None = None,
    uv: ArrayLike | None = None,
) -> None: ...

class Simulation:
    def __init__(
        self,
        points: ArrayLike,
        faces: ArrayLike,
        *,
        roots: ArrayLike | None = None,
        density: float = 0.15,
        modulus: float = 1000.0,
        damping: float = 1.6e-3,
        method: Method = "verlet",
        stretch: float | None = 1.5,
        toughness: float | None = None,
        weakening: float | None = None,
        strengths: ArrayLike | None = None,
        gravity: Triple = (0.0, -9.81, 0.0),
        drag: float = 0.5,
        colliders: Sequence[tuple[Triple, Triple | float]] = (),
        friction: float = 0.0,
        step: float | None = None,
    ) -> None: ...
    @staticmethod
    def of_scene(
        points: ArrayLike,
        faces: ArrayLike,
        path: str | PathLike[str],
        *,
        roots: ArrayLike | None = None,
        uv: ArrayLike | None = None,
    ) -> Simulation: ...
    @property
    def points(self) -> Floats: ...
    @property
    def velocities(self) -> Floats: ...
    @property
    def faces(self) -> Ids: ...
    @property
    def roots(self) -> Ids: ...
    @property
    def pieces(self) -> Ids: ...
    @property
    def time(self) -> float: ...
    @property
    def step_length(self) -> float: ...
    @property
    def open_pairs(self) -> int: ...
    def advance(self, seconds: float, steps_max: int = ...) -> int: ...
    def step(self, count: int = 1) -> int: ...
    def hold(self, vertices: ArrayLike) -> None: ...
    def free(self, vertices: ArrayLike) -> None: ...
    def pick(self, origin: Triple, direction: Triple) -> tuple[int, int, list[float]] | None: ...
    def grab(self, vertex: int, radius: float = 0.12) -> int: ...
    def lead(self, hand: int, to: Triple) -> None: ...
    def release(self, hand: int) -> None: ...
    def cut(
        self,
        plane: Plane | None = None,
        rays: Rays | None = None,
        *,
        layers: Layers = "all",
        snap: float = 0.05,
    ) -> int: ...
    def heal(self, cut: int | None = None) -> int: ...
    def set_wind(self, velocity: Triple | None, coefficient: float = 1.0) -> None: ...
    def events(self) -> list[tuple]: ...
    def reaction(self, vertices: ArrayLike) -> Floats: ...
    def map(self, values: ArrayLike, per: Per = "vertex") -> NDArray: ...
