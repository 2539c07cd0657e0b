"""The mixed model compared with numerical integration, with closed forms, and with simulated truth."""

import dataclasses
import math

import numpy as np
import pytest
from scipy import optimize, special, stats

from safe.results import mixed

SUCCESSES, OTHERS = np.array([20, 3, 0, 12, 20, 7]), np.array([18, 1, 0, 15, 20, 0])


def by_integration(parameters, successes, other, runs):
    """The logarithm of the likelihood of one maze: a sum over a fine grid of intercepts and effects."""
    centre, lower = np.array(parameters[:2]), np.array([[parameters[2], 0], parameters[3:]])
    axes = [
        np.linspace(m - 8 * sd, m + 8 * sd, 1001) for m, sd in zip(centre, np.linalg.norm(lower, axis=1), strict=True)
    ]
    intercepts, effects = np.meshgrid(*axes, indexing="ij")
    value = stats.multivariate_normal(centre, lower @ lower.T).pdf(np.stack([intercepts, effects], axis=-1))
    for logits, count in ((intercepts + effects / 2, successes), (intercepts - effects / 2, other)):
        value *= special.expit(logits) ** count * special.expit(-logits) ** (runs - count)
    return math.log(value.sum() * np.prod([axis[1] - axis[0] for axis in axes]))


@pytest.mark.parametrize("parameters", [(0.3, 0.5, 1.5, 0.2, 0.7), (-1.0, 0.0, 0.8, -0.9, 0.4)])
def test_the_likelihood_is_that_of_numerical_integration(parameters):
    pairs = np.column_stack([SUCCESSES, OTHERS]).astype(float)
    for pair in pairs:
        value, _ = mixed._marginal_likelihood(
            np.array(parameters), pair[np.newaxis], np.full((1, 2), 20.0), np.zeros((1, 2))
        )
        assert value == pytest.approx(by_integration(parameters, *pair, 20), abs=2e-4)
    modes = np.zeros_like(pairs)
    whole, gradient = mixed._marginal_likelihood(np.array(parameters), pairs, np.full_like(pairs, 20), modes)

    def likelihood(changed):
        return mixed._marginal_likelihood(changed, pairs, np.full_like(pairs, 20), modes)[0]

    assert np.isfinite(whole)
    assert gradient == pytest.approx(optimize.approx_fprime(np.array(parameters), likelihood, 1e-6), abs=2e-3)


def test_mazes_that_do_not_differ_give_the_odds_ratio_of_the_pooled_table():
    found = mixed.mixed_model([12] * 10, 20, [8] * 10, 20)
    assert found.effect == pytest.approx(2 * math.log(12 / 8), abs=1e-3)
    assert found.error == pytest.approx(math.sqrt(2 / 120 + 2 / 80), rel=0.01)
    assert found.z == pytest.approx(found.effect / found.error)
    assert found.p_value == pytest.approx(2 * stats.norm.sf(found.z))
    assert max(found.sd_mazes, found.sd_effect) < 0.05


def test_the_effect_changes_its_sign_if_the_algorithms_are_swapped():
    there, back = mixed.mixed_model(SUCCESSES, 20, OTHERS, 20), mixed.mixed_model(OTHERS, 20, SUCCESSES, 20)
    assert (there.effect, there.z) == pytest.approx((-back.effect, -back.z), rel=1e-3)
    names = ("error", "p_value", "sd_mazes", "sd_effect")
    assert [getattr(there, name) for name in names] == pytest.approx([getattr(back, name) for name in names], rel=1e-3)


def test_runs_may_differ_from_maze_to_maze():
    same = mixed.mixed_model(SUCCESSES, 20, OTHERS, 20)
    assert mixed.mixed_model(SUCCESSES, [20] * 6, OTHERS, np.full(6, 20)) == same
    more = mixed.mixed_model(SUCCESSES, [20, 20, 20, 20, 40, 20], OTHERS, 20)
    assert more.effect < same.effect, "20 successes of 40 runs, not of 20"


@pytest.mark.parametrize("successes", [[0] * 6, [20] * 6])
def test_an_algorithm_that_never_or_always_succeeds_has_no_effect(successes):
    for found in (mixed.mixed_model(successes, 20, OTHERS, 20), mixed.mixed_model(OTHERS, 20, successes, 20)):
        assert all(math.isnan(value) for value in dataclasses.astuple(found))


def test_a_known_effect_is_found_without_bias_and_covered_by_its_intervals():
    rng = np.random.default_rng(2)
    found = []
    for _ in range(80):
        intercepts, effects = rng.normal(0.5, 2, 20), rng.normal(0.8, 1, 20)
        counts = [rng.binomial(20, special.expit(intercepts + side * effects / 2)) for side in (1, -1)]
        found.append(mixed.mixed_model(counts[0], 20, counts[1], 20))
    estimates, errors = np.array([[one.effect, one.error] for one in found]).T
    assert estimates.mean() == pytest.approx(0.8, abs=3 * estimates.std() / math.sqrt(80))
    assert errors.mean() == pytest.approx(estimates.std(), rel=0.2)
    assert 0.87 <= (np.abs(estimates - 0.8) < 1.96 * errors).mean() < 1
    assert np.mean([one.sd_mazes for one in found]) == pytest.approx(2, rel=0.1)
    assert np.mean([one.sd_effect for one in found]) == pytest.approx(1, rel=0.15)


def test_with_one_run_on_each_maze_there_may_be_no_error():
    """Regression: the curvature was not positive, and its root was a domain error."""
    rng = np.random.default_rng(5)
    for _ in range(20):
        one, other = rng.integers(0, 2, (2, 60))
        found = mixed.mixed_model(one, 1, other, 1)
        assert np.isnan(found.error) or found.error > 0
        assert np.isnan(found.error) == np.isnan(found.p_value)
