"""The nearest neighbours in a grid are those that one finds by measuring all."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from safe import NoveltyArchive
from safe.neighbours import smallest
from tests.helpers import oracle

DISTANCES = {"taxicab": oracle.taxicab, "euclidean": oracle.euclidean}


def in_order(values, wanted):
    """The `wanted` smallest, as the package orders them."""
    room = len(values) + 4
    given, ascending, smaller = np.full(room, -1.0), np.empty(room), np.empty(room, dtype=np.int64)
    given[: len(values)] = values
    smallest(given, len(values), wanted, ascending, smaller)
    return ascending[:wanted].tolist()


@given(st.lists(st.integers(0, 30).map(float) | st.floats(0, 1e9), min_size=1, max_size=60), st.integers(1, 60))
def test_the_smallest_in_order(values, wanted):
    wanted = min(wanted, len(values))
    assert in_order(values, wanted) == sorted(values)[:wanted]


def test_the_smallest_of_very_many():
    values = np.random.default_rng(1).permutation(np.repeat(np.arange(3000.0), 2))
    for wanted in (1, 7, 5999, 6000):
        assert in_order(values, wanted) == sorted(values)[:wanted]


def far_apart(rng):
    """Mostly in one place, a few far away: neither is what a grid of even cells is made for."""
    return np.concatenate([rng.normal(0, 1e-9, (300, 2)), rng.uniform(-1e6, 1e6, (60, 2))])


@pytest.mark.parametrize("metric", DISTANCES)
@pytest.mark.parametrize(
    "draw",
    [
        lambda rng: rng.random((360, 2)),
        lambda rng: rng.integers(0, 4, (360, 2)).astype(float),  # hundreds of doubles of each point
        lambda rng: np.stack([rng.random(360), np.zeros(360)], axis=1),
        lambda rng: np.ones((360, 2)),
        lambda rng: rng.random((360, 5)),
        far_apart,
    ],
    ids=["even", "doubles", "on a line", "in one place", "in five dimensions", "far apart"],
)
def test_scores_do_not_depend_on_how_points_are_spread(draw, metric):
    rng = np.random.default_rng(1)
    archive = NoveltyArchive(capacity=400, k=7, metric=metric)
    for _ in range(3):
        points = rng.permuted(draw(rng), axis=0)
        others = np.concatenate([points, archive.points]) if len(archive) else points
        measure = {"taxicab": lambda d: np.abs(d).sum(axis=1), "euclidean": lambda d: np.sqrt((d * d).sum(axis=1))}
        first = np.sort(measure[metric](others - points[0]))[1:8].sum() / 7
        before = oracle.Archive(400)
        before.members = [
            (s, i, p.tolist()) for i, (p, s) in enumerate(zip(archive.points, archive.scores, strict=True))
        ]
        before.entered = len(before.members)
        scores = archive.score(points)
        assert scores[0] == pytest.approx(first, rel=1e-12)
        np.testing.assert_allclose(
            scores, oracle.novelty(points.tolist(), before, 7, DISTANCES[metric]), rtol=1e-12, atol=1e-12
        )
