"""Addresses say what they are addresses of: read again, they give the same maze, the same algorithm, the same run."""

import json
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given

import safe
from safe.playground import bundle
from safe.playground.address import drive_address, run_address
from tests.helpers.addresses import algorithm_of, maze_of, run_at, values_of
from tests.helpers.strategies import controllers, mazes
from tests.helpers.twin import NODE, needs_node

ROOT = Path(__file__).parents[2]
FEW = safe.Parameters(population=20, objectives=10, generations=3, elites=0, mutation=0.25)
MORE = safe.Parameters(20, 10, 3, elites=0, admission="threshold", admitted=7, threshold=0.00001)
LATER = safe.Parameters(20, 10, 3, elites=0, archive=30, admission="after scoring", patience=2)

ALGORITHMS = [
    *safe.ALGORITHMS.values(),
    safe.Algorithm("fixed", [(0.25, 0.75)]),
    safe.Algorithm("safe", [(0.1, 1e-7), (1 / 3, 2)], "genotypic novelty"),
    safe.Algorithm("unevolved"),
    safe.Algorithm("nobody", []),
    safe.Algorithm("novelty", [(0, 1)], scaling="rank"),
    safe.Algorithm("ratings", None, "spearman", "maximum", "drawn judge"),
    safe.Algorithm("judged", [(1, 0), (0, 1)], "pearson", judging="drawn judge"),
    safe.Algorithm("goals", None, "mutualism", judging="favourite", kind="goal"),
    safe.Algorithm(
        "places", [(0.5, 1), (1 / 3, 1e-7)], "patience", judging="drawn judge", kind="goal", pool="repertoire"
    ),
    safe.Algorithm("both", None, "redrawn", "rank", "favourite", "mixed", ("novelty", "path rarity"), "repertoire"),
    safe.Algorithm("three", [(1, 2, 3), (0, 1, 0)], components=("1 / way", "path rarity", "1 / distance")),
    safe.Algorithm("one", None, "discovery", components=("path rarity",)),
    safe.Algorithm("four", None, "shuffled", components=("1 / distance", "novelty", "path rarity", "1 / way")),
    safe.Algorithm("elites", [], pool="repertoire"),
    safe.Algorithm("a: ½, b: 50 % & #1=/", [(1, 0)]),
]


SAME = [
    "safe:genotypic:drawn",
    "safe:genotypic:drawn:raw:best",
    "safe:genotypic:drawn:raw:best:weights:generation:distance,novelty",
]
WRONG = [
    "none",
    "by:1,0",
    "none:1,0:rank",
    "none:1,0:log:best",
    "none:1,0:raw:best:weights",
    "none:1,0:raw:best:goals:generation:distance,novelty",
    "none:1,0:raw:best:weights:all:distance,novelty",
    "none:1,0:raw:best:weights:generation:",
    "none:1,0:raw:best:weights:generation:distance,1",
    "none:1,0:raw:best:weights:generation:distance,novelty,way",
    "none:1,0:raw:best:weights:generation:distance,novelty:1",
]


@pytest.mark.parametrize("parameters", [FEW, MORE, LATER], ids=["few", "more", "later"])
@pytest.mark.parametrize("algorithm", ALGORITHMS, ids=lambda algorithm: algorithm.name)
def test_the_run_that_an_address_says_is_that_of_the_experiment(algorithm, parameters):
    experiment = safe.Experiment(algorithm, "maze1", runs=3, seed=5, parameters=parameters)
    row = safe.run(experiment, progress=False).loc[2]
    made = run_at(run_address(experiment, 2))
    assert (made.success, made.generation, made.distance) == (row.success, row.generation, row.distance)
    assert list(made.controller) == row[[f"p{number}" for number in range(1, 17)]].tolist()


@pytest.mark.parametrize("algorithm", ALGORITHMS, ids=lambda algorithm: algorithm.name)
def test_an_algorithm_is_written_by_name_where_it_is_the_one_of_this_name(algorithm):
    text = values_of(run_address(safe.Experiment(algorithm, "maze1"), 0))["algorithm"]
    found = algorithm_of(text)
    assert found.content == algorithm.content
    assert (":" in text) == (algorithm not in safe.ALGORITHMS.values())
    assert found.name == algorithm.name.replace(":", " ")


def test_an_address_is_readable():
    fixed = safe.Experiment(safe.Algorithm("fixed", [(0.25, 0.75)]), "maze2", parameters=safe.Parameters(steps=7))
    address = f"view=watch&maze=maze2&algorithm=fixed:none:0.25,0.75&seed=0x{fixed.digest}/12&steps=7"
    assert run_address(fixed, np.int64(12)) == address
    nobody = safe.Experiment(safe.Algorithm("a & b", []), "maze1")
    assert run_address(nobody, 0).startswith("view=watch&maze=maze1&algorithm=a%20%26%20b:none:&seed=0x")
    judged = safe.Algorithm("judged", None, "genotypic novelty", judging="drawn judge")
    choosing = safe.Experiment(judged, "maze1", parameters=safe.Parameters(admission="random", admitted=9))
    address = f"algorithm=judged:genotypic:drawn:raw:drawn&seed=0x{choosing.digest}/0&admission=random&admitted=9"
    assert run_address(choosing, 0) == f"view=watch&maze=maze1&{address}"
    goals = safe.Algorithm("goals", None, "mutualism", judging="favourite", kind="goal", pool="repertoire")
    exploring = safe.Experiment(goals, "maze1", parameters=safe.Parameters(patience=3))
    address = "algorithm=goals:mutualism:drawn:raw:favourite:goal:repertoire:distance,novelty"
    assert run_address(exploring, 0) == f"view=watch&maze=maze1&{address}&seed=0x{exploring.digest}/0&patience=3"
    weighing = safe.Experiment(safe.Algorithm("w", [(1, 2)], components=("path rarity", "1 / way")), "maze1")
    assert run_address(weighing, 0)[22:].startswith("algorithm=w:none:1.0,2.0:raw:best:weights:generation:rarity,way&")


@needs_node
def test_the_page_reads_and_writes_the_same_addresses():
    experiments = [
        safe.Experiment(a, "maze1", parameters=p) for a in ALGORITHMS for p in (safe.Parameters(), FEW, MORE, LATER)
    ]
    addresses = [run_address(experiment, 1) for experiment in experiments]
    known = "view=watch&maze=maze1&seed=1&algorithm="
    same = [f"{known}{algorithm}" for algorithm in SAME]
    wrong = [f"{known}mine:{rest}" for rest in WRONG]
    script = f"""{bundle.script(("address.js",))}
        const {{ readAddress, writeAddress }} = playground();
        const told = (text) => {{
            try {{
                const state = {{ parameters: {{}}, ...readAddress(text) }};
                return [...state.algorithms, state.parameters, writeAddress(state)];
            }} catch (error) {{
                return error.message;
            }}
        }};
        console.log(JSON.stringify({json.dumps([*addresses, *same, *wrong])}.map(told)));"""
    found = json.loads(subprocess.run([NODE, "-"], input=script, capture_output=True, text=True, check=True).stdout)
    for experiment, address in zip(experiments, addresses, strict=True):
        algorithm, parameters, written = found.pop(0)
        assert safe.Algorithm(**algorithm).content == experiment.algorithm.content
        assert safe.Parameters(**parameters) == experiment.parameters
        assert list(values_of(written)) == list(values_of(address))
        assert algorithm_of(values_of(written)["algorithm"]).content == experiment.algorithm.content
    assert found[: len(SAME)] == [found[0]] * len(SAME)
    refusal = (
        "algorithm must be a name, or name:rating:a,b,..., perhaps with :scaling:judging, and then :kind:pool:compo"
    )
    assert [message[: len(refusal)] for message in found[len(SAME) :]] == [refusal] * len(WRONG)


@needs_node
def test_the_page_reads_every_address_that_a_text_of_the_book_links_to():
    texts = [*(ROOT / "book").glob("*.md"), *(ROOT / "notebooks").glob("*.ipynb")]
    link = re.compile(r'href=\\?"(?:[\w./]*playground\.html)?#(view=[^"\\]*)')
    addresses = [address for text in texts for address in link.findall(text.read_text(encoding="utf-8"))]
    assert len(addresses) > 20
    script = f"""{bundle.script(("address.js",))}
        const {{ readAddress }} = playground();
        const refusal = (address) => {{
            try {{
                readAddress(address);
            }} catch (error) {{
                return `${{address}}: ${{error.message}}`;
            }}
        }};
        console.log(JSON.stringify({json.dumps(addresses)}.map(refusal).filter((text) => text)));"""
    found = subprocess.run([NODE, "-"], input=script, capture_output=True, text=True, check=True).stdout
    assert json.loads(found) == []


@given(maze=mazes(), controller=controllers())
def test_a_robot_is_driven_in_the_same_maze_by_the_same_controller(maze, controller):
    values = values_of(drive_address(maze, controller))
    assert values["view"] == "drive"
    assert maze_of(values["maze"]) == maze
    assert [float(number) for number in values["controller"].split(",")] == controller.tolist()


def test_a_maze_is_written_by_name_where_it_is_the_one_of_this_name():
    maze1 = safe.load_maze("maze1")
    assert drive_address(maze1) == drive_address("maze1") == "view=drive&maze=maze1"
    for named, as_cells in ((("maze1", "mine"), True), (("maze2", "maze1"), True), (("maze2", "maze2"), False)):
        original = safe.load_maze(named[0])
        other = safe.Maze(original.walls, original.start, original.goal, named[1])
        text = values_of(drive_address(other))["maze"]
        assert ("/" in text) == as_cells
        assert maze_of(text) == original


@pytest.mark.parametrize("run", [-1, 1.5, "1", None])
def test_a_run_that_is_none(run):
    with pytest.raises(ValueError, match="run must be an integer of at least 0; got"):
        run_address(safe.Experiment("safe", "maze1"), run)


@pytest.mark.parametrize("controller", [[0] * 15, [2] * 16, ["a"] * 16, [float("nan")] * 16])
def test_a_controller_that_is_none(controller):
    with pytest.raises(ValueError, match="controller must "):
        drive_address("maze1", controller)


def test_a_maze_that_is_none():
    with pytest.raises(
        ValueError,
        match="maze must be one of 'hard', 'maze1', 'maze2', 'medium' or the path of a maze file; got 'maze3'",
    ):
        drive_address("maze3")
