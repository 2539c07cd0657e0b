from collections import Counter

import pandas as pd
import pytest

from safe.companion import designs, findings
from safe.companion.designs import DECIDING
from safe.companion.paper import MAZES
from safe.companion.questions import LATER, LONG, Mechanism, Question, all_questions
from safe.maze_files import load_mazes

PACKAGED = load_mazes(list(MAZES))
DESIGNS = {name: getattr(designs, name)(PACKAGED, designs.RUNS[DECIDING], DECIDING) for name in all_questions()}
ASKED = [(name, question) for name, questions in all_questions().items() for question in questions]
COMPARED = [(name, question) for name, question in ASKED if isinstance(question, Question)]
MECHANISMS = [(name, question) for name, question in ASKED if isinstance(question, Mechanism)]


def keys(name, levels):
    """The cells that these levels choose, by their levels."""
    names = {experiment: key for key, experiment in DESIGNS[name].cells.items()}
    return [names[experiment] for experiment in findings.cells_at(DESIGNS[name], levels)]


def one_by(words):
    """A question by words of its statement, on maze1."""
    (found,) = (question for _, question in ASKED if question.maze == "maze1" and words in question.statement)
    return found


def test_no_question_is_asked_twice():
    asked = Counter((question.maze, question.statement) for _, question in ASKED)
    assert [*filter(lambda question: asked[question] > 1, asked)] == []
    groups = [(name, *map(frozenset, (q.first.items(), q.second.items()))) for name, q in COMPARED]
    assert len(set(groups)) == len(groups)


def test_a_question_is_asked_of_both_mazes():
    """One alone is asked of maze2 only."""
    where = {}
    for name, question in ASKED:
        where.setdefault((name, question.statement), set()).add(question.maze)
    assert [*where.values()].count({*MAZES}) == len(where) - 1
    assert {question for question, mazes in where.items() if mazes == {"maze2"}} == {
        (
            "selection",
            "A drawn judge of shares of the largest succeeds more often than novelty search, "
            "both with no archive and mutation alone",
        )
    }


def test_two_groups_of_cells_are_compared():
    for name, question in COMPARED:
        first, second = keys(name, question.first), keys(name, question.second)
        assert not {*first} & {*second}, question
        assert {key[0] for key in first + second} == {question.maze}, question
        assert len(first) == len(second) == 1 or name == "factorial", question


def test_a_statement_says_which_answer_is_expected():
    for _, question in COMPARED:
        is_direction, is_likeness = "more often" in question.statement, "succeeds as often" in question.statement
        assert (is_direction, is_likeness) == (question.direction == 1, question.direction == 0), question


@pytest.mark.parametrize(
    ("words", "first", "second"),
    [
        ("Novelty search succeeds more often with k = 15 than with k = 1,", 18, 18),
        ("SAFE succeeds more often with tournaments of 20 than with tournaments of 2,", 24, 24),
        ("SAFE succeeds more often with mutation alone than", 36, 36),
        ("Novelty search succeeds more often with random admission than with the paper's archive, over", 30, 30),
        ("SAFE succeeds more often with tournaments of 20, mutation alone", 1, 1),
        ("Novelty search succeeds more often than the standard EA", 90, 6),
        ("without an archive with k = 15 than with k = 200", 6, 6),
    ],
)
def test_groups_of_the_factorial_design(words, first, second):
    question = one_by(words)
    assert (len(keys("factorial", question.first)), len(keys("factorial", question.second))) == (first, second)


def test_groups_differ_only_in_what_is_asked():
    """Each cell of a group has a partner in the other that differs from it in the levels that are compared alone."""
    for name, question in COMPARED:
        if "standard EA" in question.statement:
            continue
        compared = {factor for factor in question.first if question.first[factor] != question.second[factor]}
        places = [place for place, factor in enumerate(DESIGNS[name].factors) if factor not in compared]
        first, second = (
            {tuple(key[place] for place in places) for key in keys(name, levels)}
            for levels in (question.first, question.second)
        )
        assert first == second, question


@pytest.mark.parametrize(
    ("words", "first", "second"),
    [
        (
            "SAFE succeeds as often as with frozen objective functions (no archive)",
            ("no archive", "raw", "SAFE"),
            ("no archive", "raw", "SAFE, frozen"),
        ),
        (
            "weighs raw components than ranks (the paper's archive)",
            ("the paper's archive", "raw", "SAFE"),
            ("the paper's archive", "ranks", "SAFE"),
        ),
        (
            "drawn judge of ranks succeeds more often than one fixed sum",
            ("no archive", "ranks", "a drawn judge"),
            ("no archive", "ranks", "one fixed sum"),
        ),
        (
            "Novelty search succeeds more often than a drawn judge of shares",
            ("no archive", "raw", "novelty search"),
            ("no archive", "shares of the largest", "a drawn judge"),
        ),
        ("SAFE succeeds more often with Lehman and Stanley", ("SAFE", "threshold"), ("SAFE", "the paper's")),
        ("SAFE succeeds more often with random admission than without", ("SAFE", "random"), ("SAFE", "none")),
        (
            "Novelty search succeeds as often with the paper's archive if points enter after",
            ("novelty search", "the paper's, after scoring"),
            ("novelty search", "the paper's"),
        ),
        ("SAFE succeeds more often with 10,000 places", ("SAFE", "the paper's", 10_000), ("SAFE", "the paper's", 1000)),
        (
            "rated by Spearman's correlation as by their novelty (no archive)",
            ("no archive", "raw", "Spearman"),
            ("no archive", "raw", "genotypic novelty"),
        ),
        (
            "Rated by Pearson's correlation, objective functions of raw components lead to success more often "
            "than those of ranks (no archive)",
            ("no archive", "raw", "Pearson"),
            ("no archive", "ranks", "Pearson"),
        ),
        (
            "Novelty search without an archive succeeds more often with a population of 200",
            ("novelty search", "none", 200, 2),
            ("novelty search", "none", 50, 2),
        ),
        (
            "Novelty search succeeds more often with tournaments of 20, mutation alone",
            ("novelty search", 15, 20, "mutation alone", "random"),
            ("novelty search", 15, 5, "crossover and mutation", "the paper's"),
        ),
    ],
)
def test_the_cells_are_those_of_the_statement(words, first, second):
    question = one_by(words)
    (name,) = (name for name, asked in COMPARED if asked.statement == question.statement and asked.maze == "maze1")
    assert keys(name, question.first) == [("maze1", *first)]
    assert keys(name, question.second) == [("maze1", *second)]


def test_mechanisms_are_those_of_one_traced_cell():
    traced = {recorded.experiment.digest: recorded.traced for recorded in designs.everything()}
    for name, mechanism in MECHANISMS:
        (cell,) = findings.cells_at(DESIGNS[name], mechanism.cell)
        assert traced[cell.digest] == designs.TRACED, mechanism
        assert cell.maze.name == mechanism.maze


OPPOSITES = [  # words of a mechanism, measures of a run that has it, and of one that has not, window by window
    ("99 % of tournaments are won", {"by_novelty": [0.99, 0.99]}, {"by_novelty": [1, 0.97]}),
    ("90 % of the fitnesses", {"share": [0, 0.9]}, {"share": [1, 0.89]}),
    (
        "5 times as strong as for closeness",
        {"differential_novelty": [0.5, 1], "differential_closeness": [0.1, 0.19]},
        {"differential_novelty": [0.5, 1], "differential_closeness": [0.1, 0.21]},
    ),
    (
        "stronger for closeness than for novelty from",
        {"differential_novelty": [1, 0.1], "differential_closeness": [0, 0.2]},
        {"differential_novelty": [0, 0.2], "differential_closeness": [1, 0.2]},
    ),
    ("both coefficients above 0.8", {"a": [0, 0.81], "b": [0, 0.9]}, {"a": [1, 0.9], "b": [1, 0.8]}),
    ("archive is full after", {"archive_size": [0, 1000]}, {"archive_size": [1000, 999]}),
    (
        "lowest score in the paper's archive is above the mean novelty",
        {"archive_lowest": [0, 2], "novelty": [9, 1]},
        {"archive_lowest": [9, 1], "novelty": [0, 1]},
    ),
    ("fewer than 10 of 200", {"entered": [200, 9]}, {"entered": [0, 10]}),
    (
        "fewer cells than two thirds",
        {"archive_cells": [1000, 600], "archive_size": [1000, 1000]},
        {"archive_cells": [0, 700], "archive_size": [1000, 1000]},
    ),
    (
        "with the paper's archive, the standard deviation of novelty is below 40 %",
        {"novelty_sd": [1, 0.3], "novelty": [1, 1]},
        {"novelty_sd": [0, 0.5], "novelty": [1, 1]},
    ),
    (
        "with random admission, the standard deviation of novelty is above 40 %",
        {"novelty_sd": [0, 0.5], "novelty": [1, 1]},
        {"novelty_sd": [1, 0.3], "novelty": [1, 1]},
    ),
    ("Pearson's correlation, their mean coefficient of novelty", {"mean_b": [1, 0.1]}, {"mean_b": [0, 0.2]}),
    ("Pearson's correlation, at least 99 %", {"by_novelty": [0.99, 0.99]}, {"by_novelty": [1, 0.97]}),
    (
        "Spearman's correlation and weighing shares",
        {"by_closeness": [0, 0.6], "by_novelty": [1, 0.5]},
        {"by_closeness": [1, 0.5], "by_novelty": [0, 0.5]},
    ),
]


@pytest.mark.parametrize(("words", "having", "not_having"), OPPOSITES)
def test_what_holds_in_a_run(words, having, not_having):
    (mechanism,) = (m for _, m in MECHANISMS if m.maze == "maze2" and words in m.statement)
    windows = pd.DataFrame({"run": 0, "window": [0, LATER]})
    assert mechanism.holds(windows.assign(**having))
    assert not mechanism.holds(windows.assign(**not_having))


def test_a_run_that_ends_early_is_beyond_its_beginning_from_the_start():
    (mechanism,) = (m for _, m in MECHANISMS if m.maze == "maze2" and "90 % of the fitnesses" in m.statement)
    assert mechanism.holds(pd.DataFrame({"window": [0, 3], "share": [0.8, 1]}))
    assert not mechanism.holds(pd.DataFrame({"window": [0, 3], "share": [0.6, 1]}))


def test_runs_last_as_long_as_their_statement_says():
    for _, mechanism in MECHANISMS:
        words = {f"last {LONG} generations": LONG, f"after {LATER} generations": LATER}
        (*lasting,) = (number for phrase, number in words.items() if phrase in mechanism.statement)
        assert [mechanism.lasting] == (lasting or [0])
