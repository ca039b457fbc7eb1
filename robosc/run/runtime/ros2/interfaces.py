"""Build the Python modules of ROS 2 interface packages with the generators in the wheels and a C compiler, no colcon.

The result is for the Python of the wheels. A package consists of its modules, an extension with their type support,
and libraries that the extension and the middleware find beside it.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from concurrent.futures import ThreadPoolExecutor
from contextlib import redirect_stdout
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy
from rosidl_adapter.action import convert_action_to_idl
from rosidl_adapter.msg import convert_msg_to_idl
from rosidl_adapter.srv import convert_srv_to_idl
from rosidl_cli.command.helpers import dependencies_from_include_paths, generate_visibility_control_file
from rosidl_generator_c import generate_c
from rosidl_generator_py import generate_py
from rosidl_generator_type_description import generate_type_hash
from rosidl_typesupport_c import generate_c as generate_dispatch
from rosidl_typesupport_fastrtps_c import generate_typesupport_fastrtps_c
from rosidl_typesupport_introspection_c import generate_c as generate_introspection

from robosc.base.ros_types.folders import Workspace

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

PREFIX = Path(sys.prefix)
SHARE = PREFIX / "share"
CONVERTERS = {"msg": convert_msg_to_idl, "srv": convert_srv_to_idl, "action": convert_action_to_idl}
#: Implicit dependencies of each service and action.
IMPLIED = ("action_msgs", "builtin_interfaces", "service_msgs", "unique_identifier_msgs")
#: Libraries of each package, and of the generators.
KINDS = ("generator_c", "generator_py", "typesupport_c", "typesupport_fastrtps_c", "typesupport_introspection_c")
RUNTIME = ("rcutils", "fastcdr", "rosidl_runtime_c", *(f"rosidl_{kind}" for kind in KINDS[2:]))
SUPPORTS = ["rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c"]
_INCLUDED = re.compile(r'^#include "(\w+)/', re.MULTILINE)


class BuildError(Exception):
    """Error that prevents the build: a definition, a missing package, a compiler."""


@dataclass(frozen=True)
class _Package:
    """Package whose definitions were converted."""

    name: str
    #: Its definitions in IDL, by their paths below the folder of all packages: `msg/Bool.idl`.
    files: Sequence[str]
    #: Packages whose types these definitions name.
    named: frozenset[str]


def build(folders: Iterable[Path], out: Path) -> list[str]:
    """Build all packages below some folders into a folder for PYTHONPATH; return their names in build order.

    A package replaces its former version only when all of its files are built. Raises BuildError, and OSError if `out`
    can't be written.
    """
    sources: dict[str, Path] = {}
    for folder in folders:
        workspace = Workspace(folder.resolve(), "ROS 2")
        for name in workspace.packages():
            for root in workspace.roots(name):
                if any(path for kind in CONVERTERS for path in root.glob(f"{kind}/*.{kind}")):
                    sources.setdefault(name, root)
    if not sources:
        raise BuildError("no package has msg/*.msg, srv/*.srv or action/*.action")
    if not (SHARE / "rosidl_generator_c").is_dir():
        raise BuildError("this ROS 2 is not installed from wheels: build the packages with colcon")
    out.mkdir(parents=True, exist_ok=True)
    # The generators print the files that they read and write.
    with tempfile.TemporaryDirectory(prefix=".robosc-", dir=out) as temporary, redirect_stdout(StringIO()):
        work, built = Path(temporary, "work"), Path(temporary, "made")
        packages = {name: _converted(name, root, work) for name, root in sorted(sources.items())}
        order = _ordered(packages)
        for name in order:
            _build(packages[name], packages, built, work)
            shutil.rmtree(out / name, ignore_errors=True)
            shutil.copytree(built / name, out / name)
    return order


def _converted(name: str, package: Path, work: Path) -> _Package:
    """Return a package with its definitions converted to IDL, in `work/idl`."""
    idl = work / "idl" / name
    files = []
    for kind, convert in CONVERTERS.items():
        for path in sorted(package.glob(f"{kind}/*.{kind}")):
            try:
                convert(package, name, path.relative_to(package), idl / kind)
            except Exception as error:
                # The generators have no exception of their own for an invalid text.
                raise BuildError(f"{path}: {str(error) or type(error).__name__}") from error
            files.append(f"{kind}/{path.stem}.idl")
    named = {other for file in files for other in _INCLUDED.findall((idl / file).read_text(encoding="utf-8"))}
    return _Package(name, files, frozenset(named - {name}))


def _ordered(packages: Mapping[str, _Package]) -> list[str]:
    """Return the packages in an order in which each follows those whose types it names."""
    for package in packages.values():
        for other in sorted(package.named - packages.keys()):
            if not any((SHARE / other).glob("*/*.idl")):
                raise BuildError(f"{package.name} uses types of {other}, which is neither installed nor in the call")
    try:
        return [
            *TopologicalSorter(
                {name: package.named & packages.keys() for name, package in packages.items()}
            ).static_order()
        ]
    except CycleError as error:
        raise BuildError(f"these packages use types of each other: {', '.join(sorted(set(error.args[1])))}") from None


def _needed(package: _Package, packages: Mapping[str, _Package]) -> tuple[list[str], list[str]]:
    """Return the direct and indirect dependencies of a package: those built with it, and those installed."""
    built: dict[str, None] = {}
    installed: dict[str, None] = {}
    waiting = [*IMPLIED, *sorted(package.named)]
    while waiting:
        name = waiting.pop()
        if name in built or name in installed or name == package.name:
            continue
        if name in packages:
            built[name] = None
            waiting += sorted(packages[name].named)
        elif (SHARE / name).is_dir():
            installed[name] = None
            texts = (path.read_text(encoding="utf-8") for path in (SHARE / name).glob("*/*.idl"))
            waiting += sorted({other for text in texts for other in _INCLUDED.findall(text)} - {name})
    return sorted(built), sorted(installed)


def _generate(package: _Package, packages: Mapping[str, _Package], out: Path, work: Path) -> None:
    """Write all sources of a package, those of one generator in one folder."""
    name, files = package.name, package.files
    idl, descriptions = work / "idl", work / "rosidl_generator_type_description"
    built, installed = _needed(package, packages)
    known = [*(idl / other for other in built), *(SHARE / other for other in installed)]
    described = {**{other: descriptions / other for other in built}, **{other: SHARE / other for other in installed}}

    def arguments(generator: str, **more: object) -> str:
        folder = out / name if generator == "rosidl_generator_py" else work / generator / name
        for file in files:
            (folder / file).parent.mkdir(parents=True, exist_ok=True)
        templates = SHARE / generator / "resource"
        for template in templates.glob("*visibility_control.h.in"):
            generate_visibility_control_file(
                package_name=name, template_path=str(template), output_path=str(folder / "msg" / template.stem)
            )
        values = {
            "package_name": name,
            "output_dir": str(folder),
            "template_dir": str(templates),
            "idl_tuples": [f"{idl / name}:{file}" for file in files],
            "ros_interface_dependencies": sorted(dependencies_from_include_paths(map(str, known))),
            "target_dependencies": [],
        }
        path = work / f"{name}-{generator}.json"
        path.write_text(json.dumps(values | more))
        return str(path)

    include = [f"{other}:{folder}" for other, folder in described.items()]
    generate_type_hash(arguments("rosidl_generator_type_description", include_paths=include))
    own = descriptions / name
    generate_c(
        arguments(
            "rosidl_generator_c",
            type_description_tuples=[f"{file}:{own / file.replace('.idl', '.json')}" for file in files],
            ros_interface_files=[str(idl / name / file) for file in files],
        )
    )
    generate_typesupport_fastrtps_c(arguments("rosidl_typesupport_fastrtps_c"))
    generate_introspection(arguments("rosidl_typesupport_introspection_c"))
    generate_dispatch(arguments("rosidl_typesupport_c"), SUPPORTS)
    generate_py(arguments("rosidl_generator_py"), ["rosidl_typesupport_c"])
    (out / name / "__init__.py").touch()


def _build(package: _Package, packages: Mapping[str, _Package], out: Path, work: Path) -> None:
    """Build the modules of one package. Precondition: its dependencies are built."""
    name = package.name
    try:
        _generate(package, packages, out, work)
    except Exception as error:
        raise BuildError(f"the generators of ROS 2 cannot make modules of {name}: {error}") from error
    generated = [work / generator for generator in ("rosidl_generator_c", "rosidl_typesupport_c", *SUPPORTS)]
    folders = [*generated, out, sysconfig.get_path("include"), numpy.get_include()]
    folders += [*sorted((PREFIX / "include").iterdir()), PREFIX / "include"]
    include = [f"-I{folder}" for folder in folders]
    built, installed = _needed(package, packages)
    others = [path for other in built for path in sorted((out / other).glob(f"lib{other}__*.so"))]
    runpath = ":".join([str(PREFIX / "lib"), "$ORIGIN", *(f"$ORIGIN/../{other}" for other in built)])
    there = [*RUNTIME, *(f"{other}__rosidl_{kind}" for other in installed for kind in KINDS)]
    libraries = [f"-l{library}" for library in there if (PREFIX / "lib" / f"lib{library}.so").exists()]

    def library(file: str, sources: Iterable[Path], linked: Sequence[Path] = ()) -> Path:
        objects = _compiled(sorted(sources), include, work / "objects" / name / file)
        # The middleware looks up a type support by its library's name: it has to be loaded already, used or not.
        options = ["-shared", f"-Wl,-soname,{file}", "-Wl,--no-as-needed", f"-Wl,-rpath,{runpath}"]
        target = out / name / file
        _run("g++", *options, "-o", target, *objects, *linked, *others, f"-L{PREFIX / 'lib'}", *libraries)
        return target

    modules = out / name
    types = library(
        f"lib{name}__rosidl_generator_c.so", [*_sources(generated[0] / name), *_sources(generated[1] / name)]
    )
    libraries_built = [
        library(f"lib{name}__{folder.name}.so", _sources(folder / name), [types]) for folder in generated[2:]
    ]
    conversions = [source for kind in CONVERTERS for source in _sources(modules / kind)]
    libraries_built += [types, library(f"lib{name}__rosidl_generator_py.so", conversions, [types])]
    ending = sysconfig.get_config_var("EXT_SUFFIX")
    library(f"{name}_s__rosidl_typesupport_c{ending}", modules.glob("*.c"), libraries_built)


def _sources(folder: Path) -> list[Path]:
    return [path for path in folder.rglob("*.c*") if path.suffix in (".c", ".cpp")]


def _compiled(sources: Iterable[Path], include: Sequence[str], objects: Path) -> list[Path]:
    """Compile the sources in parallel; return the object files."""
    objects.mkdir(parents=True)
    object_files = {source: objects / f"{number}.o" for number, source in enumerate(sources)}

    def compile_one(source: Path) -> None:
        compiler = "g++" if source.suffix == ".cpp" else "gcc"
        _run(compiler, "-O0", "-w", "-fPIC", *include, "-c", source, "-o", object_files[source])

    with ThreadPoolExecutor(os.cpu_count()) as executor:
        for _ in executor.map(compile_one, object_files):
            pass
    return list(object_files.values())


def _run(compiler: str, *arguments: str | Path) -> None:
    command = [compiler, *arguments]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603 - our own words and files
    except FileNotFoundError:
        raise BuildError(f"{compiler} not found: install compilers of C and C++ (Debian: apt install g++)") from None
    if done.returncode != 0:
        raise BuildError(f"{compiler} rejects the generated code:\n{done.stderr[-2000:]}")
