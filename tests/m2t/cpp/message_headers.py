"""Write the C++ headers of a package of ROS 2 types, with the generators of ROS 2's wheels.

python message_headers.py PACKAGE_FOLDER OUT
"""

import json
import sys
from pathlib import Path

from rosidl_adapter.action import convert_action_to_idl
from rosidl_adapter.msg import convert_msg_to_idl
from rosidl_adapter.srv import convert_srv_to_idl
from rosidl_cli.command.helpers import generate_visibility_control_file
from rosidl_generator_cpp import generate_cpp
from rosidl_generator_type_description import generate_type_hash

KINDS = {"msg": convert_msg_to_idl, "srv": convert_srv_to_idl, "action": convert_action_to_idl}


def write(package: Path, out: Path) -> None:
    """Write the headers of a package, `OUT/PACKAGE/KIND/*.hpp`."""
    name, share = package.name, Path(sys.prefix) / "share"
    idl, descriptions = out / "idl", out / "descriptions"
    files = []
    for kind, convert in KINDS.items():
        for folder in (out / name, descriptions):
            (folder / kind).mkdir(parents=True)
        for path in sorted(package.glob(f"{kind}/*.{kind}")):
            convert(package, name, path.relative_to(package), idl / kind)
            files.append(f"{kind}/{path.stem}.idl")

    def arguments(generator: str, folder: Path, **more: object) -> str:
        path = out / f"{generator}.json"
        values = {
            "package_name": name,
            "output_dir": str(folder),
            "template_dir": str(share / generator / "resource"),
            "idl_tuples": [f"{idl}:{file}" for file in files],
            "ros_interface_dependencies": [],
            "target_dependencies": [],
        }
        path.write_text(json.dumps(values | more))
        return str(path)

    include = [f"{other.parent.name}:{other.parent}" for other in share.glob("*/package.xml")]
    generate_type_hash(arguments("rosidl_generator_type_description", descriptions, include_paths=include))
    described = [f"{file}:{descriptions / file.replace('.idl', '.json')}" for file in files]
    template = share / "rosidl_generator_cpp" / "resource" / "rosidl_generator_cpp__visibility_control.hpp.in"
    generate_visibility_control_file(
        package_name=name, template_path=str(template), output_path=str(out / name / "msg" / template.stem)
    )
    generate_cpp(arguments("rosidl_generator_cpp", out / name, type_description_tuples=described))


if __name__ == "__main__":
    write(Path(sys.argv[1]), Path(sys.argv[2]))
