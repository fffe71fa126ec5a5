"""One module per family; `FAMILIES` lists them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.sources.procedural.families import (
    bottle,
    box,
    bucket,
    button_panel,
    cabinet,
    coffee_machine,
    desk_lamp,
    dishwasher,
    door,
    fan,
    faucet,
    folding_chair,
    fridge,
    gantry,
    gripper,
    hand,
    hexapod,
    humanoid,
    laptop,
    microwave,
    office_chair,
    oven,
    pliers,
    quadruped,
    safe,
    scara,
    scissors,
    serial_arm,
    snake,
    stapler,
    switch_panel,
    table,
    toaster,
    toilet,
    trash_can,
    washing_machine,
    window,
)

if TYPE_CHECKING:
    from kinematify.sources.procedural.family import Family

FAMILIES: dict[str, Family] = {
    module.FAMILY.name: module.FAMILY
    for module in (
        cabinet,
        serial_arm,
        scara,
        gantry,
        gripper,
        hand,
        quadruped,
        snake,
        oven,
        fridge,
        table,
        microwave,
        dishwasher,
        washing_machine,
        safe,
        laptop,
        box,
        window,
        door,
        switch_panel,
        button_panel,
        desk_lamp,
        fan,
        toaster,
        coffee_machine,
        trash_can,
        toilet,
        faucet,
        office_chair,
        folding_chair,
        scissors,
        pliers,
        hexapod,
        humanoid,
        stapler,
        bottle,
        bucket,
    )
}
"""Keyed by name."""
