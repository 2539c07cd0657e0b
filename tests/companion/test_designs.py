from dataclasses import replace
from itertools import product

import pytest

import safe
from safe.companion import designs
from safe.companion.designs import DECIDING, EXPLORING, RUNS, TRACED, Recorded
from safe.companion.paper import MAZES
from safe.maze_files import load_mazes

PACKAGED = load_mazes(list(MAZES))
DESIGNS = {
    design.__name__: design
    for design in (
        designs.selection,
        designs.archives,
        designs.capacities,
        designs.mutualism,
        designs.factorial,
        designs.sizes,
    )
}
PAPERS = "the paper's archive"
SETTING = ("crossover and mutation", "the paper's")


def cells(name, runs=500, seed=7):
    return DESIGNS[name](PACKAGED, runs, seed).cells


@pytest.mark.parametrize(
    ("name", "factors", "levels", "number"),
    [
        (
            "selection",
            ("maze", "condition", "weighed", "judge"),
            [
                {PAPERS, "no archive", "no archive, mutation alone"},
                {"raw", "shares of the largest", "ranks"},
                {"novelty search", "SAFE", "SAFE, frozen", "one fixed sum", "a drawn judge"},
            ],
            2 * 3 * (3 * 4 + 1),
        ),
        ("archives", ("maze", "algorithm", "archive"), [{"novelty search", "SAFE"}, {*designs.ARCHIVES}], 2 * 2 * 7),
        (
            "capacities",
            ("maze", "algorithm", "archive", "places"),
            [
                {"novelty search", "SAFE"},
                {"the paper's", "random", "threshold"},
                {0, 100, 300, 1000, 3000, 10_000},
            ],
            2 * 2 * (6 + 2 + 2),
        ),
        (
            "mutualism",
            ("maze", "condition", "weighed", "rating"),
            [
                {PAPERS, "no archive"},
                {"raw", "shares of the largest", "ranks"},
                {"Pearson", "Spearman", "genotypic novelty"},
            ],
            2 * 2 * 3 * 3,
        ),
        (
            "factorial",
            ("maze", "algorithm", "k", "tournament", "variation", "archive"),
            [
                {"standard EA", "novelty search", "SAFE"},
                {1, 5, 15, 50, 200},
                {2, 5, 20},
                {"crossover and mutation", "mutation alone"},
                {"the paper's", "none", "random"},
            ],
            2 * 3 * 2 * (1 + 3 * (5 + 4)),
        ),
        (
            "sizes",
            ("maze", "algorithm", "archive", "population", "elites"),
            [
                {"standard EA", "novelty search", "SAFE"},
                {"the paper's", "none"},
                {50, 100, 200, 500, 1000},
                {0, 2, 20},
            ],
            2 * 5 * (5 + 2),
        ),
    ],
)
def test_factors_and_levels(name, factors, levels, number):
    design = DESIGNS[name](PACKAGED, 500, 7)
    assert design.factors == factors
    assert [set(column) for column in zip(*design.cells, strict=True)] == [set(MAZES), *levels]
    assert len(design.cells) == number
    assert len({experiment.digest for experiment in design.cells.values()}) == number, "no cell is another one's twin"
    for (maze, *_), experiment in design.cells.items():
        assert (experiment.maze, experiment.seed) == (PACKAGED[MAZES.index(maze)], 7)


@pytest.mark.parametrize(
    ("name", "levels", "algorithm"),
    [
        ("selection", (PAPERS, "raw", "SAFE"), "safe"),
        ("selection", (PAPERS, "raw", "novelty search"), "novelty"),
        ("selection", (PAPERS, "raw", "one fixed sum"), "fixed"),
        ("archives", ("SAFE", "the paper's"), "safe"),
        ("archives", ("novelty search", "the paper's"), "novelty"),
        ("capacities", ("SAFE", "the paper's", 1000), "safe"),
        ("capacities", ("novelty search", "the paper's", 1000), "novelty"),
        ("mutualism", (PAPERS, "raw", "genotypic novelty"), "safe"),
        ("factorial", ("SAFE", 15, 5, *SETTING), "safe"),
        ("factorial", ("novelty search", 15, 5, *SETTING), "novelty"),
        ("factorial", ("standard EA", 15, 5, SETTING[0], "none"), "standard"),
        ("sizes", ("SAFE", "the paper's", 200, 2), "safe"),
        ("sizes", ("novelty search", "the paper's", 200, 2), "novelty"),
    ],
)
def test_the_papers_setting_is_a_cell(name, levels, algorithm):
    for maze in MAZES:
        papers = safe.Experiment(algorithm, maze, seed=7)
        cell = cells(name)[(maze, *levels)]
        assert cell.algorithm.name in levels
        named = replace(papers.algorithm, name=cell.algorithm.name)
        assert cell == replace(papers, algorithm=named, runs=cell.runs)
        assert cell.digest == papers.digest


def test_what_cells_do():
    """A few cells of each design, with all in which they depart from the paper's setting."""
    alone = {"crossover": 0.0, "mutation": 1.0}
    for name, levels, algorithm, departures in [
        (
            "selection",
            ("no archive, mutation alone", "ranks", "a drawn judge"),
            {"objectives": None, "rating": "none", "scaling": "rank", "judging": "drawn judge"},
            {"archive": 0} | alone,
        ),
        (
            "selection",
            ("no archive", "shares of the largest", "SAFE, frozen"),
            {"objectives": None, "rating": "none", "scaling": "maximum"},
            {"archive": 0},
        ),
        ("archives", ("SAFE", "none"), {"objectives": None, "rating": "genotypic novelty"}, {"archive": 0}),
        *(
            ("archives", ("novelty search", level), {"objectives": ((0, 1),), "rating": "none"}, {"admission": rule})
            for level, rule in (
                ("random", "random"),
                ("threshold", "threshold"),
                ("the paper's, after scoring", "after scoring"),
                ("the paper's, distinct cells", "distinct"),
                ("the paper's, rescored", "rescored"),
            )
        ),
        (
            "capacities",
            ("novelty search", "random", 10_000),
            {"objectives": ((0, 1),), "rating": "none"},
            {"admission": "random", "archive": 10_000},
        ),
        (
            "mutualism",
            ("no archive", "ranks", "Spearman"),
            {"objectives": None, "rating": "spearman", "scaling": "rank"},
            {"archive": 0},
        ),
        (
            "factorial",
            ("SAFE", 50, 20, "mutation alone", "random"),
            {"objectives": None, "rating": "genotypic novelty"},
            {"k": 50, "tournament": 20, "admission": "random"} | alone,
        ),
        (
            "factorial",
            ("standard EA", 15, 2, "mutation alone", "none"),
            {"objectives": ((1, 0),), "rating": "none"},
            {"tournament": 2} | alone,
        ),
        (
            "sizes",
            ("novelty search", "none", 1000, 2),
            {"objectives": ((0, 1),), "rating": "none"},
            {"population": 1000, "generations": 100, "archive": 0},
        ),
        (
            "sizes",
            ("SAFE", "the paper's", 200, 20),
            {"objectives": None, "rating": "genotypic novelty"},
            {"elites": 20},
        ),
    ]:
        experiment = cells(name)[("maze1", *levels)]
        assert (experiment.algorithm.content, experiment.parameters.departures) == (algorithm, departures)


def test_all_sizes_cost_the_same():
    assert {experiment.parameters.evaluations for experiment in cells("sizes").values()} == {100_000}


def test_shares_of_runs():
    def shares(name, runs=500):
        return {experiment.runs for experiment in cells(name, runs).values()}

    assert {key[1:3]: e.runs for key, e in cells("selection").items() if key[3] == "SAFE"} == {
        (condition, weighed): n
        for (condition, n), weighed in product(
            ((PAPERS, 500), ("no archive", 300), ("no archive, mutation alone", 100)), designs.WEIGHED
        )
    }
    assert {(key[1], key[2] == "raw"): e.runs for key, e in cells("mutualism").items()} == {
        (PAPERS, True): 500,
        ("no archive", True): 300,
        (PAPERS, False): 100,
        ("no archive", False): 100,
    }
    assert (shares("archives"), shares("capacities")) == ({500}, {200})
    assert (shares("factorial"), shares("sizes")) == ({25}, {60})
    assert (shares("factorial", 1), shares("sizes", 2)) == ({1}, {1}), "at least one run"


def test_an_algorithm_is_named_after_the_level_that_says_who_judges():
    for name, key, judge in (
        ("selection", ("no archive", "ranks", "SAFE, frozen"), "SAFE, frozen"),
        ("archives", ("SAFE", "none"), "SAFE"),
        ("mutualism", ("no archive", "ranks", "Pearson"), "Pearson"),
        ("factorial", ("novelty search", 1, 2, "mutation alone", "none"), "novelty search"),
    ):
        assert cells(name)[("maze1", *key)].algorithm.name == judge


def test_another_maze():
    maze = safe.Maze.from_drawing("S.G", "mine")
    design = designs.archives([maze], 10, 0)
    assert {key[0] for key in design.cells} == {"mine"}
    assert {experiment.maze for experiment in design.cells.values()} == {maze}
    assert len(design.cells) == 14


@pytest.fixture(scope="module")
def everything():
    return designs.everything()


def test_each_experiment_is_recorded_once_with_the_largest_number_of_runs(everything):
    wanted = {}
    for name, (seed, runs) in product(DESIGNS, RUNS.items()):
        for experiment in cells(name, runs, seed).values():
            wanted.setdefault(experiment.digest, []).append(experiment.runs)
    recorded = [(each.experiment.digest, each.experiment.runs) for each in everything]
    assert len(dict(recorded)) == len(recorded)
    assert dict(recorded) == {digest: max(runs) for digest, runs in wanted.items()}
    assert any(len(set(runs)) > 1 for runs in wanted.values()), "otherwise the largest number would be the only one"


def test_each_experiment_stands_where_the_first_design_has_it(everything):
    place = {each.experiment.digest: number for number, each in enumerate(everything)}
    first = cells("selection", RUNS[EXPLORING], EXPLORING).values()
    assert [place[experiment.digest] for experiment in first] == [*range(len(first))]


def test_runs_are_traced_whose_mechanism_is_asked_for(everything):
    traced = {each.experiment.digest: each.traced for each in everything}
    assert set(traced.values()) == {0, TRACED}
    assert all(each.traced == 0 for each in everything if each.experiment.seed == EXPLORING)

    def traced_of(name):
        return {key[1:] for key, e in cells(name, RUNS[DECIDING], DECIDING).items() if traced[e.digest]}

    def keys(name, wanted):
        return {key[1:] for key in cells(name) if wanted(*key[1:])}

    assert traced_of("selection") == keys("selection", lambda condition, *_: "mutation" not in condition)
    assert traced_of("mutualism") == keys("mutualism", lambda *_: True)
    assert traced_of("archives") == keys(
        "archives",
        # SAFE with and without the paper's archive stands in other designs, too
        lambda search, archive: search == "novelty search" or archive in ("the paper's", "none"),
    )
    assert sum(map(bool, traced.values())) == len(
        {
            cells(name, RUNS[DECIDING], DECIDING)[(maze, *key)].digest
            for name, maze in product(("selection", "mutualism", "archives"), MAZES)
            for key in traced_of(name)
        }
    )


@pytest.mark.parametrize("traced", [-1, 7, 1.5])
def test_no_more_runs_are_traced_than_there_are(traced):
    with pytest.raises(ValueError, match=r"traced must be an integer from 0 to 6; got"):
        Recorded(safe.Experiment("safe", "maze1", 6), traced)
