"""Drawings for inclusion in a page: without their own ids, styles and colours, and as short as possible."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from xml.etree import ElementTree as ET

from weakforms.verification.report.junit import clean

FEWEST = 4
"""Number of equal marks from which they are written as one path."""

GLYPH = re.compile(r'<path id="([\w-]+--)(STIX\w*-\w+-[0-9a-f]+)"( [^>]*)/>')
"""A letter in a drawing; its name tells font and character, so that it is the same in every drawing."""

WORD = re.compile(r'(?:<use href="#STIX[\w-]+" transform="[^"]*" ?/>){2,}')
"""Letters that follow each other; the same text has the same letters at the same places."""
STYLE = re.compile(r' style="(?:fill|stroke)[^"]{16,}"')
"""The style of an element of a drawing."""


def inline_svg(drawing: str, ident: str, title: str, description: str, colours: Mapping[str, str]) -> str:
    """A matplotlib drawing, prepared for a page with other drawings.

    Args:
        drawing: The SVG document from matplotlib.
        ident: Every id, and every reference to one, gets this prefix.
        title: Accessible name.
        description: Description of the drawing in words.
        colours: Hexadecimal colour to the CSS variable that may replace it.

    Returns:
        An ``<svg>`` element without document type, metadata, style sheet or fixed size.
    """
    root = ET.fromstring(drawing)
    for parent in root.iter():
        for child in list(parent):
            if child.tag.rpartition("}")[2] in ("metadata", "style"):
                parent.remove(child)
    used = set(re.findall(r"#([\w-]+)", " ".join(v for e in root.iter() for v in e.attrib.values())))
    names = [name for name in (e.get("id") for e in root.iter()) if name in used]
    short = {name: name if name.startswith("STIX") else str(k) for k, name in enumerate(names)}
    for element in root.iter():
        element.tag = element.tag.rpartition("}")[2]
        attributes = {key.rpartition("}")[2]: value for key, value in element.attrib.items()}
        element.attrib.clear()
        for key, value in attributes.items():
            if key != "id" or value in used:
                element.set(key, _rewritten(key, value, ident, colours, short))
    box = root.get("viewBox", "")
    root.attrib.clear()
    root.attrib |= {"xmlns": "http://www.w3.org/2000/svg", "viewBox": box, "role": "img"}
    root.attrib |= {"aria-labelledby": f"{ident}--title {ident}--desc", "class": "figure"}
    root.attrib |= {"stroke-linejoin": "round", "stroke-linecap": "butt"}
    for group in root.iter("g"):
        styles = {use.get("style") for use in group} if all(e.tag == "use" for e in group) else ()
        if len(styles) == 1 and len(group) > 1 and not group.get("style") and None not in styles:
            group.set("style", styles.pop() or "")
            for use in group:
                del use.attrib["style"]
    _with_markers(root)
    _unwrap(root)
    for place, (tag, text) in enumerate((("title", title), ("desc", description))):
        element = ET.Element(tag, id=f"{ident}--{tag}")
        element.text = clean(text)
        root.insert(place, element)
    for element in root.iter():
        element.tail = None
        element.text = (element.text or "").strip() or None
    return ET.tostring(root, encoding="unicode", short_empty_elements=True).replace(" />", "/>")


def _unwrap(element: ET.Element) -> None:
    """Leave out what shows nothing: groups without a style or a place, and areas without a colour."""
    kept: list[ET.Element] = []
    for child in element:
        _unwrap(child)
        if child.tag == "path" and child.get("style") == "fill: none" and not child.get("id"):
            continue
        bare = child.tag in ("g", "defs") and not child.attrib
        kept.extend(child if bare and (child.tag == "g" or not len(child)) else [child])
    element[:] = kept


def _rewritten(key: str, value: str, ident: str, colours: Mapping[str, str], short: Mapping[str, str]) -> str:
    if key == "id":
        return f"{ident}--{short[value]}"
    if key == "href":
        return f"#{ident}--{short[value[1:]]}"
    if key == "d" and not re.search("[^MLz0-9. -]", value):
        return _differences(value)
    if key in ("d", "x", "y"):
        return " ".join(re.sub(r"(\.\d\d)\d+", r"\1", value).split())
    if key == "transform":
        return re.sub(r"translate\([^)]*\)", lambda hit: re.sub(r"-?\d+\.\d+", _rounded, hit[0]), value)
    value = re.sub(r"url\(#([\w-]+)", lambda hit: f"url(#{ident}--{short[hit[1]]}", value)
    return re.sub(
        "#[0-9a-f]{6}",
        lambda hit: f"var({colours[hit[0]]},{hit[0]})" if hit[0] in colours else hit[0],
        value,
    )


def _differences(lines: str) -> str:
    """Straight lines written by their differences in hundredths of a point, without repeated points."""
    text, first, here, letter = "", (0, 0), (0, 0), ""
    for command, numbers in re.findall("([MLz])([^MLz]*)", lines):
        if command == "z":
            text, here, letter = f"{text}z", first, "z"
            continue
        x, y = (round(100 * float(number)) for number in numbers.split())
        step = (x, y) if command == "M" else (x - here[0], y - here[1])
        if command == "L" and step == (0, 0) and letter == "l":
            continue
        if command == "M":
            first, text = (x, y), f"{text}M"
        else:
            text += "l" if letter != "l" else "" if step[0] < 0 else " "
        text += _hundredths(step[0]) + ("" if step[1] < 0 else " ") + _hundredths(step[1])
        here, letter = (x, y), command.lower()
    return text


def _rounded(found: re.Match[str]) -> str:
    return _hundredths(round(100 * float(found[0])))


def _hundredths(number: int) -> str:
    """A number of hundredths as a decimal fraction, as short as possible."""
    text = f"{abs(number) / 100:g}"
    return "-" * (number < 0) + (text.removeprefix("0") if text != "0" else text)


def _with_markers(root: ET.Element) -> None:
    """Write equal marks as one path with SVG markers, which takes a quarter of the characters."""
    marks = {f"#{e.get('id')}": e for e in root.iter("path") if e.get("id")}
    for number, group in enumerate(root.iter("g")):
        uses = list(group)
        named = {use.get("href") for use in uses}
        plain = all(use.tag == "use" and set(use.attrib) <= {"href", "x", "y"} for use in uses)
        if len(uses) < FEWEST or len(named) != 1 or not plain or not named <= marks.keys():
            continue
        mark = marks[str(named.pop())]
        ident = f"{mark.get('id')}-{number}"
        shown = {key: value for key, value in mark.attrib.items() if key != "id"}
        places = "L".join(f"{use.get('x')} {use.get('y')}" for use in uses)
        for use in uses:
            group.remove(use)
        look = {"id": ident, "overflow": "visible", "markerUnits": "userSpaceOnUse"}
        marker = ET.SubElement(group, "marker", look)
        ET.SubElement(marker, "path", shown)
        ends = {f"marker-{place}": f"url(#{ident})" for place in ("start", "mid", "end")}
        ET.SubElement(group, "path", {"d": f"M{places}", "style": "fill: none; stroke: none", **ends})
    used = {use.get("href") for use in root.iter("use")}
    for defs in root.iter("defs"):
        for path in [p for p in defs if p.tag == "path" and f"#{p.get('id')}" not in used]:
            defs.remove(path)


def standalone(drawing: str) -> str:
    """A drawing of a page as a file of its own, with the colours of light pages."""
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n' + re.sub(r"var\(--[\w-]+,(#\w+)\)", r"\1", drawing) + "\n"
    )


def share_letters(page: str) -> str:
    """A page on which letters, repeated words and styles of its drawings are defined once, before its text.

    Blanks between the cells of its tables are left out.
    """
    page = re.sub(r"(</t[dhr]>|<tr[^>]*>)\s+(?=<)", r"\1", page)
    letters: dict[str, str] = {}

    def keep(found: re.Match[str]) -> str:
        letters.setdefault(found[2], f'<path id="{found[2]}"{found[3]}/>')
        return ""

    page = GLYPH.sub(keep, page)
    if not letters:
        return page
    page = re.sub(
        r'href="#[\w-]+--(STIX\w*-\w+-[0-9a-f]+)"', r'href="#\1"', page.replace("<defs></defs>", "")
    )
    page, words = _numbered(page, WORD, "w", '<use href="#{}"/>')
    page, styles = _numbered(page, STYLE, "s", ' class="{}"')
    groups = "".join(f'<g id="{name}">{word}</g>' for word, name in words.items())
    rules = "".join(f".{name}{{{style[8:-1]}}}" for style, name in styles.items())
    defined = f"<style>{rules}</style>" * bool(rules) + "".join(letters.values()) + groups
    shared = f'<svg width="0" height="0" aria-hidden="true" class="letters"><defs>{defined}</defs></svg>'
    start = page.index(">", page.index("<body")) + 1
    return f"{page[:start]}{shared}{page[start:]}"


def _numbered(page: str, what: re.Pattern[str], letter: str, instead: str) -> tuple[str, dict[str, str]]:
    """The page with a name in place of everything that occurs twice, and the names."""
    repeated = [text for text, times in Counter(what.findall(page)).items() if times > 1]
    names = {text: f"{letter}{k}" for k, text in enumerate(repeated)}
    page = what.sub(lambda hit: instead.format(names[hit[0]]) if hit[0] in names else hit[0], page)
    return page, names
