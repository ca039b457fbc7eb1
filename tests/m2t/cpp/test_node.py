"""Output of the templates for graphs that no accepted model produces yet."""

from __future__ import annotations

from pathlib import Path

import robosc
from robosc.m2t.ros.names import CppNames
from robosc.m2t.ros.node import GeneratedNode
from robosc.model import expression as ex
from robosc.model import rosgraph


def test_what_a_trigger_changes_is_done_after_its_data_is_made() -> None:
    robot = robosc.load(Path(__file__).parent / "courier.rscd")
    graph = robosc.to_rosgraph(robot)
    graph.model.supervisor = robosc.synthesize(graph.model)
    variable = next(variable for variable in graph.variables if variable.name == "total")
    (sending,) = (sending for topic in graph.publishers for sending in topic.sendings if sending.name == "sum")
    plant = next(plant for plant in graph.model.plants if plant.name == "component_Scanner")
    graph.reactions.append(
        rosgraph.Reaction(
            event=sending.event,
            locations=plant.locations[:1],
            assignments=[rosgraph.NodeAssignment(variable=variable, value=ex.IntegerLiteral(value=7))],
        )
    )
    publishers = GeneratedNode(graph, robosc.to_engine(graph.model)).publishers
    message = next(message for topic in publishers for message in topic.messages if message.word == "sum")
    assert message.reaction is not None
    (reaction,) = message.reaction.reactions
    assert reaction.condition == "supervisor_.state.component_Scanner == courier_component_Scanner_looking"
    assert [(assignment.target, assignment.value) for assignment in reaction.assignments] == [
        ("data_.Counter.total", "Integer(7)")
    ]


def test_no_name_is_a_macro_of_a_standard_header() -> None:
    robot = robosc.load(
        text="""robot R { component C {
            parameter M_PI: double(0.0..4.0) = 3.14
            outgoing message angle with type: double
            behaviour { variable NAN: double initial marked state s { on response from angle do NAN := value * M_PI } }
        } }"""
    )
    graph = robosc.to_rosgraph(robot)
    names = CppNames(graph)
    assert [names.variable(kept) for kept in (*graph.variables, *graph.parameters)] == ["C.NAN_", "parameters.M_PI_"]
