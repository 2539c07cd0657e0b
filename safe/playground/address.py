"""Addresses in the playground, the page of the book that runs SAFE in the browser.

An address is the part of the page's URL behind the `#`, `key=value&key=value`, and describes all that the page shows::

    view         `watch` a run, `drive` a robot by its controller, or make many `runs`
    maze         a packaged maze's name, or the cells of any maze: HEIGHTxWIDTH/row,column of the start/row,column of
                 the goal/walls; the walls are bits, row by row, in base64url without padding
    algorithm    its name in `safe.ALGORITHMS`, or name:rating:objectives, then :scaling:judging and then
                 :kind:pool:components unless they, and all behind them, are the paper's; the objectives are `drawn`,
                 or the genes of one after the other, a,b,a,b,... (empty: nobody judges); the components are separated
                 by commas; each of these by its last word, any other choice by its first
    seed         an integer or several, separated by commas, then perhaps a slash and the spawn key; a run of an
                 experiment has the experiment's digest and the number of the run
    controller   the sixteen weights, separated by commas
    runs         how many of each algorithm, in the view `runs`
    class, seats the name of a class that shares the runs of experiments, and how many seats it has
    ...          any of `safe.Parameters` by its name, if it departs from the paper's

Numbers are written so that reading them gives exactly the same values: an address opens exactly the same run.
"""

from __future__ import annotations

import base64
import re
from collections.abc import Iterable, Sequence
from dataclasses import fields
from urllib.parse import quote, unquote

import numpy as np

from safe import checks
from safe.algorithms import ALGORITHMS, WEIGHABLE, Algorithm, Parameters, get_algorithm
from safe.evolution import Seed, seed_sequence
from safe.experiments.experiment import Experiment
from safe.judges import KINDS, RATINGS, SCALINGS
from safe.maze import Maze
from safe.maze_files import is_packaged, load_maze, packaged_mazes
from safe.operators import JUDGINGS
from safe.repertoire import POOLS
from safe.robot import WEIGHTS

READABLE = "!~*'(),:/"  # left as they are by encodeURIComponent, or used in our values
_NUMBER = r"(?:0x[0-9a-fA-F]{1,64}|[0-9]{1,80})"
_SEED = re.compile(rf"({_NUMBER}(?:,{_NUMBER})*)(?:/({_NUMBER}(?:,{_NUMBER})*))?")
_PARAMETERS = {field.name: field.type for field in fields(Parameters)}
_CHOICES = {"rating": RATINGS, "scaling": SCALINGS, "judging": JUDGINGS, "kind": KINDS, "pool": POOLS}
_LARGEST = 2**256 - 1  # number in a seed; as large as the digest of an experiment
_POOL_SIZE = np.random.SeedSequence(0).pool_size  # the only one that the page supports


def run_address(experiment: Experiment, run: int) -> str:
    """The address at which the playground shows one run of an experiment.

    Raises
    ------
    ValueError
        If the run is not a non-negative integer.

    Examples
    --------
    >>> run_address(Experiment("safe", "maze1", seed=3), 7)[:50]
    'view=watch&maze=maze1&algorithm=safe&seed=0xc59dd4'
    >>> run_address(Experiment(Algorithm("mine", rating="pearson", judging="drawn judge"), "maze1"), 7)[22:65]
    'algorithm=mine:pearson:drawn:raw:drawn&seed'
    >>> goals = Experiment(Algorithm("mine", judging="favourite", kind="goal"), "maze1")
    >>> run_address(goals, 7)[22:99]
    'algorithm=mine:none:drawn:raw:favourite:goal:generation:distance,novelty&seed'
    >>> from safe import Parameters
    >>> run_address(Experiment("safe", "maze1", parameters=Parameters(population=50, mutation=0.1)), 7)[-29:]
    '/7&population=50&mutation=0.1'
    """
    run = checks.integer("run", run, 0)
    return _address(
        ("view", "watch"),
        ("maze", _maze(experiment.maze)),
        ("algorithm", _algorithm(experiment.algorithm)),
        ("seed", f"0x{experiment.digest}/{run}"),
        *((name, str(value)) for name, value in experiment.parameters.departures.items()),
    )


def side_by_side_address(maze: Maze | str, algorithms: Iterable[Algorithm | str], seed: Seed) -> str:
    """The address at which the playground shows runs of several algorithms beside each other, with the same seed.

    Raises
    ------
    ValueError
        If a name is unknown, or the seed is not valid (see `seed_text`).

    Examples
    --------
    >>> side_by_side_address("maze1", ["safe", Algorithm("frozen")], seed=7)
    'view=watch&maze=maze1&algorithm=safe&algorithm=frozen:none:drawn&seed=7'
    """
    shown = [("algorithm", _algorithm(get_algorithm(algorithm))) for algorithm in algorithms]
    return _address(("view", "watch"), ("maze", _maze(load_maze(maze))), *shown, ("seed", seed_text(seed)))


def drive_address(maze: Maze | str, controller: np.ndarray | None = None) -> str:
    """The address at which the playground drives a robot in a maze, by this controller if one is given.

    Parameters
    ----------
    maze : Maze or str
        The maze, or its name.
    controller : array of float, shape (16,), optional
        The weights p_1..p_16, each in [-1, 1], to start with.

    Raises
    ------
    ValueError
        If the controller does not hold 16 finite numbers in [-1, 1].

    Examples
    --------
    >>> drive_address("maze2")
    'view=drive&maze=maze2'
    >>> drive_address(Maze.from_drawing("S..\\n.#.\\n..G"), [0.5] + [0] * 15)
    'view=drive&maze=3x3/0,0/2,2/CAA&controller=0.5,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0'
    """
    values = [("view", "drive"), ("maze", _maze(load_maze(maze)))]
    if controller is not None:
        values.append(("controller", _numbers(checks.array("controller", controller, (WEIGHTS,), -1, 1))))
    return _address(*values)


def class_address(
    name: str, seats: int, runs: int, algorithms: Sequence[Algorithm], maze: Maze, seed: int, parameters: Parameters
) -> str:
    """The link of a class that shares the runs of experiments (see `safe.playground.lines`)."""
    return _address(
        ("view", "runs"),
        ("maze", _maze(maze)),
        *(("algorithm", _algorithm(algorithm)) for algorithm in algorithms),
        ("seed", str(seed)),
        *((name, str(value)) for name, value in parameters.departures.items()),
        ("runs", str(runs)),
        ("class", name),
        ("seats", str(seats)),
    )


def read_class_address(text: str) -> dict[str, object]:
    """The arguments of `class_address` that gave an address.

    Raises
    ------
    ValueError
        If the address is not that of a class, or names what does not exist.
    """
    pairs = [(key, unquote(value, errors="strict")) for key, value in re.findall(r"([^&=]+)=([^&]*)", text)]
    values = dict(pairs)
    algorithms = [_read_algorithm(value) for key, value in pairs if key == "algorithm"]
    if values.get("view") != "runs" or not algorithms or not {"maze", "seed", "runs", "class", "seats"} <= set(values):
        raise ValueError(f"an address of a class must name all that its runs need; got {checks.shown(text)}")
    own = {key: value for key, value in pairs if key in _PARAMETERS}
    if unknown := set(values) - set(own) - {"view", "maze", "algorithm", "seed", "runs", "class", "seats"}:
        raise ValueError(f"an address must hold known keys; got {checks.shown(min(unknown))}")
    return {
        "name": values["class"],
        "seats": _read_integer("seats", values["seats"]),
        "runs": _read_integer("runs", values["runs"]),
        "algorithms": algorithms,
        "maze": _read_maze(values["maze"]),
        "seed": read_seed(values["seed"]),
        "parameters": Parameters(**{key: _read_parameter(key, value) for key, value in own.items()}),
    }


def seed_text(seed: Seed) -> str:
    """A seed as an address writes it.

    Raises
    ------
    ValueError
        If the seed is not valid, or if the page does not support it: numbers of more than 256 bits, or a pool that
        is not of numpy's usual size.

    Examples
    --------
    >>> seed_text(7), seed_text([1, 2]), seed_text(np.random.SeedSequence(2**255, spawn_key=(17,)))[-6:]
    ('7', '1,2', '000/17')
    """
    sequence = seed_sequence(seed)
    if sequence.pool_size != _POOL_SIZE:
        raise ValueError(f"seed must have a pool_size of {_POOL_SIZE}; got {sequence.pool_size}")
    entropy = sequence.entropy if isinstance(sequence.entropy, Iterable) else [sequence.entropy]
    parts = ([checks.integer("seed", word, 0, _LARGEST) for word in words] for words in (entropy, sequence.spawn_key))
    return "/".join(",".join(str(word) if word < 2**64 else hex(word) for word in words) for words in parts if words)


def read_seed(text: str) -> Seed:
    """The seed that `seed_text` wrote: an int or a tuple of ints, or with a spawn key a SeedSequence.

    Raises
    ------
    ValueError
        If the text does not describe a seed.

    Examples
    --------
    >>> read_seed("7"), read_seed("0xff,2"), read_seed("7/17").spawn_key
    (7, (255, 2), (17,))
    """
    found = _SEED.fullmatch(text) if isinstance(text, str) else None
    if not found:
        raise ValueError(
            f"seed must be 7 or 1,2,3, or either followed by a spawn key as in 7/17; got {checks.shown(text)}"
        )
    entropy, key = (_read_numbers(part) for part in found.groups(default=""))
    entropy = entropy if len(entropy) > 1 else entropy[0]
    return np.random.SeedSequence(entropy, spawn_key=key) if key else entropy


def _read_numbers(text: str) -> tuple[int, ...]:
    return tuple(int(word, 16 if word.startswith("0x") else 10) for word in text.split(",") if word)


def _address(*values: tuple[str, str]) -> str:
    return "&".join(f"{key}={quote(value, safe=READABLE)}" for key, value in values)


def _maze(maze: Maze) -> str:
    if is_packaged(maze):
        return maze.name
    (height, width), start, goal = maze.shape, maze.start, maze.goal
    bits = base64.urlsafe_b64encode(np.packbits(maze.walls).tobytes()).decode().rstrip("=")
    return f"{height}x{width}/{start[0]},{start[1]}/{goal[0]},{goal[1]}/{bits}"


def _algorithm(algorithm: Algorithm) -> str:
    if algorithm == ALGORITHMS.get(algorithm.name):
        return algorithm.name
    objectives = "drawn" if algorithm.objectives is None else _numbers(np.ravel(algorithm.objectives))
    parts = [algorithm.name.replace(":", " "), _code(algorithm.rating), objectives]  # a colon separates the parts
    later = [
        {"scaling": _code(algorithm.scaling), "judging": _code(algorithm.judging)},
        {
            "kind": _code(algorithm.kind),
            "pool": _code(algorithm.pool),
            "components": ",".join(component.split()[-1] for component in algorithm.components),
        },
    ]
    while later and algorithm.content.keys().isdisjoint(later[-1]):
        later.pop()
    return ":".join(parts + [code for codes in later for code in codes.values()])


def _code(choice: str) -> str:
    return choice.split()[0]


def _read_integer(name: str, text: str) -> int:
    if not re.fullmatch(r"[0-9]{1,80}", text):
        raise ValueError(f"{name} must be a number; got {checks.shown(text)}")
    return int(text)


def _read_parameter(name: str, text: str) -> int | float | str:
    if _PARAMETERS[name] == "str":
        return text
    number = float(text)
    return int(number) if _PARAMETERS[name] == "int" and number.is_integer() else number


def _read_maze(text: str) -> Maze:
    """The inverse of `_maze`."""
    if "/" not in text:
        return packaged_mazes()[checks.choice("maze", text, packaged_mazes())]
    found = re.fullmatch(r"(\d{1,4})x(\d{1,4})/(\d{1,4}),(\d{1,4})/(\d{1,4}),(\d{1,4})/([\w-]*)", text)
    if not found:
        raise ValueError(
            f"maze must be a name, or the cells of a maze as an address gives them; got {checks.shown(text)}"
        )
    height, width, *ends = map(int, found.groups()[:6])
    bits = found.group(7)
    packed = np.frombuffer(base64.urlsafe_b64decode(bits + "=" * (-len(bits) % 4)), np.uint8)
    if len(packed) != -(-height * width // 8):
        raise ValueError(f"maze must have a bit for each of its cells; got {checks.shown(text)}")
    walls = np.unpackbits(packed, count=height * width).reshape(height, width)
    return Maze(walls, tuple(ends[:2]), tuple(ends[2:]), "drawn")


def _read_algorithm(text: str) -> Algorithm:
    """The inverse of `_algorithm`."""
    name, *parts = text.split(":")
    if not parts:
        return get_algorithm(name)
    names = ["rating", "objectives", "scaling", "judging", "kind", "pool", "components"]
    if len(parts) not in (2, 4, 7):
        raise ValueError(f"algorithm must be a name, or name:rating:a,b,...; got {checks.shown(text)}")
    codes = dict(zip(names, parts, strict=False))
    choices = {field: _choice_of(field, code) for field, code in codes.items() if field in _CHOICES}
    if "components" in codes:
        choices["components"] = [_choice_of("components", code) for code in codes["components"].split(",")]
    if codes["objectives"] == "drawn":
        return Algorithm(name, None, **choices)
    genes = [float(gene) for gene in codes["objectives"].split(",") if gene]
    width = Algorithm(name, None, **choices).genes if genes else 1
    return Algorithm(name, [genes[at : at + width] for at in range(0, len(genes), width)], **choices)


def _choice_of(field: str, code: str) -> str:
    if field == "components":
        return next((name for name in WEIGHABLE if name.split()[-1] == code), code)
    return next((choice for choice in _CHOICES[field] if _code(choice) == code), code)


def _numbers(values: np.ndarray) -> str:
    return ",".join(map(repr, values.tolist()))
