"""Two driven wheels with encoders, by default those of a TurtleBot3 Waffle Pi."""

from __future__ import annotations

import math

from .geometry import Pose

MAX_LINEAR, MAX_ANGULAR = 0.26, 1.82
TRACK, WHEEL_RADIUS = 0.287, 0.033
#: The acceleration of a wheel in m/s².
ACCELERATION = 2.0
ENCODER_STEPS = 4096


class Drive:
    """Wheels that follow commanded speeds as fast as they can, and count their turns.

    `pose` is the robot's real pose, `odometry` its pose according to the encoders, relative to the start. They differ
    because encoders cannot measure less than one of their steps, nor that the robot is held while its wheels turn.
    """

    def __init__(self, pose, fastest=MAX_LINEAR, acceleration=ACCELERATION):
        self.pose = pose
        self._fastest, self._acceleration = fastest, acceleration
        self.odometry = Pose()
        self.linear = self.angular = 0.0
        self._speeds = [0.0, 0.0]
        self._rolled = [0.0, 0.0]
        self._counted = [0, 0]

    @property
    def speed(self):
        """The current linear and angular speed."""
        left, right = self._speeds
        return (left + right) / 2, (right - left) / TRACK

    def command(self, linear, angular):
        """Set the speeds from now on, within the limits of the motors. Ignore commands that are not finite."""
        if math.isfinite(linear) and math.isfinite(angular):
            self.linear = max(-self._fastest, min(self._fastest, linear))
            self.angular = max(-MAX_ANGULAR, min(MAX_ANGULAR, angular))

    def step(self, seconds):
        """Turn the wheels for this time. Return the resulting pose; the caller assigns it to `pose` if it is free."""
        ways = []
        for wheel, side in enumerate((-1, 1)):
            wanted = self.linear + side * self.angular * TRACK / 2
            change = self._acceleration * seconds
            self._speeds[wheel] += max(-change, min(change, wanted - self._speeds[wheel]))
            ways.append(self._speeds[wheel] * seconds)
        self._count(ways)
        return rolled(self.pose, *ways)

    def _count(self, ways):
        resolution = 2 * math.pi * WHEEL_RADIUS / ENCODER_STEPS
        seen = []
        for wheel, way in enumerate(ways):
            self._rolled[wheel] += way
            count = round(self._rolled[wheel] / resolution)
            seen.append((count - self._counted[wheel]) * resolution)
            self._counted[wheel] = count
        self.odometry = rolled(self.odometry, *seen)


def rolled(pose, left, right):
    """Return the pose of a robot after its wheels have rolled these distances, exactly along an arc."""
    way, turn = (left + right) / 2, (right - left) / TRACK
    # The chord of the arc: sin(a)/a, without a division by zero.
    chord = way * (math.sin(turn / 2) / (turn / 2) if abs(turn) > 1e-9 else 1.0)
    middle = pose.heading + turn / 2
    return Pose(pose.x + chord * math.cos(middle), pose.y + chord * math.sin(middle), pose.heading + turn)
