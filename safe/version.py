"""The version of this package, which is recorded with every result."""

__version__ = "0.1.0"
