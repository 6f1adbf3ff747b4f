#!/usr/bin/env python3
"""All of polybody in one header, for a program that copies one file.

  cmake/packages/single_header.py -o polybody.hpp                          what polybody/polybody.hpp includes
  cmake/packages/single_header.py --also bodies/ffr/ffr.hpp -o polybody.hpp   and further headers

Each header stands once, where it is first included; the standard library and Eigen are included as before.
"""
import argparse
import os
import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'\s*#\s*include\s*<polybody/([^>]+)>')
ROOT = Path(__file__).resolve().parent.parent.parent / "include" / "polybody"


def put(name, done, out):
    """Writes a header and, before it, those that it includes."""
    if name in done:
        return
    done.add(name)
    path = ROOT / name
    if not path.is_file():
        raise SystemExit(f"single_header.py: there is no header polybody/{name}.")
    for line in path.read_text(encoding="utf-8").splitlines():
        found = INCLUDE.match(line)
        if found:
            put(found.group(1), done, out)
        elif line.strip() != "#pragma once":
            out.append(line)


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--also", action="append", default=[], metavar="HEADER", help="a further header, below polybody/")
    parser.add_argument("-o", required=True, metavar="FILE", dest="file")
    options = parser.parse_args(arguments)
    version = re.search(r'library_version = "([^"]+)"', (ROOT / "version.hpp").read_text()).group(1)
    out = ["#pragma once", f"// polybody {version} in one header, made by cmake/packages/single_header.py."]
    license_of = (ROOT.parent.parent / "LICENSE").read_text(encoding="utf-8").strip().splitlines()
    out += [("// " + line).rstrip() for line in license_of]
    done = set()
    for name in ["polybody.hpp", *options.also]:
        put(name, done, out)
    file = Path(options.file)
    part = file.with_name(file.name + ".part")
    try:
        part.write_text("\n".join(out) + "\n", encoding="utf-8")
        os.replace(part, file)
    except OSError as error:
        raise SystemExit(f"single_header.py: {file} cannot be written: {error.strerror}.")
    print(f"{file}: {len(done)} headers, {len(out)} lines")


if __name__ == "__main__":
    main(sys.argv[1:])
