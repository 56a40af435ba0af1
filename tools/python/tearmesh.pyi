"""Types of the module; `help(tearmesh)` has the texts: shapes, units, and what is refused."""

from os import PathLike
from typing import Any, Literal, Sequence, SupportsIndex, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Floats = NDArray[np.float64]
_Ids = NDArray[np.int64]
_Triple = Sequence[float] | NDArray[np.floating]
_Plane = tuple[_Triple, _Triple] | NDArray[np.floating]
_Rays = tuple[tuple[_Triple, _Triple], tuple[_Triple, _Triple]] | NDArray[np.floating]
_Per = Literal["vertex", "corner", "face"]
_How = Literal["mix", "source"]
_Layers = Literal["all", "first"]
_Method = Literal["verlet", "implicit", "xpbd", "pbd", "provot"]

__version__: str
__all__ = ["Simulation", "TornMesh", "__version__", "check", "cut", "mend", "pieces", "read_obj", "write_obj"]

@final
class TornMesh:
    @property
    def points(self) -> _Floats: ...
    @property
    def faces(self) -> _Ids: ...
    @property
    def roots(self) -> _Ids: ...
    @property
    def pieces(self) -> _Ids: ...
    @property
    def uv(self) -> NDArray | None: ...
    @property
    def sides(self) -> NDArray[np.int8]: ...
    @property
    def seam(self) -> list[_Ids]: ...
    @property
    def missed(self) -> bool: ...
    def map(self, values: ArrayLike, per: _Per = "vertex", how: _How | None = None) -> NDArray: ...
    def __copy__(self) -> TornMesh: ...
    def __deepcopy__(self, _memo: Any, /) -> TornMesh: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

def check(faces: ArrayLike, n: SupportsIndex) -> list[str]: ...
def pieces(faces: ArrayLike, n: SupportsIndex, *, roots: ArrayLike | None = None) -> _Ids: ...
def cut(
    points: ArrayLike,
    faces: ArrayLike,
    plane: _Plane | None = None,
    rays: _Rays | None = None,
    *,
    uv: ArrayLike | None = None,
    layers: _Layers = "all",
    gap: float = 0.0,
    snap: float = 0.05,
    roots: ArrayLike | None = None,
    weld: float | bool | None = None,
) -> TornMesh: ...
def mend(
    points: ArrayLike,
    faces: ArrayLike,
    roots: ArrayLike,
    *,
    uv: ArrayLike | None = None,
    max_distance: float | None = None,
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

@final
class Simulation:
    def __new__(
        cls,
        points: ArrayLike,
        faces: ArrayLike,
        *,
        roots: ArrayLike | None = None,
        density: float = 0.15,
        modulus: float = 1000.0,
        damping: float = 1.6e-3,
        method: _Method = "verlet",
        stretch: float | None = 1.5,
        toughness: float | None = None,
        weakening: float | None = None,
        strengths: ArrayLike | None = None,
        gravity: _Triple | None = None,
        drag: float = 0.5,
        colliders: Sequence[tuple[_Triple, _Triple | float]] | None = None,
        friction: float = 0.0,
        ripple: float | None = None,
        step: float | None = None,
    ) -> Simulation: ...
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
    def points(self) -> _Floats: ...
    @property
    def velocities(self) -> _Floats: ...
    @property
    def faces(self) -> _Ids: ...
    @property
    def roots(self) -> _Ids: ...
    @property
    def pieces(self) -> _Ids: ...
    @property
    def time(self) -> float: ...
    @property
    def step_length(self) -> float: ...
    @property
    def open_pairs(self) -> int: ...
    def advance(self, seconds: float, steps_max: SupportsIndex | None = None) -> int: ...
    def step(self, count: SupportsIndex = 1) -> int: ...
    def hold(self, vertices: ArrayLike) -> None: ...
    def free(self, vertices: ArrayLike) -> None: ...
    def pick(self, origin: _Triple, direction: _Triple) -> tuple[int, int, list[float]] | None: ...
    def grab(self, vertex: SupportsIndex, radius: float = 0.12) -> int: ...
    def lead(self, hand: SupportsIndex, to: _Triple) -> None: ...
    def release(self, hand: SupportsIndex) -> None: ...
    def cut(
        self,
        plane: _Plane | None = None,
        rays: _Rays | None = None,
        *,
        layers: _Layers = "all",
        snap: float = 0.05,
    ) -> int: ...
    def heal(self, cut: SupportsIndex | None = None) -> int: ...
    def set_wind(self, velocity: _Triple | None, coefficient: float = 1.0) -> None: ...
    def events(self) -> list[tuple]: ...
    def reaction(self, vertices: ArrayLike) -> _Floats: ...
    def map(self, values: ArrayLike, per: _Per = "vertex", how: _How | None = None) -> NDArray: ...
