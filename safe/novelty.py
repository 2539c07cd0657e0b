"""Novelty: how far a point lies from its nearest neighbours among the points seen so far (Section 3 of the paper).

The novelty of a point is the sum of its distances to its k nearest neighbours, divided by k. Neighbours are all other
points of the population and all points of an archive. The points of a generation are scored in order, and each is
offered to the archive right after it is scored. Later points of the same generation can therefore meet it twice: in the
population and in the archive.

The archive has a fixed number of places. Every point enters while there is room. Then a newcomer whose score is
strictly above the lowest in the archive replaces the point with that score, the oldest one on a tie. A point keeps the
score with which it entered.

The same rule rates solutions, by the taxicab distance between end points, and objective functions, by the Euclidean
distance between genomes (Section 6).

For the archive of end points, there are other rules of admission beside the paper's "lowest replaced". With all of
them, a generation is scored against the population and the archive as it was before, nobody meets a point twice, and
points enter after all are scored. By two rules, what enters takes the place of the oldest if there is no other:

    random      solutions drawn with replacement enter, in the order drawn; their number is a parameter
    threshold   all whose novelty is above a threshold enter, in the order of the population (Lehman and Stanley, 2011).
                The threshold, at first a parameter, rises by 20 % after a generation in which more than 4 enter, and
                falls by 5 % after generations without an entry once they make 2500 evaluations, counted from the last
                entry or fall

The other three change the paper's rule: the first its order, the other two this and one thing more:

    after scoring   points are offered, in the order of the population, after all are scored
    distinct        as "after scoring", but no point enters a cell that the archive already holds
    rescored        as "after scoring", but no score is kept from entry: in each generation the archive's points are
                    scored like the population's, against the population and the rest of the archive

Without places (a capacity of 0) nothing is drawn, enters or changes. The archive of objective functions always keeps
the paper's rule.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from safe import checks
from safe.kernel import index, kernel
from safe.neighbours import Grid, Members, Nearest, even_reach, grid_over, look_around, smallest, sort_into_cells

METRICS = ("taxicab", "euclidean")
K = 15
ARCHIVE_CAPACITY = 1000
# to the archive of end points
ADMISSIONS = ("lowest replaced", "random", "threshold", "after scoring", "distinct", "rescored")
LOWEST_REPLACED, RANDOM, THRESHOLD, AFTER_SCORING, DISTINCT, RESCORED = range(len(ADMISSIONS))
MOST_ENTRIES = 4  # in a generation: if more enter, the threshold rises
RISE = 1.2
MOST_IDLE = 2500  # evaluations without an entry: after them, the threshold falls
FALL = 0.95
RINGS = 24  # of cells searched around a point: searching more would cost more than measuring all distances
MOST_DIMENSIONS = 1000  # of a point: an archive reserves memory for each


class ArchiveArrays(NamedTuple):
    """An archive as the compiled functions take it; changed in place."""

    points: np.ndarray  # float64, (dimensions, capacity)
    scores: np.ndarray  # float64, (capacity,), as they were on entry, unless they are computed again
    entry: np.ndarray  # int64, (capacity,), 0 for the first point that ever entered
    heap: np.ndarray  # int64, (capacity,), places as a binary heap: the lowest score first, the oldest on a tie
    counts: np.ndarray  # int64, (2,): points in it now, points that ever entered


class NoveltyArchive:
    """An archive of points, which scores the novelty of new ones.

    Parameters
    ----------
    capacity : int
        The number of places.
    k : int
        The number of nearest neighbours that count.
    metric : {"taxicab", "euclidean"}
        The distance between two points.

    Raises
    ------
    ValueError
        If capacity is not in 0..1,000,000 or k not in 1..1,000,000, or if the metric is unknown.

    Examples
    --------
    Three points on a line, each scored by its two nearest neighbours.

    >>> archive = NoveltyArchive(capacity=10, k=2)
    >>> archive.score([[0, 0], [0, 1], [0, 4]]).tolist()
    [2.5, 1.0, 3.0]

    The second scores (1 + 1) / 2 rather than (1 + 3) / 2: the first is its neighbour in the population and, having
    entered by then, in the archive as well.

    >>> len(archive), archive.scores.tolist()
    (3, [2.5, 1.0, 3.0])
    """

    def __init__(self, capacity: int = ARCHIVE_CAPACITY, k: int = K, metric: str = "taxicab") -> None:
        self.capacity = checks.integer("capacity", capacity, 0, checks.MOST)
        self.k = checks.integer("k", k, 1, checks.MOST)
        self.metric = checks.choice("metric", metric, METRICS)
        self._arrays: ArchiveArrays | None = None  # made with the first points, which set the dimensions

    def score(self, points: np.ndarray) -> np.ndarray:
        """Score the points of one generation in order; those that the archive admits stay in it.

        Parameters
        ----------
        points : array of float, shape (n, dimensions)

        Returns
        -------
        array of float, shape (n,)

        Raises
        ------
        ValueError
            If the points are not finite or exceed 1e100 in magnitude, if they do not have 1 to 1000 dimensions, or
            not as many as the points before.
        """
        dimensions = None if self._arrays is None else len(self._arrays.points)
        points = checks.array("points", points, (None, dimensions))
        checks.integer("the columns of points", points.shape[1], 1, MOST_DIMENSIONS)
        if self._arrays is None:
            self._arrays = empty_archive(self.capacity, points.shape[1])
        scores = np.empty(len(points))
        score_points(points, self._arrays, self.k, self.metric == "taxicab", scores)
        return scores

    def __len__(self) -> int:
        return 0 if self._arrays is None else int(self._arrays.counts[0])

    @property
    def points(self) -> np.ndarray:
        """The archive's points, the oldest first, as an array of float of shape (len(archive), dimensions); a copy."""
        return np.empty((0, 0)) if self._arrays is None else archived(self._arrays)[0]

    @property
    def scores(self) -> np.ndarray:
        """The scores with which they entered, as an array of float of shape (len(archive),); a copy."""
        return np.empty(0) if self._arrays is None else archived(self._arrays)[1]


def empty_archive(capacity: int, dimensions: int) -> ArchiveArrays:
    """An archive without points."""
    return ArchiveArrays(
        points=np.zeros((dimensions, capacity)),
        scores=np.zeros(capacity),
        entry=np.zeros(capacity, dtype=np.int64),
        heap=np.zeros(capacity, dtype=np.int64),
        counts=np.zeros(2, dtype=np.int64),
    )


def empty_occupancy(shape: tuple[int, int]) -> np.ndarray:
    """The count of points in each cell of a maze, all zero, with an empty margin of RINGS cells around the maze."""
    return np.zeros((shape[0] + 2 * RINGS, shape[1] + 2 * RINGS), dtype=np.int32)


def archived(archive: ArchiveArrays) -> tuple[np.ndarray, np.ndarray]:
    """Copies of an archive's points, shape (n, dimensions), and their scores, shape (n,), the oldest first."""
    size = archive.counts[0]
    oldest_first = np.argsort(archive.entry[:size])
    return archive.points[:, oldest_first].T.copy(), archive.scores[oldest_first]


# Compiled functions
#
# Nearest neighbours are found in one of two ways, both exact.
#
# End points are cells of a maze, so taxicab distances are whole numbers and many points share a cell. `score_cells`
# counts the points in every cell, and sums these counts ring by ring around a point until it has k neighbours. If they
# lie beyond the outermost ring, as in a large and empty maze, it measures the distance to every point.
#
# `score_points` takes any points, and searches a grid for the neighbours of each (see `safe.neighbours`).


@kernel
def score_cells(
    cells: np.ndarray, archive: ArchiveArrays, occupancy: np.ndarray, k: int, admission: int, scores: np.ndarray
) -> None:
    """Score cells (int64, (n, 2), row and column) by taxicab distance, in order.

    By the paper's rule, each is offered to the archive. By others, none is (see `admit`). `occupancy` (see
    `empty_occupancy`) counts the archive's points in each cell, on entry and on return.
    """
    n = len(cells)
    offering = admission == LOWEST_REPLACED
    for i in range(n):
        occupancy[RINGS + cells[i, 0], RINGS + cells[i, 1]] += 1
    size = archive.counts[0]
    threshold = threshold_of(archive) if offering else np.inf
    for i in range(n + size if admission == RESCORED else n):  # one loop, so that the rings are compiled into it
        if i < n:
            row, column = cells[i, 0], cells[i, 1]
        else:
            row, column = int(archive.points[0, i - n]), int(archive.points[1, i - n])
        wanted = min(k, n - 1 + size)
        total = _sum_over_rings(RINGS + row, RINGS + column, occupancy, wanted)
        if total < 0:
            total = _sum_over_all(row, column, occupancy, cells, archive.points, size, wanted)
        if i >= n:
            archive.scores[i - n] = total / k
            continue
        scores[i] = total / k
        if scores[i] > threshold:
            replace_lowest(cells[i], scores[i], archive, occupancy)
            size = archive.counts[0]
            threshold = threshold_of(archive)
    for i in range(n):
        occupancy[RINGS + cells[i, 0], RINGS + cells[i, 1]] -= 1


@kernel
def replace_lowest(cell: np.ndarray, score: float, archive: ArchiveArrays, occupancy: np.ndarray) -> None:
    """Let a cell into the archive, at a free place or that of the lowest score."""
    place = vacate(archive)
    if place < archive.counts[0]:
        occupancy[RINGS + int(archive.points[0, place]), RINGS + int(archive.points[1, place])] -= 1
    occupancy[RINGS + cell[0], RINGS + cell[1]] += 1
    archive.points[0, place] = cell[0]
    archive.points[1, place] = cell[1]
    enter(archive, place, score)


@kernel
def admit(
    cells: np.ndarray,
    scores: np.ndarray,
    archive: ArchiveArrays,
    occupancy: np.ndarray,
    admission: int,
    admitted: int,
    threshold: np.ndarray,
    rng: np.random.Generator,
) -> None:
    """Admit scored cells to the archive, by a rule other than the paper's.

    Where the oldest leave, places are taken round and round. `threshold` holds the threshold, and the evaluations since
    the last entry or fall; both are changed in place.
    """
    points, archived_scores, entry, _, counts = archive
    n, capacity, entered = len(cells), len(archived_scores), counts[1]
    if capacity == 0:
        return
    if admission >= AFTER_SCORING:
        sort_heap(archive)  # of which all scores may be new
        for i in range(n):
            is_held = admission == DISTINCT and occupancy[RINGS + cells[i, 0], RINGS + cells[i, 1]] > 0
            if scores[i] > threshold_of(archive) and not is_held:
                replace_lowest(cells[i], scores[i], archive, occupancy)
        return
    for turn in range(admitted if admission == RANDOM else n):
        i = int(rng.random() * n) if admission == RANDOM else turn
        if admission == THRESHOLD and scores[i] <= threshold[0]:
            continue
        place = counts[1] % capacity
        if place < counts[0]:  # the oldest leaves
            occupancy[RINGS + int(points[0, place]), RINGS + int(points[1, place])] -= 1
        occupancy[RINGS + cells[i, 0], RINGS + cells[i, 1]] += 1
        points[0, place] = cells[i, 0]
        points[1, place] = cells[i, 1]
        archived_scores[place] = scores[i]
        entry[place] = counts[1]
        counts[1] += 1
        counts[0] = min(counts[1], capacity)
    if admission == THRESHOLD:
        entries = counts[1] - entered
        threshold[1] = 0 if entries > 0 else threshold[1] + n
        if entries > MOST_ENTRIES:
            threshold[0] *= RISE
        elif threshold[1] >= MOST_IDLE:
            threshold[0] *= FALL
            threshold[1] = 0


@kernel
def _sum_over_rings(row: int, column: int, occupancy: np.ndarray, wanted: int) -> int:
    """The sum of the distances from a point to the `wanted` nearest others; -1 if some lie beyond the rings."""
    found = occupancy[row, column] - 1  # without the point itself
    total = 0
    for radius in range(1, RINGS + 1):
        if found >= wanted:
            return total
        on_ring = 0
        for step in range(radius):  # along the four sides of the ring at once
            on_ring += occupancy[index(row - radius + step), index(column + step)]
            on_ring += occupancy[index(row + step), index(column + radius - step)]
            on_ring += occupancy[index(row + radius - step), index(column - step)]
            on_ring += occupancy[index(row - step), index(column - radius + step)]
        total += radius * min(on_ring, wanted - found)
        found += on_ring
    return total if found >= wanted else -1


@kernel(makes_arrays=True)
def _sum_over_all(
    row: int, column: int, occupancy: np.ndarray, cells: np.ndarray, archived: np.ndarray, size: int, wanted: int
) -> int:
    """The same sum, from the number of points, in the population and in the archive, at every distance."""
    at_distance = np.zeros(occupancy.shape[0] + occupancy.shape[1], dtype=np.int64)
    for j in range(len(cells)):
        at_distance[abs(cells[j, 0] - row) + abs(cells[j, 1] - column)] += 1
    for j in range(size):
        at_distance[abs(int(archived[0, j]) - row) + abs(int(archived[1, j]) - column)] += 1
    found = at_distance[0] - 1  # without the point itself
    total = 0
    distance = 0
    while found < wanted:
        distance += 1
        total += distance * min(at_distance[distance], wanted - found)
        found += at_distance[distance]
    return total


@kernel(makes_arrays=True)
def score_points(points: np.ndarray, archive: ArchiveArrays, k: int, taxicab: bool, scores: np.ndarray) -> None:
    """Score points in order, offering each to the archive."""
    n, dimensions = points.shape
    if n == 0:
        return
    size, capacity = archive.counts[0], len(archive.scores)
    grid = grid_over(points, n + size)
    most_members = n + min(capacity, size + n)
    most_newcomers = 1 + int(math.sqrt(most_members))
    room = most_members + most_newcomers
    members = Members(
        np.zeros((max(dimensions, 2), room)),
        np.empty(grid.rows.count * grid.columns.count + 2, dtype=np.int64),
        np.empty(capacity, dtype=np.int64),
    )
    nearest = Nearest(np.empty(room + 4), np.empty(room + 4), np.empty(room + 4, dtype=np.int64))
    _score_among(points, archive, k, taxicab, grid, members, most_newcomers, nearest, scores)


@kernel
def _score_among(
    points: np.ndarray,
    archive: ArchiveArrays,
    k: int,
    taxicab: bool,
    grid: Grid,
    members: Members,
    most_newcomers: int,
    nearest: Nearest,
    scores: np.ndarray,
) -> None:
    """The same in the arrays that `score_points` makes: to count references to them would take time."""
    n, dimensions = points.shape
    counts = archive.counts
    size = in_cells = sort_into_cells(grid, points, archive.points, counts[0], members)
    reach = even_reach(grid, (k + 1) / size)
    threshold = threshold_of(archive)
    for i in range(n):
        # the point also finds itself, at a distance of 0, which adds nothing to the sum
        wanted = min(k, n - 1 + counts[0]) + 1
        found = look_around(points, i, grid, members, in_cells, size, wanted, reach, taxicab, nearest.distances)
        smallest(nearest.distances, found, wanted, nearest.ascending, nearest.smaller)
        total = 0.0
        for j in range(wanted):
            total += nearest.ascending[j] if taxicab else math.sqrt(nearest.ascending[j])
        scores[i] = total / k
        if scores[i] > threshold:
            place = vacate(archive)
            if place < counts[0]:
                members.points[0, members.places[place]] = np.nan  # near to nothing
            enter(archive, place, scores[i])
            threshold = threshold_of(archive)
            members.places[place] = size
            for axis in range(dimensions):
                archive.points[axis, place] = members.points[axis, size] = points[i, axis]
            size += 1
            if size - in_cells == most_newcomers:
                size = in_cells = sort_into_cells(grid, points, archive.points, counts[0], members)


@kernel
def threshold_of(archive: ArchiveArrays) -> float:
    """The score that a point must exceed to enter: any while there is room, then the lowest in the archive."""
    size, capacity = archive.counts[0], len(archive.scores)
    if size < capacity:
        return -1.0
    return archive.scores[archive.heap[0]] if capacity > 0 else np.inf


@kernel
def vacate(archive: ArchiveArrays) -> int:
    """The place in the archive for the next point that enters: a free one, or that of the lowest score."""
    size = archive.counts[0]
    return size if size < len(archive.scores) else archive.heap[0]


@kernel
def enter(archive: ArchiveArrays, place: int, score: float) -> None:
    """Let the point at the place that `vacate` returned into the archive."""
    _, scores, entry, heap, counts = archive
    scores[place] = score
    entry[place] = counts[1]
    counts[1] += 1
    if place == counts[0]:  # it was free: the point rises from the end of the heap
        node = place
        while node > 0 and score < scores[heap[(node - 1) // 2]]:
            heap[node] = heap[(node - 1) // 2]
            node = (node - 1) // 2
        counts[0] += 1
    else:  # it was that of the lowest: the point sinks from the top
        node = np.int64(0)
        child = _lower_child(archive, node)
        while child >= 0 and scores[heap[child]] <= score:  # it is the youngest of equals
            heap[node] = heap[child]
            node = child
            child = _lower_child(archive, node)
    heap[node] = place


@kernel
def _lower_child(archive: ArchiveArrays, node: int) -> int:
    """The child of a node of the heap with the lower score, the older one on a tie; -1 if it has none."""
    _, scores, entry, heap, counts = archive
    left, right = 2 * node + 1, 2 * node + 2
    if right >= counts[0]:
        return left if left < counts[0] else -1
    one, other = heap[left], heap[right]
    is_other = scores[other] < scores[one] or (scores[other] == scores[one] and entry[other] < entry[one])
    return right if is_other else left


@kernel
def sort_heap(archive: ArchiveArrays) -> None:
    """Rebuild the heap after scores have changed: sorted places, by insertion, since they are nearly so, are a heap."""
    _, scores, entry, heap, counts = archive
    for node in range(1, counts[0]):
        place = heap[node]
        while node > 0 and (
            scores[heap[node - 1]] > scores[place]
            or (scores[heap[node - 1]] == scores[place] and entry[heap[node - 1]] > entry[place])
        ):
            heap[node] = heap[node - 1]
            node -= 1
        heap[node] = place
