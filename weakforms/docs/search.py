"""A page that finds words in all other pages, in the reader's browser and without a server."""

from __future__ import annotations

import base64
import hashlib
import html
import json
import re
from collections.abc import Mapping
from itertools import pairwise

SCRIPT = """
const entries = JSON.parse(document.getElementById("entries").textContent);
const asked = document.getElementById("asked"), found = document.getElementById("found");
function show() {
  const words = asked.value.toLowerCase().split(/\\s+/).filter(Boolean);
  found.replaceChildren();
  if (!words.length) return;
  const rank = ([title]) => words.filter(word => title.toLowerCase().includes(word)).length;
  const has = ([title, , text], word) => text.includes(word) || title.toLowerCase().includes(word);
  const hits = entries.filter(entry => words.every(word => has(entry, word)));
  hits.sort((a, b) => rank(b) - rank(a));
  for (const [title, place] of hits.slice(0, 40)) {
    const item = document.createElement("li"), link = document.createElement("a");
    link.href = place;
    link.textContent = title;
    item.append(link);
    found.append(item);
  }
  document.getElementById("count").textContent = `${hits.length} found`;
}
asked.addEventListener("input", show);
""".strip()
"""Shows the sections whose title or text has every word that is asked for."""

HEADING = re.compile(
    r'<(?:section[^>]*id="([^"]+)"[^>]*>\s*<h2[^>]*|h[23](?: id="([^"]+)")?[^>]*)>(.*?)</h[23]>', re.S
)
WORD = re.compile(r"[a-zA-Zα-ωΑ-Ω_][\w.-]+")


def policy() -> str:
    """The source of scripts that the page allows: this one only, by its checksum."""
    digest = base64.b64encode(hashlib.sha256(SCRIPT.encode()).digest()).decode()
    return f"script-src 'sha256-{digest}'"


def entries(pages: Mapping[str, str]) -> str:
    """Title, place and words of every section of every page, as JSON that may stand in a page.

    Args:
        pages: HTML by file name.
    """
    found = []
    for name, text in pages.items():
        title = _plain(re.search(r"<h1>(.*?)</h1>", text, re.S)[1])
        body = text.partition('<main id="main"')[2].partition("</main>")[0]
        body = re.sub(r"<(svg|style|script)\b.*?</\1>", " ", body, flags=re.S)
        cuts = list(HEADING.finditer(body))
        edges = [0, *(hit.start() for hit in cuts), len(body)]
        for k, (start, stop) in enumerate(pairwise(edges)):
            hit = cuts[k - 1] if k else None
            anchor = (hit[1] or hit[2] or "") if hit else ""
            heading = f"{title}: {_plain(hit[3])}" if hit else title
            words = " ".join(sorted(set(WORD.findall(_plain(body[start:stop]).lower()))))
            found.append((heading, f"{name}#{anchor}" if anchor else name, words))
    return json.dumps(found, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")


def _plain(text: str) -> str:
    return " ".join(html.unescape(re.sub(r"<[^>]+>", " ", text)).split())
