"""A scene's problems on grids: heights are sampled once where the grid that decides is the one solved on."""

from __future__ import annotations

from dataclasses import replace

from refimpl.grid import Grid
from refimpl.model.problem import Problem, Terms, pose
from refimpl.scene.scene import Scene

EVERYTHING = Terms(coupled=True, oblique=True, slope_correction=False)


class Posing:
    """Poses a scene under its load or at an approach (m), and keeps what its surfaces had to remark."""

    def __init__(self, scene: Scene, approach: float | None) -> None:
        self._scene, self._approach = scene, approach
        self._last: Problem | None = None
        self.remarks: tuple[str, ...] = ()

    def whole(self, grid: Grid) -> Problem:
        """With all terms, for a plan to look at."""
        self._last = self._posed(grid, EVERYTHING)
        return self._last

    def take(self, grid: Grid, terms: Terms) -> Problem:
        """With these terms, from the heights last seen if they are this grid's; these are not kept."""
        seen, self._last = self._last, None
        return replace(seen, terms=terms) if seen and seen.grid == grid else self._posed(grid, terms)

    def _posed(self, grid: Grid, terms: Terms) -> Problem:
        problem = pose(self._scene, grid, terms, self._approach)
        self.remarks = self._scene.cautions(grid)
        return problem
