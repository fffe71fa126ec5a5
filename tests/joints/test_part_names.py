"""What the name of a part says of its joint."""

from __future__ import annotations

import pytest

from kinematify.joints.candidate import FIXED, SLIDE, TURN
from kinematify.joints.choice.judge import kind_said


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("drawer_2", SLIDE),
        ("DoorLeft", TURN),
        ("hingedoor", TURN),
        ("oven drawer", SLIDE),
        ("Wheels.003", TURN),
        ("foot_0", FIXED),
        ("handle_drawer", None),
        ("part_007", None),
        ("link_3", None),
        ("mesh12", None),
    ],
)
def test_the_last_word_that_says_something_decides(name: str, kind: int | None) -> None:
    assert kind_said(name) == kind
