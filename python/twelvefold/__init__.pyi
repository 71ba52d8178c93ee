from typing import Literal, SupportsIndex, overload

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

__all__ = [
    "Placement",
    "environment",
    "exactly",
    "measure",
    "mesh_points",
    "sample",
    "stipple",
    "__version__",
]

__version__: str

_Rectangle = tuple[float, float, float, float]
_Points = NDArray[np.floating]
_Weights = NDArray[np.float64]
_Ranks = NDArray[np.uint64]

def stipple(
    image: ArrayLike,
    n: SupportsIndex,
    *,
    refine: SupportsIndex = 10,
    best: bool = False,
    exact: bool = False,
    relaxed: bool = True,
    seed: SupportsIndex = 0,
    part: tuple[int, int] | None = None,
    invert: bool = False,
    linear: bool = False,
    black: float = 0,
    white: float | None = None,
    gamma: float = 1.0,
) -> NDArray[np.float32]: ...
@overload
def sample(
    importance: ArrayLike | None = None,
    n: float | None = None,
    *,
    density: float | None = None,
    relaxed: bool = True,
    domain: _Rectangle | None = None,
    seed: SupportsIndex = 0,
    seamless: bool = False,
    dtype: DTypeLike | None = None,
    weights: Literal[False] = False,
    ranks: Literal[False] = False,
    part: tuple[int, int] | None = None,
) -> _Points: ...
@overload
def sample(
    importance: ArrayLike | None = None,
    n: float | None = None,
    *,
    density: float | None = None,
    relaxed: bool = True,
    domain: _Rectangle | None = None,
    seed: SupportsIndex = 0,
    seamless: bool = False,
    dtype: DTypeLike | None = None,
    weights: Literal[True],
    ranks: Literal[False] = False,
    part: tuple[int, int] | None = None,
) -> tuple[_Points, _Weights]: ...
@overload
def sample(
    importance: ArrayLike | None = None,
    n: float | None = None,
    *,
    density: float | None = None,
    relaxed: bool = True,
    domain: _Rectangle | None = None,
    seed: SupportsIndex = 0,
    seamless: bool = False,
    dtype: DTypeLike | None = None,
    weights: Literal[False] = False,
    ranks: Literal[True],
    part: tuple[int, int] | None = None,
) -> tuple[_Points, _Ranks]: ...
@overload
def sample(
    importance: ArrayLike | None = None,
    n: float | None = None,
    *,
    density: float | None = None,
    relaxed: bool = True,
    domain: _Rectangle | None = None,
    seed: SupportsIndex = 0,
    seamless: bool = False,
    dtype: DTypeLike | None = None,
    weights: Literal[True],
    ranks: Literal[True],
    part: tuple[int, int] | None = None,
) -> tuple[_Points, _Weights, _Ranks]: ...
@overload
def sample(
    importance: ArrayLike | None = None,
    n: float | None = None,
    *,
    density: float | None = None,
    relaxed: bool = True,
    domain: _Rectangle | None = None,
    seed: SupportsIndex = 0,
    seamless: bool = False,
    dtype: DTypeLike | None = None,
    weights: bool = False,
    ranks: bool = False,
    part: tuple[int, int] | None = None,
) -> _Points | tuple[NDArray[np.generic], ...]: ...
def exactly(
    importance: ArrayLike | None = None,
    n: SupportsIndex | None = None,
    *,
    domain: _Rectangle | None = None,
    seed: SupportsIndex = 0,
    seamless: bool = False,
) -> tuple[NDArray[np.float64], _Weights]: ...
def environment(
    map: ArrayLike,
    n: SupportsIndex,
    *,
    method: Literal["sobol", "progressive", "warp"] = "sobol",
    frame: Literal["pbrt", "mitsuba", "blender", "gltf", "openexr"] = "pbrt",
    rotate: float = 0.0,
    seed: SupportsIndex = 0,
    filter: Literal["nearest", "bilinear"] = "nearest",
    negative: Literal["reject", "zero"] = "reject",
    infinite: Literal["reject", "zero"] | float = "reject",
    nan: Literal["reject", "zero"] = "reject",
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float32]]: ...
def mesh_points(
    vertices: ArrayLike,
    faces: ArrayLike,
    n: SupportsIndex,
    *,
    density: ArrayLike | None = None,
    relax: SupportsIndex = 10,
    seed: SupportsIndex = 0,
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64]]: ...
def measure(
    points: ArrayLike,
    *,
    window: _Rectangle | None = None,
    importance: ArrayLike | None = None,
) -> dict[str, float]: ...

class Placement:
    def __init__(
        self,
        domain: _Rectangle = (0.0, 0.0, 1.0, 1.0),
        seed: SupportsIndex = 0,
        *,
        density: float | None = None,
        seamless: bool = False,
    ) -> None: ...
    @property
    def domain(self) -> _Rectangle: ...
    @property
    def seed(self) -> int: ...
    @property
    def density(self) -> float | None: ...
    @property
    def seamless(self) -> bool: ...
    @overload
    def sample(
        self,
        importance: ArrayLike | None = None,
        n: float | None = None,
        *,
        density: float | None = None,
        relaxed: bool = True,
        dtype: DTypeLike | None = None,
        weights: Literal[False] = False,
        ranks: Literal[False] = False,
        part: tuple[int, int] | None = None,
    ) -> _Points: ...
    @overload
    def sample(
        self,
        importance: ArrayLike | None = None,
        n: float | None = None,
        *,
        density: float | None = None,
        relaxed: bool = True,
        dtype: DTypeLike | None = None,
        weights: Literal[True],
        ranks: Literal[False] = False,
        part: tuple[int, int] | None = None,
    ) -> tuple[_Points, _Weights]: ...
    @overload
    def sample(
        self,
        importance: ArrayLike | None = None,
        n: float | None = None,
        *,
        density: float | None = None,
        relaxed: bool = True,
        dtype: DTypeLike | None = None,
        weights: Literal[False] = False,
        ranks: Literal[True],
        part: tuple[int, int] | None = None,
    ) -> tuple[_Points, _Ranks]: ...
    @overload
    def sample(
        self,
        importance: ArrayLike | None = None,
        n: float | None = None,
        *,
        density: float | None = None,
        relaxed: bool = True,
        dtype: DTypeLike | None = None,
        weights: Literal[True],
        ranks: Literal[True],
        part: tuple[int, int] | None = None,
    ) -> tuple[_Points, _Weights, _Ranks]: ...
    @overload
    def sample(
        self,
        importance: ArrayLike | None = None,
        n: float | None = None,
        *,
        density: float | None = None,
        relaxed: bool = True,
        dtype: DTypeLike | None = None,
        weights: bool = False,
        ranks: bool = False,
        part: tuple[int, int] | None = None,
    ) -> _Points | tuple[NDArray[np.generic], ...]: ...
    def exactly(
        self,
        importance: ArrayLike | None = None,
        n: SupportsIndex | None = None,
    ) -> tuple[NDArray[np.float64], _Weights]: ...
    def __eq__(self, other: object) -> bool: ...
    def __hash__(self) -> int: ...
