"""The eight scenarios of the thesis (section 6.2) and two larger ones: places, scripts and goals."""

from __future__ import annotations

import math

from .camera import BallDetector, GoalDetector, LineDetector, ObjectDetector, PersonDetector
from .devices import EMPTY, TRIGGER, Odometry, Rotator, Steps, Wheels
from .field import Boom, Driver, Radio, Receiver, Remote
from .geometry import Disc, Pose, Segment, box, path, turned
from .navigation import Navigation
from .scenario import Scenario, stop_and_continue
from .warehouse import AisleManager, Battery, Bumpers, Docking, Lift, SafetyLidars, Undocking, WarehouseNavigation
from .world import Area, Ball, Person, Sight, World

LINE_PIXELS, VIEW_PIXELS = 1.0, 2.0


class LineFollower(Scenario):
    """A robot follows a yellow line with bends to its end, past an obstacle, a stop button and a cloth on the line."""

    name = "line_follower"
    #: The parts of the line: straight, a bend to the left, straight, a bend to the right, straight.
    bends = ((1.5, 0), (0.8, 90), (0.4, 0), (0.8, -90), (1.2, 0))

    def world(self):
        """Return the place. The robot stands beside the line's start and faces along it."""
        return World(Pose(0.0, 0.06), line=_line(Pose(-0.1, 0.0), self.bends))

    def devices(self, world, noise):
        """Return a platform and a detector."""
        del world
        return [Wheels(), LineDetector(noise.up_to(LINE_PIXELS))]

    def script(self, simulation):
        """Place the incidents along the robot's progress."""
        world = simulation.world
        yield lambda: world.travelled > 1.0
        world.pillars.append(Disc(*self._on_line(world, 1.0), 0.12))
        simulation.happens("an obstacle is put on the line")
        yield 6.0
        world.pillars.clear()
        simulation.happens("the obstacle is taken away")
        yield lambda: world.travelled > 2.6
        yield from stop_and_continue(simulation, 2.0)
        yield lambda: world.travelled > 3.4
        world.line_covered = True
        simulation.happens("the line is covered")
        yield 1.5
        world.line_covered = False
        simulation.happens("the line is uncovered")
        yield lambda: self._at_end(world)
        yield 1.0
        yield lambda: self.reached(simulation)

    def reached(self, simulation):
        """Return whether the robot is at rest at the line's end."""
        return self._at_end(simulation.world) and abs(simulation.world.drive.speed[0]) < 0.01

    def pose(self, world):
        """Return the pose with the distance to the line."""
        return {**super().pose(world), "off_line": world.off_line, "travelled": world.travelled}

    @staticmethod
    def _at_end(world):
        x, y = world.line[-1]
        return math.hypot(x - world.pose.x, y - world.pose.y) < 0.3

    @staticmethod
    def _on_line(world, ahead):
        """Return the point of the line at a distance ahead of the robot."""
        near = min(range(len(world.line)), key=lambda at: math.dist(world.line[at], (world.pose.x, world.pose.y)))
        return world.line[near + round(ahead / LINE_STEP)]


class SupervisedLineFollower(LineFollower):
    """The same line for a robot that drives in steps, and for a controller that ignores dangers."""

    name = "supervised_line_follower"
    controller = "controller/line_stepper.rscd"
    #: Blocked steps never arrive here.
    alive = "/supervised_line_follower_layer/state"

    def devices(self, world, noise):
        """Return a platform that drives in steps, and a detector."""
        del world
        return [Steps(), LineDetector(noise.up_to(LINE_PIXELS))]


class SimpleNavigation(Scenario):
    """An empty room with a map and two destinations: a stop on the first way, a change of plan on the second."""

    name = "simple_navigation"
    people = {
        "/initialpose": "geometry_msgs/PoseWithCovarianceStamped",
        "/clicked_point": "geometry_msgs/PointStamped",
    }
    unheard = ("/odom", "/scan")
    alive = "/simple_navigation_controller/state"
    start = Pose(0.6, 0.6, 0.3)
    room = (0.0, 0.0, 4.0, 3.0)
    first, second, third = (2.6, 0.8), (0.8, 2.4), (3.2, 2.3)

    def world(self):
        """Return the place. The robot stands in a corner."""
        return World(self.start, walls=self.walls())

    def walls(self):
        """Return the walls on the map."""
        return box(*self.room)

    def devices(self, world, noise):
        """Return Nav2."""
        del world, noise
        return [Navigation(self.walls())]

    def script(self, simulation):
        """Click on a map, as in RViz."""
        nav = simulation.device(Navigation)
        yield 0.6
        self.click(simulation, *self.first)
        yield 0.6
        self.locate(simulation)
        yield 0.6
        self.click(simulation, *self.first)
        yield lambda: simulation.world.travelled > 0.7
        yield from stop_and_continue(simulation, 2.0)
        yield 1.5
        self.click(simulation, *self.first)
        yield lambda: nav.arrived == 1
        yield 1.0
        self.click(simulation, *self.second)
        yield lambda: simulation.world.travelled > 2.8
        self.click(simulation, *self.third)
        yield lambda: nav.arrived == 2
        yield 1.0

    def reached(self, simulation):
        """Return whether the robot was at both destinations that were not canceled, and is now at the last one."""
        return simulation.device(Navigation).arrived == 2 and self._at(simulation.world, self.third)

    def locate(self, simulation):
        """Set the robot's position on the map."""
        pose = simulation.world.pose
        orientation = {"x": 0.0, "y": 0.0, "z": math.sin(pose.heading / 2), "w": math.cos(pose.heading / 2)}
        position = {"x": pose.x, "y": pose.y, "z": 0.0}
        stamped = {"stamp": simulation.time, "frame_id": "map"}
        simulation.happens("the initial pose is set")
        data = {"header": stamped, "pose": {"pose": {"position": position, "orientation": orientation}}}
        simulation.say("/initialpose", data)

    def click(self, simulation, x, y):
        """Click a point."""
        simulation.happens("a point is clicked")
        header = {"stamp": simulation.time, "frame_id": "map"}
        simulation.say("/clicked_point", {"header": header, "point": {"x": x, "y": y, "z": 0.0}})

    @staticmethod
    def _at(world, point):
        return math.dist(point, (world.pose.x, world.pose.y)) < 0.15


class ObstacleNavigation(SimpleNavigation):
    """A room with pillars that no map contains. A person moves a chair right before the robot."""

    name = "obstacle_navigation"
    alive = "/obstacle_navigation_controller/state"
    room = (0.0, 0.0, 4.4, 3.0)
    start = Pose(0.5, 1.5)
    first, second = (3.9, 1.5), (0.6, 0.6)

    def world(self):
        """Return the place. The robot stands at one side, and pillars are on its way to the other."""
        pillars = [Disc(x, y, 0.15) for x, y in ((1.5, 1.5), (2.6, 1.0), (2.6, 2.0), (1.5, 0.5), (1.5, 2.5))]
        return World(self.start, walls=self.walls(), pillars=pillars)

    def script(self, simulation):
        """Click on a map, and move a chair."""
        world, nav = simulation.world, simulation.device(Navigation)
        yield 0.6
        self.locate(simulation)
        yield 0.6
        self.click(simulation, *self.first)
        yield lambda: world.travelled > 2.0
        world.pillars.append(Disc(*world.pose.ahead(0.37), 0.12))
        simulation.happens("a chair is moved before the robot")
        yield lambda: nav.arrived == 1
        yield 1.0
        self.click(simulation, *self.second)
        yield 3.0
        yield from stop_and_continue(simulation, 2.0)
        yield 1.0

    def reached(self, simulation):
        """Return whether the robot is at the point, after it got stuck on the way."""
        nav = simulation.device(Navigation)
        return nav.arrived == 1 and nav.recoveries > 0 and self._at(simulation.world, self.first)


class ObjectFinder(Scenario):
    """Corridors with a dead end, and a stop sign around two corners."""

    name = "object_finder"
    alive = "/object_finder_controller/state"

    def world(self):
        """Return the place. The robot faces a dead end."""
        walls = path((0, 0), (4, 0), (4, 3), (6.5, 3), (6.5, 4), (3, 4), (3, 1), (0, 1), (0, 0))
        sights = [
            Sight("stop sign", 6.45, 3.5, 0.3, 0.8),
            Sight("chair", 3.5, 3.9, 0.4, 0.9),
            Sight("fire hydrant", 5.6, 3.9, 0.3, 0.95),
        ]
        return World(Pose(1.2, 0.5, math.pi), walls=walls, sights=sights)

    def devices(self, world, noise):
        """Return a platform, a rotator and Darknet."""
        del world, noise
        return [Wheels(), Rotator(EMPTY), ObjectDetector()]

    def script(self, simulation):
        """Press stop once while the robot drives."""
        yield lambda: simulation.world.pose.x > 2.0
        yield from stop_and_continue(simulation, 1.5)
        yield lambda: self.reached(simulation)
        yield 1.0

    def reached(self, simulation):
        """Return whether the robot is at rest, with the sign in sight."""
        world = simulation.world
        near = math.hypot(world.pose.x - 6.45, world.pose.y - 3.5) < ObjectDetector.reach + 0.1
        return near and max(map(abs, world.drive.speed)) < 0.01


class MazeSolver(Scenario):
    """A maze of squares with sides of one meter."""

    name = "maze_solver"
    alive = "/maze_solver_controller/state"
    #: Each square has its own walls: `_` below it, `|` to its right. The way out is in the last row.
    plan = (
        " _ _ _ _ ",
        "|  _    |",
        "| |_ _| |",
        "|_ _|_  |",
    )

    def world(self):
        """Return the place. The robot stands in the middle and faces a wall."""
        return World(Pose(1.6, 1.5, math.pi), walls=walls_of(self.plan))

    def devices(self, world, noise):
        """Return a platform and a rotator."""
        del world, noise
        return [Wheels(), Rotator("std_msgs/Int16")]

    def script(self, simulation):
        """Press stop once while the robot drives."""
        yield lambda: simulation.world.travelled > 1.0
        yield from stop_and_continue(simulation, 1.5)
        yield lambda: self.reached(simulation)

    def reached(self, simulation):
        """Return whether the robot is outside."""
        pose = simulation.world.pose
        return not (-0.2 < pose.x < (len(self.plan[0]) - 1) / 2 + 0.2 and -0.2 < pose.y < len(self.plan) - 0.8)


class PushBall(Scenario):
    """A room with a ball and a goal."""

    name = "push_ball"

    def world(self):
        """Return the place. The robot faces away from the ball."""
        goal = (3.6, -0.5, 4.1, 0.5)
        walls = [*box(-1.5, -2.0, 4.6, 2.0), *path((3.6, -0.5), (4.1, -0.5), (4.1, 0.5), (3.6, 0.5))]
        return World(Pose(0.0, 0.0, 2.2), walls=walls, ball=Ball(1.3, 0.18, 0.1), goal=goal)

    def devices(self, world, noise):
        """Return a platform and two detectors."""
        del world
        pixels = noise.up_to(VIEW_PIXELS)
        return [Wheels(), BallDetector(pixels), GoalDetector(pixels)]

    def script(self, simulation):
        """Press stop once while the robot pushes the ball."""
        yield lambda: simulation.world.ball.x > 1.6
        yield from stop_and_continue(simulation, 1.5)
        yield lambda: self.reached(simulation)
        yield 1.0

    def reached(self, simulation):
        """Return whether the ball is in the goal and the robot at rest."""
        world = simulation.world
        return world.ball_in_goal and max(map(abs, world.drive.speed)) < 0.01

    def pose(self, world):
        """Return the pose with the ball's place."""
        return {**super().pose(world), "ball": [world.ball.x, world.ball.y]}


class PersonFollower(Scenario):
    """A person who walks around, and disappears for a while."""

    name = "person_follower"
    last = (3.2, 2.6)

    def world(self):
        """Return the place. The person stands a little aside."""
        return World(Pose(0.0, 0.0), person=Person(1.9, 0.6, 0.15), walls=box(-1.5, -2.0, 6.0, 4.5))

    def devices(self, world, noise):
        """Return a platform and a detector."""
        del world, noise
        return [Wheels(), PersonDetector()]

    def script(self, simulation):
        """Let the person walk, press stop, and hide the person behind a curtain."""
        person, world = simulation.world.person, simulation.world
        yield 3.0
        person.walk(0.18, (2.6, 0.4), (3.6, 0.6), (4.0, 1.4))
        yield 9.0
        yield from stop_and_continue(simulation, 2.0)
        yield lambda: not person.way
        yield 4.0
        x, y = world.pose.towards(person.x, person.y)
        curtain = Segment(*world.pose.ahead(x - 0.35, y - 0.6), *world.pose.ahead(x - 0.35, y + 0.6))
        world.walls.append(curtain)
        simulation.happens("a curtain hides the person")
        yield 2.0
        world.walls.remove(curtain)
        simulation.happens("the curtain is drawn back")
        person.walk(0.2, self.last)
        yield lambda: self.reached(simulation)
        yield 1.0

    def reached(self, simulation):
        """Return whether the person stands at the last place, with the robot near and turned to the person."""
        world = simulation.world
        ahead, left = world.pose.towards(*self.last)
        there = math.dist(self.last, (world.person.x, world.person.y)) < 0.01
        near = 0.8 < math.hypot(ahead, left) < 1.4 and abs(turned(math.atan2(left, ahead))) < 0.1
        return there and near and abs(world.drive.speed[0]) < 0.01

    def pose(self, world):
        """Return the pose with the distance to the person."""
        away = math.dist((world.person.x, world.person.y), (world.pose.x, world.pose.y))
        return {**super().pose(world), "person": away}


class WarehouseRobot(Scenario):
    """A hall with a dock, a shelf, and between them an aisle in which people walk."""

    name = "warehouse_robot"
    calls = {"/fetch_again": TRIGGER}
    goals = {"/fetch": "nav2_msgs/NavigateToPose"}
    people = {
        "/order": "geometry_msgs/PoseStamped",
        "/served": EMPTY,
        "/dock/again": EMPTY,
    }
    alive = "/warehouse_robot_controller/state"
    scale = 80
    patience = 300.0
    start = Pose(-0.7, 0.0)
    shelf = (7.5, 2.4)

    def world(self):
        """Return the place. The robot stands in its dock, a person beside its way."""
        areas = [
            Area("dock", -1.1, -0.4, -0.3, 0.4, "#dfe6ee"),
            Area("aisle", 1.0, -1.5, 6.3, 4.0, "#fbf1d8"),
            Area("shelf", 7.0, 1.9, 8.0, 2.9, "#e4d5c3"),
        ]
        person = Person(3.4, 2.9, 0.15)
        return World(self.start, walls=self.walls(), person=person, areas=areas, fastest=1.0, acceleration=5.0)

    def walls(self):
        """Return the walls on the map."""
        return box(-1.6, -1.5, 9.0, 4.0)

    def sensors(self, noise):
        """Return two lidars, and encoders, which only Nav2 reads."""
        return [SafetyLidars(noise.up_to(0.005)), Odometry()]

    def devices(self, world, noise):
        """Return all devices of a warehouse."""
        del world, noise
        docking = Docking(self.start.x)
        navigation = WarehouseNavigation(self.walls(), self.start)
        return [Bumpers(), Battery(docking, 0.15), Lift(), AisleManager(), docking, Undocking(docking), navigation]

    def script(self, simulation):
        """Send two orders. The second ends half way because the battery is low."""
        docking, battery = simulation.device(Docking), simulation.device(Battery)
        docking.refusals = 2
        yield from self.to_the_shelf(simulation)
        yield from self.at_the_shelf(simulation)
        yield from self.home(simulation)
        yield lambda: docking.docked and battery.charge > 0.5
        simulation.happens("the fleet manager orders the shelf again")
        simulation.order("/fetch_again", {})
        yield lambda: simulation.world.pose.x > 2.0
        battery.charge = 0.19
        simulation.happens("the battery runs low")
        yield lambda: docking.docked
        yield 1.0

    def to_the_shelf(self, simulation):
        """Let people fill the aisle and one of them block the way, and press stop."""
        world, aisle = simulation.world, simulation.device(AisleManager)
        navigation = simulation.device(WarehouseNavigation)
        yield 1.0
        aisle.crowded = True
        self.order(simulation)
        yield lambda: not simulation.device(Docking).docked and world.pose.x > -0.05
        yield 1.5
        aisle.crowded = False
        simulation.happens("there is room in the aisle")
        yield lambda: world.pose.x > 1.0
        simulation.happens("somebody walks into the way")
        world.person.walk(1.2, world.pose.ahead(2.0))
        yield lambda: not world.person.way
        world.person.walk(0.8, world.pose.ahead(0.6))
        yield lambda: not navigation.under_way
        yield 1.5
        simulation.happens("the person walks on")
        world.person.walk(1.2, (4.6, -1.2))
        yield lambda: world.pose.x > 4.6 and navigation.under_way
        yield from stop_and_continue(simulation, 2.0)
        yield lambda: navigation.arrived == 1

    @staticmethod
    def at_the_shelf(simulation):
        """Press stop before the lift moves. The lift jams once on its way down."""
        lift, aisle = simulation.device(Lift), simulation.device(AisleManager)
        lift.jams = 1
        yield lambda: not aisle.let_in
        yield from stop_and_continue(simulation, 1.5)
        yield lambda: lift.height == 1.0
        yield 1.5
        simulation.happens("the shelf is served")
        simulation.say("/served", {})

    @staticmethod
    def home(simulation):
        """Disconnect a lidar and touch a bumper."""
        world, navigation = simulation.world, simulation.device(WarehouseNavigation)
        lidars, bumpers = simulation.device(SafetyLidars), simulation.device(Bumpers)
        yield lambda: navigation.under_way and world.pose.x < 5.6
        lidars.silent.add("/front/scan")
        simulation.happens("the lidar ahead is cut off")
        yield 2.0
        lidars.silent.clear()
        simulation.happens("the lidar speaks again")
        yield lambda: navigation.under_way and world.pose.x < 3.0
        bumpers.pressed.add("/left/bumper")
        simulation.happens("a bumper is touched")
        yield 1.5
        bumpers.pressed.clear()
        simulation.happens("the bumper is free")
        yield lambda: navigation.arrived == 2

    def reached(self, simulation):
        """Return whether a shelf was served and the robot has returned twice."""
        docking, lift = simulation.device(Docking), simulation.device(Lift)
        served = simulation.device(WarehouseNavigation).arrived == 3 and lift.height == 0.0
        return served and docking.docked and max(map(abs, simulation.world.drive.speed)) < 0.01

    def order(self, simulation):
        """Order the shelf by a behavior tree."""
        simulation.happens("a behavior tree orders the shelf")
        x, y = self.shelf
        pose = {"position": {"x": x, "y": y}, "orientation": {"z": 0.0, "w": 1.0}}
        header = {"stamp": simulation.time, "frame_id": "map"}
        simulation.order("/fetch", {"pose": {"header": header, "pose": pose}})


class Sprayer(Scenario):
    """The corner of a field: two rows, the second past the field's end, and a way across sprayed ground."""

    name = "sprayer"
    people = {"/route": "nav_msgs/Path"}
    scale = 40
    patience = 300.0
    #: The field's edges are 100 m and 40 m from its middle.
    first = ((86.5, 36.5), (86.5, 33.5), (101.5, 33.5))
    second = ((97.5, 30.5), (91.5, 30.5), (91.5, 38.5))

    def world(self):
        """Return the place. The sprayer stands beside the field and faces it."""
        field = Area("field", 84.0, 27.0, 100.0, 40.0, "#f3ecd9")
        return World(Pose(102.0, 36.5, math.pi), areas=[field], fastest=1.5, acceleration=5.0)

    def sensors(self, noise):
        """Return a satellite receiver."""
        return [Receiver(noise.up_to(0.03))]

    def devices(self, world, noise):
        """Return all devices of a sprayer."""
        del world, noise
        return [Wheels(), Radio(), Remote(), Boom(), Driver()]

    def script(self, simulation):
        """Drive by hand into the field, along a route that leads out of it, back by hand, and along another route."""
        yield 1.0
        self.plan(simulation, self.first)
        yield 0.5
        yield from self.steer(simulation, 0.8, lambda x: x < 98.0)
        yield 0.6
        self.switch(simulation, automatic=True)
        yield from self.first_row(simulation)
        yield from self.second_row(simulation)
        yield from self.steer(simulation, -0.6, lambda x: x < 97.0)
        self.plan(simulation, self.second)
        yield 0.5
        self.switch(simulation, automatic=True)
        yield lambda: simulation.device(Driver).arrived == 5
        yield 1.0

    @staticmethod
    def first_row(simulation):
        """Lose the radio, empty the tank, and lose the satellites."""
        pose, boom = (lambda: simulation.world.pose), simulation.device(Boom)
        radio, receiver = simulation.device(Radio), simulation.device(Receiver)
        yield lambda: pose().x < 94.0
        radio.in_reach = False
        simulation.happens("the radio is out of reach")
        yield 3.0
        radio.in_reach = True
        simulation.happens("the radio is back")
        yield lambda: pose().x < 91.0
        boom.level = 0.01
        simulation.happens("the tank is empty")
        yield 2.5
        boom.level = 0.5
        simulation.happens("the tank is filled")
        yield lambda: pose().y < 35.0
        receiver.in_view = False
        simulation.happens("no satellite is in view")
        yield 2.0
        receiver.in_view = True
        simulation.happens("satellites are in view")

    def second_row(self, simulation):
        """Press stop, switch the mode while the stick is held, drive through mud, and reach the field's end."""
        driver, pose = simulation.device(Driver), lambda: simulation.world.pose
        remote = simulation.device(Remote)
        yield lambda: driver.arrived == 2 and pose().x > 88.0
        yield from stop_and_continue(simulation, 2.0)
        yield lambda: pose().x > 91.0
        remote.stick = (0.5, 0.0)
        simulation.happens("the stick is pushed, to no avail")
        yield 1.0
        self.switch(simulation, automatic=False)
        yield 1.5
        remote.stick = None
        simulation.happens("the stick is let go")
        yield 0.6
        yield from self.steer(simulation, 0.5, lambda x: x > 94.0)
        self.switch(simulation, automatic=True)
        yield lambda: pose().x > 96.0 and driver.under_way
        driver.trouble = True
        yield lambda: pose().x > 100.0 and not driver.under_way
        yield 1.5
        self.switch(simulation, automatic=False)
        yield 0.5

    @staticmethod
    def steer(simulation, speed, there):
        """Steer straight ahead until the x of the sprayer reaches `there`."""
        remote = simulation.device(Remote)
        remote.stick = (speed, 0.0)
        simulation.happens("the stick is pushed")
        yield lambda: there(simulation.world.pose.x)
        remote.stick = None
        simulation.happens("the stick is let go")

    @staticmethod
    def switch(simulation, automatic):
        """Switch the mode."""
        simulation.device(Remote).automatic = automatic
        simulation.happens("switched to automatic" if automatic else "switched to manual")

    @staticmethod
    def plan(simulation, points):
        """Send a route."""
        simulation.happens("a route is sent")
        stamped = {"stamp": simulation.time, "frame_id": "field"}
        poses = [
            {"header": stamped, "pose": {"position": {"x": x, "y": y}, "orientation": {"z": 0.0, "w": 1.0}}}
            for x, y in points
        ]
        simulation.say("/route", {"header": stamped, "poses": poses})

    def reached(self, simulation):
        """Return whether the sprayer rests at the end of the second route and has sprayed the field along its way."""
        driver, boom = simulation.device(Driver), simulation.device(Boom)
        resting = max(map(abs, simulation.world.drive.speed)) < 0.01
        return driver.arrived == 5 and resting and len(boom.sprayed) > 60


LINE_STEP = 0.01

#: All scenarios by name.
SCENARIOS = {
    scenario.name: scenario
    for scenario in (
        LineFollower(),
        SimpleNavigation(),
        ObstacleNavigation(),
        ObjectFinder(),
        MazeSolver(),
        PushBall(),
        PersonFollower(),
        SupervisedLineFollower(),
        WarehouseRobot(),
        Sprayer(),
    )
}


def _line(pose, bends):
    """Return points on a line from a pose: (length, 0) goes straight ahead, (radius, degrees) around a bend."""
    points = []
    for size, degrees in bends:
        length = abs(math.radians(degrees)) * size if degrees else size
        start, turn = pose, math.radians(degrees)
        for step in range(round(length / LINE_STEP)):
            points.append((pose.x, pose.y))
            share = (step + 1) / round(length / LINE_STEP)
            if degrees:
                side = math.copysign(size, degrees)
                angle = turn * share
                x, y = start.ahead(side * math.sin(angle), side * (1 - math.cos(angle)))
                pose = Pose(x, y, start.heading + angle)
            else:
                pose = Pose(*start.ahead(length * share), start.heading)
    return points


def walls_of(plan):
    """Return the walls of a maze: `_` is the lower edge of a square, `|` stands between two squares."""
    rows = len(plan) - 1
    walls = []
    for row, text in enumerate(plan):
        for column, sign in enumerate(text):
            y = rows - row
            if sign == "_" and column % 2:
                walls.append(Segment((column - 1) / 2, y, (column + 1) / 2, y))
            elif sign == "|":
                walls.append(Segment(column / 2, y, column / 2, y + 1))
    return walls
