from collections import Counter
from dataclasses import replace

import pandas as pd
import pytest

import safe
from safe import Algorithm, Experiment, Parameters, load_maze
from safe.companion import contest, findings, ledger, standings
from safe.companion.contest import Contrast
from safe.companion.designs import DECIDING, EXPLORING, MUTATION_ALONE, VARIATION
from safe.results.mixed import mixed_model
from safe.results.statistics import compare_pairs

PAIR = Contrast("better than novelty", "one", "other", "mutation alone")


def test_contestants_have_names_of_their_own_and_search_differently():
    found = contest.contestants()
    assert max(Counter(one.name for one in found).values()) == 1
    experiments = [Experiment(Algorithm(o.name, **o.fields), "maze1", 1, 0, Parameters(**o.rules)) for o in found]
    assert len({experiment.digest for experiment in experiments}) == len(found)


def test_no_contestant_knows_the_goal_but_those_that_say_so():
    knowing = [one.name for one in contest.contestants() if "1 / way" in one.fields.get("components", ())]
    assert knowing
    assert all(name.startswith("the true way") for name in knowing)


def test_contrasts_are_between_contestants_with_the_same_operators():
    names = {one.name: one for one in contest.contestants()}
    for one in contest.contrasts():
        assert {one.first, one.second} <= {*names}
        assert one.question in contest.QUESTIONS
        assert one.operators in VARIATION
        if one.question == "coevolution":  # they differ by the rating alone
            first, second = (dict(names[name].fields) for name in (one.first, one.second))
            assert first.pop("rating") != second.pop("rating")
            assert first == second
            assert names[one.first].rules == names[one.second].rules
    assert {*contest.LEVELS} == {*contest.QUESTIONS} == {one.question for one in contest.contrasts()}


def test_a_contest_has_a_cell_for_each_maze_and_contestant():
    mazes = [load_maze("maze1"), load_maze("maze2")]
    ends = [("MAP-Elites", "mutation alone"), ("SAFE, archive the paper's", "crossover and mutation")]
    design = contest.contest(mazes, ends, 7, 3)
    assert [key[:2] for key in design.cells] == [(maze, name) for maze in ("maze1", "maze2") for name, _ in ends]
    elites = design.cells["maze2", "MAP-Elites", "mutation alone"]
    assert elites == Experiment(elites.algorithm, "maze2", 7, 3, Parameters(**MUTATION_ALONE))
    assert elites.algorithm.pool == "repertoire"


def test_the_three_kinds_differ_by_what_places_are_bred_for():
    design = contest.kinds([load_maze("maze1")], 5, DECIDING)
    ratings = {kind: experiment.algorithm.rating for (_, kind), experiment in design.cells.items()}
    assert ratings == {
        "mutualism": "mutualism",
        "competition": "competition",
        "commensalism": "genotypic novelty",
        "unchanging": "none",
        "redrawn": "redrawn",
        "mutualism, best score": "mutualism",
    }
    alike = {
        replace(e.algorithm, name="any", rating="none") for (_, kind), e in design.cells.items() if "," not in kind
    }
    assert len(alike) == 1
    assert DECIDING != EXPLORING


def counted(**successes):
    """Counts of 10 runs on each maze with mutation alone, from the successes of each contestant, maze by maze."""
    rows = {
        (name, "mutation alone", f"maze {number}"): {"successes": count, "runs": 10, "evaluations": 1000}
        for name, of_one in successes.items()
        for number, count in enumerate(of_one)
    }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis(["contestant", "operators", "maze"])


def test_counts_are_those_of_the_runs():
    few = Parameters(population=10, objectives=10, generations=3)
    experiment = Experiment("standard", "maze1", 2, 0, few)
    design = contest.Design(("maze", "contestant", "operators"), {("maze1", "standard", "mutation alone"): experiment})
    table = pd.DataFrame({"success": [True, False], "evaluations": [10, 30]})
    found = standings.counts(design, {experiment: table})
    assert found.loc[("standard", "mutation alone", "maze1")].tolist() == [1, 2, 40]


def test_mazes_that_all_or_none_solve_tell_nobody_apart():
    counts = counted(one=[0, 10, 10, 3], other=[0, 10, 9, 3])
    assert standings.telling(counts) == ["maze 2", "maze 3"]


def test_the_ladder_is_sorted_by_mean_rates():
    table = standings.ladder(counted(one=[0, 2, 1, 0], other=[0, 10, 9, 3]))
    assert table.index.get_level_values("contestant").tolist() == ["other", "one"]
    best = table.iloc[0]
    assert (best.rate, best.mazes, best.runs, best.solved) == (pytest.approx(0.55), 4, 10, 3)
    assert best.low < 0.55 < best.high
    assert best.per_success == 4000 / 22


def test_contrasts_are_decided_by_paired_mazes():
    first, second = [0, 10, 10, 9, 8, 7, 9, 6, 5, 8, 9, 7, 10], [0, 10, 4, 3, 2, 2, 3, 1, 1, 4, 3, 2, 4]
    counts = counted(one=first, other=second, bystander=[1] * 13)
    (found,) = standings.answers([PAIR], counts).to_dict("records")
    told = slice(2, None)  # all or none solve the first two; the bystander does not count
    pair = compare_pairs([n / 10 for n in first[told]], [n / 10 for n in second[told]])
    assert found["mazes"] == 11
    assert (found["p_value"], found["difference"]) == (pytest.approx(pair.p_value), pytest.approx(pair.difference))
    assert found["p_holm"] == pytest.approx(pair.p_value)
    assert found["effect"] == pytest.approx(mixed_model(first[told], 10, second[told], 10).effect, rel=1e-4)
    assert found["answer"] == "confirmed"
    (reverse,) = standings.answers([replace(PAIR, first="other", second="one")], counts).to_dict("records")
    assert (reverse["answer"], reverse["better"], reverse["worse"]) == ("not confirmed", 0, 11)


def test_holm_counts_all_contrasts_and_each_question_has_its_level():
    first, second = [5, 6, 7, 8, 4, 6, 7], [4, 5, 6, 7, 3, 5, 6]
    counts = counted(one=first, other=second)
    many = replace(PAIR, question="many judges")
    table = standings.answers([PAIR, many], counts)
    assert table.p_holm.tolist() == pytest.approx((2 * table.p_value).tolist())
    assert 0.01 < table.p_holm[0] < 0.05
    assert table.answer.tolist() == ["undecided", "confirmed"]


def test_answers_become_rows_of_the_ledger():
    counts = counted(one=[9, 10, 8, 9, 10, 9, 8, 9], other=[1, 2, 0, 1, 2, 1, 0, 9])
    seen = counted(one=[5, 10], other=[1, 1])
    answers = standings.answers([PAIR, replace(PAIR, question="many judges", first="other", second="one")], counts)
    first, second = standings.as_findings(answers, seen, seed=7).to_dict("records")
    assert first["here"] == "90 % against 20 %"
    assert first["explored"] == "75 % against 10 %"
    assert first["evidence"] == "8 mazes, 10 runs on each, seed 7"
    assert first["statement"] == "one succeeds more often than other (mutation alone)"
    assert (first["verdict"], second["verdict"]) == (answers.answer[0], "not confirmed")
    assert first["p_adjusted"] == answers.p_holm[0]
    (unseen,) = standings.as_findings(answers[:1], counted(one=[1]), seed=7).explored
    assert unseen == "–"


def test_the_rows_have_the_columns_of_other_findings():
    answers = standings.answers([PAIR], counted(one=[9, 8], other=[1, 2]))
    rows = standings.as_findings(answers, counted(one=[1]), seed=7)
    assert [*rows.columns] == [*ledger.recorded(findings.RECORD).columns]


def test_what_was_tried_stands_family_by_family_the_best_in_front():
    names = ["MAP-Elites", "random search", "weighing, favourites"]
    rows = {
        (name, operators, f"maze {number}"): {"successes": successes, "runs": 10, "evaluations": 1}
        for place, name in enumerate([*names, "a peer"])
        for operators in VARIATION
        for number, successes in enumerate([place, 2 * place])
    }
    counts = pd.DataFrame.from_dict(rows, orient="index").rename_axis(["contestant", "operators", "maze"])
    table = standings.readable_tried(counts, counts)
    assert table.index.tolist() == [
        ("baselines", "random search"),
        ("baselines", "MAP-Elites"),
        ("weighing", "weighing, favourites"),
        ("peers", "a peer"),
    ]
    row = table.loc["peers", "a peer"]
    assert row["mutation alone"].startswith("45 (")
    assert (row["maze 0"], row["maze 1"]) == ("3, 3", "6, 6")


def test_the_name_of_the_best_is_that_contestant():
    by_name = {one.name: one for one in contest.contestants()}
    best = Algorithm("any", **by_name[contest.CHALLENGERS[0]].fields)
    assert best.content == safe.ALGORITHMS["weighing-and-goals"].content
