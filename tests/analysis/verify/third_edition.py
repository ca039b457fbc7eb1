"""Small robots with the constructs of the language's third edition, for faults seeded into RoboSC."""

from __future__ import annotations

#: Assumptions about sets of events, before and after an event changes their condition, and for each instance.
ASSUMED = """robot Assumed {
  component Cell(ns: string) {
    outgoing message opened with identifier: ns + "/opened", type: none
    outgoing message closed with identifier: ns + "/closed", type: none
    service move with identifier: ns + "/move", request: none, response: none
    behaviour {
      initial marked state still { on request to move goto moving }
      state moving {
        on response from opened goto still
        on response from closed goto still
        on response from move goto still
        on error from move goto still
      }
    }
  }
  component Unit[1..2] is Cell("/unit" + text(number))
  component Lamp {
    incoming message lamp with identifier: "/lamp", type: none
    behaviour { initial marked state here { on request to lamp } }
  }
  assume A1: each Cell: { Cell.opened, Cell.closed } needs Cell.moving
  assume A2 "one after the other": { response from Unit[1].move, Unit[1].opened } needs Unit[2].still
  requirement lamp needs Unit[1].still
}
"""
#: A fleet with several arguments, quantifiers, and an automaton for each instance.
FLEET = """robot Fleet {
  component Station(ns: string, least: integer(0..3), most: integer(0..3)) {
    outgoing message done with identifier: ns + "/done", type: integer(0..3)
    service enter with identifier: ns + "/enter", request: none, response: none
    requirement enter needs used < most and used >= least
    behaviour {
      variable used: integer(0..3) = least
      initial marked state outside {
        on request to enter do used := used + 1
        on response from enter goto inside
        on error from enter
        on response from done do used := value
      }
      marked state inside { on response from done goto outside }
    }
  }
  component Cell[1..2] is Station("/cell" + text(number), number - 1, number + 1)
  component Gate {
    incoming message lamp with type: none
    behaviour { initial marked state here { on request to lamp } }
  }
  requirement R1: each Station: Station.enter needs (count Station: Station.inside or Station.enter.running) < 1
  requirement Turns: each Station: automaton {
    initial marked state mine { on response from Station.enter goto yours on request to lamp }
    marked state yours { on request to lamp goto mine on response from Station.enter }
  }
  requirement each Station: Station.enter needs Turns.mine
  requirement lamp needs Turns[Cell[2]].yours or Cell[1].inside
}
"""
#: A base that must get home: a way home is lost in the second round of synthesis only.
REACHED = """robot Reached {
  component Base {
    outgoing message low with type: none
    incoming message home with type: none
    incoming message away with type: none
    incoming message far with type: none
    behaviour {
      initial marked state docked {
        on request to away goto out
        on request to far goto gone
      }
      marked state out {
        on request to home goto docked
        on request to far goto side
      }
      marked state side { on request to far goto edge }
      marked state edge {
        on request to home goto docked
        on response from low goto lost
      }
      marked state lost {}
      marked state gone {}
    }
  }
  requirement R1 "can get home": reachable Base.docked from !Base.gone
  requirement R2: reachable Base.out or Base.gone
}
"""
#: Comparisons with stored values: shared texts, negations, joined conditions, and integers with ranges.
STORED = """robot Stored {
  interface pose use Pose from stored_msgs
  datatype object Pose { x: double y: double level: integer(0..3) parts: array(double) }
  component Lidar {
    outgoing message pose with identifier: "/pose", type: Pose links pose
    action seek with identifier: "/seek", request: none, response: Pose, feedback: none links pose
    behaviour {
      variable last: double
      initial marked state idle {
        on response from pose if !(value.x < last) goto near
        on response from pose do last := value.x
      }
      marked state near { on response from pose if value.x < last and value.y < last goto idle }
      on request to seek
      on error from seek if !(value.parts[0] < last) goto near
      on error from seek if value.parts[0] > value.x or near goto idle
      on canceled from seek
    }
  }
  component Base {
    incoming message move with identifier: "/move", type: none
    behaviour {
      variable last: double
      variable held: Pose
      variable level: integer(0..2)
      initial marked state slow {
        on response from pose if value.x < last goto quick
        on response from pose if held.level > level do level := held.level goto slow
        on response from pose do last := value.y, held := value
        on request to move
      }
      marked state quick { on response from pose if value.x < last do level := round(last) goto slow }
    }
  }
  requirement move needs (Lidar.near or Base.level > 1) and !Lidar.seek.running
  requirement seek needs Base.level < 2
}
"""
#: A fleet whose instances compare the same data with values of their own, and a quantifier over these.
SHARED = """robot Shared {
  component Driver(ns: string) {
    incoming message move with identifier: ns + "/move", type: none
    behaviour {
      variable last: double
      initial marked state slow {
        on response from seen if value < last goto quick
        on response from seen do last := value
        on request to move
      }
      marked state quick { on response from seen if value < last goto slow }
    }
  }
  component Rover[1..2] is Driver("/rover" + text(number))
  component Judge {
    outgoing message seen with identifier: "/seen", type: double
    behaviour {
      initial marked state far { on response from seen if all Driver: value < Driver.last goto near }
      marked state near { on response from seen if (count Driver: value < Driver.last) = 0 goto far }
    }
  }
  requirement each Driver: Driver.move needs Judge.near and any Driver: Driver.quick
}
"""
#: Arrays at an error, which may be missing: each condition that reads one is an input of its own.
ARRAYS = """robot Arrays {
  interface seek use Seek from seek_msgs
  datatype object Result { parts: array(double) }
  component Base {
    action seek with identifier: "/seek", request: none, response: Result, feedback: none links seek
    behaviour {
      variable high: boolean
      initial marked state idle {
        on request to seek
        on error from seek if !(value.parts[0] < 0.5) goto stuck
        on error from seek if value.parts[1] < 0.5 or high goto stuck
        on error from seek do high := value.parts[2] < 0.5 and value.parts[3] < 0.5
        on canceled from seek
      }
      marked state stuck { on error from seek if value.parts[4] < 0.5 and high goto idle }
    }
  }
  requirement seek needs !Base.high or Base.stuck
}
"""
#: Ends of services and actions, with reasons and while they run.
ENDS = """robot Ends {
  component Base {
    action drive with identifier: "/drive", request: none, response: none, feedback: none
    service reset with identifier: "/reset", request: none, response: none
    incoming message lamp with identifier: "/lamp", type: none
    outgoing message near with identifier: "/near", type: boolean
    behaviour {
      variable close: boolean
      variable why: Failure
      on response from near do close := value
      on request to lamp
      initial marked state still { on request to drive goto driving }
      state driving {
        on response from drive goto still
        on error from drive if error = lost do why := error goto stuck
        on error from drive do why := error goto still
        on canceled from drive goto still
      }
      marked state stuck { on request to reset goto mending }
      state mending {
        on response from reset goto still
        on error from reset if error = timeout or error = failed goto stuck
        on error from reset goto still
      }
    }
  }
  requirement drive needs !Base.close
  requirement lamp needs !Base.drive.running and Base.why != unreadable
}
"""
ROBOTS = {
    "Assumed": ASSUMED,
    "Fleet": FLEET,
    "Reached": REACHED,
    "Stored": STORED,
    "Shared": SHARED,
    "Arrays": ARRAYS,
    "Ends": ENDS,
}
