"""Scalings, scores, ranks and correlations, against plain Python to the bit, and against scipy."""

import hypothesis.extra.numpy as hnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from safe.judges import SCALINGS, Judges, best_scores, correlations, rank, scale, score_all
from tests.helpers import oracle

VALUES = st.integers(0, 4).map(float) | st.floats(0, 9, allow_subnormal=False)  # with ties
COEFFICIENTS = st.sampled_from([-0.5, 0.0, 0.25, 1.0]) | st.floats(-1, 1)


@st.composite
def judges(draw, coefficients=COEFFICIENTS):
    """Some objective functions, and the components of some solutions."""
    n, m, width = draw(st.integers(2, 12)), draw(st.integers(1, 6)), draw(st.integers(1, 3))
    return Judges(
        objectives=draw(hnp.arrays(np.float64, (m, width), elements=coefficients)),
        components=draw(hnp.arrays(np.float64, (width, n), elements=VALUES)),
    )


def panel_of(judges):
    """The scores that each objective function gives all solutions."""
    return [
        [oracle.score(o, solution) for solution in judges.components.T.tolist()] for o in judges.objectives.tolist()
    ]


def correlated(judges, distances, of_ranks):
    fitness = np.empty(len(judges.objectives))
    correlations(judges, np.array(distances), of_ranks, fitness)
    return fitness.tolist()


@given(hnp.arrays(np.float64, st.integers(1, 40), elements=VALUES | st.sampled_from([-1.0, -0.0])))
def test_equal_values_share_the_average_of_their_ranks(values):
    ranks = np.empty(len(values))
    rank(values, ranks)
    assert ranks.tolist() == oracle.ranks(values.tolist())
    assert (ranks + 1 == stats.rankdata(values)).all()


@given(hnp.arrays(np.float64, st.integers(2, 40), elements=VALUES), st.sampled_from(SCALINGS[1:]))
def test_scaled_components_are_those_of_the_oracle_from_0_to_1(values, scaling):
    scaled = np.empty(len(values))
    scale(values, SCALINGS.index(scaling), scaled)
    assert scaled.tolist() == oracle.scale(values.tolist(), scaling)
    assert scaled.min() >= 0
    assert scaled.max() <= 1
    assert (np.argsort(scaled, kind="stable") == np.argsort(values, kind="stable")).all()


@pytest.mark.parametrize(("scaling", "expected"), [("maximum", [0, 0, 0]), ("rank", [0.5, 0.5, 0.5])])
def test_a_component_that_is_0_everywhere(scaling, expected):
    scaled = np.empty(3)
    scale(np.zeros(3), SCALINGS.index(scaling), scaled)
    assert scaled.tolist() == expected


@given(judges())
def test_scores_are_those_of_the_oracle(judges):
    m, n = len(judges.objectives), judges.components.shape[1]
    scores = np.empty((m, n))
    for j in range(m):
        score_all(judges, j, scores[j])
    assert scores.tolist() == panel_of(judges)
    fitness, winners = np.empty(n), np.empty(n, dtype=np.int64)
    best_scores(judges, fitness, winners)
    assert fitness.tolist() == scores.max(axis=0).tolist()
    assert winners.tolist() == scores.argmax(axis=0).tolist()


@given(judges(), st.data(), st.booleans())
def test_correlations_are_those_of_the_oracle(judges, data, of_ranks):
    distances = data.draw(hnp.arrays(np.int64, judges.components.shape[1], elements=st.integers(0, 9)))
    correlate = oracle.spearman if of_ranks else oracle.pearson
    expected = [correlate(scores, (-distances).tolist()) for scores in panel_of(judges)]
    assert correlated(judges, distances, of_ranks) == expected


@pytest.mark.parametrize("of_ranks", [False, True])
def test_correlations_are_those_of_scipy(of_ranks):
    rng = np.random.default_rng(1)
    judges = Judges(rng.random((50, 2)), rng.integers(0, 20, (2, 200)) / 7)
    distances = rng.integers(0, 30, 200)
    correlate = stats.spearmanr if of_ranks else stats.pearsonr
    expected = [correlate(scores, -distances).statistic for scores in panel_of(judges)]
    assert correlated(judges, distances, of_ranks) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("of_ranks", [False, True])
def test_what_does_not_vary_has_no_correlation(of_ranks):
    same = Judges(np.array([[1.0], [0.1]]), np.full((1, 7), 0.1))  # the mean of seven tenths is no tenth
    assert correlated(same, range(7), of_ranks) == [0.0, 0.0]
    different = Judges(np.array([[1.0], [0.0]]), np.arange(7.0)[np.newaxis])
    assert correlated(different, [3] * 7, of_ranks) == [0.0, 0.0]
    assert correlated(different, range(7), of_ranks) == pytest.approx([-1.0, 0.0])
    tiny = Judges(np.array([[5e-324]]), np.arange(7.0)[np.newaxis])  # varies, but the squares are too small to see
    assert correlated(tiny, range(7), of_ranks) == (pytest.approx([-1.0]) if of_ranks else [0.0])
