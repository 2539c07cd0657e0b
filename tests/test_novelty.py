from pathlib import Path

import hypothesis.extra.numpy as hnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from safe import NoveltyArchive
from safe.novelty import (
    AFTER_SCORING,
    DISTINCT,
    LOWEST_REPLACED,
    RANDOM,
    RESCORED,
    RINGS,
    THRESHOLD,
    admit,
    archived,
    empty_archive,
    empty_occupancy,
    score_cells,
)
from tests.helpers import oracle
from tests.helpers.strategies import generations_of_points

DATA = Path(__file__).parent / "data"
DISTANCES = {"taxicab": oracle.taxicab, "euclidean": oracle.euclidean}
GENERATIONS_OF_CELLS = st.lists(
    hnp.arrays(np.int64, st.tuples(st.integers(0, 9), st.just(2)), elements=st.integers(0, 7)), max_size=6
)


def generator(seed):
    return np.random.Generator(np.random.SFC64(seed))


@pytest.mark.parametrize(
    ("points", "scores", "metric"),
    [("endpoints", "endpoint_novelty", "taxicab"), ("objectives", "objective_novelty", "euclidean")],
)
def test_every_reference_score(points, scores, metric):
    with np.load(DATA / "novelty.npz") as reference:
        generations, expected = reference[points], reference[scores]
    archive = NoveltyArchive(metric=metric)
    got = np.array([archive.score(generation) for generation in generations])
    assert got.shape == expected.shape == (10, 200)
    np.testing.assert_allclose(got, expected, rtol=0, atol=1e-12)


def test_every_reference_score_by_counting_cells():
    with np.load(DATA / "novelty.npz") as reference:
        generations, expected = reference["endpoints"].astype(np.int64), reference["endpoint_novelty"]
    archive, occupancy = empty_archive(1000, 2), empty_occupancy((100, 100))
    for cells, scores in zip(generations, expected, strict=True):
        got = np.empty(len(cells))
        score_cells(cells, archive, occupancy, 15, LOWEST_REPLACED, got)
        np.testing.assert_allclose(got, scores, rtol=0, atol=1e-12)


def occupied(archive):
    """What `score_cells` and admissions must leave in the occupancy."""
    expected = empty_occupancy((8, 8))
    np.add.at(expected, tuple(archived(archive)[0].astype(int).T + RINGS), 1)
    return expected


@given(GENERATIONS_OF_CELLS, st.integers(0, 12), st.integers(1, 20))
def test_counting_cells_gives_the_scores_and_the_archive_of_measuring_points(generations, capacity, k):
    points, cells = NoveltyArchive(capacity, k), empty_archive(capacity, 2)
    occupancy = empty_occupancy((8, 8))
    for generation in generations:
        scores = np.empty(len(generation))
        score_cells(generation, cells, occupancy, k, LOWEST_REPLACED, scores)
        assert scores.tolist() == points.score(generation).tolist()
        assert archived(cells)[0].tolist() == points.points.tolist() or len(points) == 0
        assert archived(cells)[1].tolist() == points.scores.tolist()
        assert (occupancy == occupied(cells)).all()


@given(generations_of_points(), st.integers(0, 12), st.integers(1, 20), st.sampled_from(sorted(DISTANCES)))
def test_scores_and_archive_are_those_of_the_oracle(generations, capacity, k, metric):
    archive, expected = NoveltyArchive(capacity, k, metric), oracle.Archive(capacity)
    for points in generations:
        scores = archive.score(points)
        oracle_scores = oracle.novelty(points.tolist(), expected, k, DISTANCES[metric])
        np.testing.assert_allclose(scores, oracle_scores, rtol=1e-12, atol=1e-12)
        # the oracle goes on from the same archive: a last digit may decide who is in it
        expected.members = [
            (score, entry, point.tolist())
            for entry, (point, score) in enumerate(zip(archive.points, archive.scores, strict=True))
        ]
        expected.entered = len(expected.members)


@given(
    GENERATIONS_OF_CELLS.map(lambda generations: [cells for cells in generations if len(cells)]),
    st.integers(0, 12),
    st.integers(1, 20),
    st.integers(1, 15) | st.floats(0, 4),
)
def test_admission_at_random_or_by_threshold_is_that_of_the_oracle(generations, capacity, k, admitted_or_threshold):
    archive, expected, occupancy = empty_archive(capacity, 2), oracle.Archive(capacity), empty_occupancy((8, 8))
    rng, twin = generator(k), generator(k)
    threshold, expected_threshold = np.array([admitted_or_threshold, 0.0]), oracle.Threshold(admitted_or_threshold)
    for cells in generations:
        scores = np.empty(len(cells))
        rule = RANDOM if isinstance(admitted_or_threshold, int) else THRESHOLD
        score_cells(cells, archive, occupancy, k, rule, scores)
        assert scores.tolist() == oracle.novelty(cells.tolist(), expected, k, oracle.taxicab, offering=False)
        if rule == RANDOM:
            admit(cells, scores, archive, occupancy, rule, admitted_or_threshold, threshold, rng)
            oracle.admit_drawn(cells.tolist(), scores.tolist(), expected, admitted_or_threshold, twin)
        else:
            admit(cells, scores, archive, occupancy, rule, 5, threshold, rng)
            expected_threshold.admit(cells.tolist(), scores.tolist(), expected)
        points, kept = archived(archive)
        assert points.tolist() == [point for _, _, point in expected.members]
        assert kept.tolist() == [score for score, _, _ in expected.members]
        assert (occupancy == occupied(archive)).all()
        assert threshold.tolist() == [expected_threshold.value, expected_threshold.idle]
    assert rng.random() == twin.random()


@given(
    GENERATIONS_OF_CELLS.map(lambda generations: [cells for cells in generations if len(cells)]),
    st.integers(0, 12),
    st.integers(1, 20),
    st.sampled_from([AFTER_SCORING, DISTINCT, RESCORED]),
)
def test_admission_after_scoring_is_that_of_the_oracle(generations, capacity, k, rule):
    archive, expected, occupancy = empty_archive(capacity, 2), oracle.Archive(capacity), empty_occupancy((8, 8))
    for cells in generations:
        points, scores = cells.tolist(), np.empty(len(cells))
        score_cells(cells, archive, occupancy, k, rule, scores)
        assert scores.tolist() == oracle.novelty(points, expected, k, oracle.taxicab, offering=False)
        if rule == RESCORED:
            expected.rescore(points, k, oracle.taxicab)
        admit(cells, scores, archive, occupancy, rule, 5, np.zeros(2), generator(0))
        oracle.admit_after_scoring(points, scores.tolist(), expected, rule == DISTINCT)
        assert archived(archive)[0].tolist() == [point for _, _, point in expected.members]
        assert archived(archive)[1].tolist() == [score for score, _, _ in expected.members]
        assert (occupancy == occupied(archive)).all()
        assert rule != DISTINCT or archive.counts[0] == 0 or occupancy.max() == 1


@given(st.integers(1, 30), st.integers(1, 9), st.lists(st.integers(1, 9), min_size=1, max_size=5))
def test_random_admission_keeps_the_newest(capacity, n, admitted):
    archive, occupancy, rng, twin = empty_archive(capacity, 2), empty_occupancy((90, 90)), generator(n), generator(n)
    entered = []
    for g, count in enumerate(admitted):
        cells = np.stack([np.arange(n), np.full(n, g)], axis=1)
        admit(cells, np.zeros(n), archive, occupancy, RANDOM, count, np.zeros(2), rng)
        entered += [[int(twin.random() * n), g] for _ in range(count)]
    assert archived(archive)[0].tolist() == entered[-capacity:]


@given(st.integers(1, 400), st.lists(st.integers(0, 7), max_size=40))
def test_the_threshold_rises_and_falls(population, entries):
    archive, occupancy = empty_archive(5, 2), empty_occupancy((8, 8))
    cells, threshold, expected, idle = np.zeros((population, 2), dtype=np.int64), np.array([3.0, 0.0]), 3.0, 0
    for entering in entries:
        scores = np.where(np.arange(population) < entering, np.nextafter(expected, np.inf), expected)
        admit(cells, scores, archive, occupancy, THRESHOLD, 5, threshold, generator(0))
        idle = 0 if entering else idle + population
        if min(entering, population) > 4:
            expected *= 1.2
        if idle >= 2500:
            expected, idle = expected * 0.95, 0
        assert threshold[0] == expected


@pytest.mark.parametrize("admission", [RANDOM, THRESHOLD, AFTER_SCORING, DISTINCT, RESCORED])
def test_without_places_no_rule_of_admission_does_anything(admission):
    cells, archive, occupancy = np.zeros((9, 2), dtype=np.int64), empty_archive(0, 2), empty_occupancy((8, 8))
    rng, threshold = generator(1), np.array([0.5, 0.0])
    admit(cells, np.ones(9), archive, occupancy, admission, 5, threshold, rng)
    assert rng.random() == generator(1).random()
    assert threshold.tolist() == [0.5, 0.0]
    assert archive.counts.tolist() == [0, 0]
    assert not occupancy.any()


def test_cells_far_apart_have_the_scores_of_points():
    rng = np.random.default_rng(1)
    cells, points, occupancy = empty_archive(60, 2), NoveltyArchive(60, k=4), empty_occupancy((900, 700))
    for _ in range(4):
        generation = rng.integers(0, (900, 700), (30, 2))
        scores = np.empty(30)
        score_cells(generation, cells, occupancy, 4, LOWEST_REPLACED, scores)
        assert scores.tolist() == points.score(generation).tolist()
        assert archived(cells)[0].tolist() == points.points.tolist()


@given(
    st.lists(hnp.arrays(np.int64, st.tuples(st.integers(0, 9), st.just(2)), elements=st.integers(0, 9)), max_size=6),
    st.integers(0, 12),
    st.sampled_from([1, 2, 4]),
)
def test_who_is_in_the_archive(generations, capacity, k):
    # taxicab distances of cells, over a power of two, are exact: so is every admission
    archive, expected = NoveltyArchive(capacity, k), oracle.Archive(capacity)
    for points in generations:
        assert archive.score(points).tolist() == oracle.novelty(points.tolist(), expected, k, oracle.taxicab)
        assert archive.scores.tolist() == [score for score, _, _ in expected.members]
        assert archive.points.tolist() == [point for _, _, point in expected.members] or len(archive) == 0
        assert len(archive) == len(expected.members)


def test_a_point_meets_its_forerunners_twice_in_their_own_generation():
    assert NoveltyArchive(k=2).score([[0, 0], [0, 3]]).tolist() == [1.5, 3.0]


def test_fewer_neighbours_than_k_still_count_as_k():
    assert NoveltyArchive(k=15).score([[0, 0]]).tolist() == [0.0]
    assert NoveltyArchive(k=15).score([[0, 0], [0, 30]]).tolist() == [2.0, 4.0]


def test_a_full_archive_lets_go_of_the_lowest_and_of_equals_the_oldest():
    archive = NoveltyArchive(capacity=2, k=1)
    archive.score([[0, 0], [0, 1]])  # both score 1
    assert archive.scores.tolist() == [1.0, 1.0]
    archive.score([[0, 2]])  # 1 is not above 1
    assert archive.points.tolist() == [[0, 0], [0, 1]]
    archive.score([[0, 5]])  # 4 is: the oldest goes
    assert archive.points.tolist() == [[0, 1], [0, 5]]
    assert archive.scores.tolist() == [1.0, 4.0]


def test_without_places_nothing_enters():
    archive = NoveltyArchive(capacity=0, k=1)
    assert archive.score([[0, 0], [0, 4]]).tolist() == [4.0, 4.0]
    assert len(archive) == 0


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ({"k": 0}, "k must be an integer from 1 to 1000000; got 0"),
        ({"k": 1.5}, "k must be an integer from 1 to 1000000; got 1.5"),
        ({"capacity": -1}, "capacity must be an integer from 0 to 1000000; got -1"),
        ({"metric": "cosine"}, "metric must be one of 'taxicab', 'euclidean'; got 'cosine'"),
        ({"metric": None}, "metric must be one of"),
    ],
)
def test_bad_archives(arguments, complaint):
    with pytest.raises(ValueError, match=complaint):
        NoveltyArchive(**arguments)


@pytest.mark.parametrize("points", [[1, 2], [[1, np.nan]], [["a", "b"]], [[1, 2], [3]], [[1, 2, 3]], [[1, 1e101]]])
def test_bad_points(points):
    archive = NoveltyArchive()
    archive.score([[0, 0]])
    with pytest.raises(ValueError, match="points must"):
        archive.score(points)
    assert len(archive) == 1


@pytest.mark.parametrize("metric", DISTANCES)
def test_points_so_far_apart_that_their_distance_would_be_infinite(metric):
    with pytest.raises(ValueError, match="points must be finite and in"):
        NoveltyArchive(metric=metric).score([[1e308], [-1e308]])
    assert np.isfinite(NoveltyArchive(metric=metric).score([[1e100], [-1e100]])).all()


@pytest.mark.parametrize("columns", [0, 1001])
def test_points_without_a_coordinate_or_with_more_than_an_archive_reserves_memory_for(columns):
    with pytest.raises(ValueError, match=f"the columns of points must be an integer from 1 to 1000; got {columns}"):
        NoveltyArchive().score(np.zeros((2, columns)))


def test_a_huge_k_costs_no_more_than_the_neighbours_there_are():
    points = np.random.default_rng(1).random((200, 2))
    all_neighbours, huge = (NoveltyArchive(k=k).score(points) * k for k in (400, 1_000_000))
    assert huge == pytest.approx(all_neighbours)
