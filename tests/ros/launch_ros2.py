"""Include a launch file, in a pushed namespace or with a clock setting of the including file.

python3 launch_ros2.py FILE plain|pushed|simulated [ARGUMENT=VALUE ...]
"""

import sys

from launch import LaunchDescription, LaunchService
from launch.actions import GroupAction, IncludeLaunchDescription
from launch.launch_description_sources import AnyLaunchDescriptionSource
from launch_ros.actions import PushRosNamespace, SetParameter


def main(file, how, *arguments):
    around = {
        "plain": [],
        "pushed": [PushRosNamespace("hall")],
        "simulated": [SetParameter("use_sim_time", value=True)],
    }
    pairs = [tuple(argument.split("=", 1)) for argument in arguments]
    include = IncludeLaunchDescription(AnyLaunchDescriptionSource(file), launch_arguments=pairs)
    service = LaunchService()
    service.include_launch_description(LaunchDescription([GroupAction([*around[how], include])]))
    return service.run()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
