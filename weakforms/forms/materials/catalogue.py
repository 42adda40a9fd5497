"""The material laws by name, with constants, ranges, defaults, scaling and source."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from ufl.core.expr import Expr

from weakforms.forms.materials import chains, phenomenological, plane_stress

SCALE = "S, any stress; energies and pressures are over it"


@dataclass(frozen=True)
class Constant:
    """A constant of a law, its default and its range."""

    default: float
    low: float
    high: float
    meaning: str
    open_low: bool = False
    """Whether the lower end of the range is excluded."""

    @property
    def allowed(self) -> str:
        """The range as text."""
        return f"{'>' if self.open_low else '>='} {self.low:g} and <= {self.high:g}"

    def contains(self, value: float) -> bool:
        """Whether a value is in the range."""
        return (self.low < value if self.open_low else self.low <= value) and value <= self.high


def natural(lam1: Expr, **_constants: Expr) -> Expr:
    r"""Width in uniaxial tension for every isotropic incompressible law."""
    return lam1**-0.5


def admitted(_constants: Mapping[str, float]) -> str:
    """No condition on the constants besides their ranges."""
    return ""


@dataclass(frozen=True)
class Material:
    """A law ``w(lam1, lam2, **constants)`` with its constants, its scaling and its source."""

    name: str
    title: str
    law: Callable[..., Expr]
    text: str
    """The energy as text."""
    source: str
    constants: Mapping[str, Constant]
    scale: str = SCALE
    kind: str = "phenomenological"
    incompressible: bool = True
    width: Callable[..., Expr] = natural
    """Transverse stretch in uniaxial tension, ``width(lam1, **constants)``."""
    refusal: Callable[[Mapping[str, float]], str] = field(default=admitted)
    """Why a set of constants is refused although each is in its range; empty if it is admitted."""

    def energy(self, constants: Mapping[str, Expr]) -> Callable[[Expr, Expr], Expr]:
        """The law as a function of the two principal stretches alone."""
        return lambda lam1, lam2: self.law(lam1, lam2, **constants)

    def natural_width(self, constants: Mapping[str, Expr]) -> Callable[[Expr], Expr]:
        """The width in uniaxial tension as a function of the stretch alone."""
        return lambda lam1: self.width(lam1, **constants)


def _modulus(default: float, meaning: str) -> Constant:
    return Constant(default, 0.0, 1e9, f"{meaning}, over S", open_low=True)


def _coefficient(default: float, meaning: str, low: float = 0.0) -> Constant:
    return Constant(default, low, 1e9, f"{meaning}, over S")


SERIES = {(i, j): f"c{i}{j}" for n in (1, 2, 3) for i, j in zip(range(n, -1, -1), range(n + 1), strict=True)}
"""Names of the constants of Rivlin's series up to third order, by their powers."""


def _rivlin_refusal(c: Mapping[str, float]) -> str:
    """Why a series is refused: each invariant's cubic must not be negative, so that the energy grows."""
    if not c["c10"] + c["c01"] > 0:
        return "c10 + c01 must be positive: it is half the shear modulus"
    for linear, square, cube in (("c10", "c20", "c30"), ("c01", "c02", "c03")):
        if c[square] < 0 and c[square] ** 2 > 4 * c[linear] * c[cube]:
            return f"{square} = {c[square]:g} makes the energy negative; allowed: >= -2 sqrt({linear} {cube})"
    return ""


def _biderman_refusal(c: Mapping[str, float]) -> str:
    return _rivlin_refusal({**dict.fromkeys(SERIES.values(), 0.0), **c})


def _ogden_refusal(c: Mapping[str, float]) -> str:
    for i in (1, 2, 3):
        mu, alpha = c[f"mu{i}"], c[f"alpha{i}"]
        if mu != 0 and not mu * alpha > 0:
            return f"mu{i} alpha{i} = {mu:g} * {alpha:g} must be positive (mu{i} = 0 leaves the term out)"
    return "" if any(c[f"mu{i}"] for i in (1, 2, 3)) else "one of mu1, mu2, mu3 must not be 0"


def _rivlin_law(lam1: Expr, lam2: Expr, **c: Expr) -> Expr:
    return phenomenological.rivlin(lam1, lam2, [(i, j, c[name]) for (i, j), name in SERIES.items()])


def _biderman(lam1: Expr, lam2: Expr, c10: Expr, c01: Expr, c20: Expr, c30: Expr) -> Expr:
    return phenomenological.rivlin(lam1, lam2, [(1, 0, c10), (0, 1, c01), (2, 0, c20), (3, 0, c30)])


def _ogden(lam1: Expr, lam2: Expr, **c: Expr) -> Expr:
    return phenomenological.ogden(lam1, lam2, [(c[f"mu{i}"], c[f"alpha{i}"]) for i in (1, 2, 3)])


def _rivlin_saunders(lam1: Expr, lam2: Expr, c10: Expr, c01: Expr, q: Expr) -> Expr:
    return phenomenological.rivlin_saunders(lam1, lam2, c10, phenomenological.falling_slope(c01, q))


_SERIES_DEFAULTS = {"c10": 1.0, "c01": 0.1, "c20": 0.01, "c11": 0.001, "c30": 1e-4}
_OGDEN = {"mu": (1.491, 0.003, -0.023), "alpha": (1.3, 5.0, -2.0)}
_MU = "S; the defaults give the small-strain shear modulus 2 S, as C1 = S does"
_NKT = "S; by default N K T = 2 S: long chains have the shear modulus 2 S, as for C1 = S"
_LINKS = Constant(26.5, 1.0, 1e6, "links n of a chain: it is fully stretched at sqrt(n)", open_low=True)

MATERIALS: dict[str, Material] = {
    m.name: m
    for m in (
        Material(
            "neo_hookean",
            "Neo-Hookean",
            phenomenological.neo_hookean,
            "w = I1 - 3",
            "Treloar (1944); thesis, equations 3.6 and 3.7",
            {},
            scale="C1 = N K T/2",
            kind="micro-mechanical",
        ),
        Material(
            "mooney_rivlin",
            "Mooney (Mooney-Rivlin)",
            phenomenological.mooney_rivlin,
            "w = I1 - 3 + alpha (I2 - 3)",
            "Mooney (1940); thesis, equation 3.1",
            {"alpha": Constant(0.1, 0.0, 10.0, "C2/C1")},
            scale="C1",
        ),
        Material(
            "rivlin",
            "General Mooney-Rivlin series, to third order",
            _rivlin_law,
            "w = sum c_ij (I1 - 3)^i (I2 - 3)^j, i + j <= 3",
            "Rivlin (1948); thesis, equation 3.2",
            {
                name: _coefficient(
                    _SERIES_DEFAULTS.get(name, 0.0),
                    f"of (I1-3)^{i} (I2-3)^{j}",
                    -1e9 if (i, j) in ((2, 0), (0, 2)) else 0.0,
                )
                for (i, j), name in SERIES.items()
            },
            refusal=_rivlin_refusal,
        ),
        Material(
            "ogden",
            "Ogden, three terms",
            _ogden,
            "w = sum mu_i/alpha_i (lam1^alpha_i + lam2^alpha_i + lam3^alpha_i - 3), mu_i alpha_i > 0",
            "Ogden (1972, 1997); thesis, equation 3.3; defaults: the three-term rubber over its modulus",
            {
                f"{letter}{i + 1}": Constant(
                    _OGDEN[letter][i],
                    -1e9 if letter == "mu" else -100.0,
                    1e9 if letter == "mu" else 100.0,
                    f"{letter}_{i + 1}, {'over S' if letter == 'mu' else '1'}",
                )
                for i in range(3)
                for letter in ("mu", "alpha")
            },
            scale="S; the defaults are over the small-strain shear modulus, S = mu",
            refusal=_ogden_refusal,
        ),
        Material(
            "biderman",
            "Biderman",
            _biderman,
            "w = c10 (I1 - 3) + c01 (I2 - 3) + c20 (I1 - 3)^2 + c30 (I1 - 3)^3",
            "Biderman (1958); thesis, equation 3.4; defaults: signs and sizes usual for natural rubber",
            {
                "c10": _coefficient(1.0, "of I1 - 3"),
                "c01": _coefficient(0.1, "of I2 - 3"),
                "c20": _coefficient(-0.01, "of (I1 - 3)^2", -1e9),
                "c30": _coefficient(0.002, "of (I1 - 3)^3"),
            },
            refusal=_biderman_refusal,
        ),
        Material(
            "rivlin_saunders",
            "Rivlin-Saunders, with a slope in I2 that decreases",
            _rivlin_saunders,
            "w = c10 (I1 - 3) + f(I2 - 3), f(x) = c01 q ln(1 + x/q) (forms take any f)",
            "Rivlin & Saunders (1951); thesis, equation 3.5",
            {
                "c10": _modulus(1.0, "of I1 - 3"),
                "c01": _coefficient(0.2, "initial slope of f"),
                "q": Constant(3.0, 0.0, 1e9, "I2 - 3 at which the slope of f has halved", open_low=True),
            },
        ),
        Material(
            "three_chain",
            "3-chain",
            chains.three_chain,
            "w = (nkt n/3) sum [e(lam_i/sqrt n) - e(1/sqrt n)], e' = inverse Langevin function",
            "James & Guth (1943); thesis, equation 3.8",
            {"nkt": _modulus(2.0, "N K T"), "links": _LINKS},
            scale=_NKT,
            kind="micro-mechanical",
        ),
        Material(
            "arruda_boyce",
            "8-chain (Arruda-Boyce)",
            chains.arruda_boyce,
            "w = nkt n [e(sqrt(I1/(3 n))) - e(1/sqrt n)], e' = inverse Langevin function",
            "Arruda & Boyce (1993); thesis, equations 3.9 and 3.10; n = 26.5: Treloar's rubber",
            {"nkt": _modulus(2.0, "N K T"), "links": _LINKS},
            scale=_NKT,
            kind="micro-mechanical",
        ),
        Material(
            "beda_chevalier",
            "Beda-Chevalier",
            phenomenological.beda_chevalier,
            "w = k1 (I1 - 3) + k2 ln(I2/3) + (k3/power)(lam1^power + lam2^power + lam3^power - 3)",
            "Beda & Chevalier (2003); thesis, equation 3.11 (which prints its last term without a modulus)",
            {
                "k1": _modulus(1.0, "of I1 - 3"),
                "k2": _coefficient(2.36, "of ln(I2/3); K2/K1 = 0.30/0.127 as printed"),
                "k3": _coefficient(1e-3, "of the last term"),
                "power": Constant(5.0, 2.0, 100.0, "exponent, 1", open_low=True),
            },
            kind="hybrid",
        ),
        Material(
            "saint_venant_kirchhoff",
            "Saint Venant-Kirchhoff in plane stress",
            plane_stress.saint_venant_kirchhoff,
            "w = shear nu/(1 - nu) (tr E)^2 + shear tr E^2, E of the sheet",
            "Thesis, equation 3.12; Gil & Bonet (2006). Not admissible: finite energy at lam -> 0",
            {
                "shear": _modulus(2.0, "shear modulus"),
                "poisson": Constant(0.5, 0.0, 0.5, "Poisson's ratio, 1"),
            },
            kind="other",
            incompressible=False,
            width=lambda lam1, poisson, **_: plane_stress.kirchhoff_width(lam1, poisson),
        ),
        Material(
            "varga",
            "Varga",
            phenomenological.varga,
            "w = 2 shear (lam1 + lam2 + lam3 - 3)",
            "Varga (1966)",
            {"shear": _modulus(2.0, "shear modulus")},
            scale=_MU,
        ),
        Material(
            "gent",
            "Gent",
            phenomenological.gent,
            "w = -(shear jm/2) ln(1 - (I1 - 3)/jm)",
            "Gent (1996)",
            {
                "shear": _modulus(2.0, "shear modulus"),
                "jm": Constant(97.2, 0.0, 1e9, "largest I1 - 3", open_low=True),
            },
            scale=_MU,
        ),
        Material(
            "harmonic",
            "Harmonic (compressible), without normal stress",
            plane_stress.harmonic,
            "W = 2 shear [f(lam1 + lam2 + lam3) - lam1 lam2 lam3], f(i) = 1 + (i-3) + f2 (i-3)^2/2; "
            "lam3 = 3 + (lam1 lam2 - 1)/f2 - lam1 - lam2",
            "John (1960), Haughton (2001); thesis, equation 3.25",
            {
                "shear": _modulus(2.0, "shear modulus"),
                "f2": Constant(2.0, 2 / 3, 100.0, "f''(3) = (1 - nu)/(1 - 2 nu)", open_low=True),
            },
            scale=_MU,
            kind="other",
            incompressible=False,
            width=lambda lam1, f2, **_: plane_stress.harmonic_width(lam1, f2),
        ),
    )
}
"""Every law of chapter 3, and Gent's and Varga's, by name."""
