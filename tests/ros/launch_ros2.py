"""Include a launch file, in a pushed namespace or with a clock setting of the including file.

With `stopped`, everything ends when the second process has started, or after five seconds.

python3 launch_ros2.py FILE plain|pushed|simulated|stopped [ARGUMENT=VALUE ...]
"""

import sys

from launch import LaunchDescription, LaunchService
from launch.actions import (
    EmitEvent,
    GroupAction,
    IncludeLaunchDescription,
    OpaqueFunction,
    RegisterEventHandler,
    TimerAction,
)
from launch.event_handlers import OnProcessStart
from launch.events import Shutdown
from launch.launch_description_sources import AnyLaunchDescriptionSource
from launch_ros.actions import PushRosNamespace, SetParameter


def stop():
    """Return actions that end the launch system after the second start of a process, or after some seconds."""
    starts = []
    end = EmitEvent(event=Shutdown())

    def count(_context):
        starts.append(1)
        return [end] if len(starts) > 1 else []

    counting = OnProcessStart(on_start=[OpaqueFunction(function=count)])
    return [RegisterEventHandler(counting), TimerAction(period=5.0, actions=[end])]


def main(file, how, *arguments):
    around = {
        "plain": [],
        "pushed": [PushRosNamespace("hall")],
        "stopped": stop(),
        "simulated": [SetParameter("use_sim_time", value=True)],
    }
    pairs = [tuple(argument.split("=", 1)) for argument in arguments]
    include = IncludeLaunchDescription(AnyLaunchDescriptionSource(file), launch_arguments=pairs)
    service = LaunchService()
    service.include_launch_description(LaunchDescription([GroupAction([*around[how], include])]))
    return service.run()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
