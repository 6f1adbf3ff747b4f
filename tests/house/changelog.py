"""Form of CHANGELOG.md [Keep a Changelog 1.1]:  changelog.py CHANGELOG.md

Versions are headings of level two: `Unreleased`, or a number with a date. Changes are bullets below headings of level
three. A bullet is one line of at most 40 words. A program must change: a box "Breaking, migration" of quoted bullets.
"""

import re
import sys
from pathlib import Path

KINDS = ("Added", "Changed", "Deprecated", "Removed", "Fixed", "Known limitations", "Compatibility")
MOST_WORDS = 40


def faults(text):
    version = kind = None
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("## "):
            version, kind = line[3:], None
            if not re.fullmatch(r"Unreleased|\d+\.\d+\.\d+ - \d{4}-\d\d-\d\d", version):
                yield f"{number}: the version \"{version}\" is neither Unreleased nor a number with a date"
        elif line.startswith("### "):
            kind = line[4:]
            if kind not in KINDS:
                yield f"{number}: the heading \"{kind}\" is none of {', '.join(KINDS)}"
        elif line == "> **Breaking, migration**":
            kind = kind or "box"
        elif bullet := re.match(r"(> )?[-*] (.*)", line):
            words = len(bullet[2].split())
            if words > MOST_WORDS:
                yield f"{number}: {words} words in a bullet, more than {MOST_WORDS}"
            if version is None or kind is None:
                yield f"{number}: a bullet without version and heading"
        elif version and line.strip() and line.startswith("  "):
            yield f"{number}: a bullet has more than one line"


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    found = [f"{sys.argv[1]}:{f}" for f in faults(Path(sys.argv[1]).read_text(encoding="utf-8"))]
    print(*found, sep="\n")
    sys.exit(1 if found else 0)
