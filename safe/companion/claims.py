"""The claims of the paper's results, each with the paper's number, ours, and the test that compares them.

Every function here takes the runs of the paper's experiments, one experiment for each algorithm and maze.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from itertools import product

import numpy as np
import pandas as pd
from scipy import stats

from safe.algorithms import COEFFICIENTS
from safe.companion.paper import MAZES, reported
from safe.companion.verdicts import UNTESTABLE
from safe.experiments.experiment import WEIGHT_COLUMNS, Experiment
from safe.maze import SENSORS, ways_to_goal
from safe.results import formats
from safe.results.statistics import MARGIN, compare_means, compare_rates, success_interval
from safe.results.tables import (
    COMPARED,
    Results,
    evolved_table,
    generations_table,
    pairs,
    success_table,
    with_generations,
)
from safe.robot import endpoints

SUCCESSES, GENERATIONS, COMPARISONS, EVOLVED = "successes", "generations", "one against another", "evolved values"
READINGS = "read from the tables"

_NAMES = {
    "standard": "the standard algorithm",
    "novelty": "novelty search",
    "safe": "SAFE",
    "fixed": "fixed coefficients ½, ½",
    "random": "random search",
}
# What the paper reads from its Table 3: on which maze, in which sums, the weights of which directions are larger than
# those of which others.
_READ_FROM_WEIGHTS = (
    ("maze1", "h", "right down up", "left", "h weighs the left sensors less than the others"),
    ("maze1", "h", "right", "left down up", "h weighs the right sensors more than the others"),
    ("maze1", "v", "right", "left down up", "v weighs the right sensors more than the others"),
    ("maze2", "hv", "left", "right down up", "h and v weigh the left sensors more than the others"),
    ("maze2", "hv", "down", "right up", "h and v weigh the down sensors more than the right and up ones"),
    ("maze2", "hv", "left", "down", "h and v weigh the down sensors less than the left ones"),
)


@dataclass(frozen=True)
class Claim:
    """A claim with all that leads to its verdict, except the other claims of its family."""

    claim: str  # a short name
    source: str  # where in the paper
    statement: str
    family: str
    paper: str  # the paper's number, or a dash
    here: str
    evidence: str  # the experiments and seeds behind it
    test: str
    direction: int = 0  # +1 or -1: claims that the first is larger, or smaller; 0: claims a number or a likeness
    difference: float = np.nan
    low: float = np.nan
    high: float = np.nan
    p_value: float = np.nan
    effect: float = np.nan
    p_equivalence: float = np.nan


def all_claims(results: Results) -> Iterator[Claim]:
    """Every claim that these runs bear on, and those that no run can decide."""
    yield from successes(results)
    yield from generations(results)
    yield from _directions(results)
    yield from _likenesses(results)
    yield from _deceptions(results)
    yield from _weighings(results)
    yield from _readings(results)
    yield from _evolved(results)
    yield from _untestable()


def evidence(parts: Results) -> str:
    """Experiments that differ in their seeds alone, in words."""
    first = next(iter(parts))
    runs, seeds = sum(map(len, parts.values())), ", ".join(str(experiment.seed) for experiment in parts)
    return f"{first.algorithm.name} on {first.maze.name}: {runs} runs, seed {seeds}"


def successes(results: Results) -> Iterator[Claim]:
    """The paper's counts of successes."""
    rows = success_table(results, reported).iterrows()
    for (experiment, runs), (_, row) in zip(results.items(), rows, strict=True):
        maze, algorithm = experiment.maze.name, experiment.algorithm.name
        yield Claim(
            claim=f"{maze} {algorithm} successes",
            source="Table 2" if algorithm != "fixed" else "text",
            statement=f"{_capital(_NAMES[algorithm])} on {maze}",
            family=SUCCESSES,
            paper=formats.count(row.paper_successes, row.paper_runs),
            here=formats.count(row.successes, row.runs),
            evidence=evidence({experiment: runs}),
            test="Fisher, Newcombe",
            difference=row.difference,
            low=row.difference_low,
            high=row.difference_high,
            p_value=row.p_value,
            effect=row.effect,
            p_equivalence=row.p_equivalence,
        )


def generations(results: Results) -> Iterator[Claim]:
    """The paper's mean generations to success."""
    timed = with_generations(results)
    rows = generations_table(timed, reported).iterrows()
    for (experiment, runs), (_, row) in zip(timed.items(), rows, strict=True):
        if not np.isnan(row.paper_n):
            maze, algorithm = experiment.maze.name, experiment.algorithm.name
            yield _mean_claim(
                row,
                claim=f"{maze} {algorithm} generations",
                source="Table 2",
                statement=f"{_capital(_NAMES[algorithm])} on {maze}",
                family=GENERATIONS,
                evidence=evidence({experiment: runs}),
                digits=0,
            )


def _evolved(results: Results) -> Iterator[Claim]:
    """The paper's coefficients, and its Table 3."""
    items = [*COEFFICIENTS, *WEIGHT_COLUMNS]
    for experiment, runs in _of_algorithm("safe", results):
        maze = experiment.maze.name
        for (_, item, weighs), row in evolved_table({experiment: runs}, items, reported).iterrows():
            yield _mean_claim(
                row,
                claim=f"{maze} {item}",
                source="text" if item in COEFFICIENTS else "Table 3",
                statement=f"{item} on {maze}, the {'coefficient' if item in COEFFICIENTS else 'weight'} of {weighs}",
                family=EVOLVED,
                evidence=evidence({experiment: runs}),
                digits=2,
            )


def _mean_claim(row: pd.Series, digits: int, **what: str) -> Claim:
    return Claim(
        paper=_mean(row.paper_mean, row.paper_sd, row.paper_n, digits),
        here=_mean(row["mean"], row.sd, row.n, digits),
        test="Welch",
        **what,
        **row[COMPARED],
    )


def _mean(mean: float, sd: float, n: float, digits: int) -> str:
    return f"{formats.mean_and_sd(mean, sd, digits)}, n = {n:.0f}" if n else "no success"


def _directions(results: Results) -> Iterator[Claim]:
    """Which of two experiments succeeds more often."""
    more_often = product(MAZES, ("novelty", "safe"), ("standard", "random"))
    for maze, better, worse in [*more_often, ("maze1", "random", "standard")]:
        statement = f"{_capital(_NAMES[better])} succeeds more often than {_NAMES[worse]} on {maze}"
        yield from _pair(results, (maze, better), (maze, worse), statement, direction=1)
    for name in ("novelty", "safe", "fixed"):
        statement = f"maze2 is harder than maze1 for {_NAMES[name]}"
        yield from _pair(results, ("maze1", name), ("maze2", name), statement, direction=1)


def _likenesses(results: Results) -> Iterator[Claim]:
    """Which of two experiments succeed equally often, as far as can be decided."""
    for maze, (other, source) in product(MAZES, (("novelty", "Table 2"), ("fixed", "text"))):
        statement = f"SAFE succeeds as often as {_NAMES[other]} on {maze}"
        yield from _pair(results, (maze, "safe"), (maze, other), statement, source=source)


def _pair(
    results: Results,
    first: tuple[str, str],
    second: tuple[str, str],
    statement: str,
    *,
    direction: int = 0,
    source: str = "Table 2",
    family: str = COMPARISONS,
) -> Iterator[Claim]:
    """One of our experiments set against another, each given by maze and algorithm, if both have been run."""
    of = {(experiment.maze.name, experiment.algorithm.name): experiment for experiment in results}
    if not (first in of and second in of):
        return
    both = [of[first], of[second]]
    counts = [(int(results[experiment].success.sum()), len(results[experiment])) for experiment in both]
    papers = [reported(experiment).loc["successes"] for experiment in both]
    yield Claim(
        claim=f"{' '.join(first)} {'>' if direction else '~'} {' '.join(second)}",
        source=source,
        statement=statement,
        family=family,
        paper=" against ".join(formats.count(paper["mean"], paper["n"]) for paper in papers),
        here=" against ".join(formats.count(*counted) for counted in counts),
        evidence="; ".join(evidence({experiment: results[experiment]}) for experiment in both),
        test="Fisher, Newcombe",
        direction=direction,
        **asdict(compare_rates(*counts[0], *counts[1])),
    )


def _deceptions(results: Results) -> Iterator[Claim]:
    """The standard algorithm's best robots end near the goal, with nearly all of the way still before them."""
    for experiment, runs in _of_algorithm("standard", results):
        maze = experiment.maze
        ends = endpoints(maze, runs[WEIGHT_COLUMNS].to_numpy(float), experiment.parameters.steps)
        ways = ways_to_goal(maze)
        is_nearer = maze.distance(ends) < maze.distance(maze.start) / 2
        is_before_its_way = ways[tuple(ends.T)] > 0.9 * ways[maze.start]
        yield _share_claim(
            int((is_nearer & is_before_its_way).sum()),
            len(runs),
            claim=f"{maze.name} deceived",
            source="Figure 2",
            family=COMPARISONS,
            statement=f"In most runs the standard algorithm is deceived on {maze.name}: its best robot ends less "
            "than half as far from the goal as it starts, with more than 90 % of the way still to go",
            evidence=evidence({experiment: runs}),
        )


def _weighings(results: Results) -> Iterator[Claim]:
    """The objective functions of successful runs weigh novelty more than closeness."""
    for experiment, runs in _of_algorithm("safe", results):
        successful = runs[runs.success]
        if len(successful):
            maze = experiment.maze.name
            yield _share_claim(
                int((successful.b > successful.a).sum()),
                len(successful),
                claim=f"{maze} b > a",
                source="text",
                statement=f"In most successful runs on {maze} the objective function weighs novelty more",
                family=COMPARISONS,
                evidence=evidence({experiment: runs}),
            )


def _share_claim(count: int, n: int, **what: str) -> Claim:
    """A claim that something is so in more than half of the runs."""
    low, high = success_interval(count, n)
    return Claim(
        paper=formats.DASH,
        here=formats.count(count, n),
        test="binomial, Wilson",
        direction=1,
        difference=count / n - 0.5,
        low=low - 0.5,
        high=high - 0.5,
        p_value=float(stats.binomtest(count, n).pvalue),
        **what,
    )


def _readings(results: Results) -> Iterator[Claim]:
    """What the paper's text reads from its tables."""
    both = ("maze2", "safe"), ("maze2", "novelty")
    statement = "SAFE succeeds slightly more often than novelty search on maze2"
    yield from _pair(results, *both, statement, direction=1, source="text", family=READINGS)
    for maze in MAZES:
        statement = f"Fixed coefficients ½, ½ succeed as often as novelty search on {maze}"
        yield from _pair(results, (maze, "fixed"), (maze, "novelty"), statement, source="text", family=READINGS)
    yield from _faster(results)
    yield from _always_stuck(results)
    yield from _weights_read(results)


def _faster(results: Results) -> Iterator[Claim]:
    """SAFE needs slightly fewer generations than novelty search."""
    for both in pairs(results, [("safe", "novelty")]):
        maze = both[0].maze.name
        rows = [row for _, row in generations_table({e: results[e] for e in both}, reported).iterrows()]
        ours = [value for row in rows for value in (row["mean"], row.sd, int(row.n))]
        yield Claim(
            claim=f"{maze} safe < {maze} novelty, generations",
            source="text",
            statement=f"SAFE needs slightly fewer generations than novelty search on {maze} (a difference that the "
            "paper does not call significant)",
            family=READINGS,
            paper=" against ".join(_mean(row.paper_mean, row.paper_sd, row.paper_n, 0) for row in rows),
            here=" against ".join(_mean(row["mean"], row.sd, row.n, 0) for row in rows),
            evidence="; ".join(evidence({experiment: results[experiment]}) for experiment in both),
            test="Welch",
            direction=-1,
            **asdict(compare_means(*ours)),
        )


def _always_stuck(results: Results) -> Iterator[Claim]:
    """No run of the standard algorithm reaches the goal: a share of 1, which a single other run contradicts."""
    for experiment, runs in _of_algorithm("standard", results):
        paper = reported(experiment).loc["successes"]
        stuck, n = int((~runs.success).sum()), len(runs)
        low, high = success_interval(stuck, n)
        beside = np.cos(MARGIN / 2) ** 2  # the share that is an effect of MARGIN below 1
        yield Claim(
            claim=f"{experiment.maze.name} always stuck",
            source="text",
            statement=f"The standard algorithm always gets stuck on {experiment.maze.name}: no run reaches the goal",
            family=READINGS,
            paper=formats.count(paper["n"] - paper["mean"], paper["n"]),
            here=formats.count(stuck, n),
            evidence=evidence({experiment: runs}),
            test="binomial, Wilson",
            difference=stuck / n - 1,
            low=low - 1,
            high=high - 1,
            p_value=float(stats.binomtest(stuck, n, 1).pvalue),
            effect=float(2 * np.arcsin(np.sqrt(stuck / n)) - np.pi),  # Cohen's h
            p_equivalence=float(stats.binomtest(stuck, n, beside, "greater").pvalue),
        )


def _weights_read(results: Results) -> Iterator[Claim]:
    """The absolute weights of some sensors are larger than those of others, on average over the sensors."""
    for experiment, runs in _of_algorithm("safe", results):
        successful = runs[runs.success]
        for maze, sums, larger, smaller, statement in _READ_FROM_WEIGHTS:
            if maze == experiment.maze.name and len(successful):
                sizes = [_size(successful, sums, directions.split()) for directions in (larger, smaller)]
                yield _share_claim(
                    int((sizes[0] > sizes[1]).sum()),
                    len(successful),
                    claim=f"{maze} {sums}: {larger} > {smaller}",
                    source="Table 3",
                    statement=f"In most successful runs on {maze} {statement}, in absolute value",
                    family=READINGS,
                    evidence=evidence({experiment: runs}),
                )


def _size(runs: pd.DataFrame, sums: str, directions: list[str]) -> pd.Series:
    """The mean absolute weight, run by run, that these sums give to the sensors of these directions."""
    weighed = zip(product("hv", SENSORS), WEIGHT_COLUMNS, strict=True)
    columns = [column for (total, sensor), column in weighed if total in sums and sensor.split("_")[1] in directions]
    return runs[columns].abs().mean(axis=1)


def _untestable() -> Iterator[Claim]:
    for claim, source, statement in (
        (
            "times",
            "Table 2",
            "How generations to success are distributed: only means and standard deviations are given",
        ),
        (
            "needed",
            "abstract",
            "That SAFE evolves the objective functions that are needed: no result is named that would contradict it",
        ),
        (
            "balance",
            "text",
            "That evolution strikes a fairly even balance between a and b: they multiply quantities in different "
            "units, so their sizes say nothing of a balance",
        ),
        ("harder", "text", "That SAFE's task is more difficult than that of fixed coefficients: no measure is given"),
        ("elsewhere", "abstract", "That a good objective function can be found by evolution in other problems as well"),
    ):
        yield Claim(claim, source, statement, UNTESTABLE, *[formats.DASH] * 4)


def _of_algorithm(name: str, results: Results) -> Iterator[tuple[Experiment, pd.DataFrame]]:
    return ((experiment, runs) for experiment, runs in results.items() if experiment.algorithm.name == name)


def _capital(text: str) -> str:
    return text[0].upper() + text[1:]
