"""Folders that cannot be written, and somebody who may only read."""

import os
import tempfile
from contextlib import contextmanager
from pathlib import Path

import pytest

NOBODY = 65534
IS_UNIX = hasattr(os, "geteuid")
IS_ROOT = IS_UNIX and os.geteuid() == 0


@contextmanager
def public_folder():
    """A temporary folder that all users can reach, unlike pytest's; only its owner may write in it."""
    if not IS_UNIX:
        pytest.skip("a folder has these permissions only on Unix")
    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o755)
        try:
            yield Path(folder)
        finally:
            os.chmod(folder, 0o755)


def forbid_writing(folder, but_new_files=False):
    """Make all files in a folder read-only, and the folder itself or, with `but_new_files`, open to everybody."""
    for file in folder.iterdir():
        file.chmod(0o444)
    folder.chmod(0o777 if but_new_files else 0o555)


@contextmanager
def as_somebody_who_may_only_read():
    """Inside this context permissions count: root, for whom they do not, is nobody."""
    groups = os.getgroups()
    if IS_ROOT:
        os.setgroups([])
        os.setegid(NOBODY)
        os.seteuid(NOBODY)
    try:
        yield
    finally:
        if IS_ROOT:
            os.seteuid(0)
            os.setegid(0)
            os.setgroups(groups)


def state_of(folder):
    """All files in a folder: their bytes, times, permissions and owners."""
    files = {file.name: (file.read_bytes(), file.stat()) for file in folder.iterdir()}
    return {name: (data, at.st_mtime_ns, at.st_mode, at.st_uid) for name, (data, at) in files.items()}
