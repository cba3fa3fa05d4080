from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "HIT",
    "RAY",
    "Camera",
    "LodrayError",
    "Machine",
    "MachinePart",
    "Scene",
    "SceneMethod",
    "__version__",
    "machines",
    "methods",
    "paths",
]

__version__: str
HIT: np.dtype[np.void]
RAY: np.dtype[np.void]

_Path = str | PathLike[str]
_Triple = Sequence[float] | NDArray[np.floating[Any]] | NDArray[np.integer[Any]]
_Size = Sequence[int] | NDArray[np.integer[Any]]
_Progress = Callable[[str, int, int | None], object]
_Machine = Machine | _Path | dict[str, Any]

class LodrayError(ValueError): ...

@final
class Camera:
    @property
    def eye(self) -> list[float]: ...
    @property
    def target(self) -> list[float]: ...
    @property
    def up(self) -> list[float]: ...
    @property
    def fov(self) -> float: ...
    @property
    def size(self) -> tuple[int, int]: ...
    @property
    def distance(self) -> float: ...
    @property
    def cone(self) -> float: ...
    def rays(self) -> NDArray[np.void]: ...
    def __copy__(self) -> Camera: ...
    def __deepcopy__(self, _memo: Any, /) -> Camera: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class MachinePart:
    def to_dict(self) -> dict[str, Any]: ...
    def __getattr__(self, name: str) -> Any: ...
    def __setattr__(self, name: str, value: object, /) -> None: ...
    def __dir__(self) -> list[str]: ...

@final
class Machine:
    def __new__(cls, description: _Machine) -> Machine: ...
    @property
    def title(self) -> str: ...
    def set(self, changes: dict[str, Any]) -> None: ...
    def copy(self) -> Machine: ...
    def to_dict(self) -> dict[str, Any]: ...
    def __copy__(self) -> Machine: ...
    def __deepcopy__(self, _memo: Any, /) -> Machine: ...
    def __eq__(self, other: object, /) -> bool: ...
    __hash__: ClassVar[None]  # type: ignore[assignment]
    def __reduce__(self) -> tuple[Any, ...]: ...
    def __getattr__(self, name: str) -> Any: ...
    def __setattr__(self, name: str, value: object, /) -> None: ...
    def __dir__(self) -> list[str]: ...

@final
class SceneMethod:
    @property
    def name(self) -> str: ...
    def cast(
        self,
        rays: ArrayLike,
        directions: ArrayLike | None = None,
        *,
        radius: ArrayLike | None = None,
        cone: ArrayLike | None = None,
        t_min: ArrayLike | None = None,
        t_max: ArrayLike | None = None,
        follow: bool = True,
        progress: _Progress | None = None,
    ) -> NDArray[np.void]: ...
    def all_hits(
        self,
        rays: ArrayLike,
        directions: ArrayLike | None = None,
        *,
        radius: ArrayLike | None = None,
        cone: ArrayLike | None = None,
        t_min: ArrayLike | None = None,
        t_max: ArrayLike | None = None,
        progress: _Progress | None = None,
    ) -> tuple[NDArray[np.void], NDArray[np.int64]]: ...
    def occluded(
        self,
        rays: ArrayLike,
        directions: ArrayLike | None = None,
        *,
        radius: ArrayLike | None = None,
        cone: ArrayLike | None = None,
        t_min: ArrayLike | None = None,
        t_max: ArrayLike | None = None,
        progress: _Progress | None = None,
    ) -> NDArray[np.bool_]: ...
    def count(
        self,
        rays: ArrayLike,
        directions: ArrayLike | None = None,
        *,
        radius: ArrayLike | None = None,
        cone: ArrayLike | None = None,
        t_min: ArrayLike | None = None,
        t_max: ArrayLike | None = None,
        progress: _Progress | None = None,
    ) -> NDArray[np.int64]: ...
    def render(
        self,
        camera: Camera | None = None,
        *,
        what: str = "image",
        samples: int = 1,
        shading: str | None = None,
        progress: _Progress | None = None,
    ) -> NDArray[Any]: ...
    def simulate(
        self,
        machine: _Machine | Sequence[_Machine],
        camera: Camera | None = None,
        *,
        rays: ArrayLike | None = None,
        compute: str = "free",
        frames: int = 1,
        turn: float = 3.0,
        tiles_in_turn: int = 1,
        progress: _Progress | None = None,
    ) -> Any: ...

@final
class Scene:
    @staticmethod
    def open(path: _Path) -> Scene: ...
    @staticmethod
    def build(
        mesh: ArrayLike | _Path,
        faces: ArrayLike | None = None,
        *,
        max_error: float | None = None,
        levels: int | None = None,
        base: int | None = None,
        crease_angle: float | None = None,
        own_triangles: bool = False,
        bounds: str | None = None,
        vertex_form: str | None = None,
        name: str = "",
        keep_mesh: bool = False,
        progress: _Progress | None = None,
    ) -> Scene: ...
    @staticmethod
    def exact(vertices: ArrayLike, faces: ArrayLike) -> tuple[Scene, NDArray[np.int64]]: ...
    @staticmethod
    def generate(
        scene: str,
        *,
        levels: int | None = None,
        base: int | None = None,
        seed: int = 0,
        roughness: float | None = None,
        walls: int | None = None,
        width: float | None = None,
    ) -> Scene: ...
    @property
    def info(self) -> dict[str, Any]: ...
    def verify(self) -> dict[str, Any]: ...
    def save(self, path: _Path) -> None: ...
    def export(self, path: _Path, level: int | None = None) -> dict[str, Any]: ...
    def mesh(self, level: int | None = None) -> tuple[NDArray[np.float64], NDArray[np.int64]]: ...
    def refit(self, vertices: ArrayLike, *, normals: str = "smooth", grid: str = "new") -> Scene: ...
    def method(self, name: str = "lod", **knobs: Any) -> SceneMethod: ...
    def cast(
        self,
        rays: ArrayLike,
        directions: ArrayLike | None = None,
        *,
        method: str = "lod",
        radius: ArrayLike | None = None,
        cone: ArrayLike | None = None,
        t_min: ArrayLike | None = None,
        t_max: ArrayLike | None = None,
        follow: bool = True,
        progress: _Progress | None = None,
        **knobs: Any,
    ) -> NDArray[np.void]: ...
    def all_hits(
        self,
        rays: ArrayLike,
        directions: ArrayLike | None = None,
        *,
        method: str = "lod",
        radius: ArrayLike | None = None,
        cone: ArrayLike | None = None,
        t_min: ArrayLike | None = None,
        t_max: ArrayLike | None = None,
        progress: _Progress | None = None,
        **knobs: Any,
    ) -> tuple[NDArray[np.void], NDArray[np.int64]]: ...
    def occluded(
        self,
        rays: ArrayLike,
        directions: ArrayLike | None = None,
        *,
        method: str = "lod",
        radius: ArrayLike | None = None,
        cone: ArrayLike | None = None,
        t_min: ArrayLike | None = None,
        t_max: ArrayLike | None = None,
        progress: _Progress | None = None,
        **knobs: Any,
    ) -> NDArray[np.bool_]: ...
    def count(
        self,
        rays: ArrayLike,
        directions: ArrayLike | None = None,
        *,
        method: str = "lod",
        radius: ArrayLike | None = None,
        cone: ArrayLike | None = None,
        t_min: ArrayLike | None = None,
        t_max: ArrayLike | None = None,
        progress: _Progress | None = None,
        **knobs: Any,
    ) -> NDArray[np.int64]: ...
    def camera(
        self,
        *,
        size: _Size = ...,
        distance: float | None = None,
        eye: _Triple | None = None,
        target: _Triple | None = None,
        up: _Triple | None = None,
        yaw: float | None = None,
        pitch: float | None = None,
        fov: float | None = None,
    ) -> Camera: ...
    def render(
        self,
        camera: Camera | None = None,
        *,
        what: str = "image",
        samples: int = 1,
        shading: str | None = None,
        method: str = "lod",
        progress: _Progress | None = None,
        **knobs: Any,
    ) -> NDArray[Any]: ...
    def simulate(
        self,
        machine: _Machine | Sequence[_Machine],
        camera: Camera | None = None,
        *,
        rays: ArrayLike | None = None,
        method: str = "lod",
        compute: str = "free",
        frames: int = 1,
        turn: float = 3.0,
        tiles_in_turn: int = 1,
        progress: _Progress | None = None,
        **knobs: Any,
    ) -> Any: ...
    def error_time(
        self,
        distances: Sequence[float],
        *,
        size: _Size = ...,
        methods: Sequence[str] = ...,
        machine: _Machine | Sequence[_Machine] | None = None,
        compute: str = "free",
        values: dict[str, Any] | None = None,
        samples: int = 1,
        error_size: int = 192,
        most_samples: int = 0,
        out: _Path | None = None,
        progress: _Progress | None = None,
    ) -> dict[str, Any]: ...
    def plan(
        self,
        distances: Sequence[float] = ...,
        *,
        size: _Size = ...,
        delta: float = 1.0,
        progress: _Progress | None = None,
    ) -> dict[str, Any]: ...

def methods() -> list[dict[str, Any]]: ...
def machines() -> list[str]: ...
def paths(
    description: _Path | dict[str, Any],
    models: Sequence[Scene] | None = None,
    *,
    camera: str | None = None,
    size: _Size | None = None,
    samples: int | None = None,
    depth: int | None = None,
    seed: int | None = None,
    time: float = 0.0,
    starts: str | float | None = None,
    method: str = "lod",
    progress: _Progress | None = None,
    **knobs: Any,
) -> dict[str, Any]: ...
