import dataclasses

import pytest

from safe import ALGORITHMS, Algorithm, Parameters
from safe.companion import paper


def test_the_papers_algorithms():
    choices = "scaling", "judging", "kind", "components", "pool"
    papers = "raw", "best score", "weights", ("1 / distance", "novelty"), "generation"
    found = {name: ALGORITHMS[name] for name in paper.ALGORITHMS}
    assert {tuple(getattr(algorithm, choice) for choice in choices) for algorithm in found.values()} == {papers}
    assert {name: (a.objectives, a.rating) for name, a in found.items()} == {
        "standard": (((1.0, 0.0),), "none"),
        "novelty": (((0.0, 1.0),), "none"),
        "safe": (None, "genotypic novelty"),
        "fixed": (((0.5, 0.5),), "none"),
        "random": ((), "none"),
    }


def test_the_papers_parameters():
    assert dataclasses.asdict(Parameters()) == {
        "population": 200,
        "objectives": 200,
        "generations": 500,
        "tournament": 5,
        "elites": 2,
        "crossover": 0.8,
        "mutation": 0.4,
        "k": 15,
        "archive": 1000,
        "steps": 300,
        "success_distance": 2,
        "admission": "lowest replaced",
        "admitted": 5,
        "threshold": 6.0,
        "patience": 10,
    }


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ({"name": ""}, "name must be a text of printable characters; got ''"),
        (
            {"rating": "by taste"},
            "rating must be one of 'none', 'genotypic novelty', 'pearson', 'spearman', 'mutualism', .*; got 'by taste'",
        ),
        ({"scaling": "log"}, "scaling must be one of 'raw', 'maximum', 'rank'; got 'log'"),
        ({"judging": None}, "judging must be one of 'best score', 'drawn judge', 'favourite'; got None"),
        ({"objectives": [(1, 0, 0)]}, r"objectives must have the shape \(any, 2\); got shape \(1, 3\)"),
        ({"objectives": (1, 0)}, r"objectives must have the shape \(any, 2\); got shape \(2,\)"),
        ({"objectives": [(1, float("inf"))]}, "objectives must be finite"),
        ({"objectives": [(1e308, -1e308)]}, "objectives must be finite"),  # the sum of infinities is no score
        (
            {"objectives": [(1, 0)] * 3, "rating": "genotypic novelty"},
            "objectives must be even in number if they evolve; got 3",
        ),
        ({"objectives": [], "rating": "spearman"}, "objectives must be even in number if they evolve; got 0"),
        ({"objectives": 7}, "objectives must"),
        ({"kind": "place"}, "kind must be one of 'weights', 'goal', 'mixed'; got 'place'"),
        ({"pool": "archive"}, "pool must be one of 'generation', 'repertoire'; got 'archive'"),
        ({"components": []}, "components must be some of '1 / distance', 'novelty', .*, each at most once; got \\[\\]"),
        ({"components": "novelty"}, "components must be some of .*; got 'novelty'"),
        ({"components": ["novelty"] * 2}, "components must be some of"),
        ({"components": [["novelty"]]}, "components must be some of"),
        ({"components": ["novelty", "1 / way", "path rarity"], "objectives": [(1, 0)]}, "shape .any, 3."),
        ({"objectives": [(1, 2)], "kind": "goal"}, r"objectives must be finite and in \[0, 1\]; got 2.0"),
        ({"objectives": [(1, 0)] * 3, "kind": "mixed"}, "objectives must be even in number if they are mixed; got 3"),
        ({"objectives": [], "kind": "goal"}, "kind must be 'weights' without objective functions; got 'goal'"),
        (
            {"objectives": [], "judging": "favourite", "pool": "repertoire"},
            "judging must be 'best score' without objective functions; got 'favourite'",
        ),
        ({"kind": "goal", "scaling": "rank"}, "scaling must be 'raw' for goals, which weigh nothing; got 'rank'"),
        ({"kind": "goal", "components": ["novelty"]}, "components must be .* for goals, which weigh nothing"),
        (
            {"kind": "mixed", "rating": "discovery"},
            "rating must be 'none' or 'redrawn' for a mixture with goals; got 'discovery'",
        ),
        ({"rating": "patience"}, "kind must be 'goal' for a rating by patience; got 'weights'"),
        ({"pool": "repertoire"}, "kind must be 'goal' or 'mixed' to choose from the repertoire; got 'weights'"),
        (
            {"pool": "repertoire", "kind": "goal"},
            "judging must be 'drawn judge' or 'favourite' to choose from the repertoire; got 'best score'",
        ),
        (
            {"pool": "repertoire", "kind": "mixed", "judging": "drawn judge"},
            "judging must be 'favourite' to choose from the repertoire; got 'drawn judge'",
        ),
    ],
)
def test_bad_algorithms(arguments, complaint):
    with pytest.raises(ValueError, match=complaint):
        Algorithm(**{"name": "mine", **arguments})


@pytest.mark.parametrize("name", [field.name for field in dataclasses.fields(Parameters)])
@pytest.mark.parametrize("value", [-1, "1", None, float("nan"), True, 10**9])
def test_bad_parameters(name, value):
    with pytest.raises(ValueError, match=f"^{name} must be"):
        Parameters(**{name: value})


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ({"population": 199}, "population must be an even number; got 199"),
        ({"objectives": 3}, "objectives must be an even number; got 3"),
        ({"elites": 1}, "elites must be an even number; got 1"),
        ({"elites": 200}, "elites must be fewer than the 200 solutions and 200 objective functions; got 200"),
        ({"k": 0}, "k must be an integer from 1 to 1000000; got 0"),
        ({"generations": 0}, "generations must be an integer from 1"),
        ({"crossover": 1.01}, "crossover must be a number from 0 to 1; got 1.01"),
        ({"steps": 1.5}, "steps must be an integer from 1 to 1000000; got 1.5"),
        ({"admission": "all"}, "admission must be one of 'lowest replaced', .*, 'rescored'; got 'all'"),
        ({"admitted": 0}, "admitted must be an integer from 1 to 1000000; got 0"),
        ({"threshold": 1e7}, "threshold must be a number from 0 to 1000000; got 10000000.0"),
    ],
)
def test_bad_values(arguments, complaint):
    with pytest.raises(ValueError, match=complaint):
        Parameters(**arguments)
