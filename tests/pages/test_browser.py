"""Every page in a real browser: both colour schemes, on the width of a desktop and of a phone."""

import re
import time
from contextlib import suppress

import pytest
from canned_run import failing_case, passing_case, sample
from headless import CONTRASTS, SIZES, Browser, PageLeftError

from weakforms.errors import EnvironmentLackError
from weakforms.verification.judging.outcome import Verdict
from weakforms.verification.report.pdf import browser, write_pdf
from weakforms.verification.report.report import write_report

PAGES = ("index.html", "paper2.html")
WIDTHS = (1280, 390, 320)


def missing() -> bool:
    """Whether a browser is missing; ``./run test`` provides one."""
    try:
        browser()
    except EnvironmentLackError:
        return True
    return False


pytestmark = pytest.mark.skipif(missing(), reason="no Chromium or Chrome here; ./run test brings one")


@pytest.fixture(scope="module")
def window(tmp_path_factory):
    with Browser(tmp_path_factory.mktemp("profile")) as window:
        yield window


@pytest.fixture(scope="module")
def opened(tmp_path_factory):
    """A report with failures and pictures of all kinds, but without the hostile texts."""
    folder = tmp_path_factory.mktemp("opened")
    write_report(sample(passing_case(), failing_case()), folder)
    return folder


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_pages_render(window, opened, width, scheme):
    grounds = {}
    for name in PAGES:
        window.open(opened / name, width, scheme)
        sizes = window.evaluate(SIZES)
        assert window.complaints() == []
        assert window.requests() == [(opened / name).as_uri()]
        assert sizes["needed"] <= sizes["width"], f"{name} must be pushed sideways at {width}"
        assert sizes["heading"] > 20
        least, text = window.evaluate(CONTRASTS)[0]
        assert least >= 4.5, f"{name}, {scheme}: contrast {least:.2f} of {text!r}"
        assert window.unnamed_images() == []
        grounds[name] = sum(map(int, re.findall(r"\d+", sizes["background"])[:3])) / 3
    assert all(ground > 200 if scheme == "light" else ground < 60 for ground in grounds.values())


def test_hostile_texts_do_nothing(window, folder):
    for page in sorted(folder.glob("*.html")):
        window.open(page, 390, "light")
        sizes = window.evaluate(SIZES)
        assert window.complaints() == []
        assert sizes["needed"] <= sizes["width"], page.name


def test_links_lead_somewhere(window, opened):
    window.open(opened / "index.html", 1280, "light")
    with suppress(PageLeftError):
        window.evaluate("document.querySelector('a[href=\"paper2.html\"]').click()")
    # The address changes before the page is there.
    there = "location.pathname.endsWith('paper2.html') && document.readyState === 'complete'"
    for _ in range(200):
        with suppress(PageLeftError):
            if window.evaluate(there):
                break
        time.sleep(0.05)
    assert window.evaluate("document.querySelector('h1').textContent").strip().endswith("membrane")


@pytest.mark.parametrize(
    ("fault", "sense"),
    [
        ("<script>throw new Error('x')</script>", "complaints"),
        ("<script>console.warn('x')</script>", "complaints"),
        ("<img src='not-there.png' alt='x'>", "requests"),
        ("<p style='width: 2000px'>wide</p>", "overflow"),
        ("<p style='color: #999'>faint</p>", "contrast"),
        ("<svg role='img' width='9' height='9'></svg>", "pictures"),
    ],
)
def test_a_fault_would_be_seen(window, tmp_path, fault, sense):
    page = tmp_path / "page.html"
    page.write_text(f"<!DOCTYPE html><html lang=en><title>x</title><body><h1>x</h1>{fault}", "utf-8")
    window.open(page, 390, "light")
    sizes = window.evaluate(SIZES)
    seen = {
        "complaints": window.complaints() != [],
        "overflow": sizes["needed"] > sizes["width"],
        "contrast": window.evaluate(CONTRASTS)[0][0] < 4.5,
        "pictures": window.unnamed_images() != [],
        "requests": len(window.requests()) > 1,
    }
    assert seen.pop(sense)
    assert not any(seen.values()) or "not-there" in fault


def test_a_print_shows_failed_checks_and_leaves_the_usual_ones_to_the_count(window, tmp_path):
    case = failing_case()
    case.verdicts += [
        Verdict("trace:a", "trace", True, "The branch is one."),
        Verdict("trace:b", "trace", False, "The branch is two."),
    ]
    write_report(sample(case), tmp_path)
    window.open(tmp_path / "paper2.html", 1280, "light")
    seen = "[...document.querySelectorAll('table.checks tbody tr')].filter(e => e.checkVisibility()).length"
    assert window.evaluate(seen) == 5
    window.call("Emulation.setEmulatedMedia", media="print")
    assert window.evaluate(seen) == 4
    window.call("Emulation.setEmulatedMedia", media="")


def test_the_whole_report_as_a_pdf(opened, tmp_path):
    path = write_pdf(sample(passing_case(), failing_case()), tmp_path / "report.pdf")
    data = path.read_bytes()
    assert data.startswith(b"%PDF-")
    assert data.rstrip().endswith(b"%%EOF")
    assert len(re.findall(rb"/Type\s*/Page\b", data)) >= 3
    assert [item.name for item in tmp_path.iterdir()] == ["report.pdf"]
