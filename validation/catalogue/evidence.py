"""KV34x to KV36x: does the geometry of two links explain the joint between them?."""

from __future__ import annotations

from kinematify.validation.catalogue.check import Check
from kinematify.validation.finding import Blame, Severity

CHECKS: tuple[Check, ...] = (
    Check(
        id="KV341",
        title="child hangs on what it touches",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies="At rest, every moving body touches the body that carries it, or at least no other one. A child that "
        "is more than evidence.far_gap away from its parent and touches another body is an error; one whose contact "
        "with the parent has less than evidence.weak_contact of the quality of its best other contact is a warning.",
        matters="A part on the wrong parent moves with the wrong thing: the handle stays behind when the door opens.",
        remedy="Write the link that carries the part as the joint's parent and express the origin in its frame.",
    ),
    Check(
        id="KV342",
        title="axis direction is one that the parts show",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies="The axis lies within evidence.unknown_deg of a direction that the two bodies show: axes of round "
        "surfaces and circular edges on both sides of the contact, edges and faces of either body, guides, the normal "
        "and the long side of the contact. Beyond evidence.wrong_deg it is an error where another joint also explains "
        "the contact better by evidence.clearly_better. It needs no ground truth: people build along what they build.",
        matters="A hinge that is turned by some degrees lets a door scrape and lift, and no engine complains.",
        remedy="Align the axis with the hinge or guide; the message names the direction that fits best.",
    ),
    Check(
        id="KV343",
        title="axis runs where the parts have a hinge",
        severity=Severity.WARNING,
        blame=Blame.KINEMATICS,
        verifies="A turning joint's axis runs within evidence.unknown_distance of the child's size (in linkages "
        "evidence.linkage_distance) of a line that the two bodies show: a bearing, an edge or middle line of the part, "
        "the line along which they touch.",
        matters="A door that turns about a line beside its edge cuts through its frame or leaves a gap.",
        remedy="Move the joint's origin onto the hinge line; the message names the line that fits best.",
    ),
    Check(
        id="KV344",
        title="no other joint fits the contact far better",
        severity=Severity.WARNING,
        blame=Blame.KINEMATICS,
        verifies="The declared joint is scored beside all candidates of its type by the cues of the inference (room, "
        "contact near the axis, bearings, handles, margins). A lead of evidence.better (evidence.better_slide for "
        "slides) is a warning, unless both bodies are round about the declared line itself. In linkages, whose "
        "bearings are often not modelled, it takes a lead of evidence.linkage_better with a bearing on both bodies "
        "about another line (evidence.bearing_lead) or a range of which the parent blocks evidence.blocked.",
        matters="A door on the wrong edge, or a knob about the wrong line, moves plausibly in an engine and wrongly.",
        remedy="Compare with the candidate that the message names, and correct axis and origin.",
    ),
    Check(
        id="KV345",
        title="type fits the parts",
        severity=Severity.WARNING,
        blame=Blame.KINEMATICS,
        verifies="Shape and room of the part do not speak for the other type of joint: plates hinge, boxes in a cavity "
        "slide, round parts with a bearing turn, small caps are pressed. Log odds above evidence.type_odds are a "
        "warning; a slide of a linkage must also have a bearing, a better direction (evidence.better_slide) or a "
        "parent in the way (evidence.blocked), and a continuous joint is taken as meant.",
        matters="A drawer that turns and a door that slides are useless for training, and nothing else reports them.",
        remedy="Write the other type with limits in its unit, or accept the finding with a reason.",
    ),
    Check(
        id="KV346",
        title="permitted motion opens",
        severity=Severity.WARNING,
        blame=Blame.KINEMATICS,
        verifies="With a one-sided range (evidence.one_sided), the permitted side does not lead into the parent within "
        "evidence.shut of the range while the other side is free for evidence.open of it; a closed panel does not turn "
        "into its body (evidence.panel_inward), and small parts that slide do not move outwards "
        "(evidence.button_outward).",
        matters="A drawer that opens inwards is stuck in every engine, or flies out of the back of the cabinet.",
        remedy="Reverse the axis, or swap the limits together with their signs.",
    ),
    Check(
        id="KV347",
        title="a slide stays with its parent",
        severity=Severity.WARNING,
        blame=Blame.KINEMATICS,
        verifies="At the end of its range, a part that slides by more than its own length along the axis is not "
        "evidence.far_gap of the model's size farther away from its parent than at rest; beyond, it has left its "
        "guides.",
        matters="A drawer that travels twice its length hangs in the air.",
        remedy="Reduce the limits, for a drawer to about four fifths of its length.",
    ),
    Check(
        id="KV348",
        title="range is usual for such a part",
        severity=Severity.WARNING,
        blame=Blame.KINEMATICS,
        verifies="No limited range is a whole turn, mostly to one side (evidence.whole_turn). Outside linkages, an "
        "upright panel opens by no more than evidence.widest_door, a level one by no more than evidence.widest_lid, "
        "and a button travels by no more than evidence.button_travel of its own length. Meshes do not hold designed "
        "stops, so this is experience.",
        matters="A robot that learns to open a door to twice its angle fails on the real one.",
        remedy="Correct the limit, or accept the finding with a reason.",
    ),
)
