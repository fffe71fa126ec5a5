"""Corruptions of the text of a URDF. Each takes the bytes and a generator and returns other bytes."""

from __future__ import annotations

import copy
from typing import TYPE_CHECKING

import numpy as np
from lxml import etree

if TYPE_CHECKING:
    from collections.abc import Callable

    Random = np.random.Generator
    Corruption = Callable[[bytes, Random], bytes]

NUMBERS = (
    "nan", "NaN", "-nan", "inf", "-inf", "1e308", "-1e308", "1e400", "1e-320", "1e16", "-1", "0", "-0.0", "1e9", "",
    "0x10", "1,5", "1_000", "½", "--1", "1e", "1000", "0.001", "90", "3.4028235e+38", "9" * 400,
)  # fmt: skip
"""What takes the place of one number."""
VALUES = (
    *NUMBERS, " ", "0 0 0", "1 2", "1 2 3 4", "nan nan nan", "1e308 1e308 1e308", "a" * 1100, "a" * 20_000, "0 " * 5000,
    "../../../../etc/passwd", "/dev/zero", "/proc/self/mem", "/", ".", "package://nowhere/mesh.obj", "package://[",
    "http://localhost/mesh.stl", "file:///dev/random", "C:\\mesh.obj", "${radius}", "$(find robot)/mesh.stl", "%00%n",
    "drawer.urdf", "\u202e\U0001f600", "world", "base", "fixed", "floating", "planar", "revolute", "spherical",
    "a/b", "'\"<>&", "__proto__",
)  # fmt: skip
"""What takes the place of a whole attribute."""


def flip_bits(text: bytes, random: Random) -> bytes:
    """Turn over one to twenty bits."""
    changed = bytearray(text)
    for place in random.integers(len(text), size=random.integers(1, 21)):
        changed[place] ^= 1 << int(random.integers(8))
    return bytes(changed)


def overwrite_bytes(text: bytes, random: Random) -> bytes:
    """Write noise over a stretch."""
    start, length = int(random.integers(len(text))), int(random.integers(1, 64))
    return text[:start] + random.bytes(length) + text[start + length :]


def cut_end(text: bytes, random: Random) -> bytes:
    """Keep the beginning only."""
    return text[: int(random.integers(len(text)))]


def drop_bytes(text: bytes, random: Random) -> bytes:
    """Leave out a stretch."""
    start = int(random.integers(len(text)))
    return text[:start] + text[start + int(random.integers(1, 400)) :]


def repeat_bytes(text: bytes, random: Random) -> bytes:
    """Write a stretch twice."""
    start, length = int(random.integers(len(text))), int(random.integers(1, 2000))
    return text[: start + length] + text[start:]


def other_encoding(text: bytes, random: Random) -> bytes:
    """Store it in another encoding than stated, or with a declaration that does not fit."""
    words = text.decode()
    return (
        words.encode("utf-16"),
        words.encode("utf-32"),
        words.replace("name=", "name='é' x=", 1).encode("latin-1", "replace"),
        b'<?xml version="1.0" encoding="ebcdic-cp-us"?>' + text,
        b"\xef\xbb\xbf" + text,
        text.replace(b"<robot", b"\x00<robot", 1),
    )[int(random.integers(6))]


def attack(text: bytes, random: Random) -> bytes:
    """Entities, external files, and depth as attackers use them."""
    bomb = "".join(f'<!ENTITY a{k} "{f"&a{k - 1};" * 10 if k else "ha"}">' for k in range(10))
    prefix = (
        f"<!DOCTYPE robot [{bomb}]>",
        '<!DOCTYPE robot [<!ENTITY a9 SYSTEM "file:///etc/passwd">]>',
        '<!DOCTYPE robot SYSTEM "http://localhost/robot.dtd">',
        '<!DOCTYPE robot [<!ENTITY % a SYSTEM "file:///dev/zero"> %a;]>',
    )[int(random.integers(4))]
    body = text.split(b"?>", 1)[-1]
    if random.random() < 0.5:
        body = body.replace(b'name="', b'name="&a9;', 1)
    return prefix.encode() + body


# ---- changes of the tree ---------------------------------------------------------------------------------------------


def _tree(text: bytes) -> etree._Element:
    return etree.fromstring(text, etree.XMLParser(remove_comments=True))


def _written(root: etree._Element) -> bytes:
    return etree.tostring(root, pretty_print=True)


def _pick(root: etree._Element, random: Random) -> etree._Element:
    elements = list(root.iter(etree.Element))[1:]
    return elements[int(random.integers(len(elements)))]


def _parent(element: etree._Element) -> etree._Element:
    """Of an element below the root."""
    parent = element.getparent()
    if parent is None:
        raise ValueError(f"The element {element.tag} is the root, which is left alone.")
    return parent


def drop_element(text: bytes, random: Random) -> bytes:
    """Leave out one to three elements."""
    root = _tree(text)
    for _ in range(int(random.integers(1, 4))):
        element = _pick(root, random)
        _parent(element).remove(element)
    return _written(root)


def duplicate_element(text: bytes, random: Random) -> bytes:
    """Write an element several times, up to 3,000."""
    root = _tree(text)
    element = _pick(root, random)
    for _ in range(int(random.choice([1, 1, 1, 2, 10, 3000]))):
        element.addnext(copy.deepcopy(element))
    return _written(root)


def nest_element(text: bytes, random: Random) -> bytes:
    """Move an element into another one."""
    root = _tree(text)
    element = _pick(root, random)
    others = [other for other in root.iter(etree.Element) if element not in (other, *other.iterancestors())]
    others[int(random.integers(len(others)))].append(element)
    return _written(root)


def nest_deeply(text: bytes, random: Random) -> bytes:
    """Wrap an element into up to 5,000 others of its kind."""
    root = _tree(text)
    element = _pick(root, random)
    tag, depth = str(element.tag).encode(), int(random.choice([20, 250, 5000]))
    marked = etree.Element("marked")
    element.addprevious(marked)
    return _written(root).replace(b"<marked/>", b"<%b>" % tag * depth + b"</%b>" % tag * depth)


def swap_elements(text: bytes, random: Random) -> bytes:
    """Let two elements change places."""
    root = _tree(text)
    first, second = _pick(root, random), _pick(root, random)
    if first in (second, *second.iterancestors()) or second in first.iterancestors():
        return drop_element(text, random)
    mark = etree.Element("mark")
    first.addprevious(mark)
    second.addprevious(first)
    _parent(mark).replace(mark, second)
    return _written(root)


def rename_element(text: bytes, random: Random) -> bytes:
    """Change a tag."""
    root = _tree(text)
    tags = ("link", "joint", "robot", "Link", "cone", "mesh", "box", "geometry", "xacro_if", "parent", "limit")
    _pick(root, random).tag = str(random.choice(tags))
    return _written(root)


def chain_of_links(text: bytes, random: Random) -> bytes:
    """Hang a chain of up to 20,000 links on the model, or close it to a circle."""
    root = _tree(text)
    first = next(root.iter("link")).get("name") or ""
    count = int(random.choice([50, 250, 1500, 20_000]))
    above = first
    for k in range(count):
        etree.SubElement(root, "link", name=f"chain_{k}")
        joint = etree.SubElement(root, "joint", name=f"chain_{k}", type=str(random.choice(["fixed", "continuous"])))
        etree.SubElement(joint, "parent", link=above)
        above = f"chain_{k}"
        etree.SubElement(joint, "child", link=above)
    if random.random() < 0.2:
        joint = etree.SubElement(root, "joint", name="closing", type="fixed")
        etree.SubElement(joint, "parent", link=above)
        etree.SubElement(joint, "child", link=first)
    return _written(root)


# ---- changes of attributes -------------------------------------------------------------------------------------------


def _attributes(element: etree._Element) -> dict[str, str]:
    return {str(name): str(value) for name, value in element.attrib.items()}


def _pick_attribute(root: etree._Element, random: Random, *, numeric: bool) -> tuple[etree._Element, str]:
    found = [
        (element, name)
        for element in root.iter(etree.Element)
        for name, value in _attributes(element).items()
        if not numeric or value.replace("-", "").replace(".", "")[:1].isdigit()
    ]
    return found[int(random.integers(len(found)))]


def change_number(text: bytes, random: Random) -> bytes:
    """Put something else in the place of one number."""
    root = _tree(text)
    element, name = _pick_attribute(root, random, numeric=True)
    words = _attributes(element)[name].split()
    words[int(random.integers(len(words)))] = str(random.choice(NUMBERS))
    element.set(name, " ".join(words))
    return _written(root)


def scale_numbers(text: bytes, random: Random) -> bytes:
    """Multiply one number in three by something."""
    root = _tree(text)
    factor = float(random.choice([-1.0, 0.0, 1e-3, 1e3, 57.3, 1e12, 1e-12, 1e300]))
    for element in root.iter(etree.Element):
        for name, value in _attributes(element).items():
            try:
                words = [float(word) for word in value.split()]
            except ValueError:
                continue
            if words and random.random() < 1 / 3:
                element.set(name, " ".join(repr(word * factor) for word in words))
    return _written(root)


def change_attribute(text: bytes, random: Random) -> bytes:
    """Put something else in the place of an attribute."""
    root = _tree(text)
    element, name = _pick_attribute(root, random, numeric=False)
    element.set(name, VALUES[int(random.integers(len(VALUES)))])
    return _written(root)


def drop_attribute(text: bytes, random: Random) -> bytes:
    """Leave out one to three attributes."""
    root = _tree(text)
    for _ in range(int(random.integers(1, 4))):
        element, name = _pick_attribute(root, random, numeric=False)
        del element.attrib[name]
    return _written(root)


def exchange_names(text: bytes, random: Random) -> bytes:
    """Let names and references of links and joints point elsewhere."""
    root = _tree(text)
    places = [
        (e, n) for e in root.iter("link", "joint", "parent", "child", "mimic") for n in _attributes(e) if n != "type"
    ]
    names = [_attributes(element)[name] for element, name in places]
    for _ in range(int(random.integers(1, 4))):
        element, name = places[int(random.integers(len(places)))]
        element.set(name, names[int(random.integers(len(names)))])
    return _written(root)


CORRUPTIONS: dict[str, Corruption] = {
    "text: bits flipped": flip_bits,
    "text: bytes overwritten": overwrite_bytes,
    "text: end cut off": cut_end,
    "text: bytes dropped": drop_bytes,
    "text: bytes repeated": repeat_bytes,
    "text: other encoding": other_encoding,
    "text: entities and attacks": attack,
    "tree: elements dropped": drop_element,
    "tree: element duplicated": duplicate_element,
    "tree: element nested": nest_element,
    "tree: nested deeply": nest_deeply,
    "tree: elements swapped": swap_elements,
    "tree: element renamed": rename_element,
    "tree: chain of links": chain_of_links,
    "values: one number": change_number,
    "values: numbers scaled": scale_numbers,
    "values: attribute replaced": change_attribute,
    "values: attributes dropped": drop_attribute,
    "values: names exchanged": exchange_names,
}
