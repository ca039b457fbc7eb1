"""The built page, and a browser that opens it."""

from tests.chromium import chromium

__all__ = ["chromium"]
