"""Two algorithms compared on many mazes by a mixed model: how much better is one, on mazes like these?

In maze m, the log odds of success are

    first algorithm     a + u_m + (b + v_m) / 2
    second algorithm    a + u_m - (b + v_m) / 2

where b is the effect on a typical maze; (u_m, v_m), how much this maze is easier than others and favours the first, is
drawn from a normal distribution with any standard deviations and correlation. All five parameters are those of the
largest likelihood. Its integral over u and v, for each maze, is found by adaptive Gauss-Hermite quadrature.

statsmodels has Bayesian mixed models of binary outcomes, by approximations of the posterior of all effects of all mazes
at once. For this purpose their standard deviations are too small, and on thousands of runs they take minutes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import optimize, special, stats


@dataclass(frozen=True)
class MixedModel:
    """A first algorithm against a second on a typical maze, in log odds of success, and how mazes differ."""

    effect: float  # log odds of the first less those of the second: the logarithm of their odds ratio
    error: float  # its standard error
    z: float  # the effect in standard errors
    p_value: float  # of no effect, by Wald's test
    sd_mazes: float  # standard deviation, over mazes, of the log odds, midway between the algorithms
    sd_effect: float  # standard deviation, over mazes, of the effect


def mixed_model(successes: ArrayLike, runs: ArrayLike, other_successes: ArrayLike, other_runs: ArrayLike) -> MixedModel:
    """Two algorithms on the same mazes, by a logistic model with random intercepts and effects of mazes.

    If an algorithm never or always succeeds, on all mazes, no finite effect is the likeliest, and all fields are not a
    number. With few runs on each maze the spreads cannot always be told; then error, z and p are not numbers.

    Parameters
    ----------
    successes, runs : arrays of int, shape (mazes,)
        Of the first algorithm; a single number of runs is that of all mazes.
    other_successes, other_runs : arrays of int, shape (mazes,)
        Of the second.

    Examples
    --------
    >>> found = mixed_model([9, 5, 7, 2, 6, 8], 10, [6, 4, 5, 2, 2, 5], 10)
    >>> round(found.effect, 2), round(found.error, 2), round(found.p_value, 3)
    (0.98, 0.43, 0.023)
    """
    pairs = np.column_stack([successes, other_successes]).astype(float)
    trials = np.column_stack([np.broadcast_to(n, len(pairs)) for n in (runs, other_runs)]).astype(float)
    rates = pairs.sum(axis=0) / trials.sum(axis=0)
    if (rates == 0).any() or (rates == 1).any():
        return MixedModel(*[math.nan] * 6)
    logits = special.logit((pairs + 0.5) / (trials + 1)) @ np.linalg.inv(_CODING).T
    start = [*logits.mean(axis=0), logits[:, 0].std() + 0.1, 0.0, logits[:, 1].std() + 0.1]

    modes = np.zeros_like(pairs)

    def loss(parameters: np.ndarray) -> tuple[float, np.ndarray]:
        value, gradient = _marginal_likelihood(parameters, pairs, trials, modes)
        return -value / len(pairs), -gradient / len(pairs)

    found = optimize.minimize(loss, start, jac=True, method="BFGS", options={"gtol": 1e-6}).x
    curvature = len(pairs) * optimize.approx_fprime(found, lambda parameters: loss(parameters)[1], 1e-5)
    variance = np.linalg.pinv((curvature + curvature.T) / 2)[1, 1]
    error = math.sqrt(variance) if variance > 0 else math.nan  # with one run on each maze, spreads cannot be told
    effect, spread = float(found[1]), math.hypot(found[3], found[4])
    z = effect / error
    return MixedModel(effect, error, z, float(2 * stats.norm.sf(abs(z))), abs(float(found[2])), spread)


_CODING = np.array([[1, 0.5], [1, -0.5]])  # from intercept and effect to the log odds of both algorithms
_NODES, _WEIGHTS = np.polynomial.hermite.hermgauss(9)


def _marginal_likelihood(
    parameters: np.ndarray, successes: np.ndarray, runs: np.ndarray, modes: np.ndarray
) -> tuple[float, np.ndarray]:
    """The logarithm of the likelihood of a mixed model, and its gradient.

    The effects of a maze are (a, b) + L z, with L lower triangular and z standard normal, so any five numbers
    a, b, L_11, L_21, L_22 are parameters. The integral over z is a sum over nodes around its likeliest value.
    The search for this value starts from `modes`, and replaces them, since parameters change little between calls.
    """
    centre, root = parameters[:2], np.array([[parameters[2], 0], parameters[3:]])
    turn = _CODING @ root

    def scores(z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The log likelihood of successes and z, and successes less those expected; z has the shape (..., 2)."""
        logits = (_CODING @ centre) + z @ turn.T
        # numpy's logaddexp takes ten times as long
        log_failure = -np.maximum(logits, 0) - np.log1p(np.exp(-np.abs(logits)))
        value = successes * logits + runs * log_failure - z**2 / 2
        return value.sum(axis=-1), successes - runs * special.expit(logits)

    mode = modes.copy()
    value, residual = scores(mode)
    for _ in range(100):  # Newton's steps, each halved until it leads upwards
        slope = residual @ turn - mode
        variance = (successes - residual) * (1 - (successes - residual) / runs)  # of binomial counts
        curvature = np.eye(2) + np.einsum("ca,mc,cb->mab", turn, variance, turn)
        step = np.linalg.solve(curvature, slope[..., np.newaxis])[..., 0]
        if np.abs(step).max() < 1e-9:
            break
        for _ in range(30):
            later, later_residual = scores(mode + step)
            falls = later < value - 1e-12
            if not falls.any():
                break
            step[falls] /= 2
        mode, value, residual = mode + step, later, later_residual
    modes[:] = mode
    scale = np.linalg.inv(np.linalg.cholesky(curvature))  # z = mode + sqrt(2) * scale' t
    nodes = np.stack(np.meshgrid(_NODES, _NODES), axis=-1).reshape(-1, 2)
    log_weights = np.log(np.outer(_WEIGHTS, _WEIGHTS)).ravel() + (nodes**2).sum(axis=1)
    z = mode + math.sqrt(2) * (nodes @ scale).swapaxes(0, 1)
    value, residual = scores(z)
    value += log_weights[:, np.newaxis]
    largest = value.max(axis=0)
    total = largest + np.log(np.exp(value - largest).sum(axis=0))
    share = np.exp(value - total)[..., np.newaxis]  # of each node in the posterior
    slope = residual @ _CODING
    of_root = (share * slope).reshape(-1, 2).T @ z.reshape(-1, 2)
    log_integral = total + np.log(np.diagonal(scale, axis1=1, axis2=2)).sum(axis=1) - math.log(math.pi)
    gradient = np.array([*(share * slope).sum(axis=(0, 1)), of_root[0, 0], of_root[1, 0], of_root[1, 1]])
    return float(log_integral.sum()), gradient
