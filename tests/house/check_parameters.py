"""Checks the tests of hostile parameters (tests/hostile):  check_parameters.py INCLUDE_DIR TESTS_DIR

Every type of the library with a `check` must have an entry `words_of<…>`, or an entry below with the reason for its
omission. The tests must name every type with words.

"""

import re
import sys
from pathlib import Path

import cpp_reader

NOTHING_TO_TRY = {
    "NoCorrection": "it has no parameters",
    "SymplecticEuler": "it has no parameters",
    "AtStates": "it has no parameters",
    "AtMultipliers": "it has no parameters",
    "UserForce": "its law is a function",
    "UserForceWithStates": "its law is a function",
    "ContactGroup": "it calls the checks of its laws",
    "ContactSet": "it calls the checks of its laws",
    "Plane": "it has no parameters",
    "Compound": "it calls the checks of its geometries and placements: tests/hostile/contact_shapes_test.cpp",
    "NonlinearBushing": "it calls the checks of its laws, which are tried through it",
    "Continuum": "it looks at a Bar, which is tried through every body",
    "ElasticLine": "it looks at a Bar, which is tried through every body",
    "HermiteCable": "it looks at a Bar, which is tried through every body",
    "SimoVuQuoc": "it looks at a Bar, which is tried through every body",
    "CircularArc": "it looks at a Bar, which is tried through every body",
    "BumpCourse": "its constructor refuses: tests/unit/vehicle/terrain_test.cpp",
    "RoadProfile": "its constructor refuses: tests/unit/vehicle/terrain_test.cpp",
    "HeightField": "its constructor refuses: tests/unit/vehicle/terrain_test.cpp",
    "VtkWriterOf": "it looks at a file",
}
INSIDE = {"NewtonOptions"}  # tested as parts of the implicit integrators
WORDS = re.compile(r"\bwords_of<(?:\w+::)*(\w+)")


def checked(include):
    """{type with a member check: the header that declares it}"""
    found = {}
    for path in sorted(include.rglob("*.hpp")):
        for d in cpp_reader.declarations(path.read_text(encoding="utf-8")):
            scopes = d.name.split("::")
            if d.kind == "function" and scopes[-1] == "check" and len(scopes) > 1:
                found[scopes[-2]] = path.relative_to(include).as_posix()
    return found


def findings(include, tests):
    types = checked(include)
    texts = [p.read_text(encoding="utf-8") for p in sorted((tests / "hostile").iterdir())]
    worded = set(WORDS.findall("\n".join(texts)))
    for name, header in types.items():
        if name not in worded and name not in NOTHING_TO_TRY:
            yield f"{header}: {name} has a check, but tests/hostile does not try it. Give it words in parameter_words.hpp and a run."
    uses = WORDS.sub("", "\n".join(texts))
    for name in sorted((worded & set(types)) - INSIDE):
        if not re.search(rf"\b{name}\b", uses):
            yield f"tests/hostile: {name} has words, but no test tries it."
    for name in sorted(set(NOTHING_TO_TRY) - set(types)):
        yield f"check_parameters.py: {name} has no check any longer. Take it off the list."


def main(include, tests):
    found = list(findings(Path(include), Path(tests)))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
