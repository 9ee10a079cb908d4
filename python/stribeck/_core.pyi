from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias, TypedDict, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stribeck.exporters.rows import ProgramRow
from stribeck.models.rows import CoreCatalog, ParameterRow
from stribeck.passivity.rows import AnswerRow
from stribeck.robot.arm import LinkRow

__all__ = [
    "Expression",
    "Formula",
    "Model",
    "ModelError",
    "Requirement",
    "RigidBodies",
    "__version__",
    "bounded_least_squares",
    "catalog",
    "column_formula",
    "column_functions",
    "compensate",
    "divided_differences",
    "elementary",
    "elementary_constants",
    "first_order",
    "formula_functions",
    "fourier",
    "largest_factor",
    "learn",
    "least_squares",
    "low_pass",
    "margins",
    "missed",
    "normal_equations",
    "passivity",
    "pivots",
    "reduced",
    "requirements",
    "search",
    "search_by",
    "simulate",
    "simulate_arm",
    "simulate_robot",
    "singular",
    "slides",
    "solve",
    "spring_torque_curvature",
    "stroke",
    "symmetric_eigen",
    "triangle",
    "triangles_of",
    "units",
    "work",
]

_Desired: TypeAlias = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]

__version__: str

class ModelError(ValueError): ...

def elementary(
    function: str, x: Sequence[float], other: Sequence[float] = ..., *, single: bool = False
) -> list[float]: ...
def elementary_constants(*, single: bool = False) -> dict[str, list[float]]: ...
def catalog() -> CoreCatalog: ...

class _Dimension(TypedDict):
    name: str
    si: str
    unit: str | None
    powers: tuple[int, int, int, int] | None

class _Unit(TypedDict):
    dimension: str
    spellings: list[str]
    factor: float
    offset: float

class _Channel(TypedDict):
    name: str
    unit: str
    powers: tuple[int, int, int, int]

class _Units(TypedDict):
    dimensions: list[_Dimension]
    units: list[_Unit]
    channels: list[_Channel]

@final
class RigidBodies:
    def __new__(
        cls,
        links: Sequence[LinkRow],
        gravity: Sequence[float],
        coupling: Sequence[Sequence[float]] | None = None,
    ) -> RigidBodies: ...
    @property
    def joints_per_motor(self) -> list[list[float]] | None: ...
    def of_motors(
        self,
        position: ArrayLike,
        velocity: ArrayLike,
        acceleration: ArrayLike,
        *,
        single: bool = False,
    ) -> list[NDArray[np.float64]]: ...
    def inverse_dynamics(
        self,
        position: ArrayLike,
        velocity: ArrayLike,
        acceleration: ArrayLike,
        *,
        single: bool = False,
    ) -> NDArray[np.float64]: ...
    def regressor(
        self, position: ArrayLike, velocity: ArrayLike, acceleration: ArrayLike
    ) -> NDArray[np.float64]: ...
    def inverse_dynamics_derivatives(
        self, position: ArrayLike, velocity: ArrayLike, acceleration: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    def mass_matrix(self, position: ArrayLike) -> NDArray[np.float64]: ...
    def gravity_torque(self, position: ArrayLike) -> NDArray[np.float64]: ...
    def forward_dynamics(
        self, position: ArrayLike, velocity: ArrayLike, torque: ArrayLike
    ) -> NDArray[np.float64]: ...

def units() -> _Units: ...
def column_formula(text: str) -> list[tuple[str, float | str | tuple[str, int] | None, int]]: ...
def column_functions() -> list[str]: ...
def formula_functions() -> list[tuple[str, str]]: ...
def divided_differences(times: ArrayLike, values: ArrayLike, order: int) -> NDArray[np.float64]: ...
def low_pass(signals: ArrayLike, cutoff: float, padding: int) -> NDArray[np.float64]: ...
def first_order(steps: ArrayLike, values: ArrayLike, lag: float) -> NDArray[np.float64]: ...
def spring_torque_curvature(
    steps: ArrayLike, load: ArrayLike, period: float, damping: float, hardening: float | None
) -> NDArray[np.float64]: ...
def learn(
    features: ArrayLike, values: ArrayLike, unseen: ArrayLike, trees: int, fewest_in_leaf: int
) -> NDArray[np.float64]: ...
def normal_equations(
    jacobian: ArrayLike, residual: ArrayLike, group: ArrayLike, groups: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]: ...
def triangle(
    jacobian: ArrayLike, residual: ArrayLike, group: ArrayLike, groups: int
) -> NDArray[np.float64]: ...
def triangles_of(
    model: Model,
    measured: Mapping[str, object],
    groups: int,
    values: ArrayLike,
    wanted: list[int],
    slope: ArrayLike,
) -> NDArray[np.float64] | None: ...
def slides(model: Model, measured: Mapping[str, object], values: ArrayLike) -> list[bool]: ...
def search(
    model: Model,
    measured: Mapping[str, object],
    starts: ArrayLike,
    within: Mapping[str, object],
) -> list[tuple[NDArray[np.float64], float, bool, str, int, list[int]]]: ...
def reduced(
    model: Model,
    measured: Mapping[str, object],
    points: ArrayLike,
    within: Mapping[str, object],
    sloped: bool,
) -> list[tuple[NDArray[np.float64], float, NDArray[np.float64]] | None]: ...
def search_by(
    problem: object, start: ArrayLike, within: Mapping[str, object]
) -> tuple[NDArray[np.float64], float, bool, str, int, list[int]]: ...
def bounded_least_squares(
    matrix: ArrayLike, right: ArrayLike, lower: ArrayLike, upper: ArrayLike
) -> NDArray[np.float64]: ...
def least_squares(matrix: ArrayLike, right: ArrayLike, unseen: float) -> NDArray[np.float64]: ...
def singular(matrix: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
def symmetric_eigen(matrix: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
def solve(matrix: ArrayLike, right: ArrayLike) -> NDArray[np.float64]: ...
def pivots(matrix: ArrayLike) -> list[int]: ...
def passivity(
    model: Model,
    values: ArrayLike,
    sides: Mapping[str, tuple[float, float]],
    budget: int,
) -> AnswerRow: ...
def missed(
    model: Model,
    values: ArrayLike,
    sides: Mapping[str, tuple[float, float]],
    budget: int,
) -> tuple[bool | None, str, Requirement | None]: ...
def requirements(
    model: Model,
    values: ArrayLike,
    sides: Mapping[str, tuple[float, float]],
) -> list[Requirement]: ...
def margins(
    model: Model, values: ArrayLike, requirements: Sequence[Requirement]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
def work(
    model: Model,
    values: ArrayLike,
    deflection: float | None,
    steps: Sequence[tuple[float, Mapping[str, float]]],
) -> tuple[float, float]: ...
def simulate(
    model: Model,
    values: ArrayLike,
    joint: Mapping[str, float],
    acting: Mapping[str, ArrayLike],
    start: tuple[float, float],
    deflection: float,
    controller: Mapping[str, float] | None = None,
    transmission: Mapping[str, float] | None = None,
) -> dict[str, NDArray[np.float64]]: ...
def simulate_arm(
    models: tuple[Model, Model],
    values: tuple[ArrayLike, ArrayLike],
    arm: Mapping[str, float],
    acting: Mapping[str, ArrayLike],
    dt: float,
    start: tuple[Sequence[float], Sequence[float]],
    controllers: tuple[Mapping[str, float] | None, Mapping[str, float] | None],
) -> dict[str, NDArray[np.float64]]: ...
def simulate_robot(
    bodies: RigidBodies,
    models: Sequence[Model],
    values: Sequence[ArrayLike],
    acting: Mapping[str, ArrayLike],
    dt: float,
    start: tuple[Sequence[float], Sequence[float]],
    controllers: Sequence[Mapping[str, float] | None],
) -> tuple[dict[str, NDArray[np.float64]], int]: ...
def compensate(
    model: Model,
    values: ArrayLike,
    joint: Mapping[str, float],
    given: Mapping[str, ArrayLike],
    dt: float,
    controller: Mapping[str, float],
    compensator: Mapping[str, object] | None = None,
    bandwidth: float | None = None,
    guided: bool = False,
    resolution: float = 0.0,
) -> dict[str, NDArray[np.float64]]: ...
def largest_factor(
    compensator: tuple[Model, ArrayLike],
    friction: tuple[Model, ArrayLike, ArrayLike],
    sides: Mapping[str, tuple[float, float]],
    budget: int,
) -> tuple[float, float, dict[str, float] | None]: ...
def stroke(
    time: ArrayLike, ends: tuple[float, float], dwell: float, limits: Sequence[float]
) -> tuple[_Desired, float]: ...
def fourier(
    time: ArrayLike,
    centre: float,
    frequency: float,
    sine: Sequence[float],
    cosine: Sequence[float],
) -> _Desired: ...

@final
class Requirement:
    @property
    def kind(self) -> str: ...
    @property
    def points(self) -> list[dict[str, float]]: ...
    @property
    def force(self) -> float | None: ...

@final
class Formula:
    def __new__(cls, text: str) -> Formula: ...
    @property
    def names(self) -> list[str]: ...
    @property
    def roles(self) -> list[str]: ...
    @property
    def channels(self) -> list[str]: ...
    @property
    def operations(self) -> list[tuple[str, float | int | str | None]]: ...
    @property
    def terms(self) -> list[dict[str, Any]]: ...

@final
class Expression:
    def __new__(cls, text: str, known: Sequence[str]) -> Expression: ...
    @property
    def names(self) -> list[str]: ...
    @property
    def is_condition(self) -> bool: ...
    def evaluate(self, values: Sequence[float]) -> tuple[float, list[float]]: ...

@final
class Model:
    def __new__(
        cls,
        law: str | None,
        effects: Sequence[str] = ...,
        constants: Mapping[str, float] = ...,
        own: Sequence[tuple[str, Sequence[str]]] = ...,
    ) -> Model: ...
    @property
    def law(self) -> str: ...
    @property
    def effects(self) -> list[str]: ...
    @property
    def spec(self) -> str: ...
    @property
    def constants(self) -> dict[str, float]: ...
    @property
    def has_state(self) -> bool: ...
    @property
    def state_size(self) -> int: ...
    @property
    def needs(self) -> list[str]: ...
    def parameters(self) -> list[ParameterRow]: ...
    def program(self, *, single: bool = False) -> ProgramRow: ...
    def torque(
        self,
        values: ArrayLike,
        dt: float | ArrayLike | None,
        velocity: ArrayLike,
        position: ArrayLike | None = None,
        acceleration: ArrayLike | None = None,
        temperature: ArrayLike | None = None,
        load_torque: ArrayLike | None = None,
        motor_torque: ArrayLike | None = None,
        external_torque: ArrayLike | None = None,
        time: ArrayLike | None = None,
        load_torque_curvature: ArrayLike | None = None,
        temperature_rate: ArrayLike | None = None,
        smooth: Mapping[str, ArrayLike] | None = None,
        shift_load: bool = True,
        mean_velocity: ArrayLike | None = None,
        state: float | ArrayLike | None = None,
        *,
        single: bool = False,
        out: NDArray[np.float64] | None = None,
        what: str | None = None,
    ) -> NDArray[np.float64]: ...
    def gradient(
        self,
        values: ArrayLike,
        dt: float | ArrayLike | None,
        velocity: ArrayLike,
        position: ArrayLike | None = None,
        acceleration: ArrayLike | None = None,
        temperature: ArrayLike | None = None,
        load_torque: ArrayLike | None = None,
        motor_torque: ArrayLike | None = None,
        external_torque: ArrayLike | None = None,
        time: ArrayLike | None = None,
        load_torque_curvature: ArrayLike | None = None,
        temperature_rate: ArrayLike | None = None,
        smooth: Mapping[str, ArrayLike] | None = None,
        shift_load: bool = True,
        mean_velocity: ArrayLike | None = None,
        state: float | ArrayLike | None = None,
        *,
        wanted: Sequence[int] | None = None,
        out: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None,
        what: str | None = None,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    def split(
        self,
        values: ArrayLike,
        velocity: ArrayLike,
        position: ArrayLike | None = None,
        acceleration: ArrayLike | None = None,
        temperature: ArrayLike | None = None,
        load_torque: ArrayLike | None = None,
        motor_torque: ArrayLike | None = None,
        external_torque: ArrayLike | None = None,
        time: ArrayLike | None = None,
        load_torque_curvature: ArrayLike | None = None,
        temperature_rate: ArrayLike | None = None,
    ) -> dict[str, NDArray[np.float64]]: ...
