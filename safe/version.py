"""The version of this package; results tell which one made them."""

__version__ = "0.1.0"
