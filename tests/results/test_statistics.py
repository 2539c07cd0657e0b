"""Statistics compared with published worked examples, and with properties that they must have."""

import itertools
import math

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats
from statsmodels.formula.api import glm
from statsmodels.genmod.families import Binomial

from safe.results import statistics
from tests.helpers.results import runs


@pytest.mark.parametrize(
    ("successes", "n", "low", "high"),
    # Newcombe, Statistics in Medicine 17 (1998) 857-872, Table I, method 3
    [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718)],
)
def test_wilsons_interval(successes, n, low, high):
    assert statistics.success_interval(successes, n) == pytest.approx((low, high), abs=5e-5)


@pytest.mark.parametrize(
    ("first", "second", "low", "high"),
    # Newcombe, Statistics in Medicine 17 (1998) 873-890, Table II, method 10
    [((56, 70), (48, 80), 0.0524, 0.3339), ((9, 10), (3, 10), 0.1705, 0.8090), ((10, 10), (0, 20), 0.6791, 1.0)],
)
def test_newcombes_interval(first, second, low, high):
    found = statistics.compare_rates(*first, *second)
    assert (found.low, found.high) == pytest.approx((low, high), abs=5e-5)


def test_fishers_exact_test():
    # the lady tasting tea: three of four cups named rightly, p = 0.486 two-sided
    assert statistics.compare_rates(3, 4, 1, 4).p_value == pytest.approx(34 / 70)


def test_equivalence_needs_enough_runs():
    assert statistics.compare_rates(10, 20, 10, 20).p_equivalence > 0.05
    assert statistics.compare_rates(500, 1000, 500, 1000).p_equivalence < 0.05
    assert statistics.compare_rates(500, 1000, 650, 1000).p_equivalence > 0.05


@given(st.integers(1, 60), st.integers(1, 60), st.data())
def test_a_difference_of_rates_changes_sign_if_its_samples_are_swapped(n, m, data):
    first, second = (data.draw(st.integers(0, n)), n), (data.draw(st.integers(0, m)), m)
    there, back = statistics.compare_rates(*first, *second), statistics.compare_rates(*second, *first)
    assert (there.difference, there.low, there.high) == pytest.approx((-back.difference, -back.high, -back.low))
    assert (there.p_value, there.effect, there.p_equivalence) == pytest.approx(
        (back.p_value, -back.effect, back.p_equivalence)
    )
    assert there.low - 1e-9 <= there.difference <= there.high + 1e-9
    assert 0 <= there.p_value <= 1 + 1e-9


def test_means_are_compared_as_scipy_compares_the_samples():
    rng = np.random.default_rng(5)
    first, second = rng.normal(3, 2, 40), rng.normal(4, 1, 25)
    found = statistics.compare_means(first.mean(), first.std(), 40, second.mean(), second.std(), 25)
    welch = stats.ttest_ind(first, second, equal_var=False)
    interval = welch.confidence_interval(0.95)
    assert found.p_value == pytest.approx(welch.pvalue)
    assert (found.low, found.high) == pytest.approx((interval.low, interval.high))
    spread = math.sqrt((first.var(ddof=1) + second.var(ddof=1)) / 2)
    assert found.effect == pytest.approx(found.difference / spread)
    # two one-sided tests, done on the samples shifted by the margin
    margin = statistics.MARGIN * spread
    one_sided = [
        stats.ttest_ind(first + margin, second, equal_var=False, alternative="greater").pvalue,
        stats.ttest_ind(first - margin, second, equal_var=False, alternative="less").pvalue,
    ]
    assert found.p_equivalence == pytest.approx(max(one_sided))


def test_means_of_single_runs_are_not_compared():
    found = statistics.compare_means(3.0, 0.0, 1, 2.0, 1.0, 9)
    assert found.difference == 1
    assert math.isnan(found.p_value)
    assert math.isnan(found.low)
    assert math.isnan(statistics.compare_means(3.0, 0.0, 5, 2.0, 0.0, 9).p_equivalence)


def test_how_many_runs_are_needed():
    n = statistics.runs_needed(0.5, 0.6)
    rng = np.random.default_rng(1)
    counts = rng.binomial(n, [[0.5], [0.6]], (2, 4000))
    h = 2 * np.abs(np.diff(np.arcsin(np.sqrt(counts / n)), axis=0))
    assert (h * math.sqrt(n / 2) > 1.96).mean() == pytest.approx(0.8, abs=0.02)
    assert statistics.runs_needed(0.644, 0.656) > 50 * n


def test_a_success_curve_with_failures_censored():
    # one run is known only up to generation 1: of the three then left, one succeeds in generation 2
    table = pd.DataFrame({"success": [True, False, True, False, False], "generation": [0, 1, 2, 9, 9]})
    found = statistics.success_curve(table)
    assert found.generation.tolist() == [0, 2]
    assert found.share.tolist() == pytest.approx([1 / 5, 1 - (4 / 5) * (2 / 3)])
    assert ((found.low < found.share) & (found.share < found.high)).all()
    assert statistics.success_curve(runs(0, 3)).empty


def test_a_success_curve_by_evaluations():
    table = runs(2, 4, [5, 1]).assign(evaluations=lambda of: 100 * (of.generation + 1))
    found = statistics.success_curve(table, "evaluations")
    assert found.columns.tolist() == ["evaluations", "share", "low", "high"]
    assert found.evaluations.tolist() == [200, 600]
    assert found.share.tolist() == pytest.approx(statistics.success_curve(table).share.tolist())


def test_in_a_mean_success_curve_each_maze_counts_once():
    first = pd.DataFrame({"maze": "a", "success": [True, True], "evaluations": [200, 600]})
    second = pd.DataFrame({"maze": "b", "success": [True, False, False, False], "evaluations": [400, 900, 900, 900]})
    found = statistics.mean_success_curve(pd.concat([first, second]))
    assert found.evaluations.tolist() == [200, 400, 600]
    assert found.share.tolist() == pytest.approx([(0.5 + 0) / 2, (0.5 + 0.25) / 2, (1 + 0.25) / 2])
    assert found.low.tolist() == pytest.approx([0, 0.25, 0.25]), "one maze in place of both is drawn often enough"
    assert found.high.tolist() == pytest.approx([0.5, 0.5, 1])
    assert statistics.mean_success_curve(second[~second.success]).empty


def test_times_are_compared_with_failures_as_the_slowest():
    quick, slow, never = runs(2, 2, [1, 2]), runs(2, 4, [5, 6]), runs(0, 3)
    assert statistics.compare_times(quick, slow)[0] == 1
    assert statistics.compare_times(slow, quick)[0] == 0
    assert statistics.compare_times(slow, never)[0] == pytest.approx(0.5 + 0.5 * 2 / 4)
    a12, p_value = statistics.compare_times(slow, slow)
    assert (a12, p_value) == pytest.approx((0.5, 1))
    at_once = runs(2, 2, [3, 3])
    for indistinct in (never, at_once):
        assert all(math.isnan(value) for value in statistics.compare_times(indistinct, indistinct))


def test_the_log_rank_test_of_a_textbook():
    # Freireich et al. 1963, remission of leukaemia in weeks: the statistic is 16.79
    treated = [6, 6, 6, 7, 10, 13, 16, 22, 23, 6, 9, 10, 11, 17, 19, 20, 25, 32, 32, 34, 35]
    placebo = [1, 1, 2, 2, 3, 4, 4, 5, 5, 8, 8, 8, 8, 11, 11, 12, 12, 15, 17, 22, 23]
    first = pd.DataFrame({"generation": treated, "success": [True] * 9 + [False] * 12})
    second = pd.DataFrame({"generation": placebo, "success": True})
    _, p_value = statistics.compare_times(first, second)
    assert p_value == pytest.approx(stats.chi2.sf(16.79, 1), rel=0.01)


def factorial_rates(successes, **factors):
    """A full factorial design of so many successes of 20 runs, cell by cell, the last factor changing fastest."""
    cells = pd.DataFrame(itertools.product(*factors.values()), columns=[*factors])
    return cells.assign(successes=successes, runs=20)


@pytest.mark.parametrize("successes", [[2, 9, 15], [0, 9, 20], [0, 0, 3], [7, 7, 7]])
def test_the_deviance_of_a_single_factor_is_that_of_the_g_test(successes):
    table = statistics.analysis_of_deviance(factorial_rates(successes, k=[1, 15, 50]), ["k"])
    counts = np.array([successes, [20 - count for count in successes]])
    g_test = stats.chi2_contingency(counts, correction=False, lambda_="log-likelihood")
    assert table.index.tolist() == ["k"]
    assert table.loc["k"].tolist() == pytest.approx(
        [g_test.statistic, 2, g_test.pvalue, (max(successes) - min(successes)) / 20], abs=1e-3
    )


def test_deviances_are_those_of_nested_logistic_models():
    rates = factorial_rates([2, 5, 9, 7, 12, 18, 4, 8, 3, 13, 15, 11], k=[1, 15], size=[2, 5, 20], archive=["a", "b"])
    table = statistics.analysis_of_deviance(rates, ["k", "size", "archive"])

    def deviance(formula):
        outcomes = "successes + I(runs - successes)"
        return glm(f"{outcomes} ~ {formula}", rates.astype({"k": str, "size": str}), family=Binomial()).fit().deviance

    main = deviance("k + size + archive")
    expected = {
        "k": (deviance("size + archive") - main, 1),
        "size": (deviance("k + archive") - main, 2),
        "archive": (deviance("k + size") - main, 1),
        "k x size": (main - deviance("k * size + archive"), 2),
        "k x archive": (main - deviance("k * archive + size"), 1),
        "size x archive": (main - deviance("size * archive + k"), 2),
    }
    assert table.index.tolist() == [*expected]
    for name, (gained, df) in expected.items():
        row = table.loc[name]
        assert (row.deviance, row.df) == (pytest.approx(gained, abs=1e-3), df)
        assert row.p_value == pytest.approx(stats.chi2.sf(gained, df), abs=1e-3)
    assert table.span["k"] == pytest.approx((54 - 53) / 120)
    assert table.span[["k x size", "k x archive", "size x archive"]].isna().all()


def test_combinations_that_a_design_lacks_have_no_degree_of_freedom():
    rates = factorial_rates([2, 5, 9, 7, 12, 18], k=[1, 15, 50], archive=["a", "b"])[:-1]
    table = statistics.analysis_of_deviance(rates, ["k", "archive"])
    assert table.df.tolist() == [2, 1, 1]


# Bickel and Doksum (1977), depression scores before and after a tranquilliser, as in the help of R's wilcox.test
BEFORE = [1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30]
AFTER = [0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29]


def test_the_signed_rank_test_of_a_textbook():
    found = statistics.compare_pairs(BEFORE, AFTER)
    assert found.p_value == pytest.approx(0.03906, abs=5e-6)
    assert found.shift == pytest.approx(0.46, abs=5e-4)
    assert (found.better, found.worse) == (7, 2)
    assert found.difference == pytest.approx(np.mean(BEFORE) - np.mean(AFTER))


def test_pairs_change_sign_if_they_are_swapped():
    there, back = statistics.compare_pairs(BEFORE, AFTER), statistics.compare_pairs(AFTER, BEFORE)
    assert (there.difference, there.low, there.high) == pytest.approx((-back.difference, -back.high, -back.low))
    assert (there.shift, there.shift_low, there.shift_high) == pytest.approx(
        (-back.shift, -back.shift_high, -back.shift_low)
    )
    assert (there.p_value, there.better, there.worse) == (back.p_value, back.worse, back.better)


def test_mazes_without_a_difference_do_not_count_in_the_test():
    with_ties = statistics.compare_pairs([*BEFORE, 0, 1], [*AFTER, 0, 1])
    assert with_ties.p_value == pytest.approx(statistics.compare_pairs(BEFORE, AFTER).p_value)
    # differences of 0.1 are equal, however they are rounded
    tied = statistics.compare_pairs([0.3, 0.2, 0.0], [0.2, 0.3, 0.1])
    assert (tied.p_value, tied.shift) == (pytest.approx(stats.wilcoxon([1, -1, -1]).pvalue), pytest.approx(-0.05))
    same = statistics.compare_pairs([0.5, 0, 1], [0.5, 0, 1])
    assert (same.p_value, same.difference, same.shift, same.better, same.worse) == (1, 0, 0, 0, 0)


def test_intervals_over_mazes_cover_what_holds_for_all_mazes():
    rng = np.random.default_rng(4)
    covered = []
    for _ in range(40):
        first, second = rng.binomial(20, rng.beta(0.7, 0.7, (2, 40))) / 20
        mean, low, high = statistics.mean_over_mazes(first)
        assert mean == pytest.approx(first.mean())
        found = statistics.compare_pairs(first, second)
        covered.append((low < 0.5 < high, found.low < 0 < found.high, found.shift_low <= 0 <= found.shift_high))
    assert (np.mean(covered, axis=0) >= 0.85).all()


def test_intervals_over_mazes_are_as_wide_as_the_standard_error_says():
    shares = np.random.default_rng(5).random((50, 3))
    _, low, high = statistics.mean_over_mazes(shares)
    assert high - low == pytest.approx(2 * 1.96 * shares.std(axis=0) / math.sqrt(50), rel=0.05)
