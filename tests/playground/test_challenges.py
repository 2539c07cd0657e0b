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
    3: {},  # see the test
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


def answers(cases):
    """For each challenge and address (number, values): does the page say that this solves it?"""
    asked_for = []
    for number, values in cases:
        pairs = [(key, one) for key, value in values.items() for one in (value if key == "algorithm" else [value])]
        address = "&".join(f"{key}={value}" for key, value in pairs)
        asked_for.append([number, address, outcomes_of(values) if "runs" in values else []])
    return asked(f"""{json.dumps(asked_for)}.map(([number, address, outcomes]) => {{
        const challenge = CHALLENGES[number - 1];
        const state = {{ ...beginningOf(challenge), generation: 0, ...readAddress(address) }};
        return isSolved(challenge, state, outcomes.map((one, i) => ({{ ...one, algorithm: state.algorithms[i] }})));
    }})""")


@pytest.fixture(scope="module")
def beginnings():
    return [values_of(address) for address in asked("CHALLENGES.map(({ address }) => address)")]


def test_there_are_ten(beginnings):
    assert len(beginnings) == len(SOLUTIONS) == asked("MOST_CHALLENGES")


def test_each_can_be_solved_and_is_not_solved_at_first(beginnings):
    third = beginnings[2]
    sizes = {name: int(third[name]) for name in ("population", "objectives", "generations")}
    run = safe.generations(parse_maze(MAZES["trap"]), "novelty", int(third["seed"]), safe.Parameters(**sizes))
    first_out = next(generation.generation for generation in run if generation.distance < 7)
    assert first_out > 5
    solutions = SOLUTIONS | {3: {"generation": str(first_out)}}
    assert answers(enumerate(beginnings, 1)) == [False] * 10
    assert answers((n, beginning | solutions[n]) for n, beginning in enumerate(beginnings, 1)) == [True] * 10


def test_other_settings_do_not_solve_it(beginnings):
    by_hand, forgetful = beginnings[0] | SOLUTIONS[1], beginnings[5] | SOLUTIONS[6]
    cases = [
        (1, by_hand | {"maze": "trap"}),
        (1, by_hand | {"success_distance": "60"}),
        (1, by_hand | {"controller": "0,0,0,-1,0,0,0,0,0,0,0,0,0,0.5,0,-1"}),
        (3, beginnings[2] | {"generation": "5"}),
        (6, forgetful | {"generations": "1"}),
        (6, forgetful | {"seed": "7"}),
        (6, forgetful | {"runs": "3"}),
    ]
    assert answers(cases) == [False] * len(cases)
