"""The paths of a run's robots: how often each cell was visited, and how rare the cells of a path are.

The paper judges a robot by where its path ends, and names the whole path as future work. A path's cells are those on
which its robot stands, each counted once. A cell's visits are the paths of the run so far, those of this generation
included, that have the cell. Two measures come of them:

    rarity   the sum of 1 / sqrt(visits) over the cells of a path, in the order in which the robot first stands on them
    found    how many cells of a path no earlier path had; paths of one generation follow each other in its order
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from safe.kernel import kernel


class Paths(NamedTuple):
    """The paths of a generation, and the visits of a run; changed in place. Of no robots if nobody asks for them."""

    cells: np.ndarray  # int32, (robots, most cells of a path): row * width + column
    lengths: np.ndarray  # int64, (robots,): the number of cells
    found: np.ndarray  # int64, (robots,)
    visits: np.ndarray  # int64, (height * width,)


def empty_paths(robots: int, shape: tuple[int, int], steps: int) -> Paths:
    """No paths yet, and room for those of a generation of robots that take so many steps in a maze of this shape."""
    size = shape[0] * shape[1]
    return Paths(
        cells=np.zeros((robots, min(steps, size) + 1), dtype=np.int32),
        lengths=np.zeros(robots, dtype=np.int64),
        found=np.zeros(robots, dtype=np.int64),
        visits=np.zeros(size if robots > 0 else 0, dtype=np.int64),
    )


# Compiled functions


@kernel
def keep_path(paths: Paths, i: int, trail: np.ndarray, length: int, width: int) -> None:
    """Count the path of the i-th robot, the first cells of its trail (see `safe.robot.walk`)."""
    cells, lengths, found, visits = paths
    lengths[i] = length
    found[i] = 0
    for step in range(length):
        cell = trail[step, 0] * width + trail[step, 1]
        cells[i, step] = cell
        found[i] += visits[cell] == 0
        visits[cell] += 1


@kernel
def score_paths(paths: Paths, rarity: np.ndarray) -> None:
    """The rarity of all paths, after the whole generation has been counted."""
    for i in range(len(rarity)):
        total = 0.0
        for step in range(paths.lengths[i]):
            total += 1 / math.sqrt(paths.visits[paths.cells[i, step]])
        rarity[i] = total
