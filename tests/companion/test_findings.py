import math
from dataclasses import fields

import numpy as np
import pandas as pd
import pytest

import safe
from safe.companion import designs, evidence, findings, ledger
from safe.companion.claims import Claim
from safe.companion.designs import DECIDING, EXPLORING, RUNS, Design
from safe.companion.findings import UNDECIDED
from safe.companion.paper import MAZES
from safe.companion.questions import LONG
from safe.maze_files import load_mazes
from safe.results.statistics import success_interval
from tests.helpers import record
from tests.helpers.results import runs

N = 200  # made-up runs of a cell
PACKAGED = load_mazes(list(MAZES))
OTHER = safe.Maze.from_drawing("S.G", "mine")


def made_up(make_design, mazes, successes, n=N, seed=DECIDING):
    """A design, and runs of its cells, of which so many succeed, by levels without the maze; otherwise a quarter."""
    design = make_design(mazes, n, seed)
    return design, {e: runs(successes.get(key[1:], n // 4), n, evaluations=1000) for key, e in design.cells.items()}


def small_design():
    """Two cells on each of two mazes, and four runs of each."""
    cells, results = {}, {}
    for maze, places, successes in (("maze1", 0, 3), ("maze1", 10, 0), ("maze2", 0, 4), ("maze2", 10, 1)):
        experiment = safe.Experiment("novelty", maze, 4, parameters=safe.Parameters(archive=places))
        cells[maze, places] = experiment
        results[experiment] = runs(successes, 4, evaluations=[100, 200, 300, 400])
    return Design(("maze", "places"), cells), results


# Rates of success


def test_rates():
    table = findings.rates(*small_design())
    assert table.maze.tolist() == ["maze1", "maze1", "maze2", "maze2"]
    assert table.places.tolist() == [0, 10, 0, 10]
    assert table.successes.tolist() == [3, 0, 4, 1]
    assert set(table.runs) == {4}
    assert table.rate.tolist() == [0.75, 0, 1, 0.25]
    assert [*zip(table.low, table.high, strict=True)] == [success_interval(count, 4) for count in (3, 0, 4, 1)]
    assert set(table.evaluations) == {1000}
    assert table.per_success.tolist() == [pytest.approx(1000 / 3), math.inf, 250, 1000]


def test_successes_of_cells_are_taken_together():
    design, results = small_design()
    assert findings.successes(design, results, {"maze": "maze1"}) == (3, 8)
    assert findings.successes(design, results, {"places": 10}) == (1, 8)
    assert findings.successes(design, results, {"maze": "maze2", "places": 0}) == (4, 4)
    assert findings.successes(design, results, {}) == (8, 16)
    assert findings.cells_at(design, {"maze": "maze2"}) == [design.cells["maze2", 0], design.cells["maze2", 10]]
    with pytest.raises(LookupError, match=r"levels must be those of a cell; got \{'maze': 'maze1', 'places': 3\}"):
        findings.cells_at(design, {"maze": "maze1", "places": 3})


def test_rates_to_read():
    design, results = small_design()
    seen = safe.Experiment("novelty", "maze2", 2, seed=1, parameters=safe.Parameters(archive=10))
    explored = Design(design.factors, {("maze2", 10): seen}), {seen: runs(1, 2)}
    shown, behind = findings.readable_rates((design, results), explored)
    assert shown.index.tolist() == [(0,), (10,)]
    assert shown.index.names == ["places"]
    assert shown.to_dict("list") == {
        "maze1": ["3 of 4 (30 to 95 %)", "0 of 4 (0 to 49 %)"],
        "maze1, explored": ["–", "–"],
        "maze2": ["4 of 4 (51 to 100 %)", "1 of 4 (5 to 70 %)"],
        "maze2, explored": ["–", "1 of 2"],
    }
    assert behind == [[design.cells[maze, places] for maze in MAZES] for places in (0, 10)]


def test_what_was_explored_is_what_is_recorded(monkeypatch):
    table = runs(1, 2)
    monkeypatch.setattr(evidence, "runs", lambda cells: {e: table for e in cells if e.maze.name == "maze2"})
    design, results = findings.explored(designs.archives, PACKAGED)
    assert design.factors == ("maze", "algorithm", "archive")
    assert {*design.cells} == {key for key in designs.archives(PACKAGED, 1, 0).cells if key[0] == "maze2"}
    assert {*design.cells.values()} == {*results}
    assert {(e.seed, e.runs) for e in results} == {(EXPLORING, RUNS[EXPLORING])}


def test_names_of_exported_numbers():
    rates = findings.rates(*small_design())
    assert findings.exported(rates, ["maze", "places"]).to_dict("index") == {
        "maze1_0": {"successes": 3, "runs": 4},
        "maze1_10": {"successes": 0, "runs": 4},
        "maze2_0": {"successes": 4, "runs": 4},
        "maze2_10": {"successes": 1, "runs": 4},
    }
    (named,) = findings.exported(rates[:1].assign(maze="maze ½, my-own", rule="the paper's"), ["maze", "rule"]).index
    assert named == "maze_½_my_own_the_paper_s"


@pytest.mark.parametrize("name", findings.all_questions())
def test_each_cell_exports_under_a_name_of_its_own(name):
    design, results = made_up(getattr(designs, name), PACKAGED, {})
    names = findings.exported(findings.rates(design, results), design.factors).index
    assert names.is_unique
    assert all(exported.isidentifier() for exported in names)


# Answers

SEEN = {  # successes of 200 runs, of which the paper's archive has 50; then the words of a question, and its answer
    ("novelty search", "none"): (120, "without an archive than", findings.CONFIRMED),
    ("novelty search", "random"): (50, "with random admission than with the", findings.NOT_CONFIRMED),  # ruled out
    ("novelty search", "threshold"): (15, "with Lehman and Stanley", findings.NOT_CONFIRMED),  # the other direction
    ("novelty search", "the paper's, distinct cells"): (60, "if it holds no cell twice", UNDECIDED),
    ("novelty search", "the paper's, rescored"): (70, "scores are computed again", UNDECIDED),  # p = 0.03, uncorrected
    ("novelty search", "the paper's, after scoring"): (51, "enter after all are scored", findings.CONFIRMED),
}
SAFES = {  # the answers to the same question of a likeness on SAFE
    50: findings.CONFIRMED,
    60: UNDECIDED,
    120: findings.NOT_CONFIRMED,
}


@pytest.fixture
def table():
    """Answers to the questions on archives, of which nothing was explored on maze2, nor traced."""
    successes = {key: count for key, (count, *_) in SEEN.items()} | {("SAFE", "the paper's, after scoring"): 60}
    explored = made_up(designs.archives, PACKAGED[:1], {("novelty search", "none"): 6}, n=10, seed=EXPLORING)
    return findings.answers("archives", explored, made_up(designs.archives, PACKAGED, successes), {})


def found(table, words, maze="maze1", who="Novelty search"):
    (number,) = np.flatnonzero(
        table.statement.str.contains(words, regex=False) & (table.maze == maze) & table.statement.str.startswith(who)
    )
    return table.iloc[number]


@pytest.mark.parametrize("maze", MAZES)
@pytest.mark.parametrize(("words", "answer"), [expected[1:] for expected in SEEN.values()])
def test_answers_to_questions_on_rates(table, words, answer, maze):
    assert found(table, words, maze).verdict == answer


@pytest.mark.parametrize(("successes", "answer"), SAFES.items())
def test_answers_to_a_likeness(successes, answer):
    confirmed = made_up(designs.archives, PACKAGED, {("SAFE", "the paper's, after scoring"): successes})
    table = findings.answers("archives", confirmed, confirmed, {})
    assert found(table, "enter after all are scored", who="SAFE").verdict == answer


def test_all_that_leads_to_an_answer(table):
    row = found(table, "without an archive than")
    assert row.name == f"maze1: {row.statement}"
    assert (row.family, row.test, row.direction) == ("beyond the paper: archives", "Fisher, Newcombe", 1)
    assert (row.here, row.explored) == ("120 of 200 against 50 of 200", "6 of 10 against 2 of 10")
    assert row.evidence == "200 runs against 200 runs, seed 200"
    assert row.difference == pytest.approx(0.35)
    assert row.low < 0.35 < row.high
    assert found(table, "without an archive than", "maze2").explored == "–"
    assert [*table] == [*(f.name for f in fields(Claim)[1:]), "maze", "explored", "p_adjusted", "verdict"]
    assert table.index.name == "claim"
    assert table.index.is_unique
    assert len(table) == 2 * 2 * 7, "no question on what happens inside runs, since nothing is traced"


def test_the_cells_behind_an_answer_are_counted():
    confirmed = made_up(designs.factorial, PACKAGED, {})
    row = found(findings.answers("factorial", confirmed, confirmed, {}), "than the standard EA, both over all settings")
    assert row.evidence == "900 runs of 90 cells against 60 runs of 6 cells, seed 200"


def test_p_is_corrected_for_all_questions_of_a_design(table):
    largest, corrected = 0, {}
    for rank, (claim, p) in enumerate(sorted(table.p_value.items(), key=lambda item: item[1])):
        largest = max(largest, min(1, (len(table) - rank) * p))
        corrected[claim] = largest
    assert table.p_adjusted.to_dict() == pytest.approx(corrected)
    row = found(table, "scores are computed again")
    assert row.p_value < 0.05 < row.p_adjusted


def test_answers_to_read(table):
    shown = findings.readable_answers(table)
    assert shown.index.name == "question"
    assert shown.index.tolist() == table.statement.drop_duplicates().tolist()
    assert [*shown] == [f"{maze}{what}" for maze in MAZES for what in ("", ": difference", ": p")]
    row = shown.loc[found(table, "without an archive than").statement]
    assert row["maze1"] == findings.CONFIRMED
    assert row["maze1: difference"] == "+35.0 (+25.6 to +43.5)"
    assert row["maze1: p"] == "< 0.001", "of a direction the corrected p of a difference"
    likeness = shown.loc[found(table, "enter after all are scored").statement]
    assert likeness["maze2: p"] == "0.030", "of a likeness the p of equivalence"


def test_a_question_on_one_maze_has_a_dash_on_the_other():
    confirmed = made_up(designs.selection, PACKAGED, {})
    shown = findings.readable_answers(findings.answers("selection", confirmed, confirmed, {}))
    (row,) = (row for statement, row in shown.iterrows() if "both with no archive" in statement)
    assert (row["maze1"], row["maze1: p"]) == ("–", "–")
    assert row["maze2"] == findings.NOT_CONFIRMED


def test_summary(table):
    text = findings.summary(table)
    counts = table.verdict.value_counts()
    first, *listed = text.splitlines()
    confirmed, refuted, undecided = (counts[word] for word in (findings.CONFIRMED, findings.NOT_CONFIRMED, UNDECIDED))
    assert first == (
        f"28 questions were asked: {confirmed} are confirmed, {refuted} are not, and {undecided} are undecided. "
        "Not confirmed are:"
    )
    row = found(table, "scores are computed again")
    assert f"- {row.statement} (maze1: {UNDECIDED}, {row.here})" in listed
    assert len([line for line in listed if line.startswith("- ")]) == 28 - counts[findings.CONFIRMED]
    alone = table[table.verdict == findings.CONFIRMED]
    assert findings.summary(alone) == (
        f"{len(alone)} questions were asked: {len(alone)} are confirmed, 0 are not, and 0 are undecided."
    )


@pytest.mark.parametrize("name", findings.all_questions())
def test_of_another_maze_nothing_was_asked(name):
    confirmed = made_up(getattr(designs, name), [OTHER], {})
    nothing = Design(confirmed[0].factors, {}), {}
    table = findings.answers(name, nothing, confirmed, {})
    assert len(table) == 0
    assert len(findings.readable_answers(table)) == 0
    assert findings.summary(table) == "No question was asked of these mazes."


def test_answers_with_all_numbers(table):
    others = table.assign(family="beyond the paper: others")
    shown = findings.readable_ledger(pd.concat([others, table]), "archives")
    assert shown.index.tolist() == table.index.tolist()
    assert shown.index.name == "question"
    assert shown.loc[found(table, "without an archive than").name].tolist() == [
        findings.CONFIRMED,
        "120 of 200 against 50 of 200",
        "+35.0 (+25.6 to +43.5)",
        "< 0.001",
        "1.00",
        "6 of 10 against 2 of 10",
    ]


def test_answers_are_counted_by_design(table):
    others = table[table.verdict == UNDECIDED].assign(family="beyond the paper: sizes")
    counts = findings.counted(pd.concat([others, table]))
    assert counts.index.tolist() == ["sizes", "archives", "all"]
    assert counts.columns.tolist() == [findings.CONFIRMED, findings.NOT_CONFIRMED, UNDECIDED]
    expected = [sum(table.verdict == answer) for answer in counts]
    assert counts.loc["archives"].tolist() == expected
    assert counts.loc["sizes"].tolist() == [0, 0, len(others)]
    assert counts.loc["all"].tolist() == [*expected[:2], 2 * len(others)]


def test_answers_to_everything(monkeypatch):
    def recorded(cells):
        return {e: runs(e.runs // 4, e.runs) for e in cells if e.maze != OTHER and e.runs <= RUNS[e.seed]}

    monkeypatch.setattr(evidence, "runs", recorded)
    monkeypatch.setattr(evidence, "traces", lambda cells, number: {})
    for asked, used in ((40, 40), (RUNS[DECIDING] + 1, RUNS[DECIDING])):
        table = findings.beyond_the_paper(PACKAGED, asked)
        assert list(dict.fromkeys(table.family)) == [f"beyond the paper: {name}" for name in findings.all_questions()]
        assert table.index.is_unique
        assert found(table, "without an archive than").evidence == f"{used} runs against {used} runs, seed {DECIDING}"
        assert found(table, "without an archive than").explored == "25 of 100 against 25 of 100"
    assert len(findings.beyond_the_paper([OTHER], 40)) == 0
    assert set(findings.beyond_the_paper([OTHER, PACKAGED[1]], 40).maze) == {"maze2"}


# What happens inside runs


def traced(held, n, short=0, cell=("maze1", "novelty search", "the paper's")):
    """Made-up traces: in so many of n runs the archive is full and hardly any point enters; others end too early."""
    design = designs.archives(PACKAGED, N, DECIDING)
    frames = [
        pd.DataFrame(
            {
                "run": run,
                "window": [0, 10, LONG],
                "archive_size": [200, *[1000 if run < held else 999] * 2],
                "entered": [200, 50, 9 if run < held else 10],
                "archive_lowest": 1,
                "novelty": 2,
                "archive_cells": 1000,
                "novelty_sd": 1,
            }
        ).head(3 if run < n else 2)
        for run in range(n + short)
    ]
    return {design.cells[cell]: pd.concat(frames, ignore_index=True)}


def answered(traces):
    confirmed = made_up(designs.archives, PACKAGED, {})
    return findings.answers("archives", confirmed, confirmed, traces)


@pytest.mark.parametrize(
    ("held", "answer", "p"),
    [
        (15, findings.CONFIRMED, 2 * (1 + 16) / 2**16),
        (1, findings.NOT_CONFIRMED, 2 * (1 + 16) / 2**16),
        (8, UNDECIDED, 1),
    ],
)
def test_answers_to_questions_on_most_runs(held, answer, p):
    row = found(answered(traced(held, 16)), "fewer than 10 of 200 solutions enter", who="In most runs")
    assert (row.verdict, row.here, row.explored) == (answer, f"{held} of 16", "–")
    assert (row.test, row.direction) == ("binomial, Wilson", 1)
    assert row.difference == held / 16 - 0.5
    assert (row.low, row.high) == tuple(end - 0.5 for end in success_interval(held, 16))
    assert row.p_value == pytest.approx(p)
    assert math.isnan(row.p_equivalence)


def test_runs_that_end_too_early_do_not_count():
    table = answered(traced(12, 16, short=4))
    assert found(table, "fewer than 10", who="In most runs").here == "12 of 16"
    assert found(table, "is full after 10", who="In most runs").here == "12 of 20"
    only_short = answered(traced(0, 0, short=4))
    assert found(only_short, "is full after 10", who="In most runs").here == "0 of 4"
    unanswered = only_short[only_short.statement.str.contains("last 100 generations")]
    assert len(unanswered)
    assert set(unanswered.here) == {"no run lasted"}
    assert set(unanswered.verdict) == {UNDECIDED}
    assert set(unanswered.p_value) == {1.0}


def test_questions_on_most_runs_are_those_of_traced_cells():
    table = answered(traced(12, 16, cell=("maze2", "novelty search", "random")))
    (row,) = (row for _, row in table.iterrows() if row.test == "binomial, Wilson")
    assert (row.maze, row.here) == ("maze2", "16 of 16")
    assert "random admission, the standard deviation of novelty is above 40 %" in row.statement


def test_questions_on_most_runs_are_corrected_with_the_others():
    table = answered(traced(15, 16))
    row = found(table, "fewer than 10", who="In most runs")
    larger = sum(table.p_value > row.p_value)
    assert row.p_adjusted >= row.p_value * (larger + 1)


def test_no_answer_has_changed(tmp_path):
    """The answers that the recorded runs give are those that a person has examined, and that pages tell about."""
    table = record.answers()
    record.write(table, tmp_path / "findings.csv")
    assert (tmp_path / "findings.csv").read_bytes() == findings.RECORD.read_bytes()
    assert ledger.changed(table, findings.RECORD) == []
    some = table.verdict == findings.CONFIRMED
    other = ledger.changed(table.assign(verdict=table.verdict.where(~some, findings.NOT_CONFIRMED)), findings.RECORD)
    assert len(other) == some.sum() > 100
