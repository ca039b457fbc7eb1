"""The ROS installations of this machine, with the environment and commands that build and run packages."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

HERE = Path(__file__).parent


@dataclass(frozen=True)
class Ros:
    """An installation: the environment of its programs, its Python, and its build command."""

    version: int
    environment: dict[str, str]
    python: str
    build: list[str]

    def built(self, workspace: Path) -> str:
        """Build the packages below `src` of a workspace and return the output; fail if the build fails.

        The flags extend `CFLAGS` and `CXXFLAGS` of the environment.
        """
        flags = {name: f"{os.environ.get(name, '')} -Wconversion" for name in ("CFLAGS", "CXXFLAGS")}
        done = subprocess.run(
            self.build,
            cwd=workspace,
            env={**self.environment, **flags},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=3600,
            check=False,
        )
        assert done.returncode == 0, done.stdout[-4000:]
        return done.stdout


@dataclass
class Found:
    """An installation, or the reasons why there is none."""

    ros: Ros | None = None
    missing: list[str] = field(default_factory=list)


def find_ros1() -> Found:
    """Find ROS 1 as packaged by Debian, all in /usr, or below /opt/ros."""
    found = Found()
    if Path("/usr/share/roscpp/package.xml").exists():
        environment = _plain_environment() | {"ROS_PACKAGE_PATH": "/usr/share", "ROS_ETC_DIR": "/etc/ros"}
        python, prefix = "/usr/bin/python3", Path("/usr")
    else:
        sourced = _sourced("roscpp")
        if sourced is None:
            found.missing.append("no roscpp in /usr/share (Debian: libroscpp-dev) or /opt/ros")
            return found
        environment, prefix = sourced
        python = shutil.which("python3", path=environment["PATH"]) or "python3"
    needed = [
        "actionlib",
        "diagnostic_msgs",
        "geometry_msgs",
        "message_generation",
        "nav_msgs",
        "roslaunch",
        "rospy",
        "rostest",
        "sensor_msgs",
        "std_msgs",
        "std_srvs",
    ]
    found.missing += [
        f"no {package}" for package in needed if not (prefix / "share" / package / "package.xml").exists()
    ]
    if not (prefix / "share/std_msgs/msg").exists():
        found.missing.append("no definitions of std_msgs (Debian: ros-std-msgs)")
    found.missing += [f"no {program}" for program in ("catkin_make", "cmake", "g++") if not _has(program, environment)]
    if not found.missing:
        # Without an explicit number, catkin_make uses one job while the machine is busy.
        build = ["catkin_make", f"-j{os.cpu_count() or 1}", f"-DPYTHON_EXECUTABLE={python}"]
        if "CXX" not in os.environ and _has("clang++", environment):
            # clang takes a third of the time of g++; `test_build.py` checks the warnings of g++.
            build += ["-DCMAKE_C_COMPILER=clang", "-DCMAKE_CXX_COMPILER=clang++"]
            build.append(f"-DCMAKE_PROJECT_INCLUDE={HERE / 'precompiled.cmake'}")
        # No test uses the messages in Lisp.
        environment["ROS_LANG_DISABLE"] = "genlisp"
        found.ros = Ros(1, environment, python, build)
    return found


def find_ros2() -> Found:
    """Find the ROS 2 of this environment (AMENT_PREFIX_PATH), or one below /opt/ros; it must have rclcpp."""
    found = Found()
    environment = dict(os.environ)
    prefixes = [Path(part) for part in environment.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if part]
    if not any((prefix / "share/rclcpp/package.xml").exists() for prefix in prefixes):
        sourced = _sourced("rclcpp")
        if sourced is None:
            found.missing.append("no rclcpp in AMENT_PREFIX_PATH or /opt/ros")
            return found
        environment = sourced[0]
    found.missing += [f"no {program}" for program in ("colcon", "cmake", "g++") if not _has(program, environment)]
    if not found.missing:
        old = environment.get("ROS_DISTRO") in ("foxy", "galactic", "humble")
        environment |= {"ROS_LOCALHOST_ONLY": "1"} if old else {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
        python = shutil.which("python3", path=environment["PATH"]) or "python3"
        build = ["colcon", "build", "--event-handlers", "console_cohesion+", "--cmake-args", "-DBUILD_TESTING=OFF"]
        found.ros = Ros(2, environment, python, build)
    return found


def free_port() -> int:
    """Return an unused TCP port."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


def _has(program: str, environment: dict[str, str]) -> bool:
    return shutil.which(program, path=environment["PATH"]) is not None


def _plain_environment() -> dict[str, str]:
    """Return an environment without the Python and ROS of the tests, but with the options of sanitizers."""
    names = ("HOME", "LANG", "LC_ALL", "USER", "ASAN_OPTIONS", "TSAN_OPTIONS", "UBSAN_OPTIONS", "LDFLAGS")
    kept = {name: os.environ[name] for name in names if name in os.environ}
    return kept | {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin"}


def _sourced(package: str) -> tuple[dict[str, str], Path] | None:
    for setup in sorted(Path("/opt/ros").glob("*/setup.sh"), reverse=True):
        if (setup.parent / "share" / package / "package.xml").exists():
            script = f'. "{setup}" && env -0'
            shown = subprocess.run(
                ["bash", "-c", script], env=_plain_environment(), capture_output=True, text=True, check=True
            )
            pairs = (part.split("=", 1) for part in shown.stdout.split("\0") if "=" in part)
            return dict(pairs), setup.parent
    return None
