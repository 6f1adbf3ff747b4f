"""Case of the atlas: the full run compares the pages in docs/atlas with its results. CASES as in chapter2.py."""

import re


def checked(text):
    """The last line of `atlas --check`."""
    found = re.search(r"^(\d+) pages checked, (\d+) differences$", text, re.MULTILINE)
    return {"pages": {"checked": float(found[1]), "differences": float(found[2])}} if found else {}, ""


CASES = {"atlas": ("docs/atlas/summary.md", "atlas --check --pages ../../../docs/atlas", checked)}
