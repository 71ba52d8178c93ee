from typing import Literal, Optional, Tuple, Union, overload

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

__version__: str

Rectangle = Tuple[float, float, float, float]
Points = NDArray[np.floating]

@overload
def sample(
    importance: Optional[ArrayLike] = None,
    n: Optional[float] = None,
    *,
    density: Optional[float] = None,
    relaxed: bool = True,
    domain: Optional[Rectangle] = None,
    seed: int = 0,
    dtype: DTypeLike = "float32",
    weights: Literal[False] = False,
    part: Optional[Tuple[int, int]] = None,
) -> Points: ...
@overload
def sample(
    importance: Optional[ArrayLike] = None,
    n: Optional[float] = None,
    *,
    density: Optional[float] = None,
    relaxed: bool = True,
    domain: Optional[Rectangle] = None,
    seed: int = 0,
    dtype: DTypeLike = "float32",
    weights: Literal[True],
    part: Optional[Tuple[int, int]] = None,
) -> Tuple[Points, NDArray[np.float64]]: ...
def exactly(
    importance: Optional[ArrayLike] = None,
    n: int = 0,
    *,
    domain: Optional[Rectangle] = None,
    seed: int = 0,
) -> Tuple[NDArray[np.float64], NDArray[np.float64]]: ...
def environment(
    map: ArrayLike,
    n: int,
    *,
    method: str = "progressive",
    seed: int = 0,
    negative: Literal["reject", "zero"] = "reject",
) -> Tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float32]]: ...

class Placement:
    def __init__(self, domain: Rectangle = (0.0, 0.0, 1.0, 1.0), seed: int = 0) -> None: ...
    @property
    def domain(self) -> Rectangle: ...
    @property
    def seed(self) -> int: ...
    def sample(
        self,
        importance: Optional[ArrayLike] = None,
        n: Optional[float] = None,
        *,
        density: Optional[float] = None,
        relaxed: bool = True,
        dtype: DTypeLike = "float32",
        weights: bool = False,
        part: Optional[Tuple[int, int]] = None,
    ) -> Union[Points, Tuple[Points, NDArray[np.float64]]]: ...
