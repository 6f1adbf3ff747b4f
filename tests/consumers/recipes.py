"""Checks the recipes of vcpkg and Conan with simulated package managers:  recipes.py SOURCE VERSION

The recipes must name this version, as CITATION.cff does, existing files, and options of CMakeLists.txt."""
import importlib.util
import json
import re
import subprocess
import sys
import tempfile
import types
from pathlib import Path

source, version = Path(sys.argv[1]), sys.argv[2]
packages = source / "cmake" / "packages"
options = set(re.findall(r"option\((POLYBODY_\w+)", (source / "CMakeLists.txt").read_text()))


def expect(truth, what):
    if not truth:
        sys.exit(f"recipes: {what}")


def vcpkg():
    port = packages / "vcpkg" / "polybody"
    about = json.loads((port / "vcpkg.json").read_text())
    expect(about["name"] == "polybody" and about["version"] == version, f"vcpkg.json is of version {about['version']}")
    expect("eigen3" in about["dependencies"], "vcpkg.json does not need Eigen")
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder) / "port.cmake"
        calls = "vcpkg_cmake_configure vcpkg_cmake_install vcpkg_cmake_config_fixup vcpkg_fixup_pkgconfig vcpkg_install_copyright"
        surrogate_friction = "\n".join(f'function({call})\n  message("{call}: ${{ARGN}}")\nendfunction()' for call in calls.split())
        script.write_text(f"{surrogate_friction}\ninclude({port / 'portfile.cmake'})\n")
        ran = subprocess.run(["cmake", "-P", script], capture_output=True, text=True)
    expect(ran.returncode == 0, f"portfile.cmake: {ran.stderr}")
    said = dict(line.split(": ", 1) for line in ran.stderr.splitlines() if line.startswith("vcpkg_"))
    expect(set(said) == set(calls.split()), f"portfile.cmake calls {sorted(said)}")
    configured = said["vcpkg_cmake_configure"].split(";")
    expect((Path(configured[1]) / "CMakeLists.txt").is_file(), f"portfile.cmake: no sources at {configured[1]}")
    for option in re.findall(r"-D(POLYBODY_\w+)", said["vcpkg_cmake_configure"]):
        expect(option in options, f"portfile.cmake sets {option}, which CMakeLists.txt does not know")
    expect(Path(said["vcpkg_install_copyright"].split(";")[-1]).is_file(), "portfile.cmake: no licence")


def conan():
    class ConanFile:
        recipe_folder = str(packages)
        export_sources_folder = source_folder = package_folder = "folder"

        def __init__(self):
            self.required, self.info = [], types.SimpleNamespace(clear=lambda: None)
            self.cpp_info = types.SimpleNamespace(set_property=lambda *_: None)

        def requires(self, what, **_):
            self.required.append(what)

    class Toolchain:
        def __init__(self, recipe):
            self.variables = recipe.variables = {}

        def generate(self):
            pass

    copied = []
    cmake = types.SimpleNamespace(configure=lambda: None, install=lambda: None)
    for name, content in {
        "conan": {"ConanFile": ConanFile},
        "conan.tools": {},
        "conan.tools.cmake": {"CMake": lambda _: cmake, "CMakeToolchain": Toolchain},
        "conan.tools.files": {
            "copy": lambda _, pattern, src, dst: copied.append((pattern, src)),
            "load": lambda _, path: Path(path).read_text(),
        },
    }.items():
        module = types.ModuleType(name)
        vars(module).update(content)
        sys.modules[name] = module
    spec = importlib.util.spec_from_file_location("conanfile", packages / "conanfile.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    recipe = module.Polybody()
    recipe.set_version()
    expect(recipe.version == version, f"conanfile.py is of version {recipe.version}")
    for step in (recipe.export_sources, recipe.requirements, recipe.generate, recipe.package, recipe.package_info):
        step()
    expect(recipe.required == ["eigen/3.4.0"], f"conanfile.py requires {recipe.required}")
    for option in recipe.variables:
        expect(option in options, f"conanfile.py sets {option}, which CMakeLists.txt does not know")
    for pattern, folder in copied[:-1]:
        expect(any(Path(folder).glob(pattern)), f"conanfile.py exports {pattern}, of which there is none in {folder}")


def citation():
    cited = re.search(r"^version: (\S+)$", (source / "CITATION.cff").read_text(), re.M).group(1)
    expect(cited == version, f"CITATION.cff is of version {cited}")


vcpkg()
conan()
citation()
print("recipes: as they should be")
