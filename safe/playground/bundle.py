"""The playground's JavaScript modules as one script.

Modules cannot import one another in a page opened as a file, in a widget, or in a worker made from a text. Those of the
folder `javascript` keep to a few forms, so that no parser is needed to join them: a line begins with
`import { a, b } from "./x.js";`, with `export` before a function, const or class, or with
`export { a, b } from "./x.js";`; no two modules declare the same name at the beginning of a line; and the character `
comes in pairs. One module is not in the folder: `packaged_mazes.js` is written here, from the package's mazes.
"""

from __future__ import annotations

import json
import re
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from typing import NamedTuple

from safe.maze_files import MAZE_FOLDER, maze_names

FOLDER = Path(__file__).with_name("javascript")
ENTRIES = ("playground.js", "figure.js", "worker.js")  # export `mount` and `mountFigure`, and `serve` for workers
CLASS_ENTRIES = ("class_page.js", "worker.js")  # export `mountClass`, and the same

_FROM = re.compile(r'^(import|export)\s*\{([^{}]*)\}\s*from\s*"\./([^"/]+)";[^\S\n]*\n?', re.MULTILINE)
_DECLARATION = re.compile(
    r"^(export\s+)?((?:async\s+)?function\b\s*\*?\s*|(?:const|let|class)\s+)([\w$]+)", re.MULTILINE
)
_DESCRIPTION = re.compile(r"^[^\S\n]*/\*\*(?:(?!\*/).|\n)*\*/\n", re.MULTILINE)  # that fills its lines
_LAST_COMMENT = re.compile(r"\s+//[^\"'`/]*$")  # of a line; if it stood in a literal, the end of that would follow
_SPACED = re.compile(r" ?([=*<>{}(),:;?&|]) ?")
_MAY_HOLD_A_TEXT = re.compile("[\"'`/]")  # or a regular expression
_COMMENT_OF_A_LIST = re.compile(r"^#.*\n", re.MULTILINE)
_OTHER_FORM = re.compile(r"^(?:import|export)\b.*|(?<![\w$.#])import\s*(?:\(|\.\s*meta\b).*", re.MULTILINE)

# A worker is made from the text of the very function that makes it, so that it needs no address.
_BUNDLE = """\
function playground() {{
"use strict";

{modules}
let address;
function makeWorker() {{
  address ??= URL.createObjectURL(new Blob([`(${{playground}})().serve(self)`], {{ type: "text/javascript" }}));
  return new Worker(address);
}}

return {{ {exports}, makeWorker }};
}}
"""


class _Module(NamedTuple):
    imports: list[tuple[str, set[str]]]  # from which module, which names
    exports: set[str]
    names: list[str]  # declared at the beginning of a line
    body: str  # without imports and exports, shortened


def script(entries: tuple[str, ...] = ENTRIES, folder: Path = FOLDER) -> str:
    """A JavaScript function `playground()`, which holds all modules and returns what the entries export.

    It also returns `makeWorker()`, which gives a new worker that holds the same and has called `serve(self)`.

    Raises
    ------
    ImportError
        If there is no such folder.
    ValueError
        If a module is missing, is written in another form, imports what is not exported, or imports itself by way of
        others, or if two declare the same name.
    """
    modules = _read_modules(folder, entries)
    declared_in: dict[str, str] = {}
    for file, module in modules.items():
        for other, names in module.imports:
            if unknown := sorted(names - modules[other].exports):
                raise ValueError(f"{file} must import what {other} exports; got {', '.join(unknown)}")
        for name in module.names:
            if name in declared_in:
                raise ValueError(f"{file} must not declare {name}; {declared_in[name]} does")
            declared_in[name] = file
    needs = {file: [other for other, _ in module.imports] for file, module in modules.items()}
    try:
        order = list(TopologicalSorter(needs).static_order())
    except CycleError as error:
        raise ValueError(
            f"modules must not import one another in a circle; got {' from '.join(error.args[1])}"
        ) from None
    exports = sorted(set().union(*(modules[entry].exports for entry in entries)))
    return _BUNDLE.format(modules="\n".join(modules[file].body for file in order), exports=", ".join(exports))


def stylesheet(folder: Path = FOLDER) -> str:
    """The stylesheet of the playground, without comments and indentation."""
    text = (folder / "playground.css").read_text(encoding="utf-8")
    return re.sub(r"/\*.*?\*/|^\s+", "", text, flags=re.DOTALL | re.MULTILINE)


def _read_modules(folder: Path, entries: tuple[str, ...]) -> dict[str, _Module]:
    """The entries and all that they import, by file."""
    if not folder.is_dir():
        raise ImportError(
            f"safe.Playground needs the package's JavaScript; there is no folder {folder}: install the package again"
        )
    modules = {}
    wanted = [(entry, "the playground") for entry in entries]
    while wanted:
        file, importer = wanted.pop()
        if file in modules:
            continue
        try:
            text = _packaged_mazes() if file == "packaged_mazes.js" else (folder / file).read_text(encoding="utf-8")
        except OSError as error:
            raise ValueError(f"{importer} must import a module in {folder}; got {file} ({error.strerror})") from None
        modules[file] = _parse(text, file)
        wanted += [(other, file) for other, _ in modules[file].imports]
    return modules


def _packaged_mazes() -> str:
    """The module that holds the texts of the package's mazes by their names, without the comments of lists."""
    texts = {name: (MAZE_FOLDER / f"{name}.maze").read_text(encoding="utf-8") for name in maze_names()}
    lists = {name: _COMMENT_OF_A_LIST.sub("", text) for name, text in texts.items() if "\nsize " in text}
    return f"export const PACKAGED_MAZES = {json.dumps(texts | lists)};\n"


def _parse(text: str, file: str) -> _Module:
    imports, exports = [], set()
    for keyword, listed, other in _FROM.findall(text):
        names = {name.strip() for name in listed.split(",") if name.strip()}
        imports.append((other, names))
        if keyword == "export":
            exports |= names
    body = _FROM.sub("", text)
    declarations = _DECLARATION.findall(body)
    exports |= {name for exported, _, name in declarations if exported}
    body = _DECLARATION.sub(r"\2\3", body)
    if other_form := _OTHER_FORM.search(body):
        raise ValueError(f"{file} must import and export as {Path(__file__).name} reads it; got {other_form.group()!r}")
    body = _shortened(_DESCRIPTION.sub("", body), file)
    return _Module(imports, exports, [name for *_, name in declarations], body)


def _shortened(text: str, file: str) -> str:
    """The text for a page to load, without indentation, empty lines, and most comments and blanks around operators.

    To read, there are the modules.

    Template literals that span lines stay as they are.
    """
    lines = []
    is_inside = False  # of a template literal
    for line in text.split("\n"):
        if is_inside:
            lines.append(line)
        elif not (line := line.lstrip()) or line.startswith("//"):
            continue
        else:
            line = line if line.count("`") % 2 else _LAST_COMMENT.sub("", line)
            lines.append(line if _MAY_HOLD_A_TEXT.search(line) else _SPACED.sub(r"\1", line))
        is_inside ^= line.count("`") % 2 == 1
    if is_inside:
        raise ValueError(f"{file} must hold ` in pairs, also in texts and comments; got an odd number")
    return "\n".join(lines) + "\n"
