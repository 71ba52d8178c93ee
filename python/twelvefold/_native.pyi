from typing import Any, Protocol, final

# What the package's functions hand on; their types are in __init__.pyi.
__version__: str

class _Function(Protocol):
    def __call__(self, *arguments: Any) -> Any: ...

sample: _Function
exactly: _Function
stipple: _Function
environment: _Function
measure: _Function
mesh_points: _Function

@final
class Placement:
    def __new__(cls, domain: Any, seed: Any, density: Any, seamless: Any) -> Placement: ...
    @property
    def domain(self) -> tuple[float, float, float, float]: ...
