"""Builds the Python modules of ROS 2 interface packages with the generators in the wheels and a C compiler, no colcon.

    python -m robosc.runtime.ros2.interfaces OUT PACKAGE...

With the Python of the wheels. PACKAGE is a folder with `msg`, `srv` or `action` in it, OUT is for PYTHONPATH. A package
becomes its modules, an extension with their type support, and libraries that the extension and the middleware find
beside it.
"""

from __future__ import annotations

import json
import subprocess
import sys
import sysconfig
import tempfile
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

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

PREFIX = Path(sys.prefix)
SHARE = PREFIX / "share"
CONVERTERS = {"msg": convert_msg_to_idl, "srv": convert_srv_to_idl, "action": convert_action_to_idl}
#: What the packages may depend on.
KNOWN = ("action_msgs", "builtin_interfaces", "geometry_msgs", "service_msgs", "std_msgs", "unique_identifier_msgs")
#: Libraries of each of these, and of the generators.
KINDS = ("generator_c", "generator_py", "typesupport_c", "typesupport_fastrtps_c", "typesupport_introspection_c")
RUNTIME = ("rcutils", "fastcdr", "rosidl_runtime_c", *(f"rosidl_{kind}" for kind in KINDS[2:]))
SUPPORTS = ["rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c"]


def generate(name: str, package: Path, out: Path, work: Path) -> None:
    """Writes all sources of a package, those of one generator in one folder."""
    idl = work / "idl" / name
    files = []
    for kind, convert in CONVERTERS.items():
        for path in sorted(package.glob(f"{kind}/*.{kind}")):
            convert(package, name, path.relative_to(package), idl / kind)
            files.append(f"{kind}/{path.stem}.idl")
    known = [SHARE / package for package in KNOWN]

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
            "idl_tuples": [f"{idl}:{file}" for file in files],
            "ros_interface_dependencies": dependencies_from_include_paths(map(str, known)),
            "target_dependencies": [],
        }
        path = work / f"{name}-{generator}.json"
        path.write_text(json.dumps(values | more))
        return str(path)

    descriptions = work / "rosidl_generator_type_description" / name
    generate_type_hash(
        arguments("rosidl_generator_type_description", include_paths=[f"{share.name}:{share}" for share in known])
    )
    generate_c(
        arguments(
            "rosidl_generator_c",
            type_description_tuples=[f"{file}:{descriptions / file.replace('.idl', '.json')}" for file in files],
            ros_interface_files=[str(idl / file) for file in files],
        )
    )
    generate_typesupport_fastrtps_c(arguments("rosidl_typesupport_fastrtps_c"))
    generate_introspection(arguments("rosidl_typesupport_introspection_c"))
    generate_dispatch(arguments("rosidl_typesupport_c"), SUPPORTS)
    generate_py(arguments("rosidl_generator_py"), ["rosidl_typesupport_c"])
    (out / name / "__init__.py").touch()


def compile_library(
    file: Path, folders: Iterable[Path], linked: Sequence[Path], include: Sequence[str], work: Path
) -> Path:
    """Compiles all sources below some folders into one library, linked with those that were made before."""
    objects = []
    sources = sorted(path for folder in folders for path in folder.rglob("*.c*") if path.suffix in (".c", ".cpp"))
    for number, source in enumerate(sources):
        objects.append(work / f"{file.name}.{number}.o")
        compiler = "g++" if source.suffix == ".cpp" else "gcc"
        _run(compiler, "-O0", "-w", "-fPIC", *include, "-c", source, "-o", objects[-1])
    places = [f"-L{PREFIX / 'lib'}", f"-Wl,-rpath,{PREFIX / 'lib'}:$ORIGIN"]
    there = [f"{package}__rosidl_{kind}" for package in KNOWN for kind in KINDS]
    libraries = [f"-l{library}" for library in (*RUNTIME, *there) if (PREFIX / "lib" / f"lib{library}.so").exists()]
    # The middleware asks for a type support by its library's name: it has to be loaded already, used or not.
    options = ["-shared", f"-Wl,-soname,{file.name}", "-Wl,--no-as-needed"]
    _run("g++", *options, "-o", file, *objects, *linked, *places, *libraries)
    return file


def _run(*command: str | Path) -> None:
    subprocess.run(command, check=True)  # noqa: S603 - the compiler's name and files that were named for it


def build(package: Path, out: Path, work: Path) -> None:
    """The modules of one package, ready to be imported."""
    name = package.name
    generate(name, package, out, work)
    generated = [work / generator for generator in ("rosidl_generator_c", "rosidl_typesupport_c", *SUPPORTS)]
    folders = [*generated, out, sysconfig.get_path("include"), numpy.get_include()]
    folders += [*sorted((PREFIX / "include").iterdir()), PREFIX / "include"]
    include = [f"-I{folder}" for folder in folders]

    def library(file: str, *generators: Path, linked: Sequence[Path] = ()) -> Path:
        return compile_library(out / name / file, [folder / name for folder in generators], linked, include, work)

    types = library(f"lib{name}__rosidl_generator_c.so", *generated[:2])
    made = [types, *(library(f"lib{name}__{folder.name}.so", folder, linked=[types]) for folder in generated[2:])]
    library(f"{name}_s__rosidl_typesupport_c{sysconfig.get_config_var('EXT_SUFFIX')}", out, linked=made)


def main() -> int:
    """Builds the packages that the command line names; returns its exit status."""
    if len(sys.argv) < 3:
        print(__doc__, file=sys.stderr)  # noqa: T201
        return 2
    out, *packages = (Path(path).resolve() for path in sys.argv[1:])
    out.mkdir(parents=True, exist_ok=True)
    for package in packages:
        with tempfile.TemporaryDirectory() as work:
            build(package, out, Path(work))
    return 0


if __name__ == "__main__":
    sys.exit(main())
