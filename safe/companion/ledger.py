"""The ledger: every claim of the paper's results, the number behind it, ours, and a verdict.

`verdicts` holds the rules, `claims` the claims; here they are put together, written out, and compared with the record.

If successes or mean generations differ from the paper's with p < 0.05 before any correction, their experiment gets a
second look, with a number of further seeds that was fixed in advance. The number was chosen for its p, so the p of the
second look is multiplied by how many it was chosen from.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path

import pandas as pd

from safe.companion import claims
from safe.companion.claims import EVOLVED
from safe.companion.paper import is_the_papers, reported
from safe.companion.verdicts import VERDICTS, verdict
from safe.experiments.experiment import Experiment
from safe.results import formats
from safe.results.statistics import ALPHA, holm
from safe.results.tables import Results, generations_table, success_table, with_generations

SECOND_LOOK = "second look"
RECORD = Path(__file__).with_name("ledger.csv")


def ledger(results: Results, repeats: Results | None = None) -> pd.DataFrame:
    """Every claim that these runs bear on.

    Parameters
    ----------
    results : mapping of Experiment to DataFrame
        The runs of each experiment, one for each algorithm and maze. Those that are not the paper's do not count.
    repeats : mapping of Experiment to DataFrame, optional
        Runs with further seeds of some of these experiments: a second look at numbers that deviate.

    Returns
    -------
    pandas.DataFrame, one row for each claim, indexed by a short name of it
        source, statement, family, paper, here, evidence, test, direction, difference, low, high (the 95 % interval of
        the difference), p_value, effect, p_equivalence, p_adjusted (Holm's, within the family), verdict.

    Raises
    ------
    ValueError
        If results hold two experiments of the paper with the same algorithm and maze.
    """
    table = pd.DataFrame(claims.all_claims(_the_papers(results))).set_index("claim")
    table["p_adjusted"] = table.groupby("family").p_value.transform(holm)
    table = pd.concat([table, _second_look(table, repeats or {})]).rename_axis("claim")
    table["verdict"] = [verdict(row) for _, row in table.iterrows()]
    return table


def deviating_experiments(results: Results) -> list[Experiment]:
    """The experiments whose successes or mean generations differ from the paper's with p < 0.05, uncorrected.

    They deserve a second look, with further seeds.
    """
    timed = with_generations(results)
    p_values = [
        *zip(results, success_table(results, reported).p_value, strict=True),
        *zip(timed, generations_table(timed, reported).p_value, strict=True),
    ]
    deviating = {experiment for experiment, p_value in p_values if p_value < ALPHA}
    return [experiment for experiment in results if experiment in deviating]


def experiments_behind(table: pd.DataFrame, results: Results, repeats: Results | None = None) -> list[Results]:
    """For each claim of a ledger the experiments that its evidence names; results and repeats are those of `ledger`."""
    alone = [{experiment: runs} for experiment, runs in _the_papers(results).items()]
    named = {claims.evidence(parts): parts for parts in [*alone, *_pooled(repeats or {})]}
    return [
        {e: runs for text in evidence.split("; ") for e, runs in named.get(text, {}).items()}
        for evidence in table.evidence
    ]


def readable_ledger(table: pd.DataFrame) -> pd.DataFrame:
    """A ledger to read, a dash if there is no number; differences of rates are in percentage points."""
    words = pd.DataFrame(
        {
            "verdict": table.verdict,
            "in the paper": table.paper,
            "here": table.here,
            "difference (95 % interval)": [_difference(row) for _, row in table.iterrows()],
            "p (Holm)": table.p_adjusted.map(formats.p_value),
            "p (equivalence)": table.p_equivalence.map(formats.p_value),
            "experiments": table.evidence,
        }
    )
    return words.set_index(table.statement.rename("claim"))


def summary(table: pd.DataFrame) -> pd.DataFrame:
    """How many claims got which verdict, by family, the evolved values by maze; a second look is no further claim."""
    counted = table[table.family != SECOND_LOOK]
    maze = counted.index.str.split().str[0]
    groups = counted.family.where(counted.family != EVOLVED, counted.family + " on " + maze)
    counts = pd.crosstab(groups, counted.verdict)
    counts = counts.reindex(index=groups.unique(), columns=VERDICTS, fill_value=0)
    counts.loc["all"] = counts.sum()
    return counts.rename_axis(index="claims", columns=None)


def recorded(record: Path | None = None) -> pd.DataFrame:
    """A ledger as a person last examined and recorded it: of 500 runs of each of the paper's experiments, seed 0."""
    return pd.read_csv(record or RECORD, index_col="claim", keep_default_na=False, na_values=[""])


def changed(table: pd.DataFrame, record: Path | None = None) -> list[str]:
    """A line for each claim with the recorded evidence and another verdict."""
    record = recorded(record).reindex(table.index)
    other = (table.evidence == record.evidence) & (table.verdict != record.verdict)
    return [f"{claim}: was {record.verdict[claim]!r}, is {table.verdict[claim]!r}" for claim in table.index[other]]


def _the_papers(results: Results) -> Results:
    """Those of the results that bear on claims: the paper's experiments, one for each algorithm and maze."""
    found = {experiment: runs for experiment, runs in results.items() if is_the_papers(experiment)}
    for (algorithm, maze), number in Counter((e.algorithm.name, e.maze.name) for e in found).items():
        if number > 1:
            raise ValueError(
                f"results must have one experiment for each algorithm and maze; got {number} of {algorithm} on {maze}"
            )
    return found


def _second_look(table: pd.DataFrame, repeats: Results) -> pd.DataFrame:
    """Rows for the numbers that deviate, from further seeds taken together."""
    rows = {}
    for parts in _pooled(repeats):
        together = {next(iter(parts)): pd.concat(parts.values(), ignore_index=True)}
        for claim in [*claims.successes(together), *claims.generations(together)]:
            if table.p_value[claim.claim] < ALPHA:
                chosen_from = int((table.family == claim.family).sum())
                again = replace(claim, family=SECOND_LOOK, evidence=claims.evidence(parts))
                rows[f"{claim.claim}, second look"] = vars(again) | {
                    "p_adjusted": min(1.0, claim.p_value * chosen_from)
                }
    return pd.DataFrame.from_dict(rows, orient="index", columns=table.columns)


def _pooled(repeats: Results) -> list[Results]:
    """Experiments that differ in their seeds alone, taken together."""
    pooled: dict[tuple[str, str], dict[Experiment, pd.DataFrame]] = {}
    for experiment, runs in repeats.items():
        if is_the_papers(experiment):
            pooled.setdefault((experiment.maze.name, experiment.algorithm.name), {})[experiment] = runs
    return list(pooled.values())


def _difference(row: pd.Series) -> str:
    """With its interval; of rates in percentage points."""
    values = row[["difference", "low", "high"]]
    if row.test == "Welch":
        return formats.difference_of_means(*values, digits=2 if row.family == EVOLVED else 0)
    return formats.difference_of_rates(*values)
