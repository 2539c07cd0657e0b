import re
from pathlib import Path

import make

README = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")


def test_the_python_of_the_readme_runs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (code,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    exec(code, {})
    first, *_, last = capsys.readouterr().out.splitlines()
    assert first.startswith("True ")
    assert 0 < float(last) < 1
    assert (tmp_path / "results.sqlite").exists()


def test_what_the_readme_names_is_there():
    root = Path(__file__).parents[1]
    steps = re.findall(r"^make (\w+)|make\.py (\w+)", README, re.MULTILINE)
    assert steps
    assert {"".join(step) for step in steps} <= make.STEPS.keys()
    for file in re.findall(r"\]\(([^):]+)\)|(?<= )(notebooks/\S+\.ipynb)", README):
        assert (root / "".join(file)).exists(), file
