"""Types of the native module."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

Designs = Design | str | Sequence[Design | str] | Mapping[str, ArrayLike | str | Sequence[str]] | Table | NDArray[Any] | Any

class Study:
    """What to design, under which assumptions, and how to search.

    >>> import kinefront
    >>> study = kinefront.Study.paper()
    >>> study.architectures
    ['3-PRR', '3-RPR', '3-RRR']
    >>> study.objectives
    [('minimize', 'mass_kg'), ('maximize', 'workspace_radius_m')]
    """

    name: str
    architectures: list[str]
    objectives: list[tuple[str, str]]
    objective_columns: list[str]
    bounds: dict[str, tuple[float, float]]
    choices: dict[str, list[float]]
    """The values of the variables that the study lists or takes from a catalogue of bars, in metres."""
    ties: dict[str, tuple[str, float]]
    """For each variable that is a factor times another one: that variable and the factor."""
    optimizer: dict[str, Any]

    @staticmethod
    def paper() -> Study: ...
    @staticmethod
    def names() -> list[str]: ...
    @staticmethod
    def read(path: str | os.PathLike[str]) -> Study: ...
    @staticmethod
    def from_toml(text: str, name: str = "study") -> Study: ...
    def to_toml(self) -> str: ...
    def replace(self, text: str) -> Study:
        """Return the study with the settings of a text replaced.

        >>> Study.paper().replace("architectures = ['3-RRR']")
        <kinefront.Study paper: 3-RRR>
        """

    def sensitivity(self, evaluations: int) -> dict[str, Study]:
        """Return the searches of the sensitivity analysis of the report, as studies by name.

        >>> Study.paper().sensitivity(100)["seed + 1, 3-PRR"].optimizer["seed"]
        2
        """

    def design(self, text: str) -> Design: ...
    def designs(self, designs: Designs) -> list[Design]: ...
    def evaluate(self, designs: Designs, *, grid: str = "reference", threads: int | None = None) -> Table:
        """Evaluate n designs; lengths are in metres, angles in degrees. Return a table of n rows with every quantity.

        >>> study = Study.paper()
        >>> table = study.evaluate({"architecture": "3-PRR", "R": [2.0, 2.5], "r": 0.4, "Lb": 1.2, "rj": 0.02, "rp": 0.03})
        >>> table["workspace_radius_m"].round(2).tolist()
        [0.58, 0.34]
        """

    def poses(self, design: Design | str, poses: NDArray[np.float64]) -> dict[str, Any]:
        """Evaluate a design at poses (n, 3): x and y in metres, phi in radians. Return arrays by name, all with n as first axis.

        They are reachable, actuators, B, C, K, margins (in the order of constraints), and every scalar of a pose.

        >>> at = Study.paper().poses("3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056", np.array([[0.0, 0.0, 0.0], [9.0, 0.0, 0.0]]))
        >>> at["reachable"].tolist(), at["K"].shape, at["kappa"].round(3).tolist()
        ([True, False], (2, 6, 6), [0.985, nan])
        """

    def prices(self, designs: Designs) -> list[dict[str, Any]]:
        """Return what drives the first objective along a front, as ``kinefront prices TABLE --json`` does.

        >>> along = Study.paper().prices(["3-PRR R=3.89 r=0.71 Lb=2.567 rj=0.0247 rp=0.0349"])
        >>> along[0]["architecture"], along[0]["along"], len(along[0]["designs"])
        ('3-PRR', 'workspace_radius_m', 1)
        """

    def why(self, designs: Designs, wished: float, *, held: Mapping[str, float] = {}) -> dict[str, Any]:
        """Return why the first objective cannot have the value ``wished``, as ``kinefront why --json`` does.

        >>> study = Study.paper()
        >>> front = ["3-PRR R=3.89 r=0.71 Lb=2.567 rj=0.0247 rp=0.0349"]
        >>> why = study.why(front, 160.0, held={"workspace_radius_m": 1.2})["why_not"]
        >>> [round(found["needed"], 2) for found in why["relaxations"] if found["parameter"] == "k_z_min"]
        [0.76]
        """

    def optimize(
        self,
        *,
        seed: int | None = None,
        evaluations: int | None = None,
        algorithm: str | None = None,
        architectures: Sequence[str] | None = None,
        callback: Callable[[Progress], bool | None] | None = None,
        threads: int | None = None,
        out: str | os.PathLike[str] | None = None,
    ) -> Run:
        """Search for the front of the study; ``callback`` receives the progress and can end the search by returning ``False``.

        >>> run = Study.paper().optimize(seed=1, evaluations=90, architectures=["3-PRR"])
        >>> len(run.designs), run.report["outcome"]
        (90, 'completed')
        """

class Design:
    """A design of a study."""

    architecture: str
    working_mode: str
    values: dict[str, float]

    def evaluate(self, grid: str = "reference") -> dict[str, Any]: ...
    def certify(
        self,
        *,
        radius: float | None = None,
        phi_deg: float | None = None,
        tolerance: float = 1e-4,
        max_boxes: int = 200_000,
        all_homes: bool = False,
    ) -> dict[str, Any]:
        """Prove the region of the study for the design, or a workspace radius in metres, as ``kinefront certify --json`` does.

        >>> design = Study.paper().design("3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056")
        >>> design.certify(radius=1.0)["verdict"]
        'proved'
        """

    def poses(self, poses: NDArray[np.float64]) -> dict[str, Any]: ...
    def prices(
        self,
        *,
        held: Mapping[str, float] = {},
        bars_only: bool = False,
        steps: bool = False,
        wish: float | None = None,
    ) -> dict[str, Any]:
        """Return what drives the first objective at the best design near this one, as ``kinefront prices --json`` does.

        >>> design = Study.paper().design("3-PRR R=3.89 r=0.71 Lb=2.567 rj=0.0247 rp=0.0349")
        >>> prices = design.prices(held={"workspace_radius_m": 1.2})["prices"]
        >>> {found["parameter"]: round(found["price"], 2) for found in prices if found["parameter"] in ("k_z_min", "k_xy_min")}
        {'k_xy_min': 0.11, 'k_z_min': 0.41}
        """

    def wish(self, conditions: Sequence[str], *, keep: Sequence[str] = ()) -> dict[str, Any]:
        """Return the nearest design that meets the conditions, verified and proved, as ``kinefront wish --json`` does.

        >>> design = Study.paper().design("3-PRR R=3.89 r=0.71 Lb=2.567 rj=0.0247 rp=0.0349")
        >>> found = design.wish(["k_xy_n_per_m >= 1.2e6"])
        >>> found["outcome"], found["proof"]
        ('granted', 'proved')
        """

    def export(self, format: str, pose: Sequence[float] | None = None) -> str | bytes: ...

class Table:
    """Designs as named columns."""

    columns: list[str]
    units: dict[str, str]

    def __len__(self) -> int: ...
    def __contains__(self, name: str) -> bool: ...
    def __getitem__(self, name: str) -> Any: ...
    @staticmethod
    def concat(tables: Sequence[Table]) -> Table: ...
    def to_numpy(self) -> NDArray[Any]: ...
    def to_pandas(self) -> Any: ...
    def to_polars(self) -> Any: ...
    def to_arrow(self) -> Any: ...
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...

class Progress:
    """State of a search: its phase is ``search``, ``verification`` or ``proofs``."""

    phase: str
    generation: int
    evaluations: int
    budget: int
    feasible: int
    front_size: int
    hypervolume: float

class Run:
    """A run of a study."""

    study: Study
    designs: Table
    front: Table
    report: dict[str, Any] | None
    path: Any

    @staticmethod
    def open(path: str | os.PathLike[str]) -> Run: ...
