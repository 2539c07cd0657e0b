"""Two samples compared: rates of success, means, generations to success; two algorithms, over many mazes.

Each comparison answers two questions. Is a difference detected: could two samples differ this much by chance, if both
came from one source? And is equivalence shown: is a difference as large as MARGIN ruled out (two one-sided tests)?
If neither holds, the samples are too small to decide.

MARGIN is 0.2 on the scale of standardised effects, which Cohen calls small: a convention, and so not chosen to suit any
data. For rates the effect is Cohen's h, the difference of arcsines 2 arcsin sqrt(rate); its error hardly depends on the
rates, unless hardly any run succeeds. 0.2 is 10 percentage points near a rate of one half; around 2 % it reaches from
0.2 % to 5.7 %. For means the effect is Cohen's d, the difference in standard deviations.

If two algorithms are compared on many mazes, the mazes are the sample: what is found should hold on other mazes of the
same kind. So each maze counts once, by its rates of success (`compare_pairs`), or has effects that are drawn from a
distribution (`safe.results.mixed`), and intervals come from drawing mazes again (the bootstrap).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from scipy import optimize, special, stats
from statsmodels.duration.survfunc import SurvfuncRight, survdiff
from statsmodels.stats.power import NormalIndPower
from statsmodels.stats.proportion import confint_proportions_2indep, proportion_effectsize

CONFIDENCE = 0.95
ALPHA = 1 - CONFIDENCE  # also the level of all tests
MARGIN = 0.2  # the smallest effect that matters
RESAMPLES = 10_000  # of mazes, by the bootstrap


@dataclass(frozen=True)
class Comparison:
    """A first sample against a second."""

    difference: float  # the first rate or mean less the second
    low: float  # the lower end of the 95 % interval of the difference
    high: float  # the upper end
    p_value: float  # probability of a difference at least this large, if both samples come from one source
    effect: float  # the difference, standardised: Cohen's h or d
    p_equivalence: float  # probability of an effect this small or smaller, if the true one is MARGIN


def success_interval(successes: int, runs: int) -> tuple[float, float]:
    """Wilson's 95 % interval for the rate of success: its two ends, in [0, 1] (Wilson 1927).

    Examples
    --------
    >>> low, high = success_interval(322, 500)
    >>> round(low, 3), round(high, 3)
    (0.601, 0.685)
    """
    interval = stats.binomtest(successes, runs).proportion_ci(CONFIDENCE, method="wilson")
    return float(interval.low), float(interval.high)


def compare_rates(successes: int, runs: int, other_successes: int, other_runs: int) -> Comparison:
    """Two rates of success: Fisher's exact test, Newcombe's interval of the difference, Cohen's h.

    Examples
    --------
    >>> comparison = compare_rates(328, 500, 322, 500)
    >>> round(comparison.difference, 3), round(comparison.low, 3), round(comparison.high, 3)
    (0.012, -0.047, 0.071)
    >>> round(comparison.p_value, 2), round(comparison.p_equivalence, 3)
    (0.74, 0.003)
    """
    low, high = confint_proportions_2indep(
        successes, runs, other_successes, other_runs, method="newcomb", compare="diff", alpha=ALPHA
    )
    table = [[successes, runs - successes], [other_successes, other_runs - other_successes]]
    effect = float(proportion_effectsize(successes / runs, other_successes / other_runs))
    error = math.sqrt(1 / runs + 1 / other_runs)
    return Comparison(
        difference=successes / runs - other_successes / other_runs,
        low=float(low),
        high=float(high),
        p_value=float(stats.fisher_exact(table).pvalue),
        effect=effect,
        p_equivalence=float(stats.norm.sf((MARGIN - abs(effect)) / error)),
    )


def compare_means(mean: float, sd: float, n: int, other_mean: float, other_sd: float, other_n: int) -> Comparison:
    """Two means: Welch's test and interval, Cohen's d. Standard deviations are of the population (ddof = 0).

    If a sample has fewer than two values, or neither varies, everything but the difference is not a number.

    Examples
    --------
    >>> comparison = compare_means(153, 137, 321, 145, 132, 322)
    >>> round(comparison.low, 1), round(comparison.high, 1), round(comparison.p_value, 2)
    (-12.9, 28.9, 0.45)
    """
    difference = mean - other_mean
    if min(n, other_n) < 2 or sd == other_sd == 0:
        return Comparison(difference, *[math.nan] * 5)
    variances = sd**2 / (n - 1), other_sd**2 / (other_n - 1)  # of the means
    error = math.sqrt(sum(variances))
    freedom = error**4 / (variances[0] ** 2 / (n - 1) + variances[1] ** 2 / (other_n - 1))  # Welch, Satterthwaite
    spread = math.sqrt((variances[0] * n + variances[1] * other_n) / 2)
    allowed = float(stats.t.isf(ALPHA / 2, freedom)) * error
    return Comparison(
        difference=difference,
        low=difference - allowed,
        high=difference + allowed,
        p_value=float(2 * stats.t.sf(abs(difference) / error, freedom)),
        effect=difference / spread,
        p_equivalence=float(stats.t.sf((MARGIN * spread - abs(difference)) / error, freedom)),
    )


def holm(p_values: pd.Series) -> pd.Series:
    """Values of p corrected for one another (Holm 1979); one that is not a number stays so, and does not count.

    Examples
    --------
    >>> holm(pd.Series([0.01, 0.04, float("nan"), 0.03])).tolist()
    [0.03, 0.06, nan, 0.06]
    """
    # statsmodels has this, too, but it collects garbage at each call, which may take half a second
    adjusted, values = p_values.copy(), p_values.to_numpy(float)
    order = np.argsort(values)[: p_values.count()]  # those that are not numbers come last
    adjusted.iloc[order] = np.maximum.accumulate(values[order] * np.arange(len(order), 0, -1)).clip(max=1)
    return adjusted


def runs_needed(rate: float, other_rate: float, power: float = 0.8) -> int:
    """How many runs of each are needed to detect the difference of two rates with this probability.

    Examples
    --------
    >>> runs_needed(0.5, 0.6)
    388
    """
    effect = proportion_effectsize(rate, other_rate)
    return math.ceil(NormalIndPower().solve_power(abs(effect), alpha=ALPHA, power=power))


def analysis_of_deviance(rates: pd.DataFrame, factors: Sequence[str]) -> pd.DataFrame:
    """How much each factor of a designed experiment matters for success, and each pair of factors together.

    A logistic model has an effect for every level of every factor. The deviance of a factor is what the model loses
    without it, and that of a pair what it gains with an effect for every combination of their levels: both are
    likelihood-ratio tests.

    Parameters
    ----------
    rates : DataFrame, one row for each cell
        With the columns successes, runs, and those of the factors.
    factors : sequence of str

    Returns
    -------
    pandas.DataFrame, indexed by factor, or "one x other"
        deviance; df, its degrees of freedom; p_value; span, of a factor: the largest less the smallest rate of success
        among its levels, other factors taken together.

    Examples
    --------
    >>> rates = pd.DataFrame({"k": [1, 1, 15, 15], "archive": ["none", "full"] * 2})
    >>> rates = rates.assign(successes=[10, 12, 20, 22], runs=30)
    >>> analysis_of_deviance(rates, ["k", "archive"]).round(3)["p_value"].tolist()
    [0.0, 0.437, 0.969]
    """
    main = [(factor,) for factor in factors]
    of_main = _likelihood(rates, main)
    rows = {}
    for factor in factors:
        counts = rates.groupby(factor)[["successes", "runs"]].sum()
        share = counts.successes / counts.runs
        without = _likelihood(rates, [term for term in main if term != (factor,)])
        rows[factor] = _ratio_test(without, of_main) | {"span": share.max() - share.min()}
    for pair in combinations(factors, 2):
        rows[" x ".join(pair)] = _ratio_test(of_main, _likelihood(rates, [*main, pair]))
    return pd.DataFrame.from_dict(rows, orient="index")


def _ratio_test(smaller: tuple[float, int], larger: tuple[float, int]) -> dict[str, float]:
    """What the larger of two models gains; of each the logarithm of its likelihood, and its free parameters."""
    deviance, df = 2 * (larger[0] - smaller[0]), larger[1] - smaller[1]
    return {"deviance": deviance, "df": df, "p_value": stats.chi2.sf(deviance, df)}


def _likelihood(rates: pd.DataFrame, terms: Sequence[tuple[str, ...]]) -> tuple[float, int]:
    """The logarithm of the largest likelihood of a logistic model, and the number of its free parameters.

    It is found by minimising, not by weighted least squares: if no run of a level succeeds, its effect has no limit,
    but the likelihood has.
    """
    columns = [np.ones((len(rates), 1))]
    for term in terms:
        level = rates.groupby(list(term)).ngroup().to_numpy()
        columns.append(np.eye(level.max() + 1)[level])
    design = np.hstack(columns)
    successes, runs = rates.successes.to_numpy(float), rates.runs.to_numpy(float)

    def loss(effects: np.ndarray) -> tuple[float, np.ndarray]:
        logits = design @ effects
        value = (runs * np.logaddexp(0, logits) - successes * logits).sum()
        return value, design.T @ (runs * special.expit(logits) - successes)

    found = optimize.minimize(loss, np.zeros(design.shape[1]), jac=True, method="L-BFGS-B", options={"maxiter": 5000})
    return -float(found.fun), int(np.linalg.matrix_rank(design))


@dataclass(frozen=True)
class PairedComparison:
    """A first algorithm against a second, by their rates of success on the same mazes."""

    difference: float  # the mean, over mazes, of the first rate less the second
    low: float  # the lower end of its 95 % interval
    high: float  # the upper end
    shift: float  # Hodges and Lehmann's estimate: the median of the means of all two differences
    shift_low: float
    shift_high: float
    p_value: float  # of Wilcoxon's signed-rank test
    better: int  # mazes on which the first rate is higher
    worse: int  # mazes on which it is lower; on all others the rates are equal


def compare_pairs(rates: ArrayLike, other_rates: ArrayLike) -> PairedComparison:
    """Two algorithms on the same mazes: Wilcoxon's signed-rank test of their rates, and by how much they differ.

    Mazes on which the rates are equal do not count in the test. Intervals are percentiles of the bootstrap over mazes.
    If the rates are equal on all mazes, p is 1.

    Parameters
    ----------
    rates, other_rates : arrays of float, shape (mazes,)
        Rates of success, maze by maze.

    Examples
    --------
    >>> found = compare_pairs([0.9, 0.5, 0.7, 0.2, 0.6, 1.0], [0.6, 0.4, 0.5, 0.2, 0.2, 0.5])
    >>> round(found.difference, 3), round(found.shift, 3), round(found.p_value, 4)
    (0.25, 0.25, 0.0625)
    >>> found.better, found.worse
    (5, 0)
    """
    # rounded, so that equal differences of rates, such as 0.3 - 0.2 and 0.2 - 0.1, are ties
    differences = (np.asarray(rates, dtype=float) - np.asarray(other_rates, dtype=float)).round(9)
    mean, low, high = mean_over_mazes(differences)
    draws = _draws(len(differences), RESAMPLES // 10)
    redrawn = np.repeat(np.tile(differences, len(draws)), draws.ravel()).reshape(draws.shape)
    shift_low, shift_high = _middle(_pseudomedian(redrawn))
    return PairedComparison(
        difference=float(mean),
        low=float(low),
        high=float(high),
        shift=float(_pseudomedian(differences)),
        shift_low=float(shift_low),
        shift_high=float(shift_high),
        p_value=float(stats.wilcoxon(differences).pvalue) if differences.any() else 1.0,
        better=int((differences > 0).sum()),
        worse=int((differences < 0).sum()),
    )


def _pseudomedian(values: np.ndarray) -> np.ndarray:
    """The median, along the last axis, of the means of all two values, each with itself included."""
    one, other = np.triu_indices(values.shape[-1])
    return np.median(values[..., one] + values[..., other], axis=-1) / 2


def mean_over_mazes(values: ArrayLike) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The mean over mazes and the ends of its 95 % interval, by the bootstrap over mazes.

    The same mazes are drawn in every call, so the intervals of two algorithms can be compared.

    Parameters
    ----------
    values : array of float, shape (mazes, ...)

    Returns
    -------
    mean, low, high : arrays of float, shape (...)

    Examples
    --------
    >>> [round(float(end), 2) for end in mean_over_mazes([0.0, 0.5, 1.0, 0.5])]
    [0.5, 0.12, 0.88]
    """
    values = np.asarray(values, dtype=float)
    low, high = _middle(np.tensordot(_draws(len(values), RESAMPLES) / len(values), values, axes=1))
    return values.mean(axis=0), low, high


@lru_cache(maxsize=8)
def _draws(n: int, samples: int) -> np.ndarray:
    """How many times each of n mazes is drawn, in samples of n with replacement; shape (samples, n)."""
    return np.random.default_rng(0).multinomial(n, np.full(n, 1 / n), samples)


def _middle(estimates: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """The ends of the middle 95 % of estimates."""
    low, high = np.quantile(estimates, [ALPHA / 2, 1 - ALPHA / 2], axis=0)
    return low, high


def success_curve(runs: pd.DataFrame, by: str = "generation") -> pd.DataFrame:
    """The share of runs that have succeeded, by generation: one minus the curve of Kaplan and Meier.

    Runs that did not succeed are censored: all that is known of them is that they had not by their last generation.

    Parameters
    ----------
    runs : DataFrame with columns success and generation
    by : {"generation", "evaluations"}
        The column that counts how long a run took.

    Returns
    -------
    pandas.DataFrame, one row for each generation in which a run succeeded
        generation, or evaluations; share, low and high: the estimate and the ends of its pointwise 95 % interval, which
        is symmetric in log(-log(1 - share)) and so stays between 0 and 1.
    """
    found = SurvfuncRight(runs[by], runs.success.astype(int))
    left, error = np.asarray(found.surv_prob), np.asarray(found.surv_prob_se)
    between = (left > 0) & (left < 1)  # if all runs succeeded, or none did, there is no estimate of the error
    exponent = np.zeros(len(left))
    exponent[between] = stats.norm.isf(ALPHA / 2) * error[between] / (left[between] * np.log(left[between]))
    curve = {by: found.surv_times, "share": 1 - left}
    curve |= {"low": 1 - left ** np.exp(exponent), "high": 1 - left ** np.exp(-exponent)}
    return pd.DataFrame(curve)[left < 1].reset_index(drop=True)


def mean_success_curve(runs: pd.DataFrame) -> pd.DataFrame:
    """The share of runs that have succeeded, by evaluations, in the mean over mazes, each of which counts once.

    Parameters
    ----------
    runs : DataFrame with columns maze, success and evaluations

    Returns
    -------
    pandas.DataFrame, one row for each number of evaluations after which a run succeeded
        evaluations; share, low and high: the mean and the ends of its pointwise 95 % interval, by the bootstrap over
        mazes.
    """
    times = np.unique(runs.evaluations[runs.success])
    curves = [success_curve(of_maze, "evaluations") for _, of_maze in runs.groupby("maze", sort=False)]
    shares = [np.append(0, curve.share)[np.searchsorted(curve.evaluations, times, "right")] for curve in curves]
    share, low, high = mean_over_mazes(shares)
    return pd.DataFrame({"evaluations": times, "share": share, "low": low, "high": high})


def compare_times(runs: pd.DataFrame, other: pd.DataFrame) -> tuple[float, float]:
    """Generations to success of two experiments: Vargha and Delaney's A12, and p of the log-rank test.

    A12 is the probability that a run of the first is quicker than a run of the second, ties counted half; a run that
    did not succeed is slower than all that did. Both are not a number if no run succeeded, or all in one generation.
    """
    both = pd.concat([runs, other])
    if not both.success.any() or (both.success.all() and both.generation.min() == both.generation.max()):
        return math.nan, math.nan
    samples = [sample.generation.where(sample.success, np.inf) for sample in (runs, other)]
    later = stats.mannwhitneyu(*samples).statistic / (len(runs) * len(other))
    which = np.repeat([0, 1], [len(runs), len(other)])
    _, p_value = survdiff(both.generation, both.success.astype(int), which)
    return 1 - float(later), float(p_value)
