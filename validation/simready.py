"""Rules of NVIDIA's SimReady Foundation that run only inside Kit, and the checks that answer them for a URDF."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

ANSWERED: Mapping[str, tuple[str, tuple[str, ...]]] = {
    "DJ_001": ("Drives and the state at the start fit the limits", ("KV137", "KV222", "KV223")),
    "DJ_002": ("Joints have a state that can be read and set", ("KV801",)),
    "DJ_003": ("Frames of a joint meet in its state", ("KV801",)),
    "DJ_004": ("A joint is driven or follows another", ("KV127", "KV223")),
    "DJ_005": ("Joints have a velocity limit", ("KV223",)),
    "DJ_006": ("Values of drives are plausible", ("KV220", "KV224", "KV226")),
    "DJ_007": ("Followers have a leader and stay within their limits", ("KV127", "KV128", "KV225")),
    "DJ_008": ("Joints of the robot exist", ("KV110", "KV111")),
    "DJ_009": ("Links of the robot exist and are connected", ("KV120", "KV121", "KV126")),
    "DJ_010": ("Joints and links form a tree", ("KV122", "KV123", "KV124", "KV125")),
    "DJ_011": ("No loops, and one joint between two bodies", ("KV123", "KV124", "KV230")),
    "BA_001": ("There is one root of the articulation", ("KV125",)),
    "BA_002": ("Links that no joint connects do not interpenetrate", ("KV301", "KV802")),
    "JT_ART_001": ("Chains of joints are an articulation", ("KV125", "KV126")),
    "JT_ART_002": ("Articulations are not nested", ("KV125",)),
    "JT_ART_003": ("The articulation holds no kinematic body", ("KV201", "KV804")),
    "JT_ART_004": ("The articulation holds no static body", ("KV201", "KV804")),
}
"""By rule: what it asks, and our checks."""


def answered_markdown() -> list[str]:
    """Return the section of docs/checks.md."""
    rows = [
        f"| {rule} | {asks} | {', '.join(f'[{name}](#{name.lower()})' for name in names)} |"
        for rule, (asks, names) in ANSWERED.items()
    ]
    return [
        "## Rules of NVIDIA's SimReady Foundation",
        "",
        "These need Kit and its PhysX schemas. The checks on the right answer the same question for the URDF before it",
        "is exported; [formats.md](formats.md#what-nvidias-validator-says-of-the-usd) has the rules that run anywhere.",
        "",
        "| rule | asks | answered by |",
        "|---|---|---|",
        *rows,
    ]
