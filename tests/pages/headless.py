"""A real browser without a window, controlled through a pipe (the Chrome DevTools Protocol)."""

from __future__ import annotations

import fcntl
import json
import os
import subprocess
import time
from pathlib import Path

from weakforms.verification.report.pdf import QUIET, browser

PATIENCE = 60
HIGH = 20
"""A file descriptor above those the browser expects its pipes at, 3 and 4."""

TALK = ("Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded")
"""What a page that is in order never causes."""

SIZES = """({
    width: document.documentElement.clientWidth, needed: document.documentElement.scrollWidth,
    background: getComputedStyle(document.body).backgroundColor,
    heading: document.querySelector("h1").getBoundingClientRect().height})"""

CONTRASTS = """(() => {
  const rgb = (text) => { const p = text.match(/[\\d.]+/g).map(Number);
    return p.length < 4 ? [...p, 1] : p; };
  const light = (c) => { const l = c.slice(0, 3).map((v) => (v /= 255) <= 0.03928 ? v / 12.92
    : ((v + 0.055) / 1.055) ** 2.4); return 0.2126 * l[0] + 0.7152 * l[1] + 0.0722 * l[2]; };
  const ground = (e) => { for (; e; e = e.parentElement) { const c = rgb(getComputedStyle(e).backgroundColor);
    if (c[3] > 0) return c; } return [255, 255, 255, 1]; };
  const out = [];
  for (const e of document.querySelectorAll("body *:not(svg *)")) {
    if (![...e.childNodes].some((n) => n.nodeType === 3 && n.data.trim()) || !e.checkVisibility()) continue;
    const [a, b] = [light(rgb(getComputedStyle(e).color)), light(ground(e))];
    out.push([(Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05), e.textContent.trim().slice(0, 40)]);
  }
  return out.sort((p, q) => p[0] - q[0]).slice(0, 3);
})()"""
"""The least contrasts of text with what is behind it, after WCAG 2."""


class PageLeftError(Exception):
    """The browser went on to another page while a script ran."""


class Browser:
    """One browser with one page; use it in a ``with`` statement."""

    def __init__(self, folder: Path) -> None:
        (there, theirs_out), (theirs_in, self._write) = os.pipe(), os.pipe()
        self._read = there
        ends = [fcntl.fcntl(end, fcntl.F_DUPFD, HIGH) for end in (theirs_in, theirs_out)]
        os.close(theirs_in), os.close(theirs_out)
        command = [browser(), *QUIET, "--no-sandbox", "--remote-debugging-pipe", f"--user-data-dir={folder}"]
        pipes = f'exec "$@" 3<&{ends[0]} 4>&{ends[1]}'
        self._process = subprocess.Popen(
            ["bash", "-c", pipes, "bash", *command, "about:blank"],
            env=os.environ | {"HOME": str(folder)},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            pass_fds=ends,
        )
        for end in ends:
            os.close(end)
        self._buffer, self._number, self.events = b"", 0, []
        os.set_blocking(self._read, False)
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self._session = session
        for domain in ("Page", "Runtime", "Log", "Network", "Accessibility"):
            self.call(f"{domain}.enable")
        self.call("Page.setLifecycleEventsEnabled", enabled=True)

    _session: str | None = None

    def __enter__(self) -> Browser:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.terminate()
        self._process.wait(20)
        os.close(self._read), os.close(self._write)

    def call(self, method: str, **parameters: object) -> dict:
        """The answer to one command; events that arrive before it are stored."""
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        answer = self._until(lambda heard: heard.get("id") == self._number)
        if "navigated" in answer.get("error", {}).get("message", ""):
            raise PageLeftError(method)
        assert "error" not in answer, (method, answer["error"])
        return answer["result"]

    def _until(self, wanted) -> dict:
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if b"\0" in self._buffer:
                text, _, self._buffer = self._buffer.partition(b"\0")
                heard = json.loads(text)
                self.events += [heard] if "method" in heard else []
                if wanted(heard):
                    return heard
                continue
            try:
                self._buffer += os.read(self._read, 1 << 20)
            except BlockingIOError:
                assert self._process.poll() is None, "the browser ended"
                time.sleep(0.005)
        raise TimeoutError("the browser does not answer")

    def open(self, page: Path, width: int, scheme: str) -> None:
        """Show a page at a given width and colour scheme, and wait until it is loaded."""
        phone = width < 500
        self.call(
            "Emulation.setDeviceMetricsOverride", width=width, height=844, deviceScaleFactor=1, mobile=phone
        )
        scheme = {"name": "prefers-color-scheme", "value": scheme}
        self.call("Emulation.setEmulatedMedia", features=[scheme])
        self.events.clear()
        loader = self.call("Page.navigate", url=page.as_uri())["loaderId"]

        def loaded(heard: dict) -> bool:
            about = heard.get("params", {})
            return about.get("loaderId") == loader and about.get("name") == "load"

        if not any(map(loaded, self.events)):
            self._until(loaded)

    def evaluate(self, script: str) -> object:
        """The value of an expression on the page."""
        answer = self.call("Runtime.evaluate", expression=script, returnByValue=True)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def complaints(self) -> list[dict]:
        """Messages on the page's console, and errors, since it was opened."""
        return [event["params"] for event in self.events if event["method"] in TALK]

    def requests(self) -> list[str]:
        """Addresses loaded since the page was opened."""
        sent = [event for event in self.events if event["method"] == "Network.requestWillBeSent"]
        return [event["params"]["request"]["url"] for event in sent]

    def unnamed_images(self) -> list[dict]:
        """Pictures without a description for screen readers."""
        nodes = self.call("Accessibility.getFullAXTree")["nodes"]
        pictures = [n for n in nodes if not n["ignored"] and n.get("role", {}).get("value") == "image"]
        assert pictures or "<svg" not in self.evaluate("document.documentElement.outerHTML")
        return [n for n in pictures if not n.get("name", {}).get("value", "").strip()]
