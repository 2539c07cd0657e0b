"""Novelty: how far a point lies from the points seen so far, its nearest neighbours first (Section 3.3).

The novelty of a point is the sum of its distances to its k nearest neighbours, divided by k. The neighbours are
all other points of the population, and all points of an archive. The points of a generation are scored in order,
and each is offered to the archive right after its score is known, so that later points of the same generation
meet it there too, and its double in the population as well.

The archive has a fixed number of places. While there is room every point enters. Then a newcomer whose score is
strictly above the lowest in the archive takes that point's place, that of the oldest such point on a tie.
A point keeps the score that it entered with.

The same rule serves solutions, by taxicab distance between end points, and objective functions, by Euclidean
distance between genomes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from safe import checks
from safe.kernel import kernel

METRICS = ("taxicab", "euclidean")
K = 15
ARCHIVE_CAPACITY = 1000
MOST_DIMENSIONS = 1000  # of a point, for each of which an archive reserves memory


class ArchiveArrays(NamedTuple):
    """What the compiled functions need of an archive; changed in place."""

    points: np.ndarray  # float64, (dimensions, capacity), in ascending order of the first coordinate
    scores: np.ndarray  # float64, (capacity,), as they were on entry
    entry: np.ndarray  # int64, (capacity,), 0 for the first point that ever entered
    counts: np.ndarray  # int64, (3,): points in it now, points that ever entered, place of the lowest


class NoveltyArchive:
    """An archive of points, and the novelty of new ones.

    Parameters
    ----------
    capacity : int
        How many points there is room for.
    k : int
        How many nearest neighbours count.
    metric : {"taxicab", "euclidean"}
        How the distance between two points is measured.

    Raises
    ------
    ValueError
        Where capacity is not in 0..1,000,000, k not in 1..1,000,000, or the metric is unknown.

    Examples
    --------
    Three points on a line, each scored by its two nearest neighbours.

    >>> archive = NoveltyArchive(capacity=10, k=2)
    >>> archive.score([[0, 0], [0, 1], [0, 4]]).tolist()
    [2.5, 1.0, 3.0]

    The second scores (1 + 1) / 2 and not (1 + 3) / 2: the first is its neighbour in the population
    and, having entered by then, in the archive too.

    >>> len(archive), archive.scores.tolist()
    (3, [2.5, 1.0, 3.0])
    """

    def __init__(self, capacity: int = ARCHIVE_CAPACITY, k: int = K, metric: str = "taxicab") -> None:
        self.capacity = checks.integer("capacity", capacity, 0, checks.MOST)
        self.k = checks.integer("k", k, 1, checks.MOST)
        self.metric = checks.choice("metric", metric, METRICS)
        self._arrays: ArchiveArrays | None = None  # made with the first points, which tell the dimensions

    def score(self, points: np.ndarray) -> np.ndarray:
        """The novelty of one generation, in order; what the archive admits of it stays there.

        Parameters
        ----------
        points : array of float, shape (n, dimensions)

        Returns
        -------
        array of float, shape (n,)

        Raises
        ------
        ValueError
            Where the points are not finite, have other dimensions than those before, or not 1..1000 of them.
        """
        dimensions = None if self._arrays is None else len(self._arrays.points)
        points = checks.array("points", points, (None, dimensions))
        checks.integer("the columns of points", points.shape[1], 1, MOST_DIMENSIONS)
        if self._arrays is None:
            self._arrays = empty_archive(self.capacity, points.shape[1])
        scores = np.empty(len(points))
        score_points(points, self._arrays, self.k, self.metric == "taxicab", np.empty(self.k), scores)
        return scores

    def __len__(self) -> int:
        return 0 if self._arrays is None else int(self._arrays.counts[0])

    @property
    def points(self) -> np.ndarray:
        """The points in the archive, shape (len(archive), dimensions), the oldest first; a copy."""
        return np.empty((0, 0)) if self._arrays is None else archived(self._arrays)[0]

    @property
    def scores(self) -> np.ndarray:
        """The scores that they entered with, shape (len(archive),); a copy."""
        return np.empty(0) if self._arrays is None else archived(self._arrays)[1]


def empty_archive(capacity: int, dimensions: int) -> ArchiveArrays:
    """An archive without a point in it."""
    return ArchiveArrays(
        points=np.zeros((dimensions, capacity)),
        scores=np.zeros(capacity),
        entry=np.zeros(capacity, dtype=np.int64),
        counts=np.zeros(3, dtype=np.int64),
    )


def archived(archive: ArchiveArrays) -> tuple[np.ndarray, np.ndarray]:
    """Copies of an archive's points, shape (n, dimensions), and of their scores, the oldest first."""
    size = archive.counts[0]
    oldest_first = np.argsort(archive.entry[:size])
    return archive.points[:, oldest_first].T.copy(), archive.scores[oldest_first]


# Compiled functions
#
# There are two ways to find the nearest neighbours, and both are exact.
#
# End points are cells of a maze, so taxicab distances are whole numbers and many points share a cell. `score_cells`
# keeps count of the points in every cell, and adds the counts up ring by ring around a point until it has k neighbours.
#
# `score_points` serves any points. It looks among points sorted by their first coordinate, outwards from the point
# itself: the difference in one coordinate alone is never more than the distance, so the search ends where that
# difference reaches the k-th smallest distance found so far. Euclidean distances stay squared until the nearest are
# found: the order is the same, and k roots are taken, not all.


@kernel
def score_cells(cells: np.ndarray, archive: ArchiveArrays, crowd: np.ndarray, k: int, scores: np.ndarray) -> None:
    """Score cells (int64, (n, 2), row and column) by taxicab distance, in order, offering each to the archive.

    `crowd`, int32 of the shape of the maze, counts the archive's points in each cell, before and after.
    """
    n = len(cells)
    for i in range(n):
        crowd[cells[i, 0], cells[i, 1]] += 1
    for i in range(n):
        row, column = cells[i]
        size, _, lowest = archive.counts
        scores[i] = _sum_of_nearest(row, column, crowd, min(k, n - 1 + size)) / k
        leaving_row, leaving_column = np.int64(0), np.int64(0)
        is_full = size > 0 and size == len(archive.scores)
        if is_full:
            leaving_row, leaving_column = np.int64(archive.points[0, lowest]), np.int64(archive.points[1, lowest])
        if offer(archive, cells[i], scores[i]):
            crowd[row, column] += 1
            if is_full:
                crowd[leaving_row, leaving_column] -= 1
    for i in range(n):
        crowd[cells[i, 0], cells[i, 1]] -= 1


@kernel
def _sum_of_nearest(row: int, column: int, crowd: np.ndarray, wanted: int) -> int:
    """The sum of the distances from a point in this cell to the `wanted` nearest others in the crowd."""
    height, width = crowd.shape
    found = crowd[row, column] - 1  # without the point itself
    total = 0
    radius = 0
    while found < wanted:
        radius += 1
        on_ring = 0
        for r in range(max(row - radius, 0), min(row + radius, height - 1) + 1):
            aside = radius - abs(r - row)
            if column + aside < width:
                on_ring += crowd[r, column + aside]
            if 0 < aside <= column:
                on_ring += crowd[r, column - aside]
        total += radius * min(on_ring, wanted - found)
        found += on_ring
    return total


@kernel
def score_points(
    points: np.ndarray, archive: ArchiveArrays, k: int, taxicab: bool, nearest: np.ndarray, scores: np.ndarray
) -> None:
    """Score points in order, offering each to the archive. `nearest` (k places) is worked in."""
    n = len(points)
    order = np.argsort(points[:, 0])
    place = np.empty(n, dtype=np.int64)  # of each point in that order
    population = np.empty((points.shape[1], n))
    for j in range(n):
        place[order[j]] = j
        population[:, j] = points[order[j]]
    for i in range(n):
        size = archive.counts[0]
        wanted = min(k, n - 1 + size)
        found = nearest[: max(wanted, 1)]  # no longer than need be: every neighbour is sorted into all of it
        found[:] = np.inf
        here = place[i]
        _nearest_among(points[i], population, here, n, here, taxicab, found)
        middle = np.searchsorted(archive.points[0, :size], points[i, 0])
        _nearest_among(points[i], archive.points, middle, size, -1, taxicab, found)
        total = 0.0
        for j in range(wanted):  # in ascending order
            total += found[j] if taxicab else np.sqrt(found[j])
        scores[i] = total / k
        offer(archive, points[i], scores[i])


@kernel
def _nearest_among(
    point: np.ndarray,
    others: np.ndarray,
    middle: int,
    size: int,
    itself: int,
    taxicab: bool,
    nearest: np.ndarray,
) -> None:
    """Update the ascending distances `nearest` with those to the first `size` of `others`, but for `itself`.

    `others`, of shape (dimensions, at least size), is sorted by its first row; `middle` is where `point` belongs in it.
    """
    k = len(nearest)
    farthest = nearest[k - 1]
    for direction in (1, -1):
        j = middle if direction > 0 else middle - 1
        while 0 <= j < size:
            distance = _along_axis(others[0, j] - point[0], taxicab)
            if distance >= farthest:
                break
            for axis in range(1, len(point)):
                distance += _along_axis(others[axis, j] - point[axis], taxicab)
            if distance < farthest and j != itself:
                for place in range(k - 1, 0, -1):  # no branch: the processor would often guess it wrong
                    nearest[place] = min(nearest[place], max(nearest[place - 1], distance))
                nearest[0] = min(nearest[0], distance)
                farthest = nearest[k - 1]
            j += direction


@kernel
def _along_axis(difference: float, taxicab: bool) -> float:
    """What a difference in one coordinate adds to a taxicab or squared Euclidean distance."""
    return abs(difference) if taxicab else difference * difference


@kernel
def offer(archive: ArchiveArrays, point: np.ndarray, score: float) -> bool:
    """Let a point into the archive where there is room, or where it scores above the lowest. Has it entered?"""
    points, scores, entry, counts = archive
    capacity = len(scores)
    size, entered, lowest = counts
    if size < capacity:
        gap = size
        size += 1
    elif capacity > 0 and score > scores[lowest]:
        gap = lowest
    else:
        return False
    # the gap moves to where the newcomer belongs in the order of the first coordinate
    first_coordinate = points[0]
    target = gap
    while target > 0 and first_coordinate[target - 1] > point[0]:
        target -= 1
    if target == gap:
        while target + 1 < size and first_coordinate[target + 1] < point[0]:
            target += 1
    for axis in range(len(point)):
        _move(points[axis], gap, target, point[axis])
    _move(scores, gap, target, score)
    _move(entry, gap, target, entered)
    counts[0] = size
    counts[1] = entered + 1
    if size == capacity:
        counts[2] = _lowest_and_oldest(scores, entry)
    return True


@kernel
def _move(row: np.ndarray, gap: int, target: int, value) -> None:
    """Shift what lies between the gap and the target by one into the gap, and put the value at the target."""
    for place in range(gap, target):
        row[place] = row[place + 1]
    for place in range(gap, target, -1):
        row[place] = row[place - 1]
    row[target] = value


@kernel
def _lowest_and_oldest(scores: np.ndarray, entry: np.ndarray) -> int:
    """The place of the lowest score, that of the oldest on a tie."""
    place = 0
    for i in range(1, len(scores)):
        if scores[i] < scores[place] or (scores[i] == scores[place] and entry[i] < entry[place]):
            place = i
    return place
