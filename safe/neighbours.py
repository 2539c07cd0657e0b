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


class Axis(NamedTuple):
    """Intervals along one coordinate; what lies outside belongs to the outermost."""

    low: float  # where the first begins
    scale: float  # intervals in a unit of length
    count: int


class Grid(NamedTuple):
    """Cells over the first two coordinates."""

    rows: Axis
    columns: Axis


class Members(NamedTuple):
    """Points in the cells of a grid, to be searched: a population and an archive, and what entered it since."""

    points: np.ndarray  # float64, (dimensions, room), at least two: points on a line get a second coordinate
    ends: np.ndarray  # int64: a 0, then the end of each cell in `points`; one more helps to count
    places: np.ndarray  # int64, (capacity,): of the archive's points in `points`


class Nearest(NamedTuple):
    """What a search finds, with room for all members and four more."""

    distances: np.ndarray  # float64, in any order; Euclidean ones are squared
    ascending: np.ndarray  # float64, the smallest of them, in order
    smaller: np.ndarray  # int64, working memory


PER_CELL = 3.0  # points in a cell, on average
ASPECT = 10.0  # of a cell, its height to its width: a search begins few rows, and measures little beyond its reach
SLACK = 1.35  # a first search expects this many times the neighbours wanted, so that it rarely finds too few
MANY = 1000  # from here on, or from three times those wanted, a heap orders values faster than comparing all pairs
NEARLY_NOTHING = 1e-150  # an extent below which points count as one: LARGEST divided by it is still finite


# Compiled functions


@kernel
def grid_over(points: np.ndarray, size: int) -> Grid:
    """A grid over the range of these points, for `size` points in all."""
    rows, columns = 1 + int(math.sqrt(size / PER_CELL / ASPECT)), 1 + int(math.sqrt(size / PER_CELL * ASPECT))
    if points.shape[1] == 1:
        return Grid(_axis_over(points[:, 0], columns), Axis(0.0, 0.0, np.int64(1)))
    return Grid(_axis_over(points[:, 0], rows), _axis_over(points[:, 1], columns))


@kernel
def _axis_over(coordinates: np.ndarray, count: int) -> Axis:
    low = high = coordinates[0]
    for coordinate in coordinates:
        low, high = min(low, coordinate), max(high, coordinate)
    extent = high - low
    return Axis(low, count / extent, count) if extent > NEARLY_NOTHING else Axis(low, 0.0, np.int64(1))


@kernel
def _interval(axis: Axis, coordinate: float) -> int:
    """The number of the interval in which a coordinate lies."""
    return int(min(max((coordinate - axis.low) * axis.scale, 0.0), axis.count - 1.0))


@kernel(makes_arrays=True)
def sort_into_cells(
    grid: Grid, points: np.ndarray, archived_points: np.ndarray, archived_size: int, members: Members
) -> int:
    """Make points and archive the members; returns their number."""
    sorted_points, ends, places = members
    n, dimensions = points.shape
    size = n + archived_size
    rows, columns = grid
    second = min(1, dimensions - 1)  # on a line all points lie in one column, whatever their coordinate
    cells = np.empty(size, dtype=np.int64)
    for j in range(n):
        cells[j] = _interval(rows, points[j, 0]) * columns.count + _interval(columns, points[j, second])
    for j in range(archived_size):
        row, column = _interval(rows, archived_points[0, j]), _interval(columns, archived_points[second, j])
        cells[n + j] = row * columns.count + column
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
            sorted_points[axis, index(cells[j])] = points[j, axis]
        for j in range(archived_size):
            sorted_points[axis, index(cells[n + j])] = archived_points[axis, j]
    for j in range(archived_size):
        places[j] = cells[n + j]
    return size


@kernel
def even_reach(grid: Grid, share: float) -> float:
    """The distance within which this share of all points, and some more, would lie if they were spread evenly."""
    rows, columns = grid
    height = rows.count / rows.scale if rows.scale > 0 else 0.0
    width = columns.count / columns.scale if columns.scale > 0 else 0.0
    # in the plane the area of a circle; on a line its length
    return max(math.sqrt(SLACK * share * height * width / math.pi), SLACK * share * max(height, width) / 2)


@kernel(inline="always")
def look_around(
    points: np.ndarray,
    i: int,
    grid: Grid,
    members: Members,
    in_cells: int,
    size: int,
    wanted: int,
    reach: float,
    taxicab: bool,
    distances: np.ndarray,
) -> int:
    """Put the distances of members to the i-th of some points into `distances`, at least the `wanted` smallest.

    The first `in_cells` members lie in cells, the others up to `size` anywhere. Returns how many distances there are.
    """
    rows, columns = grid
    x, y = points[i, 0], points[i, 1] if points.shape[1] > 1 else 0.0
    while True:
        margin = reach * (1 + 1e-9)  # the borders of cells are rounded, and no cell may be missed
        top, bottom = _interval(rows, x - margin), _interval(rows, x + margin)
        left, right = _interval(columns, y - margin), _interval(columns, y + margin)
        is_all = (bottom - top + 1) * (right - left + 1) == rows.count * columns.count
        limit = np.inf if is_all else _along_axis(reach, taxicab)
        found = np.int64(0)
        for row in range(top - 1, bottom + 1):  # first those that lie anywhere, then row by row
            start, end = in_cells, size
            if row >= top:
                first = row * columns.count
                start, end = members.ends[index(first + left)], members.ends[index(first + right + 1)]
            for j in range(index(start), index(end)):
                dx, dy = members.points[0, j] - x, members.points[1, j] - y
                distance = _along_axis(dx, taxicab) + _along_axis(dy, taxicab)
                for axis in range(2, points.shape[1]):
                    distance += _along_axis(members.points[axis, j] - points[i, axis], taxicab)
                distances[index(found)] = distance  # no branch: the processor would often mispredict it
                found += distance <= limit
        if is_all or found >= wanted:
            return found
        reach *= max(1.25, math.sqrt(wanted / (found + 1)))


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
    for j in range(wanted):
        ascending[j] = -1.0
    for i in range(0, padded, 4):  # four at once, so that counts are loaded and stored only a fourth as often
        one, two = values[index(i)], values[index(i + 1)]
        three, four = values[index(i + 2)], values[index(i + 3)]
        for j in range(padded):
            value = values[j]
            smaller[j] += (one < value) + (two < value) + (three < value) + (four < value)
    for j in range(padded):  # its place is the number of smaller values: no branch for the processor to mispredict
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
