"""The axes by name, in the order of the report's table: functions that yield states."""

from collections.abc import Callable, Iterator

from verification.stress_tests.axes import contacts, grids, kernels, plane, shapes, topography, units
from verification.stress_tests.state import Extreme

AXES: dict[str, Callable[[], Iterator[Extreme]]] = {
    "units": units.units,
    "load": contacts.loads,
    "contact set": contacts.contact_sets,
    "material": contacts.materials,
    "friction": contacts.friction,
    "topography": topography.topography,
    "grid": grids.grids,
    "shape": shapes.shapes,
    "kernel": kernels.kernels,
    "wedge": plane.wedges,
    "finite elements": plane.finite_elements,
}


def states(name: str) -> Iterator[tuple[str, Extreme]]:
    """Ids and states of an axis; raises ValueError when two have one id."""
    seen = set()
    for extreme in AXES[name]():
        unique = f"{name}/{extreme.series}/{extreme.at}"
        if unique in seen:
            raise ValueError(f"two states are called {unique!r}")
        seen.add(unique)
        yield unique, extreme
