"""The nearest neighbours of points, found in a grid.

Points are sorted into the cells of a grid over their first two coordinates. A search around a point reaches as far as
its nearest neighbours would lie if all points were spread evenly, looks only into the cells within that reach, and
extends it if it found too few. Its cost is about proportional to what it finds, and it gives exactly the distances that
measuring all points would give. Euclidean distances stay squared, which leaves their order unchanged.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from safe.kernel import index, kernel


class Grid(NamedTuple):
    """Rows and columns of cells over the first two coordinates; points outside belong to the outermost cells."""

    low: tuple[float, float]  # where the first cells begin
    scale: tuple[float, float]  # cells in a unit of length
    sides: tuple[int, int]  # rows and columns


PER_CELL = 2.0  # points in a cell, on average
ASPECT = 4.0  # of a cell, its height to its width: a search begins few rows, and measures little beyond its reach
SLACK = 1.35  # a first search expects this many times the neighbours wanted, so that it rarely finds too few
MANY = 1000  # from here on, or from three times those wanted, a heap orders values faster than comparing all pairs
NEARLY_NOTHING = 1e-150  # an extent below which points count as one: LARGEST divided by it is still finite


# Compiled functions


@kernel(makes_arrays=True)
def grid_over(points: np.ndarray, size: int) -> Grid:
    """A grid over the range of these points, for `size` points in all."""
    rows, columns = 1 + int(math.sqrt(size / PER_CELL / ASPECT)), 1 + int(math.sqrt(size / PER_CELL * ASPECT))
    if points.shape[1] == 1:
        low, scale, cells = _axis(points[:, 0], columns)
        return Grid((low, 0.0), (scale, 0.0), (cells, 1))
    first, second = _axis(points[:, 0], rows), _axis(points[:, 1], columns)
    return Grid((first[0], second[0]), (first[1], second[1]), (first[2], second[2]))


@kernel
def _axis(coordinates: np.ndarray, cells: int) -> tuple[float, float, int]:
    """Start, scale and number of cells of one axis of a grid."""
    low = high = coordinates[0]
    for coordinate in coordinates:
        low, high = min(low, coordinate), max(high, coordinate)
    extent = high - low
    return (low, cells / extent, cells) if extent > NEARLY_NOTHING else (low, 0.0, 1)


@kernel
def _cell_along(grid: Grid, axis: int, coordinate: float) -> int:
    """The row (axis 0) or column (axis 1) in which a coordinate lies."""
    return int(min(max((coordinate - grid.low[axis]) * grid.scale[axis], 0.0), grid.sides[axis] - 1.0))


@kernel
def _cell_of(grid: Grid, x: float, y: float) -> int:
    """The number of the cell in which a point lies, row by row."""
    return _cell_along(grid, 0, x) * grid.sides[1] + _cell_along(grid, 1, y)


@kernel(makes_arrays=True)
def sort_into_cells(
    grid: Grid,
    points: np.ndarray,
    archived_points: np.ndarray,
    archived_size: int,
    members: np.ndarray,
    ends: np.ndarray,
    places: np.ndarray,
) -> int:
    """Fill `members`, `ends` and `places` of `score_points`; returns the number of members."""
    n, dimensions = points.shape
    size = n + archived_size
    second = min(1, dimensions - 1)  # on a line all points lie in one column, whatever their coordinate
    cells = np.empty(size, dtype=np.int64)
    for j in range(n):
        cells[j] = _cell_of(grid, points[j, 0], points[j, second])
    for j in range(archived_size):
        cells[n + j] = _cell_of(grid, archived_points[0, j], archived_points[second, j])
    for cell in range(len(ends)):
        ends[cell] = 0
    for j in range(size):  # not in the loops above, so that the processor computes several cells at once
        ends[index(cells[j] + 2)] += 1
    for cell in range(2, len(ends)):
        ends[cell] += ends[cell - 1]
    for j in range(size):
        cell = index(cells[j] + 1)
        cells[j] = ends[cell]  # from here on, the place of the point
        ends[cell] += 1
    for axis in range(dimensions):
        for j in range(n):
            members[axis, index(cells[j])] = points[j, axis]
        for j in range(archived_size):
            members[axis, index(cells[n + j])] = archived_points[axis, j]
    for j in range(archived_size):
        places[j] = cells[n + j]
    return size


@kernel
def even_reach(grid: Grid, share: float) -> float:
    """The distance within which this share of all points, and some more, would lie if they were spread evenly."""
    height = grid.sides[0] / grid.scale[0] if grid.scale[0] > 0 else 0.0
    width = grid.sides[1] / grid.scale[1] if grid.scale[1] > 0 else 0.0
    # in the plane the area of a circle; on a line its length
    return max(math.sqrt(SLACK * share * height * width / math.pi), SLACK * share * max(height, width) / 2)


@kernel(inline="always")
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
    """Put the distances of members to the point into `distances`, at least the `wanted` smallest; returns how many."""
    rows, columns = grid.sides
    while True:
        margin = reach * (1 + 1e-9)  # the borders of cells are rounded, and no cell may be missed
        top, bottom = _cell_along(grid, 0, point[0] - margin), _cell_along(grid, 0, point[0] + margin)
        left, right = _cell_along(grid, 1, point[1] - margin), _cell_along(grid, 1, point[1] + margin)
        is_all = (bottom - top + 1) * (right - left + 1) == rows * columns
        limit = np.inf if is_all else _along_axis(reach, taxicab)
        found = np.int64(0)
        for row in range(top - 1, bottom + 1):  # first the newcomers, then row by row
            start, end = in_cells, size
            if row >= top:
                start, end = ends[index(row * columns + left)], ends[index(row * columns + right + 1)]
            found = _measure(point, members, start, end, taxicab, limit, distances, found)
        if is_all or found >= wanted:
            return found
        reach *= max(1.25, math.sqrt(wanted / (found + 1)))


@kernel(inline="always")
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
    """Append the distances of members[:, start:end] to the point up to the limit; returns how many there are now."""
    x, y = point[0], point[1]
    for j in range(index(start), index(end)):
        distance = _along_axis(members[0, j] - x, taxicab) + _along_axis(members[1, j] - y, taxicab)
        for axis in range(2, len(point)):
            distance += _along_axis(members[axis, j] - point[axis], taxicab)
        distances[index(found)] = distance  # no branch: the processor would often mispredict it
        found += distance <= limit
    return found


@kernel
def _along_axis(difference: float, taxicab: bool) -> float:
    """The contribution of a difference in one coordinate to a taxicab or squared Euclidean distance."""
    return abs(difference) if taxicab else difference * difference


@kernel(inline="always")
def smallest(values: np.ndarray, size: int, wanted: int, ascending: np.ndarray, smaller: np.ndarray) -> None:
    """Put the `wanted` smallest of the first `size` values, which are not negative, in order into `ascending`.

    Every array has room for 4 more; what `values` holds behind the first `size`, and `smaller` (int64), is lost.
    """
    if size > min(3 * wanted, MANY):
        for j in range(wanted):
            ascending[j] = np.inf
        for i in range(size):  # the smallest so far form a heap with the largest of them on top
            if values[i] < ascending[0]:
                _sink(values[i], ascending, wanted)
        for last in range(wanted - 1, 0, -1):
            largest = ascending[0]
            _sink(ascending[last], ascending, last)
            ascending[last] = largest
        return
    padded = size + -size % 4
    for j in range(size, size + 4):
        values[j] = np.inf
    for j in range(padded):
        smaller[j] = 0
        ascending[j] = -1.0
    for i in range(0, padded, 4):  # four at once, so that counts are loaded and stored only a fourth as often
        one, two = values[index(i)], values[index(i + 1)]
        three, four = values[index(i + 2)], values[index(i + 3)]
        for j in range(padded):
            value = values[j]
            smaller[j] += (one < value) + (two < value) + (three < value) + (four < value)
    for j in range(
        padded
    ):  # the number of smaller values is a value's place: no branch for the processor to mispredict
        ascending[index(smaller[j])] = values[j]
    for j in range(1, wanted):  # equal values went to the same place
        ascending[j] = max(ascending[j], ascending[j - 1])


@kernel
def _sink(value: float, heap: np.ndarray, size: int) -> None:
    """Replace the largest value, at the top of a heap, by another, and let it sink below all larger ones."""
    node, child = 0, 1
    while child < size:
        if child + 1 < size and heap[child + 1] > heap[child]:
            child += 1
        if heap[child] <= value:
            break
        heap[node] = heap[child]
        node, child = child, 2 * child + 1
    heap[node] = value
