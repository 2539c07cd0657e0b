"""A build of the book that warned, failed or was stopped is made again from nothing."""

import pytest
from sphinx.application import Sphinx
from sphinx.util.docutils import docutils_namespace

from tests.helpers.checkout import ROOT


def stop(*_):
    raise KeyboardInterrupt


@pytest.fixture
def build(tmp_path, monkeypatch):
    """Builds a small book strictly; gives the exit status, the warnings, and the pages that were read."""
    monkeypatch.syspath_prepend(ROOT / "book")
    source = tmp_path / "source"
    source.mkdir()
    (source / "conf.py").write_text("extensions = ['strict']\n")

    def build(text, is_stopped=False, builder="html"):
        index = source / "index.rst"
        if not index.exists() or index.read_text() != text:
            index.write_text(text)
        warnings, read = (tmp_path / "warnings").open("w+"), []
        with warnings, docutils_namespace():
            app = Sphinx(
                source,
                source,
                tmp_path / builder,
                tmp_path / "read",
                builder,
                status=None,
                warning=warnings,
                warningiserror=True,
                keep_going=True,
            )
            app.connect("source-read", lambda app, name, source: read.append(name))
            if is_stopped:
                app.connect("doctree-resolved", stop)
            app.build()
            warnings.seek(0)
            return app.statuscode, warnings.read(), read

    return build


GOOD, BAD = "Title\n=====\n\nText.\n", "Title\n=====\n\n:ref:`nowhere`\n"


def test_a_build_that_failed_fails_again(build):
    for builder in ("html", "html", "latex"):
        status, warnings, _ = build(BAD, builder=builder)
        assert status != 0
        assert "undefined label: 'nowhere'" in warnings
    assert build(GOOD)[:2] == (0, "")


def test_what_was_read_without_a_warning_is_not_read_again(build):
    assert build(GOOD) == (0, "", ["index"])
    assert build(GOOD) == (0, "", [])


def test_a_build_that_was_stopped_reads_everything_again(build):
    with pytest.raises(KeyboardInterrupt):
        build(GOOD, is_stopped=True)
    assert build(GOOD) == (0, "", ["index"])
