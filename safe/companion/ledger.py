"""The ledger: every claim of the paper's results, the number behind it, ours, and a verdict.

There are three kinds of claims, and one rule for all of a kind leads from the runs to the verdict.

A number or a likeness ("328 of 500 runs", "as often as novelty search") is compared with ours:

- not reproduced, where a difference is detected;
- otherwise reproduced, where an effect as large as `statistics.MARGIN` is ruled out;
- otherwise no difference detectable at this size.

A direction ("more often than") is tested against no difference at all:

- reproduced, where a difference in this direction is detected;
- not reproduced, where one in the other direction is, or an effect as large as the margin is ruled out;
- otherwise no difference detectable at this size.

What no run of these experiments can decide is not testable here.

A difference is detected where p, corrected by Holm's method for all claims of its family, is below 0.05. An effect is
ruled out claim by claim, at the same level.

Successes or mean generations that differ from the paper's with p < 0.05 before any correction stand out, and their
experiment gets a second look, with as many further seeds as were decided on before. The number was chosen for its p, so
the p of the second look is multiplied by how many it was chosen from.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from functools import partial
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd
from scipy import stats

from safe.algorithms import COEFFICIENTS
from safe.experiments.experiment import WEIGHT_COLUMNS, Experiment, controller_of
from safe.maze import ways_to_goal
from safe.results.statistics import ALPHA, compare_rates, holm, success_interval
from safe.results.tables import evolved_table, generations_table, is_the_papers, success_table
from safe.robot import endpoints

REPRODUCED, NOT_REPRODUCED = "reproduced", "not reproduced"
UNDECIDED, UNTESTABLE = "no difference detectable at this size", "not testable here"
VERDICTS = (REPRODUCED, UNDECIDED, NOT_REPRODUCED, UNTESTABLE)

SUCCESSES, GENERATIONS, COMPARISONS, EVOLVED = "successes", "generations", "one against another", "evolved values"
SECOND_LOOK = "second look"

RECORD = Path(__file__).with_name("ledger.csv")

_NAMES = {
    "standard": "the standard algorithm",
    "novelty": "novelty search",
    "safe": "SAFE",
    "fixed": "fixed weights ½, ½",
    "random": "random search",
}
Results = Mapping[Experiment, pd.DataFrame]


@dataclass(frozen=True)
class Entry:
    """One claim, examined; all but the verdict, which depends on the family."""

    claim: str
    source: str  # where in the paper
    statement: str
    family: str
    paper: str  # the paper's number, or a dash
    here: str
    evidence: str  # the experiments and seeds behind it
    test: str
    direction: int = 0  # +1: claims that the first is larger; 0: claims a number or a likeness
    difference: float = np.nan
    low: float = np.nan
    high: float = np.nan
    p_value: float = np.nan
    effect: float = np.nan
    p_equivalence: float = np.nan


def ledger(results: Results, repeats: Results | None = None) -> pd.DataFrame:
    """Every claim that these runs bear on.

    Parameters
    ----------
    results : mapping of Experiment to DataFrame
        The runs of each experiment, one for each algorithm and maze. Those that are not the paper's bear on none of
        its claims.
    repeats : mapping of Experiment to DataFrame, optional
        Runs of further seeds of some of them: a second look at what stood out.

    Returns
    -------
    pandas.DataFrame, one row for each claim, indexed by a short name of it
        source, statement, family, paper, here, evidence, test, direction, difference, low, high (the 95 % interval of
        the difference), p_value, effect, p_equivalence, p_adjusted (Holm's, within the family), verdict.
    """
    results = {experiment: runs for experiment, runs in results.items() if is_the_papers(experiment)}
    entries = list(_untestable())
    if results:
        entries = [
            *_successes(results),
            *_generations(results),
            *_directions(results),
            *_likenesses(results),
            *_deceptions(results),
            *_weighings(results),
            *_evolved(results),
            *entries,
        ]
    table = pd.DataFrame(entries).set_index("claim")
    table["p_adjusted"] = table.groupby("family").p_value.transform(holm)
    table = pd.concat([table, _second_look(table, repeats or {})]).rename_axis("claim")
    table["verdict"] = [_verdict(row) for _, row in table.iterrows()]
    return table


def deviating_experiments(results: Results) -> list[Experiment]:
    """The experiments whose successes or mean generations differ from the paper's with p < 0.05, uncorrected.

    They deserve a second look, with further seeds.
    """
    tables = success_table(results), generations_table(results)
    found = {which for table in tables for which in table.index[table.p_value < ALPHA]}
    return [experiment for experiment in results if (experiment.maze.name, experiment.algorithm.name) in found]


def experiments_behind(table: pd.DataFrame, results: Results, repeats: Results | None = None) -> list[Results]:
    """For each claim of a ledger the experiments that its evidence names; results and repeats are those of `ledger`."""
    alone = [{experiment: runs} for experiment, runs in results.items() if is_the_papers(experiment)]
    named = {_told(parts): parts for parts in [*alone, *_pooled(repeats or {})]}
    return [
        {e: runs for text in evidence.split("; ") for e, runs in named.get(text, {}).items()}
        for evidence in table.evidence
    ]


def readable_ledger(table: pd.DataFrame) -> pd.DataFrame:
    """A ledger to read, a dash for what is not there; differences of rates are in percentage points."""
    words = pd.DataFrame(
        {
            "verdict": table.verdict,
            "in the paper": table.paper,
            "here": table.here,
            "difference (95 % interval)": [_difference(row) for _, row in table.iterrows()],
            "p (Holm)": [_p(value) for value in table.p_adjusted],
            "p (equivalence)": [_p(value) for value in table.p_equivalence],
            "experiments": table.evidence,
        }
    )
    return words.set_index(table.statement.rename("claim"))


def summary(table: pd.DataFrame) -> pd.DataFrame:
    """How many claims got which verdict, by family, the evolved values by maze; a second look is no further claim."""
    claims = table[table.family != SECOND_LOOK]
    maze = claims.index.str.split().str[0]
    groups = claims.family.where(claims.family != EVOLVED, claims.family + " on " + maze)
    counts = pd.crosstab(groups, claims.verdict)
    counts = counts.reindex(index=groups.unique(), columns=VERDICTS, fill_value=0)
    counts.loc["all"] = counts.sum()
    return counts.rename_axis(index="claims", columns=None)


def recorded() -> pd.DataFrame:
    """The ledger of 500 runs of each experiment, seed 0, as it was when it was last looked at by a person."""
    return pd.read_csv(RECORD, index_col="claim", keep_default_na=False, na_values=[""])


def changed(table: pd.DataFrame) -> list[str]:
    """What has become of recorded verdicts: a line for each claim with the recorded evidence and another verdict."""
    record = recorded().reindex(table.index)
    other = (table.evidence == record.evidence) & (table.verdict != record.verdict)
    return [f"{claim}: was {record.verdict[claim]!r}, is {table.verdict[claim]!r}" for claim in table.index[other]]


def _verdict(row: pd.Series) -> str:
    if row.family == UNTESTABLE:
        return UNTESTABLE
    detected, ruled_out = row.p_adjusted < ALPHA, row.p_equivalence < ALPHA
    if row.direction == 0:
        return NOT_REPRODUCED if detected else REPRODUCED if ruled_out else UNDECIDED
    if detected:
        return REPRODUCED if row.difference * row.direction > 0 else NOT_REPRODUCED
    return NOT_REPRODUCED if ruled_out else UNDECIDED


def _successes(results: Results) -> Iterator[Entry]:
    """The paper's counts of successes."""
    evidence = _evidence(results)
    for (maze, algorithm), row in success_table(results).iterrows():
        yield Entry(
            claim=f"{maze} {algorithm} successes",
            source="Table 2" if algorithm != "fixed" else "text",
            statement=f"{_capital(_NAMES[algorithm])} on {maze}",
            family=SUCCESSES,
            paper=f"{row.paper_successes:.0f} of {row.paper_runs:.0f}",
            here=f"{row.successes:.0f} of {row.runs:.0f}",
            evidence=evidence[maze, algorithm],
            test="Fisher, Newcombe",
            difference=row.difference,
            low=row.difference_low,
            high=row.difference_high,
            p_value=row.p_value,
            effect=row.effect,
            p_equivalence=row.p_equivalence,
        )


def _generations(results: Results) -> Iterator[Entry]:
    """The paper's mean generations to success."""
    table, evidence = generations_table(results), _evidence(results)
    for (maze, algorithm), row in table[table.paper_n.notna()].iterrows():
        yield _mean_entry(
            row,
            claim=f"{maze} {algorithm} generations",
            source="Table 2",
            statement=f"{_capital(_NAMES[algorithm])} on {maze}",
            family=GENERATIONS,
            evidence=evidence[maze, algorithm],
            digits=0,
        )


def _evolved(results: Results) -> Iterator[Entry]:
    """The paper's coefficients, and its Table 3."""
    safe_alone = {e: runs for e, runs in results.items() if e.algorithm.name == "safe"}
    if not safe_alone:
        return
    table, evidence = evolved_table(safe_alone, [*COEFFICIENTS, *WEIGHT_COLUMNS]), _evidence(results)
    for (maze, item, weighs), row in table.iterrows():
        yield _mean_entry(
            row,
            claim=f"{maze} {item}",
            source="text" if item in COEFFICIENTS else "Table 3",
            statement=f"{item} on {maze}, the weight of {weighs}",
            family=EVOLVED,
            evidence=evidence[maze, "safe"],
            digits=2,
        )


def _mean_entry(row: pd.Series, digits: int, **what: str) -> Entry:
    comparison = {name: row[name] for name in ("difference", "low", "high", "p_value", "effect", "p_equivalence")}
    return Entry(
        paper=f"{row.paper_mean:.{digits}f} ({row.paper_sd:.{digits}f}), n = {row.paper_n:.0f}",
        here=f"{row['mean']:.{digits}f} ({row.sd:.{digits}f}), n = {row.n:.0f}" if row.n else "no success",
        test="Welch",
        **what,
        **comparison,
    )


def _directions(results: Results) -> Iterator[Entry]:
    """Which of two experiments succeeds more often."""
    compare = partial(_pair, success_table(results), _evidence(results), direction=1, source="Table 2")
    more_often = product(("maze1", "maze2"), ("novelty", "safe"), ("standard", "random"))
    for maze, better, worse in [*more_often, ("maze1", "random", "standard")]:
        statement = f"{_capital(_NAMES[better])} succeeds more often than {_NAMES[worse]} on {maze}"
        yield from compare((maze, better), (maze, worse), statement)
    for name in ("novelty", "safe", "fixed"):
        yield from compare(("maze1", name), ("maze2", name), f"maze2 is harder than maze1 for {_NAMES[name]}")


def _likenesses(results: Results) -> Iterator[Entry]:
    """Which of two experiments succeed equally often, as far as can be told."""
    compare = partial(_pair, success_table(results), _evidence(results), direction=0)
    for maze, (other, source) in product(("maze1", "maze2"), (("novelty", "Table 2"), ("fixed", "text"))):
        statement = f"SAFE succeeds as often as {_NAMES[other]} on {maze}"
        yield from compare((maze, "safe"), (maze, other), statement, source=source)


def _pair(
    counts: pd.DataFrame,
    evidence: Mapping[tuple[str, str], str],
    first: tuple[str, str],
    second: tuple[str, str],
    statement: str,
    *,
    direction: int,
    source: str,
) -> Iterator[Entry]:
    """One of our experiments set against another, where both have been run; counts are of `success_table`."""
    if not (first in evidence and second in evidence):
        return
    pair = [counts.loc[first], counts.loc[second]]
    comparison = compare_rates(*(int(row[name]) for row in pair for name in ("successes", "runs")))
    yield Entry(
        claim=f"{' '.join(first)} {'>' if direction else '~'} {' '.join(second)}",
        source=source,
        statement=statement,
        family=COMPARISONS,
        paper=" against ".join(f"{row.paper_successes:.0f} of {row.paper_runs:.0f}" for row in pair),
        here=" against ".join(f"{row.successes:.0f} of {row.runs:.0f}" for row in pair),
        evidence=f"{evidence[first]}; {evidence[second]}",
        test="Fisher, Newcombe",
        direction=direction,
        **asdict(comparison),
    )


def _deceptions(results: Results) -> Iterator[Entry]:
    """The standard algorithm's best robots end near the goal, with nearly all of the way still before them."""
    evidence = _evidence(results)
    for experiment, runs in results.items():
        if experiment.algorithm.name == "standard":
            maze = experiment.maze
            ends = endpoints(maze, [controller_of(row) for _, row in runs.iterrows()], experiment.parameters.steps)
            ways = ways_to_goal(maze)
            is_nearer = maze.distance(ends) < maze.distance(maze.start) / 2
            is_before_its_way = ways[tuple(ends.T)] > 0.9 * ways[maze.start]
            yield _share_entry(
                int((is_nearer & is_before_its_way).sum()),
                len(runs),
                claim=f"{maze.name} deceived",
                source="Figure 2",
                statement=f"In most runs the standard algorithm is deceived on {maze.name}: its best robot ends less "
                "than half as far from the goal as it starts, with more than 90 % of the way still to go",
                evidence=evidence[maze.name, "standard"],
            )


def _weighings(results: Results) -> Iterator[Entry]:
    """The objective functions of successful runs weigh novelty more than closeness."""
    evidence = _evidence(results)
    for experiment, runs in results.items():
        successful = runs[runs.success]
        if experiment.algorithm.name == "safe" and len(successful):
            maze = experiment.maze.name
            yield _share_entry(
                int((successful.b > successful.a).sum()),
                len(successful),
                claim=f"{maze} b > a",
                source="text",
                statement=f"In most successful runs on {maze} the objective function weighs novelty more",
                evidence=evidence[maze, "safe"],
            )


def _share_entry(count: int, n: int, **what: str) -> Entry:
    """That something is so in more than half of the runs."""
    low, high = success_interval(count, n)
    return Entry(
        family=COMPARISONS,
        paper="–",
        here=f"{count} of {n}",
        test="binomial, Wilson",
        direction=1,
        difference=count / n - 0.5,
        low=low - 0.5,
        high=high - 0.5,
        p_value=float(stats.binomtest(count, n).pvalue),
        **what,
    )


def _untestable() -> Iterator[Entry]:
    for claim, source, statement in (
        (
            "times",
            "Table 2",
            "How generations to success are distributed: only means and standard deviations are given",
        ),
        (
            "needed",
            "abstract",
            "That SAFE evolves the objective functions that are needed: what would show the contrary is not told",
        ),
        ("elsewhere", "abstract", "That a good objective function can be found by evolution in other problems as well"),
    ):
        yield Entry(claim, source, statement, UNTESTABLE, paper="–", here="–", evidence="–", test="–")


def _second_look(table: pd.DataFrame, repeats: Results) -> pd.DataFrame:
    """Rows for the numbers that stood out, from further seeds taken together."""
    rows = {}
    for parts in _pooled(repeats):
        together = {next(iter(parts)): pd.concat(parts.values(), ignore_index=True)}
        for entry in [*_successes(together), *_generations(together)]:
            if table.p_value[entry.claim] < ALPHA:
                chosen_from = int((table.family == entry.family).sum())
                again = replace(entry, family=SECOND_LOOK, evidence=_told(parts))
                rows[f"{entry.claim}, second look"] = vars(again) | {
                    "p_adjusted": min(1.0, entry.p_value * chosen_from)
                }
    return pd.DataFrame.from_dict(rows, orient="index", columns=table.columns)


def _pooled(repeats: Results) -> list[Results]:
    """Those that differ in their seeds alone, taken together."""
    pooled: dict[tuple[str, str], dict[Experiment, pd.DataFrame]] = {}
    for experiment, runs in repeats.items():
        pooled.setdefault((experiment.maze.name, experiment.algorithm.name), {})[experiment] = runs
    return list(pooled.values())


def _evidence(results: Results) -> dict[tuple[str, str], str]:
    """What stands behind a number of an experiment, by the names of maze and algorithm."""
    return {(e.maze.name, e.algorithm.name): _told({e: runs}) for e, runs in results.items()}


def _told(parts: Results) -> str:
    """Experiments that differ in their seeds alone, as evidence."""
    first = next(iter(parts))
    runs, seeds = sum(map(len, parts.values())), ", ".join(str(experiment.seed) for experiment in parts)
    return f"{first.algorithm.name} on {first.maze.name}: {runs} runs, seed {seeds}"


def _capital(text: str) -> str:
    return text[0].upper() + text[1:]


def _difference(row: pd.Series) -> str:
    """With its interval; of rates in percentage points."""
    values = row[["difference", "low", "high"]].to_numpy(dtype=float)
    if np.isnan(values).any():
        return "–"
    if row.test == "Welch":
        form = "{:+.3f}" if row.family == EVOLVED else "{:+.0f}"
        return f"{form} ({form} to {form})".format(*values)
    return "{} ({} to {})".format(*(f"{v:+.1f}" if round(v, 1) or not v else f"{v:+.2f}" for v in 100 * values))


def _p(value: float) -> str:
    return "–" if np.isnan(value) else "< 0.001" if value < 0.001 else f"{value:.3f}" if value < 0.1 else f"{value:.2f}"
