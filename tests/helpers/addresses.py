"""Addresses of the playground, read as its page reads them."""

import base64
import re
from pathlib import Path
from urllib.parse import unquote

import numpy as np

import safe
from safe.algorithms import WEIGHABLE
from safe.judges import KINDS, RATINGS, SCALINGS
from safe.maze_files import packaged_mazes, parse_maze
from safe.operators import JUDGINGS
from safe.repertoire import POOLS

CHOICES = {"rating": RATINGS, "scaling": SCALINGS, "judging": JUDGINGS, "kind": KINDS, "pool": POOLS}
LATER = "scaling", "judging", "kind", "pool", "components"  # choices, behind the objective functions


def values_of(address):
    """The values of an address by their keys, unescaped as a browser does."""
    return {key: unquote(value) for key, value in (part.split("=") for part in address.split("&"))}


def maze_of(text):
    if "/" not in text:
        return packaged_mazes().get(text) or _maze_of_playground(text)
    size, start, goal, bits = text.split("/")
    height, width = map(int, size.split("x"))
    packed = np.frombuffer(base64.urlsafe_b64decode(bits + "=" * (-len(bits) % 4)), dtype=np.uint8)
    assert len(packed) == -(-height * width // 8)
    walls = np.unpackbits(packed, count=height * width).reshape(height, width)
    return safe.Maze(walls, *(tuple(map(int, cell.split(","))) for cell in (start, goal)))


def _maze_of_playground(name):
    modules = Path(safe.__file__).parent / "playground" / "javascript"
    named = (modules / "named_mazes.js").read_text(encoding="utf-8")
    return parse_maze(re.search(rf"^  {name}: `(.*?)`", named, re.DOTALL | re.MULTILINE).group(1), name)


def algorithm_of(text):
    if ":" not in text:
        return safe.ALGORITHMS[text]
    name, rating, objectives, *more = text.split(":")
    codes = {"rating": rating, **dict(zip(LATER, more, strict=False))}
    assert len(codes) in (1, 3, 6)
    choices = {field: choice_of(field, code) for field, code in codes.items()}
    if objectives == "drawn":
        return safe.Algorithm(name, **choices)
    genes = [float(number) for number in objectives.split(",")] if objectives else []
    width = safe.Algorithm(name, **choices).genes if genes else 1
    return safe.Algorithm(name, [genes[i : i + width] for i in range(0, len(genes), width)], **choices)


def choice_of(field, code):
    if field == "components":
        return tuple(next(name for name in WEIGHABLE if name.split()[-1] == one) for one in code.split(","))
    return next(choice for choice in CHOICES[field] if choice.split()[0] == code)


def seed_of(text):
    entropy, run = text.split("/")
    return np.random.SeedSequence(int(entropy, 0), spawn_key=(int(run),))


def run_at(address):
    """The run that an address says, made from it alone."""
    values = values_of(address)
    assert values.pop("view") == "watch"
    maze, algorithm, seed = (values.pop(key) for key in ("maze", "algorithm", "seed"))
    admission = {"admission": values.pop("admission")} if "admission" in values else {}
    own = admission | {name: (int if value.isdigit() else float)(value) for name, value in values.items()}
    return safe.evolve(maze_of(maze), algorithm_of(algorithm), seed_of(seed), safe.Parameters(**own))
