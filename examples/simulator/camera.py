"""A camera, reduced to the topics of its software: lines, balls, goals, signs, people."""

from __future__ import annotations

import math

from .devices import EMPTY, NUMBER, Device, header
from .geometry import clear
from .world import Sight

#: The pixels of an image and its angle of view: the Raspberry Pi's camera.
WIDTH, HEIGHT, OPENING = 640, 480, math.radians(62.2)
FOCAL = WIDTH / 2 / math.tan(OPENING / 2)
#: The distance of the camera before the robot's center.
MOUNT = 0.07


def place(world, thing, walls, reach=math.inf):
    """Return the left and right pixel of a thing in the image, clipped at the image's edges.

    None if its middle is outside the image, further than `reach`, or hidden by one of the walls.
    """
    eye = world.pose.ahead(MOUNT)
    ahead, left = world.pose.towards(thing.x, thing.y)
    ahead -= MOUNT
    if ahead <= 0 or math.hypot(ahead, left) > reach:
        return None
    middle, half = -left / ahead * FOCAL, thing.width / 2 / ahead * FOCAL
    if abs(middle) > WIDTH / 2 or not clear(eye, (thing.x, thing.y), walls):
        return None
    return max(0, WIDTH / 2 + middle - half), min(WIDTH, WIDTH / 2 + middle + half)


def right_of_centre(seen):
    """Return the distance of a thing to the right of the image's center in pixels."""
    return sum(seen) / 2 - WIDTH / 2


class LineDetector(Device):
    """A detector that measures how far right the middle of the yellow line before the robot is."""

    period = 0.06
    says = {"/correction": NUMBER, "/no_line": EMPTY}
    #: The visible part of the floor: its distance, its depth to both sides, and its half width.
    ahead, depth, half_width = 0.2, 0.06, 0.5

    def __init__(self, noise):
        """Create the detector. `noise` returns an error in pixels."""
        self._noise = noise

    def say(self, world):
        """Return a correction, or a message that there is no line."""
        places = (world.pose.towards(*point) for point in world.line)
        seen = [left for ahead, left in places if self._sees(ahead, left)]
        if not seen or world.line_covered:
            return [("/no_line", {})]
        right = -sum(seen) / len(seen)
        return [("/correction", {"data": right / self.half_width * WIDTH / 2 + self._noise()})]

    def _sees(self, ahead, left):
        return abs(ahead - self.ahead) <= self.depth and abs(left) <= self.half_width


class BallDetector(Device):
    """A detector of a red ball: its place, whether it slips to a side, and whether it touches the robot."""

    says = {
        "/ball_correction": NUMBER,
        "/no_ball": EMPTY,
        "/needs_adjustment": EMPTY,
        "/no_adjustment": EMPTY,
        "/ball_front_check": EMPTY,
    }
    #: Pixels off the center at which a ball will soon be lost; the share of the image that a touching ball fills.
    aside, in_front = 90, 0.5

    def __init__(self, noise):
        """Create the detector. `noise` returns an error in pixels."""
        self._noise = noise

    def say(self, world):
        """Return the messages about the ball."""
        seen = place(world, world.ball, world.walls)
        if seen is None:
            return [("/no_ball", {})]
        correction = right_of_centre(seen) + self._noise()
        said = [("/ball_correction", {"data": correction})]
        said.append(("/needs_adjustment" if abs(correction) > self.aside else "/no_adjustment", {}))
        if (seen[1] - seen[0]) / WIDTH > self.in_front:
            said.append(("/ball_front_check", {}))
        return said


class GoalDetector(Device):
    """A detector of something green: the goal's back wall."""

    says = {"/goal_correction": NUMBER, "/no_goal": EMPTY}

    def __init__(self, noise):
        """Create the detector. `noise` returns an error in pixels."""
        self._noise = noise

    def say(self, world):
        """Return the messages about the goal."""
        _, y1, x2, y2 = world.goal
        seen = place(world, Sight("goal", x2 - 0.01, (y1 + y2) / 2, y2 - y1), world.walls)
        if seen is None:
            return [("/no_goal", {})]
        return [("/goal_correction", {"data": right_of_centre(seen) + self._noise()})]


class ObjectDetector(Device):
    """Darknet: the things that it can name, the most certain first. Without any it publishes no boxes."""

    period = 0.2
    says = {
        "/darknet_ros/found_object": "darknet_ros_msgs/ObjectCount",
        "/darknet_ros/bounding_boxes": "darknet_ros_msgs/BoundingBoxes",
    }
    reach = 2.2

    def say(self, world):
        """Return the number of visible things, and their boxes."""
        boxes = []
        for visible in sorted(world.sights, key=lambda sight: -sight.certainty):
            seen = place(world, visible, world.walls, self.reach)
            if seen is not None:
                boxes.append(box(visible.name, visible.certainty, seen))
        stamped = header(world, "camera")
        said = [("/darknet_ros/found_object", {"header": stamped, "count": len(boxes)})]
        if boxes:
            said.append(("/darknet_ros/bounding_boxes", {"header": stamped, "bounding_boxes": boxes}))
        return said


class PersonDetector(Device):
    """YOLOX, configured for people: a list of boxes for each image, empty without a visible person."""

    says = {"/bounding_boxes": "bboxes_ex_msgs/BoundingBoxes"}
    reach = 4.0

    def say(self, world):
        """Return the box of the person."""
        person = world.person
        seen = place(world, person, [*world.walls, *world.pillars], self.reach)
        boxes = [] if seen is None else [{**box("person", 0.9, seen), "img_width": WIDTH, "img_height": HEIGHT}]
        return [("/bounding_boxes", {"header": header(world, "camera"), "bounding_boxes": boxes})]


def box(name, certainty, seen):
    """Return a box around a thing. Its height in the image is arbitrary, because no example uses it."""
    left, right = seen
    return {
        "class_id": name,
        "probability": certainty,
        "xmin": round(left),
        "xmax": round(right),
        "ymin": 160,
        "ymax": 320,
    }
