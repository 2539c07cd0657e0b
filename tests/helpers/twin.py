"""The engine of the playground, called from Python: in Node, in a worker of a page, and in the page itself."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Callable, Sequence
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import urljoin

import numpy as np
import pytest

from safe import Algorithm, Maze, Parameters
from safe.evolution import Generation, Run, Seed
from tests.helpers.browser import chromium, needs_browser, serving

ROOT = Path(__file__).parents[2]
NODE = shutil.which("node")

needs_node = pytest.mark.skipif(NODE is None, reason="no Node found: install Debian's nodejs")

IN_WORKER = """text => new Promise((resolve, reject) => {
    globalThis.worker ??= new Worker("worker.mjs", { type: "module" });
    worker.onmessage = ({ data }) => resolve(data);
    worker.onerror = ({ message }) => reject(new Error(message ?? "the worker's modules cannot be loaded"));
    worker.postMessage(text);
})"""
IN_PAGE = "async text => (await import(new URL('call.mjs', document.baseURI))).answer(text)"


class Twin:
    """The engine, reached by a function that takes the text of calls and gives the text of answers (see call.mjs)."""

    def __init__(self, exchange: Callable[[str], str]) -> None:
        self._exchange = exchange

    def answers(self, calls: Sequence[dict]) -> list[dict]:
        """The answer to each call {"function": ..., arguments by name}: a `result`, or an `error` and its `stack`."""
        return json.loads(self._exchange(json.dumps(list(calls), allow_nan=False)))

    def results(self, calls: Sequence[dict]) -> list:
        """The results of calls, none of which may fail."""
        calls = list(calls)
        answers = self.answers(calls)
        for call, answer in zip(calls, answers, strict=True):
            assert "result" in answer, f"{call}: {answer['stack']}"
        return [answer["result"] for answer in answers]


@contextmanager
def in_node():
    """The twin in Node."""
    with subprocess.Popen(
        [NODE, Path(__file__).parent / "javascript" / "node.mjs"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        encoding="utf-8",
    ) as node:

        def exchange(text: str) -> str:
            node.stdin.write(text + "\n")
            node.stdin.flush()
            line = node.stdout.readline()
            assert line, "Node has ended; stderr says why"
            return line

        yield Twin(exchange)


@contextmanager
def in_browser(script: str = IN_WORKER):
    """The twin in Chromium: in a worker, or in the page."""
    with serving(ROOT) as address, chromium() as browser:
        page = browser.new_page()
        page.goto(urljoin(address, "tests/helpers/javascript/"))
        yield Twin(lambda text: page.evaluate(script, text))


TWINS = (
    pytest.param(in_node, marks=needs_node, id="Node"),
    pytest.param(in_browser, marks=needs_browser, id="Chromium"),
)


# Arguments and results of the package, in the form of the engine


def algorithm_of(algorithm: Algorithm | str) -> dict | str:
    if isinstance(algorithm, str):
        return algorithm
    return {"name": algorithm.name, **algorithm.content}


def seed_of(seed: Seed) -> object:
    if isinstance(seed, np.random.SeedSequence):
        return {"entropy": seed_of(seed.entropy), "spawnKey": seed_of(list(seed.spawn_key))}
    if isinstance(seed, Sequence):
        return [seed_of(word) for word in seed]
    return seed if seed < 2**53 else hex(seed)


def run_of(function: str, maze: Maze, algorithm: Algorithm | str, seed: Seed, parameters: Parameters) -> dict:
    """A call of `evolve` or `generations`."""
    return {
        "function": function,
        "maze": maze.drawing(),
        "algorithm": algorithm_of(algorithm),
        "seed": seed_of(seed),
        "parameters": parameters.departures,
    }


def as_in_engine(run: Run) -> dict:
    """A run or a generation of the package, in the form of the engine."""
    fields = {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in vars(run).items()}
    if isinstance(run, Generation):
        fields["objectiveFitness"] = fields.pop("objective_fitness")
        fields["chosenBy"] = fields.pop("chosen_by")
        if run.repertoire is not None:
            genomes, endpoints = run.repertoire
            fields["repertoire"] = {"genomes": genomes.tolist(), "endpoints": endpoints.tolist()}
        for name, key in (("archive", "archive"), ("objective_archive", "objectiveArchive")):
            points, scores = fields.pop(name)
            fields[key] = {"points": points.tolist(), "scores": scores.tolist()}
    return json.loads(json.dumps(fields))
