"""The listings that the thesis prints."""

from pathlib import Path

import pytest

from robosc.base.files.resources import locate
from robosc.language.reading import read
from robosc.model import robosc as rsc

LISTINGS = Path(__file__).parent.parent.parent.parent / "shared" / "thesis" / "models"
NAMES = (
    *("language-concepts", "line-follower", "line-follower-supervised", "maze-solver"),
    *("object-finder", "obstacle-navigation", "person-follower", "simple-navigation"),
)
pytestmark = pytest.mark.skipif(not LISTINGS.is_dir(), reason="the thesis' listings are not beside the repository")


@pytest.mark.parametrize("name", NAMES)
def test_every_name_of_a_listing_is_resolved(name: str) -> None:
    path = LISTINGS / f"{name}.rscd"
    reading = read(path)
    assert reading.findings == []
    assert isinstance(reading.base, rsc.Robot)
    for element in reading.base.eAllContents():
        for feature in element.eClass.eAllStructuralFeatures():
            if feature.lowerBound and not feature.many:
                assert getattr(element, feature.name) is not None, (
                    f"{element.eClass.name}.{feature.name} at {element.source}"
                )


def test_a_response_may_come_from_another_component() -> None:
    reading = read(LISTINGS / "maze-solver.rscd")
    assert reading.base is not None
    used = {
        element.communicationType.communicationType.name: element.communicationType.component.name
        for element in reading.base.eAllContents()
        if isinstance(element, rsc.ResultTransition)
    }
    assert used["stop"] == "EmergencyStop"
    assert used["turn_left"] == "Platform"


def test_imported_components_come_from_the_standard_library() -> None:
    reading = read(LISTINGS / "line-follower.rscd")
    assert list(map(Path, reading.texts))[1:] == [
        locate("stdlib/emergency_stop.rscd"),
        locate("stdlib/turtlebot.rscd"),
    ]
