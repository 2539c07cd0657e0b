"""Adjustments of the theme: buttons for the repository, if there is one, and for the projector, no script without need,
no code cut off."""

from __future__ import annotations

import html
import re
from collections.abc import Callable

from sphinx.application import Sphinx
from sphinx.util.typing import ExtensionMetadata

CODE = re.compile(r'(<div class="highlight"><pre>)(.*?)(</pre>)', re.DOTALL)
WIDE = 80  # characters; longer lines of code may need to be wrapped
LAUNCH = {"binderhub_url": "https://mybinder.org", "colab_url": "https://colab.research.google.com"}
PROJECTOR = {
    "type": "javascript",
    "javascript": "project()",
    "tooltip": "Show on a projector",
    "icon": "fas fa-person-chalkboard",
    "label": "projector-button",
}


def _set_buttons(app: Sphinx, config) -> None:
    """One setting, the repository's address, decides whether pages have buttons to launch, view and edit them."""
    options = config.html_theme_options
    has_repository = bool(options.get("repository_url"))
    options["use_repository_button"] = options["use_edit_page_button"] = has_repository
    if has_repository:
        options["launch_buttons"] = LAUNCH


def _remove_scripts(app: Sphinx, pagename: str, templatename: str, context: dict, doctree) -> None:
    """Remove thebe, which would come from a CDN, and, from pages without mathematics, MathJax, which is large."""
    has_mathematics = 'class="math' in context.get("body", "")

    def is_needed(script) -> bool:
        name = script.filename or ""
        is_thebe = "sphinx-thebe" in name or "THEBE_JS_URL" in (script.attributes.get("body") or "")
        return not is_thebe and (has_mathematics or "mathjax" not in name)

    context["script_files"] = [script for script in context.get("script_files", []) if is_needed(script)]


def _add_projector(app: Sphinx, pagename: str, templatename: str, context: dict, doctree) -> None:
    """Let every page that has sections be shown on a projector (see `_static/projector.js`)."""
    if doctree is None:
        return
    app.add_js_file("projector.js", defer="defer")
    context["header_buttons"].append(PROJECTOR)


def _remove_address(app: Sphinx, pagename: str, templatename: str, context: dict, doctree) -> None:
    """Without the book's address (`ogp_site_url`), no page can state its own."""
    if not app.config.ogp_site_url and "metatags" in context:
        context["metatags"] = re.sub(r'<meta property="og:url"[^>]*>\s*', "", context["metatags"])


def _add_filter(app: Sphinx, pagename: str, templatename: str, context: dict, doctree) -> None:
    """Offer the templates `without_drawn_icons`.

    The theme loads a font of icons, and a script of 1.5 MB that puts drawings in their place: the font is enough.
    """
    context["without_drawn_icons"] = lambda text: re.sub(r"<script[^>]*/fontawesome/[^>]*></script>", "", text)


def _share_contents() -> Callable[..., None]:
    """Compute the table of contents only once for all pages of the same depth that do not stand in it, as sources."""
    made = {}

    def share(app: Sphinx, pagename: str, templatename: str, context: dict, doctree) -> None:
        compute, depth = context["toctree"], pagename.count("/")

        def contents(**settings: object) -> str:
            key = depth, *sorted(settings.items())
            if key not in made:
                made[key] = compute(**settings)
            return made[key]

        if doctree is None:
            context["toctree"] = contents

    return share


def _wrap_code(app: Sphinx, pagename: str, templatename: str, context: dict, doctree) -> None:
    """Let lines of code, where they are long, continue below themselves, indented (see `book.css`)."""

    def wrapped(code: re.Match) -> str:
        opening, text, closing = code.groups()
        lines = text.splitlines(keepends=True)
        plain = [html.unescape(re.sub("<.*?>", "", line)) for line in lines]
        if max(map(len, plain), default=0) <= WIDE:
            return code.group()
        indents = [len(line) - len(line.lstrip()) for line in plain]
        spans = (
            f'<span class="line" style="--indent: {indent}ch">{line}</span>'
            for line, indent in zip(lines, indents, strict=True)
        )
        return opening + "".join(spans) + closing

    if "body" in context:
        context["body"] = CODE.sub(wrapped, context["body"])


def setup(app: Sphinx) -> ExtensionMetadata:
    app.connect("config-inited", _set_buttons)
    app.connect("html-page-context", _remove_scripts, priority=900)
    app.connect("html-page-context", _add_projector, priority=502)  # after the theme's first buttons
    app.connect("html-page-context", _remove_address, priority=900)
    app.connect("html-page-context", _share_contents(), priority=100)  # before the theme fills its sidebar
    app.connect("html-page-context", _add_filter)
    app.connect("html-page-context", _wrap_code)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
