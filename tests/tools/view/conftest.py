"""The page as it is built, and a browser that opens it."""

from tests.chromium import chromium

__all__ = ["chromium"]
