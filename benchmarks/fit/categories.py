"""Which objects are of one category: what is evaluated held out by category is fitted to nothing of the same kind."""

from __future__ import annotations

from typing import TYPE_CHECKING

from benchmarks.fit.drawn import corpus_kinds

if TYPE_CHECKING:
    from collections.abc import Mapping

    from benchmarks.fit.examples import Example

ALIKE: Mapping[str, tuple[str, ...]] = {
    "aircraft": ("light_aircraft", "airplane"),
    "bag": ("plain_bag",),
    "blender": ("food_processor",),
    "bottle": ("spray_bottle", "soap_dispenser", "jar_with_clip", "pump_bottle"),
    "box": ("toolbox", "treasure_chest", "jack_in_the_box", "bread_bin", "lidded_box", "music_box"),
    "bucket": ("plain_bucket",),
    "button": ("button_panel", "control_box", "button_plate", "dial_plate", "key_pad"),
    "cabinet": (
        "wardrobe",
        "nightstand",
        "kitchen_block",
        "wall_cupboard",
        "sideboard_with_sliding_doors",
        "roller_shutter_cabinet",
        "slab_cabinet",
        "slab_wardrobe",
        "doors_and_drawers",
    ),
    "cart": (
        "bar_cart",
        "shopping_cart",
        "tool_cart",
        "hand_truck",
        "pallet_truck",
        "platform_cart",
        "fork_barrow",
        "wheelbarrow",
        "trailer",
        "pallet_jack",
    ),
    "cheval_mirror": ("mirror_on_stand",),
    "clock": ("wall_clock", "plain_clock"),
    "coffee_machine": ("plain_coffee_machine",),
    "cradle": ("rocking_cradle", "crib"),
    "desk_lamp": ("reading_lamp", "rod_lamp"),
    "dishwasher": ("dishwasher_with_racks", "slab_dishwasher"),
    "door": (
        "interior_door",
        "garage_door",
        "revolving_door",
        "room_door",
        "double_door",
        "dutch_door",
        "sliding_room_door",
        "folding_door",
        "slab_garage_door",
        "room_divider",
    ),
    "drawer_cabinet": ("chest_of_drawers", "office_drawer_unit", "drawer_stack", "tray_rack"),
    "fan": ("desk_fan", "tower_fan", "ceiling_fan", "box_fan"),
    "faucet": ("tap", "shower_mixer", "plain_faucet"),
    "fridge": ("slab_fridge",),
    "gate": ("garden_gate", "slab_gate"),
    "gimbal": ("camera_on_tripod",),
    "globe": ("plain_globe",),
    "hand_pump": ("floor_pump",),
    "humanoid": ("articulated_doll",),
    "iv_stand": ("drip_stand",),
    "kettle": ("plain_kettle",),
    "kick_scooter": ("scooter",),
    "kitchen_pot": ("pot_with_lid",),
    "laptop": ("folding_phone", "slab_laptop", "flip_phone"),
    "lathe": ("lathe_machine",),
    "merry_go_round": ("carousel",),
    "microwave": ("slab_microwave",),
    "office_chair": ("piano_stool", "plain_swivel_chair"),
    "oven": ("range_cooker", "slab_oven"),
    "pen": ("capped_pen",),
    "pepper_mill": ("manual_coffee_grinder", "hand_grinder"),
    "piano": ("upright_piano", "grand_piano"),
    "pliers": ("nutcracker", "plain_pliers", "tongs"),
    "plunger_pot": ("french_press",),
    "safe": ("slab_safe",),
    "satellite_dish": ("dish_antenna", "radar_dish"),
    "scissors": ("plain_scissors",),
    "sofa_bed": ("folding_bed", "trundle_bed"),
    "solar_panel": ("solar_tracker",),
    "stapler": ("hole_punch", "plain_stapler"),
    "step_ladder": ("extension_ladder",),
    "suitcase": ("plain_suitcase",),
    "switch": ("switch_panel", "knife_switch", "fuse_box", "rocker_plate", "toggle_plate"),
    "table": (
        "gateleg_table",
        "desk_with_pedestal",
        "standing_desk",
        "drawer_table",
        "folding_table",
        "drop_leaf_table",
    ),
    "telescope": ("refracting_telescope",),
    "toaster": ("lever_toaster",),
    "toilet": ("cistern", "plain_toilet"),
    "trash_can": ("pedal_bin", "plain_bin"),
    "valve": ("gate_valve", "ball_valve"),
    "vehicle": ("box_car", "pickup_truck", "van", "bus_or_tram", "tractor", "dump_truck"),
    "vise": ("bench_vice",),
    "washing_machine": ("top_loader", "round_door_washer"),
    "well": ("well_with_windlass",),
    "window": ("casement_window", "sash_window", "house_shutters", "pane_window", "plain_sliding_window"),
}
"""Category -> kinds of the library that are of it under other names; all others are what they are called."""

_OF_NAME = {name: category for category, names in ALIKE.items() for name in names}


def category_of(example: Example) -> str:
    """The word that real objects of the same kind carry."""
    name = example.category
    if name in _OF_NAME or name not in corpus_kinds():
        return _OF_NAME.get(name, name)
    kind = corpus_kinds()[name].like or name
    return _OF_NAME.get(kind, kind)
