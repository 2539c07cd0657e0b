"""The nearest neighbours of points, found in a grid.

Points are sorted into the cells of a grid over their first two coordinates. Around a point one looks as far as its
nearest neighbours would be if points were spread evenly, and only into the cells that are that near; then farther,
where too few were found. So a search costs about as much as it finds, and gives exactly the distances that measuring
all points would give. Euclidean distances stay squared: the order is the same.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from safe.kernel import index, kernel


class Grid(NamedTuple):
    """Rows and columns of cells over the first two coordinates; what lies outside belongs to the outermost cells."""

    low: tuple[float, float]  # where the first cells begin
    scale: tuple[float, float]  # cells in a unit of length
    sides: tuple[int, int]  # rows and columns


PER_CELL = 4.0  # points in a cell, on average
SLACK = 1.35  # times as many neighbours are looked for at first as are wanted, so that there are rarely too few
MANY = 1000  # values, or three times as many as are wanted, are better not put in order by comparing all with all
NEARLY_NOTHING = 1e-150  # an extent below which points count as one: even LARGEST over it is a number


# Compiled functions


@kernel
def grid_over(points: np.ndarray, size: int) -> Grid:
    """A grid over the range of these points, for so many in all."""
    low, high = points[0].copy(), points[0].copy()
    for i in range(1, len(points)):
        for axis in range(points.shape[1]):
            low[axis] = min(low[axis], points[i, axis])
            high[axis] = max(high[axis], points[i, axis])
    cells = 1 + int(math.sqrt(size / PER_CELL))  # in a row or column
    first = _axis(low[0], high[0], cells)
    second = _axis(low[1], high[1], cells) if points.shape[1] > 1 else _axis(0.0, 0.0, cells)
    return Grid((first[0], second[0]), (first[1], second[1]), (first[2], second[2]))


@kernel
def _axis(low: float, high: float, cells: int) -> tuple[float, float, int]:
    """Begin, scale and side of one axis of a grid."""
    extent = high - low
    return (low, cells / extent, cells) if extent > NEARLY_NOTHING else (low, 0.0, 1)


@kernel
def _cell_along(grid: Grid, axis: int, coordinate: float) -> int:
    """The row (axis 0) or column (axis 1) in which a coordinate lies."""
    return int(min(max((coordinate - grid.low[axis]) * grid.scale[axis], 0.0), grid.sides[axis] - 1.0))


@kernel
def sort_into_cells(
    grid: Grid,
    points: np.ndarray,
    archived_points: np.ndarray,
    archived_size: int,
    members: np.ndarray,
    ends: np.ndarray,
    places: np.ndarray,
) -> int:
    """Fill `members`, `ends` and `places` of `score_points`. How many members are there?"""
    n, dimensions = points.shape
    size = n + archived_size
    unsorted = np.zeros((len(members), size))
    for axis in range(dimensions):
        for j in range(n):
            unsorted[axis, j] = points[j, axis]
        for j in range(archived_size):
            unsorted[axis, n + j] = archived_points[axis, j]
    cells = np.empty(size, dtype=np.int64)
    gaps = np.zeros(len(ends), dtype=np.int64)  # where the next point of each cell goes
    for j in range(size):
        cells[j] = _cell_along(grid, 0, unsorted[0, j]) * grid.sides[1] + _cell_along(grid, 1, unsorted[1, j])
        gaps[cells[j] + 1] += 1
    ends[0] = 0
    for cell in range(1, len(ends)):
        gaps[cell] += gaps[cell - 1]
        ends[cell] = gaps[cell]
    for j in range(size):
        place = gaps[cells[j]]
        gaps[cells[j]] += 1
        for axis in range(dimensions):
            members[axis, place] = unsorted[axis, j]
        if j >= n:
            places[j - n] = place
    return size


@kernel
def even_reach(grid: Grid, share: float) -> float:
    """How far around a point this share of all points is, and some more, where they are spread evenly."""
    height = grid.sides[0] / grid.scale[0] if grid.scale[0] > 0 else 0.0
    width = grid.sides[1] / grid.scale[1] if grid.scale[1] > 0 else 0.0
    # in the plane the area of a circle; on a line its length
    return max(math.sqrt(SLACK * share * height * width / math.pi), SLACK * share * max(height, width) / 2)


@kernel
def look_around(
    point: np.ndarray,
    grid: Grid,
    members: np.ndarray,
    ends: np.ndarray,
    in_cells: int,
    size: int,
    wanted: int,
    reach: float,
    taxicab: bool,
    distances: np.ndarray,
) -> int:
    """Put distances of members to the point into `distances`, the `wanted` smallest among them. How many are there?"""
    rows, columns = grid.sides
    while True:
        margin = reach * (1 + 1e-9)  # the borders of cells are rounded: none is to be missed for that
        top, bottom = _cell_along(grid, 0, point[0] - margin), _cell_along(grid, 0, point[0] + margin)
        left, right = _cell_along(grid, 1, point[1] - margin), _cell_along(grid, 1, point[1] + margin)
        is_all = (bottom - top + 1) * (right - left + 1) == rows * columns
        limit = np.inf if is_all else _along_axis(reach, taxicab)
        found = _measure(point, members, in_cells, size, taxicab, limit, distances, 0)
        for row in range(top, bottom + 1):
            start, end = ends[row * columns + left], ends[row * columns + right + 1]
            found = _measure(point, members, start, end, taxicab, limit, distances, found)
        if is_all or found >= wanted:
            return found
        reach *= max(1.25, math.sqrt(wanted / (found + 1)))


@kernel
def _measure(
    point: np.ndarray,
    members: np.ndarray,
    start: int,
    end: int,
    taxicab: bool,
    limit: float,
    distances: np.ndarray,
    found: int,
) -> int:
    """Append the distances of members[:, start:end] to the point, but for those above the limit. How many are there?"""
    x, y = point[0], point[1]
    for j in range(index(start), index(end)):
        distance = _along_axis(members[0, j] - x, taxicab) + _along_axis(members[1, j] - y, taxicab)
        for axis in range(2, len(point)):
            distance += _along_axis(members[axis, j] - point[axis], taxicab)
        distances[index(found)] = distance  # no branch: the processor would often guess it wrong
        found += distance <= limit
    return found


@kernel
def _along_axis(difference: float, taxicab: bool) -> float:
    """What a difference in one coordinate adds to a taxicab or squared Euclidean distance."""
    return abs(difference) if taxicab else difference * difference


@kernel
def smallest(values: np.ndarray, size: int, wanted: int, ascending: np.ndarray) -> None:
    """Put the `wanted` smallest of the first `size` values, none of them negative, in order into `ascending`."""
    if size > min(3 * wanted, MANY):
        for j in range(wanted):
            ascending[j] = np.inf
        for i in range(size):  # the smallest so far are a heap, the largest of them at its top
            if values[i] < ascending[0]:
                _sink(values[i], ascending, wanted)
        for last in range(wanted - 1, 0, -1):
            largest = ascending[0]
            _sink(ascending[last], ascending, last)
            ascending[last] = largest
        return
    for j in range(size):
        ascending[j] = -1.0
    for i in range(size):
        value = values[i]
        smaller = 0  # as many as there are tell its place: no branch for the processor to guess wrong
        for j in range(size):
            smaller += values[j] < value
        ascending[smaller] = value
    for j in range(1, size):  # equal ones went to the same place
        ascending[j] = max(ascending[j], ascending[j - 1])


@kernel
def _sink(value: float, heap: np.ndarray, size: int) -> None:
    """Put a value in the place of the largest, at the top of a heap, and let it sink below all that are larger."""
    node, child = 0, 1
    while child < size:
        if child + 1 < size and heap[child + 1] > heap[child]:
            child += 1
        if heap[child] <= value:
            break
        heap[node] = heap[child]
        node, child = child, 2 * child + 1
    heap[node] = value
