"""What people read has no misspelt word that is known to codespell."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
READ = [*ROOT.glob("*.md"), *ROOT.glob("book/*.md"), *ROOT.glob("notebooks/*.ipynb"), *ROOT.glob("safe/**/*.py")]


def misspelt(*files):
    command = [sys.executable, "-m", "codespell_lib", "--ignore-words-list", "whats", *map(str, files)]
    return subprocess.run(command, capture_output=True, text=True).stdout


def test_no_word_is_misspelt():
    assert misspelt(*READ) == ""


def test_a_misspelt_word_is_found(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("A robot must recieve its readings.", encoding="utf-8")
    assert "recieve ==> receive" in misspelt(page)
