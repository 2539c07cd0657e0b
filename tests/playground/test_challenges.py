"""Every challenge of the playground can be solved, and is not solved where it begins."""

import json
import re
import subprocess

import pytest

import safe
from safe.maze_files import parse_maze
from safe.playground import bundle
from safe.playground.address import drive_address
from tests.helpers.addresses import algorithm_of, maze_of
from tests.helpers.twin import NODE, needs_node

pytestmark = needs_node

TEXT = (bundle.FOLDER / "named_mazes.js").read_text(encoding="utf-8")
MAZES = dict(re.findall(r"^  (\w+): `(.*?)`", TEXT, re.DOTALL | re.MULTILINE))
WALLS = ("wall 25,15 25,25\n", "wall 20,15 25,15\n")  # of the spiral, that another spiral lacks
OTHER_SPIRAL = parse_maze(MAZES["spiral"].replace(WALLS[0], "").replace(WALLS[1], ""))
PATHS = "safe:genotypic:drawn:raw:best:weights:generation:novelty,rarity"
SOLUTIONS = {  # what each changes of the address with which its challenge begins
    1: {"controller": "0,0,0,-1,0,0,0,0,0,0,0,0,0,0,0,-1"},
    2: {"controller": "0,0,0,0,0.5,0,-1,0,0,-1,0,0,0,0,0,0"},
    3: {},  # see below
    4: {"view": "runs", "maze": drive_address(OTHER_SPIRAL).split("maze=")[1]},
    5: {"view": "runs", "maze": drive_address(OTHER_SPIRAL).split("maze=")[1]},
    6: {"archive": "0"},
    7: {"algorithm": ["fixed:none:0.999,0.001"]},
    8: {"algorithm": ["fixed"], "population": "40", "generations": "50", "mutation": "1"},
    9: {"algorithm": [PATHS, "novelty"]},
    10: {"algorithm": [PATHS]},
}


def asked(expression):
    """What an expression gives in JavaScript."""
    script = f"""{bundle.script(("challenges.js", "address.js"))}
        const {{ CHALLENGES, MOST_CHALLENGES, beginningOf, isSolved, readAddress }} = playground();
        console.log(JSON.stringify({expression}));"""
    return json.loads(subprocess.run([NODE, "-"], input=script, capture_output=True, text=True, check=True).stdout)


def values_of(address):
    """The values of an address; those of algorithms in a list."""
    values = {"algorithm": []}
    for key, value in (part.split("=", 1) for part in address.split("&")):
        if key == "algorithm":
            values[key].append(value)
        else:
            values[key] = value
    return values


def outcomes_of(values):
    """For each algorithm how many of the runs of an address succeed, as the package makes them."""
    sizes = {name: values[name] for name in vars(safe.Parameters()) if name in values}
    parameters = safe.Parameters(**{name: (int if text.isdigit() else float)(text) for name, text in sizes.items()})
    maze = parse_maze(MAZES[values["maze"]]) if values["maze"] in MAZES else maze_of(values["maze"])
    algorithms, runs = map(algorithm_of, values["algorithm"]), int(values["runs"])
    return [
        {"runs": runs, "successes": sum(safe.evolve(maze, algorithm, i, parameters).success for i in range(runs))}
        for algorithm in algorithms
    ]


def is_solved(number, values):
    """Does the page say that an address solves a challenge?"""
    outcomes = outcomes_of(values) if "runs" in values else []
    pairs = [(key, one) for key, value in values.items() for one in (value if key == "algorithm" else [value])]
    address = "&".join(f"{key}={value}" for key, value in pairs)
    return asked(f"""(() => {{
        const challenge = CHALLENGES[{number - 1}];
        const state = {{ ...beginningOf(challenge), generation: 0, ...readAddress({json.dumps(address)}) }};
        const outcomes = {json.dumps(outcomes)}.map((one, i) => ({{ ...one, algorithm: state.algorithms[i] }}));
        return isSolved(challenge, state, outcomes);
    }})()""")


@pytest.fixture(scope="module")
def beginnings():
    return [values_of(address) for address in asked("CHALLENGES.map(({ address }) => address)")]


def test_there_are_ten(beginnings):
    assert len(beginnings) == len(SOLUTIONS) == asked("MOST_CHALLENGES")


@pytest.mark.parametrize("number", SOLUTIONS)
def test_it_can_be_solved(beginnings, number):
    beginning = beginnings[number - 1]
    solution = SOLUTIONS[number]
    if number == 3:
        sizes = {name: int(beginning[name]) for name in ("population", "objectives", "generations")}
        run = safe.generations(parse_maze(MAZES["trap"]), "novelty", int(beginning["seed"]), safe.Parameters(**sizes))
        solution = {"generation": str(next(one.generation for one in run if one.distance < 7))}
    assert not is_solved(number, beginning)
    assert is_solved(number, beginning | solution)


def test_other_settings_do_not_solve_it(beginnings):
    solution = beginnings[0] | SOLUTIONS[1]
    assert not is_solved(1, solution | {"maze": "trap"})
    assert not is_solved(1, solution | {"success_distance": "60"})
    assert not is_solved(1, solution | {"controller": "0,0,0,-1,0,0,0,0,0,0,0,0,0,0.5,0,-1"})
    forgetful = beginnings[5] | SOLUTIONS[6]
    assert not is_solved(6, forgetful | {"generations": "1"})
    assert not is_solved(6, forgetful | {"seed": "7"})
    assert not is_solved(6, forgetful | {"runs": "3"})
