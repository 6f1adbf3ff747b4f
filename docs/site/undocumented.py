"""Members and types without a comment according to Doxygen:  undocumented.py WARNINGS

One line each: file, line, name, kind (`type`, `name` of a namespace, or `member`), separated by tabs.

"""
import re
import sys
from pathlib import Path

WARNING = re.compile(r"^(\S+?):(\d+): (?:warning: )?(?:Member (.*) \((\w+)\) of (\w+) (\S.*)|Compound (.*)) is not documented\.$")


def rows(warnings):
    """Each item once, although Doxygen names members of groups twice."""
    seen = set()
    for line in Path(warnings).read_text(encoding="utf-8").splitlines():
        if not (found := WARNING.match(line)):
            continue
        whole = found[3] or found[7]
        name = re.split(r"::|\s", re.sub(r"[\[(<].*", "", whole).strip() or whole)[-1]
        kind = "type" if found[7] else "name" if found[5] in ("namespace", "group") else "member"
        row = (found[1], int(found[2]), name, kind)
        if row not in seen and found[4] != "friend":
            seen.add(row)
            yield row


if __name__ == "__main__":
    for row in rows(sys.argv[1]):
        print(*row, sep="\t")
