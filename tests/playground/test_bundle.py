import json
import subprocess

import pytest

from safe.maze_files import packaged_mazes, parse_maze
from safe.playground import bundle
from tests.helpers.twin import NODE, needs_node

ENTRY = ("entry.js",)


@pytest.fixture
def write(tmp_path):
    """Write modules, given by their names without ending."""

    def write(**modules):
        for name, text in modules.items():
            (tmp_path / f"{name}.js").write_text(text)
        return tmp_path

    return write


def node(text):
    """What a script logs."""
    run = subprocess.run([NODE, "-"], input=text, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    return run.stdout


@needs_node
def test_modules_become_one_function(write):
    folder = write(
        entry="""
// the entry
import { counts } from "./all.js";
import {
  TWO,
  Pair,
} from "./base.js";

export const sum = (pair) => pair.first + pair.second + hidden();
export async function later() { return new Pair(TWO, 1); }
export function numbers() { return [...counts(TWO)]; }
function hidden() { return 100; }
""",
        all='export { counts } from "./counts.js";\nexport { TWO } from "./base.js";\n',
        counts='import { TWO } from "./base.js";\nexport function* counts(n) { yield 0; yield n; yield TWO + 1; }',
        base="export const TWO = 2;\nexport class Pair { constructor(a, b) { this.first = a; this.second = b; } }\n",
    )
    text = bundle.script(ENTRY, folder)
    assert text.startswith("function playground() {\n")
    assert text.count("TWO=2") == 1
    log = node(
        f"{text}\nconst {{ sum, later, numbers, makeWorker, ...others }} = playground();\n"
        "console.log(numbers(), Object.keys(others)); later().then((pair) => console.log(sum(pair)));"
    )
    assert log == "[ 0, 2, 3 ] []\n103\n"


@needs_node
def test_a_method_may_be_called_import(write):
    folder = write(entry="export class Taker { #import() { return 7; } take() { return this.#import(); } }\n")
    assert node(bundle.script(ENTRY, folder) + "console.log(new (playground().Taker)().take());") == "7\n"


@needs_node
def test_a_worker_holds_the_same_modules(write):
    folder = write(entry='export function serve(scope) { scope.greeting = greeting; }\nconst greeting = "ready";\n')
    log = node(
        bundle.script(ENTRY, folder)
        + """
globalThis.Blob = class { constructor(parts, options) { this.text = parts.join(""); this.type = options.type; } };
URL.createObjectURL = (blob) => blob;
globalThis.Worker = class {
  constructor(blob) { (0, eval)("self = {}; " + blob.text); console.log(blob.type, self.greeting); }
};
playground().makeWorker();
"""
    )
    assert log == "text/javascript ready\n"


@needs_node
def test_what_is_left_out_means_nothing(write):
    folder = write(
        entry=r"""
/** Everything that
 * looks like a comment. */
export const TEXTS = [ // odd ones
  "a // b", // "c" and 'd'
  'a // b',   // e

  `a // b`, // the `same` again
  // a ` of its own
  `  a // ${["b", "  c // d"].map((one) => `${one} // e`)} f
    // g

  h`, // i
  /[ // ]/.source,
  8 / 4 // 2
  / 2, // 1 / 2
];
"""
    )
    text = bundle.script(ENTRY, folder)
    log = json.loads(node(text + "console.log(JSON.stringify(playground().TEXTS));"))
    inside = "  a // b // e,  c // d // e f\n    // g\n\n  h"
    assert log == ["a // b", "a // b", "a // b", inside, "[ // ]", 1]
    assert "odd" not in text
    assert "// e\n" not in text
    assert "\nTEXTS" not in text


@needs_node
def test_blanks_that_mean_something_stay(write):
    folder = write(
        entry="""
export function odd(a, b = { c: 1 }) {
  return a > 0 ? .5 - -b.c + +a : [ a, - - 2, a ** 2 ];
}
export const text = "a = b ( c )";
export const pattern = /a ? =/;
"""
    )
    log = node(
        bundle.script(ENTRY, folder) + "const p = playground(); console.log(p.odd(1), p.odd(0), p.text, p.pattern);"
    )
    assert log == "2.5 [ 0, 2, 0 ] a = b ( c ) /a ? =/\n"


@pytest.mark.parametrize(
    ("modules", "complaint"),
    [
        ({}, r"the playground must import a module in .*; got entry.js .No such file or directory."),
        (
            {"entry": 'import { a } from "./none.js";\n'},
            r"entry.js must import a module in .*; got none.js .No such file or directory.",
        ),
        (
            {"entry": 'import { a, b, c } from "./base.js";\n', "base": "export const b = 1;\nconst a = 2;\n"},
            "entry.js must import what base.js exports; got a, c",
        ),
        (
            {
                "entry": 'export { a } from "./base.js";\nimport { b } from "./base.js";',
                "base": "export const a = 1;\n",
            },
            "entry.js must import what base.js exports; got b",
        ),
        (
            {
                "entry": 'import { a } from "./base.js";\nfunction b() {}\n',
                "base": "export const a = 1, c = 2;\nclass b {}\n",
            },
            "base.js must not declare b; entry.js does",
        ),
        ({"entry": "export const tick = '`';\n"}, "entry.js must hold ` in pairs, .*; got an odd number"),
        (
            {"entry": 'import { a as b } from "./base.js";', "base": "export const a = 1;\n"},
            "entry.js must import what base.js exports; got a as b",
        ),
    ],
)
def test_modules_that_do_not_fit_together(write, modules, complaint):
    with pytest.raises(ValueError, match=f"^{complaint}$"):
        bundle.script(ENTRY, write(**modules))


def test_a_circle_of_imports(write):
    folder = write(
        entry='import { a } from "./base.js";\nexport const b = 1;\n',
        base='import { b } from "./entry.js";\nexport const a = 1;\n',
    )
    with pytest.raises(
        ValueError, match=r"^modules must not import one another in a circle; got .*entry\.js from .*entry.js"
    ):
        bundle.script(ENTRY, folder)


@pytest.mark.parametrize(
    "line",
    [
        'import * as base from "./base.js";',
        'import base from "./base.js";',
        'import "./base.js";',
        'import { a } from "https://example.org/base.js";',
        'import { a } from "./base.js"',
        "export default 1;",
        "export { a };",
        "export const { a } = {};",
        'const base = await import("./base.js");',
        "const here = import.meta.url;",
    ],
)
def test_other_forms_are_refused(write, line):
    with pytest.raises(ValueError, match=r"^entry\.js must import and export as bundle\.py reads it; got '"):
        bundle.script(ENTRY, write(entry=f"{line}\n", base="export const a = 1;\n"))


@needs_node
def test_the_mazes_of_the_package_are_a_module(write):
    folder = write(entry='export { PACKAGED_MAZES } from "./packaged_mazes.js";\n')
    log = node(bundle.script(ENTRY, folder) + "console.log(JSON.stringify(playground().PACKAGED_MAZES));")
    texts = json.loads(log)
    assert {name: parse_maze(text, name) for name, text in texts.items()} == packaged_mazes()
    assert "#" not in "".join(texts.values())


@needs_node
def test_the_playground_is_bundled():
    text = bundle.script()
    parts = node(
        text
        + "const { mount, mountFigure, serve, makeWorker, ...more } = playground(); console.log(Object.keys(more));"
    )
    assert parts == "[]\n"
