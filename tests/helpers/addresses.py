"""Addresses of the playground, read as its page reads them."""

import base64
from urllib.parse import unquote

import numpy as np

import safe
from safe.judges import RATINGS, SCALINGS
from safe.operators import JUDGINGS


def values_of(address):
    """The values of an address by their keys, unescaped as a browser does."""
    return {key: unquote(value) for key, value in (part.split("=") for part in address.split("&"))}


def maze_of(text):
    if "/" not in text:
        return safe.load_maze(text)
    size, start, goal, bits = text.split("/")
    height, width = map(int, size.split("x"))
    packed = np.frombuffer(base64.urlsafe_b64decode(bits + "=" * (-len(bits) % 4)), dtype=np.uint8)
    assert len(packed) == -(-height * width // 8)
    walls = np.unpackbits(packed, count=height * width).reshape(height, width)
    return safe.Maze(walls, *(tuple(map(int, cell.split(","))) for cell in (start, goal)))


def algorithm_of(text):
    if ":" not in text:
        return safe.ALGORITHMS[text]
    name, rating, objectives, *more = text.split(":")
    numbers = [float(number) for number in objectives.split(",")] if objectives not in ("drawn", "") else []
    pairs = None if objectives == "drawn" else list(zip(numbers[::2], numbers[1::2], strict=True))
    choices = [(RATINGS, rating), *zip((SCALINGS, JUDGINGS), more, strict=bool(more))]
    return safe.Algorithm(
        name, pairs, *(next(choice for choice in allowed if choice.split()[0] == code) for allowed, code in choices)
    )


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
